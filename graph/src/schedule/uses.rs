//! All uses of all passes in one flat table.
//!
//! Steps are large and lie far apart; planning walks uses by pass and by resource many times, and needs little of each. Messages,
//! which need the rest, go back to the step.

use super::part::Rect;
use crate::bind::types::Bound;
use crate::expand::types::{PassId, ResourceId};
use crate::lists::Lists;
use crate::plan::{Access, Role, Use};

/// What planning needs of a use.
#[derive(Debug, Clone)]
pub(crate) struct Touch {
    pub(crate) pass: PassId,
    pub(crate) resource: ResourceId,
    pub(crate) rect: Rect,
    /// For a reader: the value as this pass left it, instead of the final one.
    pub(crate) version: Option<PassId>,
    pub(crate) role: Role,
    pub(crate) access: Access,
}

/// A use, by its place in the table: by pass, then in the order of the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct UseId(pub(crate) u32);

/// The table. What names no resource of the pipeline is left out of the second grouping.
#[derive(Debug)]
pub(crate) struct Uses {
    all: Vec<Touch>,
    /// Where each pass begins, and where the last one ends.
    starts: Vec<u32>,
    by_resource: Lists,
}

impl Uses {
    /// Reads every step once.
    pub(crate) fn new(bound: &Bound) -> Uses {
        let resources = bound.expanded.resources.len();
        let mut all = Vec::with_capacity(4 * bound.steps.len());
        let mut starts = Vec::with_capacity(bound.steps.len() + 1);
        for (pass, step) in bound.steps.iter().enumerate() {
            starts.push(all.len() as u32);
            all.extend(step.uses.iter().map(|used| Touch {
                pass: PassId(pass as u32),
                resource: used.resource,
                rect: Rect::new(&used.mips, &used.layers),
                version: used.version,
                role: used.role,
                access: used.access,
            }));
        }
        starts.push(all.len() as u32);
        let known = (0u32..).zip(&all).filter(|(_, touch)| touch.resource.index() < resources);
        let by_resource = Lists::from_pairs(resources, known.map(|(id, touch)| (touch.resource.0, id)));
        Uses { all, starts, by_resource }
    }

    /// A use.
    pub(crate) fn get(&self, id: UseId) -> &Touch {
        &self.all[id.0 as usize]
    }

    /// The use with all that its step says of it. The table was made from the same `bound`.
    pub(crate) fn in_step<'a>(&self, bound: &'a Bound, id: UseId) -> &'a Use {
        &bound.steps[self.get(id).pass.index()].uses[self.place_in_step(id)]
    }

    /// A use's place in the list of its step.
    pub(crate) fn place_in_step(&self, id: UseId) -> usize {
        (id.0 - self.starts[self.get(id).pass.index()]) as usize
    }

    /// The uses of a pass.
    pub(crate) fn of_pass(&self, pass: usize) -> &[Touch] {
        &self.all[self.starts[pass] as usize..self.starts[pass + 1] as usize]
    }

    /// The uses of a resource, by pass.
    pub(crate) fn of_resource(&self, resource: usize) -> impl Iterator<Item = UseId> + Clone {
        self.by_resource.of(resource).iter().map(|id| UseId(*id))
    }
}
