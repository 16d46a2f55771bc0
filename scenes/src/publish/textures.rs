//! Textures and samplers of all materials, each once.
//!
//! Texture 0 is white and texture 1 a flat normal: they stand in for textures that a material lacks. The others come in
//! the order of their first use. Mips are built by as many threads as the machine has; the result depends on none of them.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::published::{MaterialBinding, PublishedMaterials, PublishedSampler, PublishedTexels, PublishedTexture, PublishedWrap};

use super::coverage;
use super::materials::texture_uses;
use super::mips::{self, Levels, Role};
use crate::asset::{AlphaMode, Image, Material, MipFilter, Sampler, Wrap};

/// What draws of the materials bind.
#[derive(Debug, Clone, Default)]
pub(super) struct TextureSet {
    pub(super) published: PublishedMaterials,
    /// Those that come from images.
    built: Built,
    /// `publish::image-reduced`.
    pub(super) warnings: Vec<Diagnostic>,
}

/// Textures by the image and its role.
type Built = BTreeMap<(usize, Role), Arc<PublishedTexture>>;

const WHITE: usize = 0;
const FLAT_NORMAL: usize = 1;

/// Builds all textures but those of `before`, which was built from the same images. Images that materials name and that are not there
/// count as missing.
pub(super) fn build(materials: &[Material], images: &[Image], max_edge: u32, before: Option<&TextureSet>) -> TextureSet {
    let mut set = PublishedMaterials { samplers: vec![sampler(Sampler::default())], ..PublishedMaterials::default() };
    let mut jobs: Vec<(usize, Role)> = Vec::new();
    let mut known: BTreeMap<(usize, Role), usize> = BTreeMap::new();
    for material in materials {
        let mut binding = MaterialBinding::default();
        for ((texture, role), missing) in texture_uses(material).into_iter().zip(roles(material)).zip(MISSING) {
            let texture = texture.filter(|texture| texture.image < images.len());
            binding.textures.push(texture.map_or(missing, |texture| {
                *known.entry((texture.image, role)).or_insert_with(|| {
                    jobs.push((texture.image, role));
                    FLAT_NORMAL + jobs.len()
                })
            }));
            let wanted = texture.map_or_else(|| sampler(Sampler::default()), |texture| sampler(texture.sampler));
            binding.samplers.push(set.samplers.iter().position(|known| *known == wanted).unwrap_or_else(|| {
                set.samplers.push(wanted);
                set.samplers.len() - 1
            }));
        }
        set.bindings.push(binding);
    }
    set.textures = vec![single("white", [255; 4]), single("flat normal", [128, 128, 255, 255])];
    let mut built: Built = before.map(|before| before.built.clone()).unwrap_or_default();
    built.retain(|job, _| known.contains_key(job));
    let missing: Vec<(usize, Role)> = jobs.iter().copied().filter(|job| !built.contains_key(job)).collect();
    for ((index, role), levels) in missing.iter().zip(build_levels(&missing, images, max_edge)) {
        let Some(image) = images.get(*index) else { continue };
        let Levels { width, height, bytes: mips } = levels;
        let texels = if role.is_srgb() { PublishedTexels::Srgb8 } else { PublishedTexels::Unorm8 };
        built.insert((*index, *role), Arc::new(PublishedTexture { name: image.name.clone(), texels, width, height, mips }));
    }
    let mut warnings: Vec<Diagnostic> = Vec::new();
    for job in &jobs {
        let (Some(image), Some(texture)) = (images.get(job.0), built.get(job)) else { continue };
        if (texture.width, texture.height) != (image.width, image.height) && !warnings.iter().any(|known| names(known, image)) {
            warnings.push(Diagnostic::warning(
                "publish::image-reduced",
                format!(
                    "image `{}` has {}x{} texels, more than the {max_edge} along an edge that the device allows; it is reduced to {}x{}",
                    image.name, image.width, image.height, texture.width, texture.height
                ),
            ));
        }
        set.textures.push(Arc::clone(texture));
    }
    TextureSet { published: set, built, warnings }
}

fn names(warning: &Diagnostic, image: &Image) -> bool {
    warning.message.starts_with(&format!("image `{}` ", image.name))
}

/// What stands in for a missing texture, in the schema's order.
const MISSING: [usize; super::layout::TEXTURES] = [WHITE, WHITE, FLAT_NORMAL, WHITE, WHITE, WHITE, WHITE];

/// The roles of a material's textures, in the schema's order.
fn roles(material: &Material) -> [Role; super::layout::TEXTURES] {
    let base_color = match material.alpha_mode {
        AlphaMode::Opaque => Role::Color,
        // Shaders compare the product of texture and factor, so the texture's own cutoff is larger.
        AlphaMode::Mask { cutoff } => Role::Masked(coverage::first_passing(cutoff / material.base_color[3].max(1e-6))),
        AlphaMode::Blend => Role::Blended,
    };
    [base_color, Role::Data, Role::Normal, Role::Data, Role::Color, Role::Data, Role::Color]
}

