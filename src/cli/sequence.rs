//! `luminaire render --frames 0..120`: one image for each frame, the scene at the frame's time.
//!
//! Guarantees: each frame runs until it has settled, or once if some pass runs in every frame. Where no frame depends on those before it
//! ([`Plan::carries_over`]), its file has the bytes that it has alone, and frames whose file is there already are left out. Where one
//! does, each frame of the range runs, from the first on, whatever is there already; only files are left out. So a sequence that was
//! interrupted ends with the same files.
//! Things may come and go: the pipeline is compiled for each number of lights and the like before the first frame, so that what is wrong
//! with one of them is said before hours of rendering.
//!
//! Downside: whether files that are there came from the same pipeline, scene and size is not looked at.
//!
//! [`Plan::carries_over`]: luminaire_graph::plan::Plan::carries_over

use std::time::Instant;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_passes::Adapter;
use luminaire_scenes::publish::counts;
use luminaire_scenes::world::{World, assign_slots, set_time};
use serde_json::Value;

use super::arguments::RenderArguments;
use super::progress::Progress;
use super::render::{execute, nowhere};
use super::stats::{self, SequenceFrame};
use super::target::Sequence;
use crate::image_file::{create_folder_of, sweep_unfinished, write_image};
use crate::session::{Problems, RenderRequest, Session, carries_over, load_scene};

/// What a sequence is rendered from.
pub(super) struct Job<'a> {
    pub(super) adapter: &'a Adapter,
    /// As it was loaded.
    pub(super) world: World,
    pub(super) request: &'a RenderRequest<'a>,
    pub(super) sequence: &'a Sequence,
    /// The output to write.
    pub(super) output: &'a str,
    pub(super) arguments: &'a RenderArguments,
    pub(super) progress: &'a Progress,
}

/// Renders what is due and returns the statistics if they are asked for.
pub(super) fn render(mut job: Job<'_>) -> Result<Option<Value>, Problems> {
    let started = Instant::now();
    let sequence = job.sequence;
    let first = *sequence.frames.start();
    let carries_over = job.carries_over()?;
    job.go_back_to(first)?;
    let mut session = Session::on(job.adapter, &mut job.world, job.request)?;
    job.progress.report(&session.warnings.0, &session.warnings.1);
    let mut entries = Vec::new();
    if let Some(last) = sequence.due.last() {
        let one = |problem: Diagnostic| nowhere(vec![problem]);
        create_folder_of(&sequence.pattern.path(first)).map_err(one)?;
        sweep_unfinished(sequence.pattern.folder());
        let frames: Vec<u32> = if carries_over { (first..=*last).collect() } else { sequence.due.clone() };
        job.progress.say("rendering");
        if carries_over && sequence.warm_up > 0 {
            execute(&mut session, Some(sequence.warm_up), |_| ())?;
        }
        job.progress.count(frames.len() as u64);
        let mut memory = job.arguments.stats.as_ref().map(|_| stats::memory(&session));
        for (done, frame) in (0..).zip(frames) {
            job.progress.at(done);
            if job.go_on_to(frame, &mut session)? {
                memory = memory.map(|_| stats::memory(&session));
            }
            let frame_started = Instant::now();
            let once = session.never_settles().then_some(1);
            let mut executed = execute(&mut session, once, |_| ())?;
            let path = sequence.due.binary_search(&frame).is_ok().then(|| sequence.pattern.path(frame));
            if let Some(path) = &path {
                let image = session.read_output(job.output)?;
                executed.elapsed = frame_started.elapsed();
                write_image(path, &image).map_err(one)?;
            }
            if let Some(memory) = &memory {
                let frame = SequenceFrame { frame, time: sequence.time(frame), file: path.as_deref() };
                entries.push(stats::of_frame(&session, &frame, &executed, memory));
            }
        }
    }
    let scene = &job.arguments.scene;
    let stats = job.arguments.stats.as_ref();
    Ok(stats.map(|_| stats::of_sequence(&session, scene, sequence, carries_over, started.elapsed(), entries)))
}

impl Job<'_> {
    /// Whether frames depend on those before them anywhere in the sequence: a light that appears may bring passes that gather. Goes
    /// through all of it, and compiles for whatever the scene has on the way.
    fn carries_over(&mut self) -> Result<bool, Problems> {
        let mut known = Vec::new();
        let mut found = false;
        for frame in self.sequence.frames.clone() {
            self.set_time(frame)?;
            assign_slots(&mut self.world);
            let counts = counts(&self.world);
            if !known.contains(&counts) {
                found |= carries_over(self.adapter, &mut self.world, self.request)?;
                known.push(counts);
            }
        }
        Ok(found)
    }

    /// Where what has happened can't be undone, the scene is loaded again.
    fn go_back_to(&mut self, frame: u32) -> Result<(), Problems> {
        if self.set_time(frame).is_ok() {
            return Ok(());
        }
        self.world = load_scene(&self.arguments.scene, self.arguments.asset_root.as_deref())?.world;
        self.set_time(frame)
    }

    /// Brings the scene and what renders it to a frame. Returns whether the plan is another; of its warnings, new ones are reported.
    fn go_on_to(&mut self, frame: u32, session: &mut Session) -> Result<bool, Problems> {
        self.set_time(frame)?;
        let before = session.warnings.0.clone();
        let compiled = session.follow(&mut self.world, self.request)?;
        if compiled {
            let (warnings, sources) = &session.warnings;
            let new: Vec<Diagnostic> = warnings.iter().filter(|warning| !before.contains(warning)).cloned().collect();
            self.progress.report(&new, sources);
        }
        Ok(compiled)
    }

    fn set_time(&mut self, frame: u32) -> Result<(), Problems> {
        set_time(&mut self.world, self.sequence.time(frame)).map_err(nowhere)
    }
}
