//! Mip levels of an image, filtered in the space in which it is used.
//!
//! Every level is an area-weighted mean of the one above, so that images whose size is no power of two keep their mean as well.
//! Colors are averaged in linear light, weighted with alpha where alpha counts; normals are averaged and normalised
//! again; masked images keep their alpha coverage. Levels are computed in f32 and only rounded when stored.
//! Accepted downside: roughness is averaged as it is. What normals lose in length is not added to it, so glossy bumpy
//! surfaces look smoother from afar than they are.

use std::sync::Arc;

use super::coverage;
use crate::asset::Image;

/// How an image is used, which decides how it is filtered. Images with equal roles share a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Role {
    /// sRGB; alpha is ignored.
    Color,
    /// sRGB; alpha is compared with a cutoff, given as the smallest stored alpha that passes.
    Masked(u32),
    /// sRGB; alpha is blended with.
    Blended,
    /// Linear numbers.
    Data,
    /// Tangent-space normals.
    Normal,
}

impl Role {
    pub(super) fn is_srgb(self) -> bool {
        matches!(self, Role::Color | Role::Masked(_) | Role::Blended)
    }

    fn weights_alpha(self) -> bool {
        matches!(self, Role::Masked(_) | Role::Blended)
    }
}

/// An image with its levels, down to one texel. Level 0 is the image itself, and not copied.
#[derive(Debug, Clone)]
pub(super) struct Levels {
    /// Of level 0, at most the limit asked for.
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) bytes: Vec<Arc<[u8]>>,
}

/// Filtered texels: four numbers each, in the role's space.
pub(super) struct Level {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) texels: Vec<[f32; 4]>,
}

/// All levels of an image whose edges are at most `max_edge`; larger ones lose their topmost levels.
pub(super) fn build(image: &Image, role: Role, max_edge: u32) -> Levels {
    let space = Space::new(role);
    let wanted_coverage = match role {
        Role::Masked(passing) => coverage::coverage(&image.rgba, passing),
        _ => 0.0,
    };
    let mut levels = Levels { width: image.width, height: image.height, bytes: Vec::new() };
    let max_edge = max_edge.max(1);
    let fits = |width: u32, height: u32| width.max(height) <= max_edge;
    if fits(image.width, image.height) {
        levels.bytes.push(Arc::clone(&image.rgba));
    }
    let mut above: Option<Level> = None;
    let (mut width, mut height) = (image.width, image.height);
    while width > 1 || height > 1 {
        // Level 0 is decoded as it is read: as floats it would be four times the image.
        let level = match &above {
            Some(above) => shrink(width, height, |index| above.texels.get(index).copied().unwrap_or_default()),
            None => shrink(width, height, |index| image.rgba.get(4 * index..4 * index + 4).map_or([0.0; 4], |texel| space.decode(texel))),
        };
        (width, height) = (level.width, level.height);
        if fits(width, height) {
            if levels.bytes.is_empty() {
                (levels.width, levels.height) = (width, height);
            }
            levels.bytes.push(space.encode(&level.texels, wanted_coverage).into());
        }
        above = Some(level);
    }
    levels
}

/// The next level: each texel is the mean over its area, whose borders may cut texels above.
pub(super) fn shrink(width: u32, height: u32, fetch: impl Fn(usize) -> [f32; 4]) -> Level {
    let (columns, rows) = (spans(width), spans(height));
    let mut texels = Vec::with_capacity(columns.len() * rows.len());
    for row in &rows {
        for column in &columns {
            let mut sum = [0.0_f32; 4];
            for (y, weight_y) in row.iter().filter(|(_, weight)| *weight > 0.0) {
                for (x, weight_x) in column.iter().filter(|(_, weight)| *weight > 0.0) {
                    let texel = fetch(*y as usize * width as usize + *x as usize);
                    for channel in 0..4 {
                        sum[channel] += texel[channel] * weight_x * weight_y;
                    }
                }
            }
            texels.push(sum);
        }
    }
    Level { width: columns.len() as u32, height: rows.len() as u32, texels }
}

/// For each texel of the level below: up to three texels along an edge with their weights, which sum to 1.
fn spans(edge: u32) -> Vec<[(u32, f32); 3]> {
    let below = (edge / 2).max(1);
    let span = |index: u32| {
        // In units of 1 / below, borders are whole numbers.
        let (start, end) = (u64::from(index) * u64::from(edge), u64::from(index + 1) * u64::from(edge));
        let first = start / u64::from(below);
        std::array::from_fn(|offset| {
            let texel = first + offset as u64;
            let overlap = end.min((texel + 1) * u64::from(below)).saturating_sub(start.max(texel * u64::from(below)));
            (texel as u32, overlap as f32 / edge as f32)
        })
    };
    (0..below).map(span).collect()
}

