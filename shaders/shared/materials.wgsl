// Materials: the published table `materials`. glTF 2.0 metallic-roughness with KHR_materials_specular, _ior, _unlit and
// _emissive_strength. Textures are read in shared/material_textures.wgsl.

struct Material {
    // Linear, alpha last.
    base_color: vec4<f32>,
    // Nits.
    emissive: vec3<f32>,
    metallic: f32,
    // Perceptual: the alpha of GGX is its square.
    roughness: f32,
    normal_scale: f32,
    occlusion_strength: f32,
    alpha_cutoff: f32,
    // Tint of a dielectric's reflection at normal incidence.
    specular_color: vec3<f32>,
    // Strength of a dielectric's reflection.
    specular: f32,
    ior: f32,
    // MATERIAL_ bits.
    flags: u32,
    // Bit i: texture i is looked up with the second set of texture coordinates.
    uv_sets: u32,
    // KHR_texture_transform of texture i: rows [2 i] and [2 i + 1] of a 2x3 matrix, applied to (u, v, 1).
    uv_transforms: array<vec4<f32>, 14>,
}

var<storage, read> materials: array<Material>;

// Fully transparent below the cutoff, opaque at or above it.
const MATERIAL_MASKED: u32 = 1u;
const MATERIAL_DOUBLE_SIDED: u32 = 2u;
// Shown as its base colour; takes no light.
const MATERIAL_UNLIT: u32 = 4u;
const MATERIAL_BLEND: u32 = 8u;
const MATERIAL_HAS_NORMAL_TEXTURE: u32 = 16u;

fn has_flag(material: u32, flag: u32) -> bool {
    return (materials[material].flags & flag) != 0u;
}

// Whether a point of this alpha is cut out. Only masked materials are ever cut.
fn is_cut_out(material: u32, alpha: f32) -> bool {
    return has_flag(material, MATERIAL_MASKED) && alpha < materials[material].alpha_cutoff;
}

// Reflectance of a dielectric at normal incidence, before KHR_materials_specular's strength:
// ((ior - 1) / (ior + 1))^2, tinted, at most 1.
fn dielectric_f0(ior: f32, specular_color: vec3<f32>) -> vec3<f32> {
    let ratio = (ior - 1.0) / (ior + 1.0);
    return min(specular_color * (ratio * ratio), vec3<f32>(1.0));
}
