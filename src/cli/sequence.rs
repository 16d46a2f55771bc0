//! `luminaire render --frames 0..120`: one image for each frame, the scene at the frame's time.
//!
//! Guarantees: where no frame depends on those before it ([`Plan::carries_over`]), each runs until it has settled, so that its file has
//! the bytes that it has alone, and frames whose file is there already are left out. Where one does, each frame of the range runs once,
//! from the first on, whatever is there already; only files are left out. So a sequence that was interrupted ends with the same files.
//! Things may come and go: the pipeline is compiled for each number of lights and the like before the first frame, so that what is wrong
//! with one of them is said before hours of rendering.
//!
//! Downside: whether files that are there came from the same pipeline, scene and size is not looked at.
//!
//! [`Plan::carries_over`]: luminaire_graph::plan::Plan::carries_over

use std::time::Instant;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_scenes::publish::counts;
use luminaire_scenes::world::{World, assign_slots, set_time};
use serde_json::Value;

use super::progress::Progress;
use super::render::{execute, nowhere};
use super::stats::{self, SequenceFrame};
use super::target::Sequence;
use crate::image_file::{create_folder_of, sweep_unfinished, write_image};
use crate::session::{Problems, RenderRequest, Session};

/// What a sequence is rendered from.
pub(super) struct Job<'a> {
    /// Compiled for the world as it is at the first frame.
    pub(super) session: &'a mut Session,
    /// Its time is that of the first frame.
    pub(super) world: &'a mut World,
    pub(super) request: &'a RenderRequest<'a>,
    pub(super) sequence: &'a Sequence,
    /// The output to write.
    pub(super) output: &'a str,
    /// As the user named it.
    pub(super) scene: &'a str,
    /// Whether frames are measured.
    pub(super) measure: bool,
    pub(super) progress: &'a Progress,
}

/// Renders what is due and returns the statistics.
pub(super) fn render(mut job: Job<'_>) -> Result<Value, Problems> {
    let started = Instant::now();
    let sequence = job.sequence;
    let first = *sequence.frames.start();
    job.progress.say("compiling for all that comes into the scene");
    let carries_over = job.carries_over()?;
    job.progress.report(&job.session.warnings.0, &job.session.warnings.1);
    let mut entries = Vec::new();
    if let Some(last) = sequence.due.last() {
        let one = |problem: Diagnostic| nowhere(vec![problem]);
        create_folder_of(&sequence.pattern.path(first)).map_err(one)?;
        sweep_unfinished(sequence.pattern.folder());
        let frames: Vec<u32> = if carries_over { (first..=*last).collect() } else { sequence.due.clone() };
        job.progress.say("rendering");
        if carries_over && sequence.warm_up > 0 {
            execute(job.session, Some(sequence.warm_up), |_| ())?;
        }
        job.progress.count(frames.len() as u64);
        let mut memory = job.measure.then(|| stats::memory(job.session));
        for (done, frame) in (0..).zip(frames) {
            job.progress.at(done);
            job.go_to(frame, &mut memory)?;
            let frame_started = Instant::now();
            let mut executed = execute(job.session, carries_over.then_some(1), |_| ())?;
            let path = sequence.due.binary_search(&frame).is_ok().then(|| sequence.pattern.path(frame));
            if let Some(path) = &path {
                let image = job.session.read_output(job.output)?;
                executed.elapsed = frame_started.elapsed();
                write_image(path, &image).map_err(one)?;
            }
            if let Some(memory) = &memory {
                let frame = SequenceFrame { frame, time: sequence.time(frame), file: path.as_deref() };
                entries.push(stats::of_frame(job.session, &frame, &executed, memory));
            }
        }
    }
    Ok(stats::of_sequence(job.session, job.scene, sequence, carries_over, started.elapsed(), entries))
}

impl Job<'_> {
    /// Whether frames depend on those before them anywhere in the sequence: a light that appears may bring passes that gather.
    fn carries_over(&mut self) -> Result<bool, Problems> {
        let mut known = Vec::new();
        let mut found = false;
        for frame in self.sequence.frames.clone() {
            self.set_time(frame)?;
            assign_slots(self.world);
            let counts = counts(self.world);
            if !known.contains(&counts) {
                found |= self.session.would_carry_over(self.world, self.request)?;
                known.push(counts);
            }
        }
        self.set_time(*self.sequence.frames.start())?;
        Ok(found)
    }

    /// Brings scene and session to a frame. Warnings of another plan are new, if there is one.
    fn go_to(&mut self, frame: u32, memory: &mut Option<Value>) -> Result<(), Problems> {
        self.set_time(frame)?;
        let before = self.session.warnings.0.clone();
        if self.session.follow(self.world, self.request)? {
            let (warnings, sources) = &self.session.warnings;
            let new: Vec<Diagnostic> = warnings.iter().filter(|warning| !before.contains(warning)).cloned().collect();
            self.progress.report(&new, sources);
            if let Some(memory) = memory {
                *memory = stats::memory(self.session);
            }
        }
        Ok(())
    }

    fn set_time(&mut self, frame: u32) -> Result<(), Problems> {
        set_time(self.world, self.sequence.time(frame)).map_err(nowhere)
    }
}
