//! How many of each thing a scene has.

use bevy_ecs::prelude::World;
use luminaire_graph::published::SceneCounts;

use super::objects::Coverage;
use super::schema::COUNT_NAMES;
use crate::world::{DirectionalSlot, LocalLight, LocalSlot, Materials, MeshInstance, RectangleSlot};

/// The counts, under [`COUNT_NAMES`]. `directional_lights`, `local_lights` and `rectangle_lights` are the rows of the tables, as loops
/// over them need: a slot that was freed below others in use still counts. All others are entities, hidden ones among them, so that no plan has
/// to be made anew for what is hidden and shown.
pub fn counts(world: &World) -> SceneCounts {
    let directional = world.try_query::<&DirectionalSlot>().and_then(|mut query| query.iter(world).map(|slot| slot.0 + 1).max());
    let local = world.try_query::<&LocalSlot>().and_then(|mut query| query.iter(world).map(|slot| slot.0 + 1).max());
    let (mut points, mut spots) = (0, 0);
    if let Some(mut query) = world.try_query::<&LocalLight>() {
        for light in query.iter(world) {
            *(if light.cone.is_some() { &mut spots } else { &mut points }) += 1;
        }
    }
    let rectangles = world.try_query::<&RectangleSlot>().and_then(|mut query| query.iter(world).map(|slot| slot.0 + 1).max());
    let mut surfaces = [0; 3];
    if let (Some(mut query), Some(materials)) = (world.try_query::<&MeshInstance>(), world.get_resource::<Materials>()) {
        for instance in query.iter(world) {
            if let Some(material) = materials.0.get(instance.material) {
                surfaces[Coverage::of(material) as usize] += 1;
            }
        }
    }
    let [opaque, masked, blended] = surfaces;
    let values = [directional.unwrap_or(0), points, spots, local.unwrap_or(0), rectangles.unwrap_or(0), opaque, masked, blended];
    COUNT_NAMES.iter().zip(values).map(|(name, value)| ((*name).to_owned(), value)).collect()
}
