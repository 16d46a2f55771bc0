//! The image of the sky as a texture of 32-bit floats, with its unit and what the light unit needs to know of it.
//!
//! It is built again only for another image. A scene without one has one black texel. Accepted: an image larger than the device takes is
//! halved until it fits; the means are over texels and not over solid angles, so that rows at the poles count for more than they cover.

use std::sync::Arc;

use bevy_ecs::prelude::World;
use luminaire_graph::published::{PublishedTexels, PublishedTexture};

use super::mips::{Level, shrink};
use crate::linear_image::LinearImage;
use crate::world::{SkyImage, SkyShape};

/// A half float holds so many times the light unit's brightest modest radiance.
const HEADROOM: f64 = 1023.0;
/// The brightest texel in units: half of what a half float ends at, so that sums of a few weights never pass it.
const BRIGHTEST_IN_UNITS: f64 = 32768.0;

/// The texture of the last image.
#[derive(Debug)]
pub(super) struct SkyTexture {
    /// The image and the largest edge that it was built from.
    from: Option<(Arc<LinearImage>, u32)>,
    texture: Arc<PublishedTexture>,
    brightest: f64,
    unit: f32,
}

/// How the image is seen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sky {
    pub(super) rotation: f32,
    /// 0 where there is no image.
    pub(super) strength: f32,
    /// The radiance that the light unit should do justice to, nits.
    pub(super) brightest: f64,
    /// A power of two.
    pub(super) unit: f32,
    pub(super) has_faces: bool,
}

impl Default for SkyTexture {
    fn default() -> SkyTexture {
        let black = PublishedTexture {
            name: "no sky".to_owned(),
            texels: PublishedTexels::Float,
            width: 1,
            height: 1,
            mips: vec![encode(&[[0.0; 4]])],
        };
        SkyTexture { from: None, texture: Arc::new(black), brightest: 0.0, unit: 1.0 }
    }
}

impl SkyTexture {
    /// The texture of the world's sky, with edges of at most `max_edge`.
    pub(super) fn update(&mut self, world: &World, max_edge: u32) -> (Arc<PublishedTexture>, Sky) {
        let Some(sky) = world.get_resource::<SkyImage>().filter(|sky| !sky.image.texels.is_empty()) else {
            *self = SkyTexture::default();
            let none = Sky { rotation: 0.0, strength: 0.0, brightest: 0.0, unit: 1.0, has_faces: false };
            return (Arc::clone(&self.texture), none);
        };
        let same = self.from.as_ref().is_some_and(|(image, edge)| Arc::ptr_eq(image, &sky.image) && *edge == max_edge);
        if !same {
            *self = SkyTexture {
                from: Some((Arc::clone(&sky.image), max_edge)),
                texture: Arc::new(build(&sky.image, max_edge)),
                brightest: brightest(&sky.image),
                unit: unit(&sky.image),
            };
        }
        let finite = |value: f32| if value.is_finite() { value } else { 0.0 };
        let strength = finite(sky.strength).max(0.0);
        let seen = Sky {
            rotation: finite(sky.rotation),
            strength,
            brightest: self.brightest * f64::from(strength),
            unit: self.unit,
            has_faces: sky.shape == SkyShape::Faces,
        };
        (Arc::clone(&self.texture), seen)
    }
}

fn largest(texel: &[f32; 4]) -> f64 {
    f64::from(texel[0].max(texel[1]).max(texel[2]))
}

/// Its mean, or its brightest texel as far as that would not fit otherwise: the sun in an image may clip nothing else.
fn brightest(image: &LinearImage) -> f64 {
    let mean = image.texels.iter().map(largest).sum::<f64>() / image.texels.len().max(1) as f64;
    mean.max(image.texels.iter().map(largest).fold(0.0, f64::max) / HEADROOM)
}

/// Brings the brightest texel to between a half of [`BRIGHTEST_IN_UNITS`] and all of it; 1 for a black image.
fn unit(image: &LinearImage) -> f32 {
    let most = image.texels.iter().map(largest).fold(0.0, f64::max);
    if most > 0.0 { (most / BRIGHTEST_IN_UNITS).log2().ceil().clamp(-100.0, 120.0).exp2() as f32 } else { 1.0 }
}

/// The image, halved until its edges are at most `max_edge`.
fn build(image: &LinearImage, max_edge: u32) -> PublishedTexture {
    let mut smaller: Option<Level> = None;
    let (mut width, mut height) = (image.width, image.height);
    while width.max(height) > max_edge.max(1) {
        let texels = smaller.as_ref().map_or(&image.texels, |level| &level.texels);
        let level = shrink(width, height, |index| texels.get(index).copied().unwrap_or_default());
        (width, height) = (level.width, level.height);
        smaller = Some(level);
    }
    let texels = smaller.as_ref().map_or(&image.texels, |level| &level.texels);
    PublishedTexture { name: "sky".to_owned(), texels: PublishedTexels::Float, width, height, mips: vec![encode(texels)] }
}

/// What is no finite light becomes 0.
fn encode(texels: &[[f32; 4]]) -> Arc<[u8]> {
    let light = |value: &f32| if value.is_finite() { value.max(0.0) } else { 0.0 };
    texels.iter().flatten().flat_map(|value| light(value).to_le_bytes()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_is_a_power_of_two_below_which_the_brightest_texel_stays() {
        for most in [1e-6_f32, 0.9, 1.0, 32_768.0, 40_000.0, 1e9, 3e38] {
            let image = LinearImage { width: 2, height: 1, texels: vec![[0.0, most, 0.0, 1.0], [0.0; 4]] };
            let unit = f64::from(unit(&image));
            let inside = f64::from(most) / unit;
            assert!(unit.log2().fract() == 0.0 && inside <= 32_768.0 && inside > 16_384.0, "{most}: {unit}");
        }
        assert_eq!(unit(&LinearImage { width: 1, height: 1, texels: vec![[0.0; 4]] }), 1.0);
    }

    #[test]
    fn an_image_is_halved_until_it_fits() {
        let image = LinearImage { width: 8, height: 4, texels: vec![[1.0, 2.0, 3.0, 1.0]; 32] };
        let built = build(&image, 3);
        assert_eq!((built.width, built.height, built.mips[0].len()), (2, 1, 32));
        assert_eq!(built.mips[0][..4], 1.0_f32.to_le_bytes());
    }
}
