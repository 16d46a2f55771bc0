//! From which step to which each resource is in use, and which resources outlive the frame.
//!
//! Lifetimes are per whole resource: one part in use keeps all of it.

use std::ops::Range;

use crate::bind::types::Bound;
use crate::expand::types::PassId;
use crate::lists::Lists;
use crate::plan::Retained;
use crate::schedule::{InitialClear, Schedule, Uses};

/// When each resource is in use, by resource id.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Lifetimes {
    /// The steps from the first to the last that touch it, by place in the order, end exclusive. Empty if none does.
    pub ranges: Vec<Range<usize>>,
    /// Why it shares memory with nothing, if so.
    pub retained: Vec<Option<Retained>>,
}

/// Lifetimes in the chosen order, for what [`crate::dirty::retention()`] says.
pub fn lifetimes(bound: &Bound, schedule: &Schedule, retained: Vec<Option<Retained>>) -> Lifetimes {
    let mut ranges = schedule.model.touches.ranges(&schedule.order);
    // An output that nothing writes is cleared by a step that does not name it.
    let mut places = vec![None; if schedule.initial_clears.is_empty() { 0 } else { bound.steps.len() }];
    for (place, pass) in schedule.order.iter().enumerate().take(places.len()) {
        places[pass.index()] = Some(place);
    }
    for InitialClear { pass, part, .. } in &schedule.initial_clears {
        if let (Some(place), Some(range)) = (places[pass.index()], ranges.get_mut(part.resource.index())) {
            // Whoever touches it first fills what it needs; only what nobody touches needs a place of its own.
            if Range::is_empty(range) {
                *range = place..place + 1;
            }
        }
    }
    Lifetimes { ranges, retained }
}

/// For each pass the resources that it touches, each once. Flat, since every candidate order walks all of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Touches {
    resources: Lists,
    resource_count: usize,
}

impl Touches {
    /// Reads the uses of all steps.
    pub(crate) fn new(bound: &Bound, uses: &Uses) -> Touches {
        let resource_count = bound.expanded.resources.len();
        let mut resources = Lists::with_capacity(bound.steps.len(), 4 * bound.steps.len());
        let mut seen_by = vec![u32::MAX; resource_count];
        for (pass, step) in bound.steps.iter().enumerate() {
            let declared = step.clears.iter().map(|(part, _)| part.resource);
            for resource in uses.of_pass(pass).iter().map(|used| used.resource).chain(declared) {
                if let Some(seen) = seen_by.get_mut(resource.index())
                    && std::mem::replace(seen, pass as u32) != pass as u32
                {
                    resources.push(resource.0);
                }
            }
            resources.finish_list();
        }
        Touches { resources, resource_count }
    }

    /// What a pass touches.
    pub(crate) fn of(&self, pass: PassId) -> &[u32] {
        self.resources.of(pass.index())
    }

    /// How many resources there are.
    pub(crate) fn resource_count(&self) -> usize {
        self.resource_count
    }

    /// First to last touching place of each resource in an order, end exclusive.
    pub(crate) fn ranges(&self, order: &[PassId]) -> Vec<Range<usize>> {
        let mut ranges = vec![0..0; self.resource_count];
        for (place, pass) in order.iter().enumerate() {
            for resource in self.of(*pass) {
                let range = &mut ranges[*resource as usize];
                if Range::is_empty(range) {
                    range.start = place;
                }
                range.end = place + 1;
            }
        }
        ranges
    }
}
