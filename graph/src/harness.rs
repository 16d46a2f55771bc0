//! Unit tests of pipelines without a GPU: what runs after which change, what is shared, what the order is.
//!
//! A harness compiles a pipeline and plays frames on it. Everything is decided as on a device, and nothing is rendered.
//!
//! ```
//! # use luminaire_graph::{compile::CompileInput, device::DeviceFacts, harness::Harness};
//! # use luminaire_graph::{published::{PublishedSchema, SceneCounts}, source::{FileKind, MemoryFiles}};
//! # let files = MemoryFiles::default().with(FileKind::Pipeline, "mine.ron", r#"(
//! #     doc: "Two colours.",
//! #     resources: { "a": Texture(format: "rgba8unorm"), "b": Texture(format: "rgba8unorm") },
//! #     passes: { "first": Clear(write: "a"), "second": Copy(read: "a", write: "b") },
//! #     outputs: { "color": "b" },
//! # )"#);
//! # let (schema, counts) = (PublishedSchema::default(), SceneCounts::default());
//! # let device = DeviceFacts::webgpu_defaults();
//! # let input = CompileInput { pipeline: "mine.ron", files: &files, published: &schema, counts: &counts, device: &device,
//! #     output: [64, 64], sets: &[], outputs: None };
//! let mut harness = Harness::new(&input)?;
//! assert_eq!(harness.frame(), ["first", "second"]);
//! assert!(harness.frame().is_empty(), "nothing changed");
//! # Ok::<(), String>(())
//! ```
//!
//! Accepted: a change of an input is a change, whatever its bytes would be.

use std::sync::Arc;

use crate::compile::{CompileInput, compile};
use crate::diagnostic::render;
use crate::dirty::{Frame, StepRun, Tracker};
use crate::dump;
use crate::plan::{Input, Plan};

/// A pipeline that plays frames on no device.
#[derive(Debug)]
pub struct Harness {
    tracker: Tracker,
    revisions: Vec<u64>,
    last: Arc<Frame>,
}

impl Harness {
    /// Compiles a pipeline. The error is every problem as text, with its place.
    pub fn new(input: &CompileInput<'_>) -> Result<Harness, String> {
        Ok(Harness::play(plan(input)?))
    }

    /// For a plan that stands already.
    pub fn of(plan: Plan) -> Harness {
        Harness::play(Arc::new(plan))
    }

    fn play(plan: Arc<Plan>) -> Harness {
        let revisions = vec![0; plan.inputs.len()];
        Harness { tracker: Tracker::new(plan), revisions, last: Arc::default() }
    }

    /// Turns to another plan, as after a resize, a changed parameter or an edited file. What is the same stays held.
    pub fn replan(&mut self, input: &CompileInput<'_>) -> Result<(), String> {
        let plan = plan(input)?;
        let known: Vec<(Input, u64)> = self.tracker.inputs().iter().cloned().zip(self.revisions.iter().copied()).collect();
        let revision = |input: &Input| known.iter().find(|(other, _)| other == input).map_or(0, |(_, revision)| *revision);
        self.revisions = plan.inputs.iter().map(revision).collect();
        self.tracker.adopt(plan);
        Ok(())
    }

    /// The plan.
    pub fn plan(&self) -> &Plan {
        self.tracker.plan()
    }

    /// Plays a frame: the passes that run, in order. Of a batched pass the indices of its iterations stand behind the name: `trace[0, 7]`.
    pub fn frame(&mut self) -> Vec<String> {
        let frame = self.tracker.frame(&self.revisions);
        self.tracker.commit(&frame, &self.revisions);
        let ran = self.names(&frame);
        self.last = frame;
        ran
    }

    fn names(&self, frame: &Frame) -> Vec<String> {
        let steps = &self.tracker.plan().steps;
        let name = |run: &StepRun| {
            let iterations = if run.iterations.is_empty() { String::new() } else { format!("{:?}", run.iterations) };
            format!("{}{iterations}", steps[run.step].name)
        };
        frame.runs.iter().map(name).collect()
    }

    /// For each input, the passes that would run in the next frame if it alone changed.
    pub fn reach(&mut self) -> Vec<(String, Vec<String>)> {
        let mut revisions = self.revisions.clone();
        let mut reach = Vec::new();
        for (index, name) in self.inputs().into_iter().enumerate() {
            revisions[index] += 1;
            let frame = self.tracker.frame(&revisions);
            reach.push((name, self.names(&frame)));
            revisions[index] -= 1;
        }
        reach
    }

    /// The names of the inputs, as explanations show them: `camera`, `local_lights[2]`, `parameter exposure`.
    pub fn inputs(&self) -> Vec<String> {
        (0..self.plan().inputs.len()).map(|index| dump::input_name(self.plan(), index)).collect()
    }

    /// Changes the inputs of a name, as [`Harness::inputs`] gives them; how many there are.
    pub fn change_named(&mut self, name: &str) -> usize {
        let names = self.inputs();
        let fits = self.revisions.iter_mut().zip(&names).filter(|(_, known)| *known == name);
        fits.map(|(revision, _)| *revision += 1).count()
    }

    /// Plays frames until nothing runs; how many it took. `None` if something still runs after `most` of them.
    pub fn settle(&mut self, most: usize) -> Option<usize> {
        (0..=most).find(|_| self.frame().is_empty())
    }

    /// Changes every input that fits; how many there are. `harness.change(|input| matches!(input, Input::Table(name, _) if name == "camera"))`
    pub fn change(&mut self, fits: impl Fn(&Input) -> bool) -> usize {
        let inputs = self.tracker.inputs().to_vec();
        let mut changed = 0;
        for (revision, _) in self.revisions.iter_mut().zip(&inputs).filter(|(_, input)| fits(input)) {
            *revision += 1;
            changed += 1;
        }
        changed
    }

    /// Changes the published table of this name, and its rows, in every member; how many inputs that is.
    pub fn change_table(&mut self, name: &str) -> usize {
        self.change(|input| matches!(input, Input::Table(table, _) | Input::Row(table, ..) if table == name))
    }

    /// Loses the device: nothing is held any more.
    pub fn lose_device(&mut self) {
        self.tracker.lose();
    }

    /// The passes in the order in which they run.
    pub fn order(&self) -> Vec<&str> {
        self.plan().steps.iter().map(|step| &*step.name).collect()
    }

    /// The resources that have some of the same bytes at another time.
    pub fn shares_with(&self, resource: &str) -> Vec<&str> {
        let plan = self.plan();
        let Some(index) = plan.resources.iter().position(|known| known.name == resource) else { return Vec::new() };
        let sharers = dump::sharers(plan, crate::expand::types::ResourceId(index as u32));
        sharers.into_iter().map(|id| plan.resources[id.index()].name.as_str()).collect()
    }

    /// Whether a resource keeps its content from frame to frame.
    pub fn is_retained(&self, resource: &str) -> bool {
        self.plan().resources.iter().any(|known| known.name == resource && known.retained.is_some())
    }

    /// Why each pass ran in the last frame or did not, why each resource shares memory or does not, why each culled pass is.
    /// `pass` names the only one of interest.
    pub fn explain(&self, pass: Option<&str>) -> String {
        dump::explain_text(&self.tracker, &self.last, pass)
    }

    /// The same as JSON.
    pub fn explain_json(&self) -> serde_json::Value {
        dump::explain_json(&self.tracker, &self.last)
    }
}

fn plan(input: &CompileInput<'_>) -> Result<Arc<Plan>, String> {
    let compilation = compile(input);
    compilation.plan.map(Arc::new).ok_or_else(|| render(&compilation.diagnostics, &compilation.sources, false))
}