/// Decoding and encoding of a role's texels.
struct Space {
    role: Role,
    linear_from_byte: [f32; 256],
}

/// Weight of a fully transparent texel, so that its color counts where there is no other.
const FAINT: f32 = 1.0 / 4096.0;

impl Space {
    fn new(role: Role) -> Space {
        let linear_from_byte = std::array::from_fn(|byte| {
            let value = byte as f32 / 255.0;
            if role.is_srgb() { linear_from_srgb(value) } else { value }
        });
        Space { role, linear_from_byte }
    }

    /// With alpha weighting, color is multiplied with the weight and the weight takes alpha's place.
    fn decode(&self, texel: &[u8]) -> [f32; 4] {
        let channel = |index: usize| texel.get(index).copied().unwrap_or(0);
        let color = [0, 1, 2].map(|index| self.linear_from_byte[usize::from(channel(index))]);
        let alpha = f32::from(channel(3)) / 255.0;
        match self.role {
            Role::Masked(_) | Role::Blended => {
                let weight = FAINT + (1.0 - FAINT) * alpha;
                [color[0] * weight, color[1] * weight, color[2] * weight, weight]
            }
            Role::Normal => [color[0] * 2.0 - 1.0, color[1] * 2.0 - 1.0, color[2] * 2.0 - 1.0, alpha],
            Role::Color | Role::Data => [color[0], color[1], color[2], alpha],
        }
    }

    fn encode(&self, texels: &[[f32; 4]], wanted_coverage: f64) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(texels.len() * 4);
        for texel in texels {
            let [r, g, b, w] = *texel;
            let color = match self.role {
                Role::Normal => unit([r, g, b]).map(|value| byte(value * 0.5 + 0.5)),
                Role::Masked(_) | Role::Blended => [r, g, b].map(|value| byte(srgb_from_linear(value / w.max(FAINT * 0.5)))),
                Role::Color => [r, g, b].map(|value| byte(srgb_from_linear(value))),
                Role::Data => [r, g, b].map(byte),
            };
            bytes.extend_from_slice(&[color[0], color[1], color[2], byte(self.alpha(w))]);
        }
        if let Role::Masked(passing) = self.role {
            let alphas: Vec<f32> = texels.iter().map(|texel| self.alpha(texel[3])).collect();
            for (texel, alpha) in bytes.chunks_exact_mut(4).zip(coverage::keep_coverage(&alphas, wanted_coverage, passing)) {
                texel[3] = alpha;
            }
        }
        bytes
    }

    fn alpha(&self, stored: f32) -> f32 {
        if self.role.weights_alpha() { ((stored - FAINT) / (1.0 - FAINT)).clamp(0.0, 1.0) } else { stored }
    }
}

fn unit([x, y, z]: [f32; 3]) -> [f32; 3] {
    let length = (x * x + y * y + z * z).sqrt();
    // Opposite normals cancel; straight up is then as good as any.
    if length > 1e-4 { [x / length, y / length, z / length] } else { [0.0, 0.0, 1.0] }
}

fn byte(value: f32) -> u8 {
    (value * 255.0).round().clamp(0.0, 255.0) as u8
}