fn build_levels(jobs: &[(usize, Role)], images: &[Image], max_edge: u32) -> Vec<Levels> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<(usize, Levels)>> = Mutex::new(Vec::with_capacity(jobs.len()));
    let work = || {
        while let Some((job, image, role)) = {
            let job = next.fetch_add(1, Ordering::Relaxed);
            jobs.get(job).and_then(|(image, role)| Some((job, images.get(*image)?, *role)))
        } {
            let levels = mips::build(image, role, max_edge);
            done.lock().unwrap_or_else(PoisonError::into_inner).push((job, levels));
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(jobs.len());
    std::thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(work);
        }
        work();
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_unstable_by_key(|(job, _)| *job);
    done.into_iter().map(|(_, levels)| levels).collect()
}

fn single(name: &str, texel: [u8; 4]) -> Arc<PublishedTexture> {
    Arc::new(PublishedTexture { name: name.to_owned(), texels: PublishedTexels::Unorm8, width: 1, height: 1, mips: vec![texel.into()] })
}

fn sampler(sampler: Sampler) -> PublishedSampler {
    let wrap = |wrap| match wrap {
        Wrap::ClampToEdge => PublishedWrap::ClampToEdge,
        Wrap::MirroredRepeat => PublishedWrap::MirroredRepeat,
        Wrap::Repeat => PublishedWrap::Repeat,
    };
    PublishedSampler {
        mag_linear: sampler.mag_linear,
        min_linear: sampler.min_linear,
        mip_linear: sampler.mip == MipFilter::Linear,
        no_mips: sampler.mip == MipFilter::None,
        wrap_u: wrap(sampler.wrap_u),
        wrap_v: wrap(sampler.wrap_v),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::TextureUse;

    fn image(name: &str, edge: u32) -> Image {
        Image { name: name.to_owned(), width: edge, height: edge, rgba: vec![200; (edge * edge * 4) as usize].into() }
    }

    fn texture(image: usize) -> Option<TextureUse> {
        Some(TextureUse { image, sampler: Sampler::default(), uv_set: 0, transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] })
    }

    #[test]
    fn an_image_is_one_texture_per_role() {
        let images = [image("a", 2), image("b", 2)];
        let clamped = TextureUse { sampler: Sampler { wrap_u: Wrap::ClampToEdge, ..Sampler::default() }, ..texture(0).unwrap() };
        let materials = [
            Material { base_color_texture: texture(1), emissive_texture: Some(clamped), ..Material::default() },
            Material {
                base_color_texture: texture(0),
                occlusion_texture: texture(0),
                metallic_roughness_texture: texture(0),
                ..Material::default()
            },
            Material { base_color_texture: texture(0), alpha_mode: AlphaMode::Mask { cutoff: 0.5 }, ..Material::default() },
        ];
        let TextureSet { published: set, warnings, .. } = build(&materials, &images, 8192, None);
        let names: Vec<(&str, bool)> =
            set.textures.iter().map(|texture| (texture.name.as_str(), texture.texels == PublishedTexels::Srgb8)).collect();
        assert_eq!(names, [("white", false), ("flat normal", false), ("b", true), ("a", true), ("a", false), ("a", true)]);
        assert_eq!(set.bindings[0].textures, [2, 0, 1, 0, 3, 0, 0]);
        assert_eq!(set.bindings[0].samplers, [0, 0, 0, 0, 1, 0, 0]);
        assert_eq!(set.bindings[1].textures, [3, 4, 1, 4, 0, 0, 0]);
        assert_eq!(set.bindings[2].textures, [5, 0, 1, 0, 0, 0, 0]);
        assert!(warnings.is_empty());
    }

    #[test]
    fn too_large_images_are_reduced_and_reported_once() {
        let materials = [Material { base_color_texture: texture(0), occlusion_texture: texture(0), ..Material::default() }];
        let set = build(&materials, &[image("large", 16)], 4, None);
        assert_eq!((set.published.textures[2].width, set.published.textures[3].width), (4, 4));
        assert_eq!(set.warnings.len(), 1);
        assert_eq!(set.warnings[0].code, "publish::image-reduced");
    }

    #[test]
    fn what_stands_is_not_built_again() {
        let images = [image("a", 4), image("b", 4)];
        let one = [Material { base_color_texture: texture(0), ..Material::default() }];
        let two = [Material { base_color_texture: texture(1), emissive_texture: texture(0), ..Material::default() }];
        let before = build(&one, &images, 8192, None);
        let after = build(&two, &images, 8192, Some(&before));
        let anew = build(&two, &images, 8192, None);
        assert_eq!(after.published, anew.published);
        assert!(Arc::ptr_eq(&after.published.textures[3], &before.published.textures[2]));
    }
}
