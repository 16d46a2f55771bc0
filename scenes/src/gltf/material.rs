//! Materials: metallic-roughness with KHR_materials_specular, _ior, _emissive_strength and _unlit.
//!
//! Guarantees: every factor is finite and in its range; what was outside is clamped, with a warning. A material may use any two
//! sets of texture coordinates, which become sets 0 and 1 of its meshes' vertices.

use super::json::{Json, clip};
use super::texture::{self, Texture};
use crate::asset::{AlphaMode, Material, TextureUse};

/// A checked material.
#[derive(Clone)]
pub(super) struct MaterialSource {
    /// Image indices are the file's.
    pub(super) material: Material,
    /// Which of the file's sets of texture coordinates become sets 0 and 1.
    pub(super) uv_sets: [u32; 2],
}

impl MaterialSource {
    /// glTF's default material.
    pub(super) fn standard() -> MaterialSource {
        MaterialSource { material: Material::default(), uv_sets: [0, 1] }
    }
}

/// Every texture of a material.
pub(super) fn textures_mut(material: &mut Material) -> [&mut Option<TextureUse>; 7] {
    [
        &mut material.base_color_texture,
        &mut material.metallic_roughness_texture,
        &mut material.normal_texture,
        &mut material.occlusion_texture,
        &mut material.emissive_texture,
        &mut material.specular_texture,
        &mut material.specular_color_texture,
    ]
}

/// Checks every material.
pub(super) fn read_materials(root: &Json<'_>, textures: &[Option<Texture>]) -> Vec<MaterialSource> {
    root.objects("materials").iter().enumerate().map(|(index, json)| read_material(json, index, textures)).collect()
}

fn read_material(json: &Json<'_>, index: usize, textures: &[Option<Texture>]) -> MaterialSource {
    let mut material = Material { name: json.name_or("material", index), ..Material::default() };
    if let Some(pbr) = json.object("pbrMetallicRoughness") {
        material.base_color = factors(&pbr, "baseColorFactor", [1.0; 4], 1.0);
        material.base_color_texture = texture::read_use(&pbr, "baseColorTexture", textures);
        material.metallic = factor(&pbr, "metallicFactor", 1.0, 0.0, 1.0);
        material.roughness = factor(&pbr, "roughnessFactor", 1.0, 0.0, 1.0);
        material.metallic_roughness_texture = texture::read_use(&pbr, "metallicRoughnessTexture", textures);
    }
    material.normal_texture = texture::read_use(json, "normalTexture", textures);
    if let Some(normal) = json.object("normalTexture") {
        material.normal_scale = normal.number("scale").unwrap_or(1.0);
    }
    material.occlusion_texture = texture::read_use(json, "occlusionTexture", textures);
    if let Some(occlusion) = json.object("occlusionTexture") {
        material.occlusion_strength = factor(&occlusion, "strength", 1.0, 0.0, 1.0);
    }
    material.emissive_texture = texture::read_use(json, "emissiveTexture", textures);
    material.emissive = emissive(json);
    material.alpha_mode = alpha_mode(json);
    material.double_sided = json.boolean("doubleSided").unwrap_or(false);
    material.unlit = json.extension("KHR_materials_unlit").is_some();
    if let Some(specular) = json.extension("KHR_materials_specular") {
        material.specular = factor(&specular, "specularFactor", 1.0, 0.0, 1.0);
        material.specular_texture = texture::read_use(&specular, "specularTexture", textures);
        material.specular_color = factors(&specular, "specularColorFactor", [1.0; 3], f32::MAX);
        material.specular_color_texture = texture::read_use(&specular, "specularColorTexture", textures);
    }
    if let Some(extension) = json.extension("KHR_materials_ior") {
        let ior = extension.number("ior").unwrap_or(1.5);
        // 0 is the extension's own way to ask for full reflection; between 0 and 1 there is no meaning.
        material.ior = if ior == 0.0 { ior } else { clamp(&extension, "ior", ior, 1.0, f32::MAX) };
    }
    let uv_sets = assign_uv_sets(json, &mut material);
    MaterialSource { material, uv_sets }
}

fn emissive(json: &Json<'_>) -> [f32; 3] {
    let colour = factors(json, "emissiveFactor", [0.0; 3], 1.0);
    let Some(extension) = json.extension("KHR_materials_emissive_strength") else { return colour };
    let strength = factor(&extension, "emissiveStrength", 1.0, 0.0, f32::MAX);
    colour.map(|channel| channel * strength)
}

fn alpha_mode(json: &Json<'_>) -> AlphaMode {
    match json.text("alphaMode") {
        None | Some("OPAQUE") => AlphaMode::Opaque,
        Some("MASK") => AlphaMode::Mask { cutoff: factor(json, "alphaCutoff", 0.5, 0.0, f32::MAX) },
        Some("BLEND") => AlphaMode::Blend,
        Some(other) => {
            json.error_at("alphaMode", "gltf::alpha-mode", format_args!("expected OPAQUE, MASK or BLEND, found `{}`", clip(other)));
            AlphaMode::Opaque
        }
    }
}

/// Gives the sets of texture coordinates that a material uses the numbers 0 and 1.
fn assign_uv_sets(json: &Json<'_>, material: &mut Material) -> [u32; 2] {
    let mut used: Vec<u32> = textures_mut(material).iter().filter_map(|texture| texture.as_ref().map(|texture| texture.uv_set)).collect();
    used.sort_unstable();
    used.dedup();
    let sets = match used.as_slice() {
        [] | [0 | 1] | [0, 1] => return [0, 1],
        [set] => [*set, 0],
        [first, second] => [*first, *second],
        _ => {
            let problem = format!("its textures use {} sets of texture coordinates; two are supported", used.len());
            json.report().error("gltf::texcoord", json.place(), problem, "export the file with at most two UV maps for a material");
            return [0, 1];
        }
    };
    for texture in textures_mut(material).into_iter().flatten() {
        texture.uv_set = u32::from(texture.uv_set != sets[0]);
    }
    sets
}

/// A number between two bounds; outside of them it is clamped, with a warning.
fn factor(json: &Json<'_>, key: &str, default: f32, low: f32, high: f32) -> f32 {
    json.number(key).map_or(default, |value| clamp(json, key, value, low, high))
}

fn factors<const N: usize>(json: &Json<'_>, key: &str, default: [f32; N], high: f32) -> [f32; N] {
    json.numbers(key).map_or(default, |values| values.map(|value| clamp(json, key, value, 0.0, high)))
}

fn clamp(json: &Json<'_>, key: &str, value: f32, low: f32, high: f32) -> f32 {
    let clamped = value.clamp(low, high);
    if clamped != value {
        json.warning_at(key, "gltf::factor-range", format_args!("{value} is out of range, and taken as {clamped}"));
    }
    clamped
}
