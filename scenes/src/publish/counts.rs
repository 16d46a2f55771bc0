//! How many of each thing a scene has.

use bevy_ecs::prelude::{Component, World};
use luminaire_graph::published::SceneCounts;

use super::objects::Coverage;
use super::schema::COUNT_NAMES;
use crate::world::{DirectionalSlot, LocalSlot, Materials, MeshInstance, PointSlot, ProbeSlot, RectangleSlot, SpotSlot};

/// The counts, under [`COUNT_NAMES`]. Those of lights and probes are the rows of the tables, as loops over them need: a slot that was freed below
/// others in use still counts. All others are entities, hidden ones among them, so that no plan has to be made anew for what is hidden
/// and shown.
pub fn counts(world: &World) -> SceneCounts {
    let rows = [
        rows(world, |slot: &DirectionalSlot| slot.0),
        rows(world, |slot: &PointSlot| slot.0),
        rows(world, |slot: &SpotSlot| slot.0),
        rows(world, |slot: &LocalSlot| slot.0),
        rows(world, |slot: &RectangleSlot| slot.0),
        rows(world, |slot: &ProbeSlot| slot.0),
    ];
    let mut surfaces = [0; 3];
    if let (Some(mut query), Some(materials)) = (world.try_query::<&MeshInstance>(), world.get_resource::<Materials>()) {
        for instance in query.iter(world) {
            if let Some(material) = materials.0.get(instance.material) {
                surfaces[Coverage::of(material) as usize] += 1;
            }
        }
    }
    COUNT_NAMES.iter().zip(rows.into_iter().chain(surfaces)).map(|(name, value)| ((*name).to_owned(), value)).collect()
}

/// One more than the highest slot.
fn rows<Slot: Component>(world: &World, row: impl Fn(&Slot) -> u32) -> u32 {
    world.try_query::<&Slot>().and_then(|mut query| query.iter(world).map(|slot| row(slot) + 1).max()).unwrap_or(0)
}
