//! The edge to a GPU: a plan is walked here, and a backend does what each verb says.
//!
//! [`prepare`] runs once per plan, [`execute`] once per frame. Both are deterministic: the same plan gives the same verbs in
//! the same order, which [`record::Recorder`] writes down for tests without a GPU.
//!
//! Accepted downside: a backend sees a whole [`Plan`] with every verb and could look ahead. In return the trait has a handful of verbs
//! and no types of its own.

use crate::dirty::{Frame, StepRun};
use crate::expand::types::{ClearValue, ResourceId};
use crate::plan::{MemoryId, PartView, Plan};

mod poison;
pub mod record;

use poison::Owners;
pub use poison::execute_poisoned;

/// What runs plans. Every `step` and `clear` is a valid index into the plan's lists.
pub trait Backend {
    /// Why a verb failed. The walker never looks into it.
    type Error;

    /// Creates a memory. Called once per memory that is not taken over, in order of ids, before any step is prepared. The memory
    /// holds nothing that the plan relies on.
    fn create_memory(&mut self, plan: &Plan, memory: MemoryId) -> Result<(), Self::Error>;

    /// Creates whatever a step needs to run. Called once per step, in order, when every memory stands.
    fn prepare_step(&mut self, plan: &Plan, step: usize) -> Result<(), Self::Error>;

    /// Fills a part with a value: a declared value that is not held, or what a step starts from.
    fn fill(&mut self, plan: &Plan, part: &PartView, value: ClearValue) -> Result<(), Self::Error>;

    /// Runs a step. It is prepared, its clears have been done, and all that it reads has been written by steps before it, in
    /// this frame or (if it is held) an earlier one.
    fn run_step(&mut self, plan: &Plan, run: &StepRun) -> Result<(), Self::Error>;

    /// Hands the frame's work to the device. Called once after the last step; not called if no step ran or one failed.
    fn submit(&mut self, plan: &Plan) -> Result<(), Self::Error>;

    /// Fills a resource with what no pass can mistake for its value. Called by [`execute_poisoned`] alone, before a resource is
    /// written that takes its bytes over.
    fn poison(&mut self, plan: &Plan, resource: ResourceId) -> Result<(), Self::Error>;

    /// Forgets the frame's work, since a step of it failed. Called instead of `submit`.
    fn abandon(&mut self);
}

/// Creates the memories and prepares the steps of a plan; `taken` tells, by memory, which ones stand already. Steps are prepared
/// only if every memory stands; all errors of the memories, or else of the steps, come back at once.
pub fn prepare<B: Backend>(plan: &Plan, taken: &[Option<MemoryId>], backend: &mut B) -> Result<(), Vec<B::Error>> {
    let memories = 0..u32::try_from(plan.memories.len()).unwrap_or(u32::MAX);
    let missing = memories.filter(|memory| taken.get(*memory as usize).copied().flatten().is_none());
    collect(missing.map(|memory| backend.create_memory(plan, MemoryId(memory))))?;
    collect((0..plan.steps.len()).map(|step| backend.prepare_step(plan, step)))
}

/// Runs a frame of a prepared plan. An empty one submits nothing.
pub fn execute<B: Backend>(plan: &Plan, frame: &Frame, backend: &mut B) -> Result<(), B::Error> {
    execute_with(plan, frame, backend, &mut None)
}

fn execute_with<B: Backend>(plan: &Plan, frame: &Frame, backend: &mut B, owners: &mut Option<Owners<'_>>) -> Result<(), B::Error> {
    if frame.is_empty() {
        return Ok(());
    }
    let ran = encode(plan, frame, backend, owners);
    if ran.is_err() {
        backend.abandon();
        return ran;
    }
    backend.submit(plan)
}

fn encode<B: Backend>(plan: &Plan, frame: &Frame, backend: &mut B, owners: &mut Option<Owners<'_>>) -> Result<(), B::Error> {
    for run in &frame.runs {
        for (part, value) in &run.fills {
            if let Some(owners) = owners {
                owners.take(part.resource, backend)?;
            }
            backend.fill(plan, part, *value)?;
        }
        if let Some(owners) = owners {
            owners.step(run.step, backend)?;
        }
        for (part, value) in &run.clears {
            backend.fill(plan, part, *value)?;
        }
        backend.run_step(plan, run)?;
    }
    for (part, value) in &frame.last_fills {
        if let Some(owners) = owners {
            owners.take(part.resource, backend)?;
        }
        backend.fill(plan, part, *value)?;
    }
    Ok(())
}

fn collect<E>(results: impl Iterator<Item = Result<(), E>>) -> Result<(), Vec<E>> {
    let errors: Vec<E> = results.filter_map(Result::err).collect();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}
