//! The edge to a GPU: a plan is walked here, and a backend does what each verb says.
//!
//! [`prepare`] runs once per plan, [`execute`] once per frame. Both are deterministic: the same plan gives the same verbs in
//! the same order, which [`record::Recorder`] writes down for tests without a GPU.
//!
//! Accepted downside: a backend sees a whole [`Plan`] with every verb and could look ahead. In return the trait has a handful of verbs
//! and no types of its own.

use crate::plan::{MemoryId, Plan};

pub mod record;

/// What runs plans. Every `step` and `clear` is a valid index into the plan's lists.
pub trait Backend {
    /// Why a verb failed. The walker never looks into it.
    type Error;

    /// Creates a memory. Called once per memory, in order of ids, before any step is prepared. The memory holds nothing that
    /// the plan relies on.
    fn create_memory(&mut self, plan: &Plan, memory: MemoryId) -> Result<(), Self::Error>;

    /// Creates whatever a step needs to run. Called once per step, in order, when every memory stands.
    fn prepare_step(&mut self, plan: &Plan, step: usize) -> Result<(), Self::Error>;

    /// Fills the part of `plan.steps[step].clears[clear]` with its value. Called right before its step runs; the step is
    /// prepared.
    fn clear_part(&mut self, plan: &Plan, step: usize, clear: usize) -> Result<(), Self::Error>;

    /// Runs a step. It is prepared, its clears have been done, and all that it reads has been written by steps before it, in
    /// this frame or (if retained) an earlier one.
    fn run_step(&mut self, plan: &Plan, step: usize) -> Result<(), Self::Error>;

    /// Hands the frame's work to the device. Called once after the last step; not called if no step ran or one failed.
    fn submit(&mut self, plan: &Plan) -> Result<(), Self::Error>;

    /// Forgets the frame's work, since a step of it failed. Called instead of `submit`.
    fn abandon(&mut self);
}

/// Creates the memories and prepares the steps of a plan. Steps are prepared only if every memory stands; all errors of the
/// memories, or else of the steps, come back at once.
pub fn prepare<B: Backend>(plan: &Plan, backend: &mut B) -> Result<(), Vec<B::Error>> {
    let memories = 0..u32::try_from(plan.memories.len()).unwrap_or(u32::MAX);
    collect(memories.map(|memory| backend.create_memory(plan, MemoryId(memory))))?;
    collect((0..plan.steps.len()).map(|step| backend.prepare_step(plan, step)))
}

/// Runs every step of a prepared plan.
pub fn execute<B: Backend>(plan: &Plan, backend: &mut B) -> Result<(), B::Error> {
    execute_due(plan, 0..plan.steps.len(), backend)
}

/// Runs some steps of a prepared plan: `due` holds indices of steps in rising order. Nothing due submits nothing.
pub fn execute_due<B: Backend>(plan: &Plan, due: impl IntoIterator<Item = usize>, backend: &mut B) -> Result<(), B::Error> {
    let mut ran = false;
    for step in due {
        ran = true;
        if let Err(error) = run_one(plan, step, backend) {
            backend.abandon();
            return Err(error);
        }
    }
    if ran { backend.submit(plan) } else { Ok(()) }
}

fn run_one<B: Backend>(plan: &Plan, step: usize, backend: &mut B) -> Result<(), B::Error> {
    for clear in 0..plan.steps[step].clears.len() {
        backend.clear_part(plan, step, clear)?;
    }
    backend.run_step(plan, step)
}

fn collect<E>(results: impl Iterator<Item = Result<(), E>>) -> Result<(), Vec<E>> {
    let errors: Vec<E> = results.filter_map(Result::err).collect();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}
