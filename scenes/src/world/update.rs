//! Everything that follows from what the world's author sets, brought up to date.

use bevy_ecs::prelude::World;

use super::{SpatialIndex, assign_slots, propagate_transforms, propagate_visibility, update_bounds};

/// Runs the systems in order: transforms, visibility, slots, bounds, the spatial index. Costs what changed since the last
/// call, but for a look at each entity's ticks. Clears the world's trackers, so that `Changed` filters of queries mean "since the last
/// update".
pub fn update(world: &mut World) {
    propagate_transforms(world);
    propagate_visibility(world);
    assign_slots(world);
    update_bounds(world);
    SpatialIndex::update(world);
    world.clear_trackers();
}
