//! `--stats`: what rendering cost, as JSON.
//!
//! Of one image it is one object. Of a sequence, what is the same for all images stands in the object, and `frames` is an array
//! with an object per frame that ran, in order, also for those whose file was there already (`file` is null then). Frames that did not
//! run are not in it.

use std::path::Path;
use std::time::Duration;

use luminaire_passes::FrameStats;
use serde_json::{Value, json};

use super::target::Sequence;
use crate::session::Session;

/// What an image took.
#[derive(Debug)]
pub(super) struct Executed {
    /// How many frames ran.
    pub(super) frames: u32,
    /// The last frame that did something.
    pub(super) last: FrameStats,
    /// With reading the image back.
    pub(super) elapsed: Duration,
}

/// A frame of a sequence.
pub(super) struct SequenceFrame<'a> {
    /// Its number.
    pub(super) frame: u32,
    /// Its time, seconds.
    pub(super) time: f64,
    /// The file that was written, if one was.
    pub(super) file: Option<&'a Path>,
}

/// The statistics of one image.
pub(super) fn of_image(session: &Session, scene: &str, executed: &Executed) -> Value {
    let mut value = head(session, scene);
    value["frames"] = executed.frames.into();
    add(&mut value, session, executed, &memory(session));
    value
}

/// An entry of a sequence's `frames`.
pub(super) fn of_frame(session: &Session, frame: &SequenceFrame<'_>, executed: &Executed, memory: &Value) -> Value {
    let file = frame.file.map(|path| path.display().to_string());
    let mut value = json!({ "frame": frame.frame, "time": frame.time, "file": file, "executed": executed.frames });
    add(&mut value, session, executed, memory);
    value
}

/// The statistics of a sequence, from the entries of its frames.
pub(super) fn of_sequence(
    session: &Session,
    scene: &str,
    sequence: &Sequence,
    carries_over: bool,
    elapsed: Duration,
    frames: Vec<Value>,
) -> Value {
    let mut value = head(session, scene);
    value["fps"] = sequence.fps.into();
    value["warm_up"] = sequence.warm_up.into();
    value["carries_over"] = carries_over.into();
    value["seconds"] = elapsed.as_secs_f64().into();
    value["frames"] = frames.into();
    value
}

fn head(session: &Session, scene: &str) -> Value {
    json!({ "pipeline": session.plan.name, "scene": scene, "adapter": session.adapter.name(), "size": session.plan.extent })
}

/// What the plan's memory comes to.
pub(super) fn memory(session: &Session) -> Value {
    let figures = session.plan.figures;
    let placed = session.plan.placed();
    json!({
        "without_sharing": figures.without_sharing,
        "reached": figures.reached,
        "bound": figures.bound,
        "declared_bound": session.plan.declared_bound(),
        "placed": placed.bytes,
        "placed_bound": placed.bound,
        "retained": figures.retained,
    })
}

/// Times, memory and counts, behind what is there.
fn add(value: &mut Value, session: &Session, executed: &Executed, memory: &Value) {
    let frame = &executed.last;
    let passes: Vec<Value> = match &frame.times {
        Some(times) => times.iter().map(|time| json!({ "pass": time.name, "gpu_ms": time.milliseconds })).collect(),
        None => session.plan.steps.iter().map(|step| json!({ "pass": step.name, "gpu_ms": null })).collect(),
    };
    value["seconds"] = executed.elapsed.as_secs_f64().into();
    value["passes"] = passes.into();
    value["memory_bytes"] = memory.clone();
    value["counts"] = json!({
        "steps": frame.counts.steps,
        "culled": session.plan.culled.len(),
        "draw_calls": frame.counts.draw_calls,
        "triangles": frame.counts.triangles,
        "dispatches": frame.counts.dispatches,
        "pipelines": frame.pipelines_created,
        "bind_groups": frame.bind_groups_created,
    });
}
