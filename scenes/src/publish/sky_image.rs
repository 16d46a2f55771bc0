//! The image of the sky as a texture, with what the light unit needs to know of it.
//!
//! It is built again only for another image. A scene without one has one black texel. Accepted: mips are means over texels and not over
//! solid angles, so that the rows at the poles count for more than they cover.

use std::sync::Arc;

use bevy_ecs::prelude::World;
use half::f16;
use luminaire_graph::published::{PublishedTexels, PublishedTexture};

use super::mips::{Level, shrink};
use crate::linear_image::LinearImage;
use crate::world::SkyImage;

/// A half float holds so many times the light unit's brightest modest radiance.
const HEADROOM: f64 = 1023.0;

/// The texture of the last image.
#[derive(Debug)]
pub(super) struct SkyTexture {
    /// The image and the largest edge that it was built from.
    from: Option<(Arc<LinearImage>, u32)>,
    texture: Arc<PublishedTexture>,
    brightest: f64,
}

/// How the image is seen.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sky {
    pub(super) rotation: f32,
    /// 0 where there is no image.
    pub(super) strength: f32,
    /// The radiance that the light unit should do justice to, nits.
    pub(super) brightest: f64,
}

impl Default for SkyTexture {
    fn default() -> SkyTexture {
        let black = PublishedTexture {
            name: "no sky".to_owned(),
            texels: PublishedTexels::Half,
            width: 1,
            height: 1,
            mips: vec![encode(&[[0.0; 4]])],
        };
        SkyTexture { from: None, texture: Arc::new(black), brightest: 0.0 }
    }
}

impl SkyTexture {
    /// The texture of the world's sky, with edges of at most `max_edge`.
    pub(super) fn update(&mut self, world: &World, max_edge: u32) -> (Arc<PublishedTexture>, Sky) {
        let Some(sky) = world.get_resource::<SkyImage>().filter(|sky| !sky.image.texels.is_empty()) else {
            *self = SkyTexture::default();
            return (Arc::clone(&self.texture), Sky::default());
        };
        let same = self.from.as_ref().is_some_and(|(image, edge)| Arc::ptr_eq(image, &sky.image) && *edge == max_edge);
        if !same {
            *self = SkyTexture {
                from: Some((Arc::clone(&sky.image), max_edge)),
                texture: Arc::new(build(&sky.image, max_edge)),
                brightest: brightest(&sky.image),
            };
        }
        let finite = |value: f32| if value.is_finite() { value } else { 0.0 };
        let strength = finite(sky.strength).max(0.0);
        let seen = Sky { rotation: finite(sky.rotation), strength, brightest: self.brightest * f64::from(strength) };
        (Arc::clone(&self.texture), seen)
    }
}

/// Its mean, or its brightest texel as far as that would not fit otherwise: the sun in an image may clip nothing else.
fn brightest(image: &LinearImage) -> f64 {
    let luminance = |texel: &[f32; 4]| f64::from(texel[0].max(texel[1]).max(texel[2]));
    let mean = image.texels.iter().map(luminance).sum::<f64>() / image.texels.len().max(1) as f64;
    mean.max(image.texels.iter().map(luminance).fold(0.0, f64::max) / HEADROOM)
}

/// All levels; an image beyond `max_edge` loses its topmost ones.
fn build(image: &LinearImage, max_edge: u32) -> PublishedTexture {
    let mut texture = PublishedTexture { name: "sky".to_owned(), texels: PublishedTexels::Half, width: 0, height: 0, mips: Vec::new() };
    let mut add = |width: u32, height: u32, texels: &[[f32; 4]]| {
        if width.max(height) <= max_edge {
            if texture.mips.is_empty() {
                (texture.width, texture.height) = (width, height);
            }
            texture.mips.push(encode(texels));
        }
    };
    add(image.width, image.height, &image.texels);
    let (mut width, mut height) = (image.width, image.height);
    let mut above: Option<Level> = None;
    while width.max(height) > 1 {
        let texels = above.as_ref().map_or(&image.texels, |level| &level.texels);
        let level = shrink(width, height, |index| texels.get(index).copied().unwrap_or_default());
        (width, height) = (level.width, level.height);
        add(width, height, &level.texels);
        above = Some(level);
    }
    texture
}

fn encode(texels: &[[f32; 4]]) -> Arc<[u8]> {
    texels.iter().flatten().flat_map(|value| f16::from_f32(value.clamp(0.0, 65504.0)).to_le_bytes()).collect()
}