/// IEC 61966-2-1.
fn linear_from_srgb(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// IEC 61966-2-1.
fn srgb_from_linear(value: f32) -> f32 {
    if value <= 0.003_130_8 { value * 12.92 } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn image(width: u32, height: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> Image {
        let rgba: Vec<u8> = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).flat_map(|(x, y)| texel(x, y)).collect();
        Image { name: "test".to_owned(), width, height, rgba: rgba.into() }
    }

    fn noise(x: u32, y: u32, channel: u32) -> u8 {
        (x.wrapping_mul(374_761_393)
            .wrapping_add(y.wrapping_mul(668_265_263))
            .wrapping_add(channel.wrapping_mul(97))
            .wrapping_mul(2_654_435_761)
            >> 24) as u8
    }

    #[test]
    fn levels_halve_down_to_one_texel() {
        let levels = build(&image(13, 4, |_, _| [10, 20, 30, 40]), Role::Data, 8192);
        let sizes: Vec<usize> = levels.bytes.iter().map(|level| level.len() / 4).collect();
        assert_eq!(sizes, [13 * 4, 6 * 2, 3, 1]);
        assert!(levels.bytes.iter().all(|level| level.chunks(4).all(|texel| texel == [10, 20, 30, 40])));
    }

    #[test]
    fn black_and_white_meet_in_linear_light() {
        let checker = image(2, 2, |x, y| if (x + y) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] });
        assert_eq!(build(&checker, Role::Color, 8192).bytes[1][..], [188, 188, 188, 255], "half the light is sRGB 188");
        assert_eq!(build(&checker, Role::Data, 8192).bytes[1][..], [128, 128, 128, 255]);
    }

    proptest! {
        #[test]
        fn the_mean_is_kept_in_linear_light(width in 1_u32..40, height in 1_u32..40, seed in 0_u32..1000) {
            let image = image(width, height, |x, y| [noise(x, y, seed), noise(x, y, seed + 1), 7, 255]);
            let space = Space::new(Role::Color);
            let mean = |bytes: &[u8]| {
                let sum: f64 = bytes.chunks(4).map(|texel| f64::from(space.decode(texel)[0])).sum();
                sum / (bytes.len() / 4) as f64
            };
            let levels = build(&image, Role::Color, 8192);
            for level in &levels.bytes {
                // Rounding to a byte is off by 1/255 at most in sRGB, times a slope of at most 2.3.
                prop_assert!((mean(level) - mean(&levels.bytes[0])).abs() < 0.006);
            }
        }
    }

    #[test]
    fn weights_cover_every_texel_equally() {
        for edge in 1..100 {
            let mut cover = vec![0.0; edge as usize];
            for span in spans(edge) {
                assert!((span.iter().map(|(_, weight)| weight).sum::<f32>() - 1.0).abs() < 1e-5);
                span.iter().filter(|(_, weight)| *weight > 0.0).for_each(|(texel, weight)| cover[*texel as usize] += weight);
            }
            let expected = (edge / 2).max(1) as f32 / edge as f32;
            assert!(cover.iter().all(|weight: &f32| (weight - expected).abs() < 1e-5), "{edge}: {cover:?}");
        }
    }

    #[test]
    fn masked_images_keep_their_coverage() {
        // Thin lines: plain filtering leaves no texel above one half from level 2 on.
        let fence = image(64, 64, |x, _| [30, 90, 30, if x % 8 == 0 { 255 } else { noise(x, 3, 1) / 8 }]);
        let passing = coverage::first_passing(0.5);
        let levels = build(&fence, Role::Masked(passing), 8192);
        let wanted = coverage::coverage(&levels.bytes[0], passing);
        assert_eq!(wanted, 0.125);
        for (level, bytes) in levels.bytes.iter().enumerate().take(3) {
            let kept = coverage::coverage(bytes, passing);
            assert!((kept - wanted).abs() <= 0.13, "level {level}: {kept}");
        }
        let plain = build(&fence, Role::Blended, 8192);
        assert_eq!(coverage::coverage(&plain.bytes[2], passing), 0.0);
    }

    #[test]
    fn transparent_texels_do_not_bleed_into_color() {
        let leaf = image(2, 2, |x, _| if x == 0 { [0, 200, 0, 255] } else { [255, 0, 255, 0] });
        let [r, g, b, a] = build(&leaf, Role::Blended, 8192).bytes[1][..] else { panic!("one texel") };
        assert!(r < 10 && g.abs_diff(200) <= 1 && b < 10 && a == 128, "{r} {g} {b} {a}");
        let clear = build(&image(2, 2, |_, _| [90, 60, 30, 0]), Role::Blended, 8192);
        assert_eq!(clear.bytes[1][..], [90, 60, 30, 0]);
    }

    #[test]
    fn normals_are_normalised_again() {
        let bumps = image(2, 1, |x, _| if x == 0 { [218, 128, 218, 255] } else { [38, 128, 218, 255] });
        let level = &build(&bumps, Role::Normal, 8192).bytes[1];
        let normal: Vec<f32> = level[..3].iter().map(|value| f32::from(*value) / 255.0 * 2.0 - 1.0).collect();
        assert!((normal.iter().map(|value| value * value).sum::<f32>().sqrt() - 1.0).abs() < 0.01, "{normal:?}");
        let opposite = image(2, 1, |x, _| if x == 0 { [255, 128, 128, 255] } else { [0, 127, 127, 255] });
        assert_eq!(build(&opposite, Role::Normal, 8192).bytes[1][..3], [128, 128, 255]);
    }

    #[test]
    fn large_images_lose_their_topmost_levels() {
        let levels = build(&image(32, 8, |x, y| [noise(x, y, 0); 4]), Role::Data, 8);
        assert_eq!((levels.width, levels.height, levels.bytes.len()), (8, 2, 4));
        assert_eq!(levels.bytes[0].len(), 8 * 2 * 4);
    }
}
