//! Keeps built textures until images or materials change: filtering a scene's images takes far longer than a frame.

use bevy_ecs::change_detection::Tick;
use bevy_ecs::prelude::{Resource, World};

use super::textures::{self, TextureSet};
use crate::asset::Material;
use crate::world::{Images, Materials};

/// The last result, and what it was made from.
#[derive(Resource, Debug)]
struct Cache {
    key: Key,
    set: TextureSet,
}

/// When materials and images changed last, and the limit.
type Key = ([Option<Tick>; 2], u32);

/// The textures of `materials`, which are those of the world.
pub(super) fn textures(world: &mut World, materials: &[Material], max_edge: u32) -> TextureSet {
    let changed = [world.get_resource_change_ticks::<Materials>(), world.get_resource_change_ticks::<Images>()];
    let key = (changed.map(|ticks| ticks.map(|ticks| ticks.changed)), max_edge);
    if let Some(cache) = world.get_resource::<Cache>().filter(|cache| cache.key == key) {
        return cache.set.clone();
    }
    let set = textures::build(materials, world.get_resource::<Images>().map_or(&[][..], |images| &images.0), max_edge);
    world.insert_resource(Cache { key, set: set.clone() });
    // Changes from here on must show as later ones.
    world.increment_change_tick();
    set
}
