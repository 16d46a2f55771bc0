//! The table `materials`.

use bytemuck::Zeroable;

use super::layout::{MaterialRow, TEXTURES, flags};
use crate::asset::{AlphaMode, Material, TextureUse};

/// The texture uses of a material, in the schema's order.
pub(super) fn texture_uses(material: &Material) -> [Option<&TextureUse>; TEXTURES] {
    [
        material.base_color_texture.as_ref(),
        material.metallic_roughness_texture.as_ref(),
        material.normal_texture.as_ref(),
        material.occlusion_texture.as_ref(),
        material.emissive_texture.as_ref(),
        material.specular_texture.as_ref(),
        material.specular_color_texture.as_ref(),
    ]
}

/// A row per material; never empty.
pub(super) fn rows(materials: &[Material]) -> Vec<MaterialRow> {
    if materials.is_empty() { vec![MaterialRow::zeroed()] } else { materials.iter().map(row).collect() }
}

fn row(material: &Material) -> MaterialRow {
    let (alpha_flag, alpha_cutoff) = match material.alpha_mode {
        AlphaMode::Opaque => (0, 0.0),
        AlphaMode::Mask { cutoff } => (flags::MASKED, cutoff),
        AlphaMode::Blend => (flags::BLEND, 0.0),
    };
    let flag = |set: bool, bit: u32| if set { bit } else { 0 };
    let mut uv_sets = 0;
    let mut uv_transforms = [[0.0; 4]; 2 * TEXTURES];
    for (index, texture) in texture_uses(material).into_iter().enumerate() {
        let [first, second] = texture.map_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], |texture| texture.transform);
        uv_transforms[2 * index] = [first[0], first[1], first[2], 0.0];
        uv_transforms[2 * index + 1] = [second[0], second[1], second[2], 0.0];
        uv_sets |= flag(texture.is_some_and(|texture| texture.uv_set == 1), 1 << index);
    }
    MaterialRow {
        base_color: material.base_color,
        emissive: material.emissive,
        metallic: material.metallic,
        roughness: material.roughness,
        normal_scale: material.normal_scale,
        occlusion_strength: material.occlusion_strength,
        alpha_cutoff,
        specular_color: material.specular_color,
        specular: material.specular,
        ior: material.ior,
        flags: alpha_flag
            | flag(material.double_sided, flags::DOUBLE_SIDED)
            | flag(material.unlit, flags::UNLIT)
            | flag(material.normal_texture.is_some(), flags::NORMAL_TEXTURE),
        uv_sets,
        alpha_unused: 0.0,
        uv_transforms,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::Sampler;

    #[test]
    fn flags_sets_and_transforms_follow_the_material() {
        let texture = TextureUse { image: 0, sampler: Sampler::default(), uv_set: 1, transform: [[2.0, 0.0, 0.5], [0.0, 3.0, 0.25]] };
        let material = Material {
            alpha_mode: AlphaMode::Mask { cutoff: 0.25 },
            double_sided: true,
            normal_texture: Some(texture),
            ..Material::default()
        };
        let row = row(&material);
        assert_eq!(row.flags, flags::MASKED | flags::DOUBLE_SIDED | flags::NORMAL_TEXTURE);
        assert_eq!((row.alpha_cutoff, row.uv_sets), (0.25, 1 << 2));
        assert_eq!(row.uv_transforms[4], [2.0, 0.0, 0.5, 0.0]);
        assert_eq!(row.uv_transforms[5], [0.0, 3.0, 0.25, 0.0]);
        assert_eq!(row.uv_transforms[0], [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(rows(&[]).len(), 1);
    }
}
