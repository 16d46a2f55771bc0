//! Where resources live, as densely as deciding what runs looks at it.

use crate::expand::types::ResourceId;
use crate::plan::{MemoryId, Plan};

/// Where a resource lives, and from when on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// `None` if no step names it.
    pub(super) memory: Option<MemoryId>,
    /// Whether others live in that memory.
    pub(super) shared: bool,
    /// The first step that names it.
    pub(super) first: u32,
    /// First byte, and the one after the last.
    bytes: (u64, u64),
}

impl Place {
    /// By resource.
    pub(super) fn all(plan: &Plan) -> Vec<Place> {
        let mut holders = vec![0u32; plan.memories.len()];
        for placement in plan.resources.iter().filter_map(|resource| resource.placement) {
            holders[placement.memory.index()] += 1;
        }
        let mut places: Vec<Place> = (0..plan.resources.len()).map(|index| Place::of(plan, ResourceId(index as u32))).collect();
        for place in &mut places {
            place.shared = place.memory.is_some_and(|memory| holders[memory.index()] > 1);
        }
        places
    }

    fn of(plan: &Plan, id: ResourceId) -> Place {
        let resource = &plan.resources[id.index()];
        let start = resource.placement.map_or(0, |placement| placement.offset);
        Place {
            memory: resource.placement.map(|placement| placement.memory),
            shared: true,
            first: resource.lifetime.start as u32,
            bytes: (start, start.saturating_add(resource.bytes)),
        }
    }

    /// Whether two resources have a byte in common.
    pub(super) fn overlaps(&self, other: &Place) -> bool {
        self.memory == other.memory && self.memory.is_some() && self.bytes.0 < other.bytes.1 && other.bytes.0 < self.bytes.1
    }
}

/// Whether two resources of a plan have a byte in common.
pub(crate) fn overlap(plan: &Plan, a: ResourceId, b: ResourceId) -> bool {
    Place::of(plan, a).overlaps(&Place::of(plan, b))
}
