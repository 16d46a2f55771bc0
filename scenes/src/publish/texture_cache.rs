//! Keeps built textures until images or materials change: filtering a scene's images takes far longer than a frame.

use std::sync::Arc;

use bevy_ecs::change_detection::Tick;
use bevy_ecs::prelude::World;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::published::PublishedMaterials;

use super::textures::{self, TextureSet};
use crate::asset::Material;
use crate::world::{Images, Materials};

/// The last result, and what it was made from.
#[derive(Debug, Default)]
pub(super) struct TextureCache {
    materials: Option<Tick>,
    images: Option<Tick>,
    max_edge: u32,
    set: TextureSet,
    published: Arc<PublishedMaterials>,
}

impl TextureCache {
    /// The textures of `materials`, which are those of the world, with warnings. Equal ones are the ones of before.
    pub(super) fn update(&mut self, world: &World, materials: &[Material], max_edge: u32) -> (Arc<PublishedMaterials>, &[Diagnostic]) {
        let of_materials = world.get_resource_change_ticks::<Materials>().map(|ticks| ticks.changed);
        let of_images = world.get_resource_change_ticks::<Images>().map(|ticks| ticks.changed);
        let same_images = self.images == of_images && self.max_edge == max_edge;
        if !same_images || self.materials != of_materials {
            let images = world.get_resource::<Images>().map_or(&[][..], |images| &images.0);
            self.set = textures::build(materials, images, max_edge, Some(&self.set).filter(|_| same_images));
            if *self.published != self.set.published {
                self.published = Arc::new(self.set.published.clone());
            }
            (self.materials, self.images, self.max_edge) = (of_materials, of_images, max_edge);
        }
        (Arc::clone(&self.published), &self.set.warnings)
    }
}
