//! Frames for tests: bytes that change hands are poisoned first, so that what relies on another resource's leftovers shows.
//!
//! A resource takes bytes over when a step or a fill first writes it while they belong to another one, or to nobody. Accepted
//! downside: a resource that still has its bytes keeps its old content there, even where nobody may rely on that any more.

use super::Backend;
use crate::dirty::{Frame, Tracker, overlap};
use crate::expand::types::ResourceId;
use crate::plan::Plan;
use crate::schedule::writes;

/// Runs a frame of the tracker's plan like [`super::execute`], and has bytes poisoned that are taken over.
pub fn execute_poisoned<B: Backend>(tracker: &Tracker, frame: &Frame, backend: &mut B) -> Result<(), B::Error> {
    let plan = tracker.plan();
    super::execute_with(plan, frame, backend, &mut Some(Owners { plan, residents: tracker.residents().to_vec() }))
}

/// Whose bytes are whose while a frame runs.
pub(super) struct Owners<'a> {
    plan: &'a Plan,
    /// By memory.
    residents: Vec<Vec<ResourceId>>,
}

impl Owners<'_> {
    /// Before a step does anything to what it writes.
    pub(super) fn step<B: Backend>(&mut self, step: usize, backend: &mut B) -> Result<(), B::Error> {
        let plan = self.plan;
        plan.steps[step].uses.iter().filter(|used| writes(used.role)).try_for_each(|used| self.take(used.resource, backend))
    }

    /// Before a resource is written.
    pub(super) fn take<B: Backend>(&mut self, resource: ResourceId, backend: &mut B) -> Result<(), B::Error> {
        let Some(placement) = self.plan.resources[resource.index()].placement else { return Ok(()) };
        let residents = &mut self.residents[placement.memory.index()];
        if residents.contains(&resource) {
            return Ok(());
        }
        residents.retain(|other| !overlap(self.plan, *other, resource));
        residents.push(resource);
        backend.poison(self.plan, resource)
    }
}
