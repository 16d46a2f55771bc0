// The textures of the material that is drawn, and their values at a point. For Draw passes only: each draw binds its own.
//
// A missing texture is one white texel (for normals: one that points straight up), so every function below may be called for
// every material. All of them sample, so call them where all invocations come by: before any discard or branch.

#import "shared/materials.wgsl"

var base_color_texture: texture_2d<f32>;
var metallic_roughness_texture: texture_2d<f32>;
var normal_texture: texture_2d<f32>;
var occlusion_texture: texture_2d<f32>;
var emissive_texture: texture_2d<f32>;
var specular_texture: texture_2d<f32>;
var specular_color_texture: texture_2d<f32>;

var base_color_sampler: sampler;
var metallic_roughness_sampler: sampler;
var normal_sampler: sampler;
var occlusion_sampler: sampler;
var emissive_sampler: sampler;
var specular_sampler: sampler;
var specular_color_sampler: sampler;

// Places of the textures in `uv_sets` and `uv_transforms`.
const BASE_COLOR: u32 = 0u;
const METALLIC_ROUGHNESS: u32 = 1u;
const NORMAL: u32 = 2u;
const OCCLUSION: u32 = 3u;
const EMISSIVE: u32 = 4u;
const SPECULAR: u32 = 5u;
const SPECULAR_COLOR: u32 = 6u;

// Where to look up texture `index`. `uv` holds the first set of coordinates in xy and the second in zw.
fn texture_coordinates(material: u32, index: u32, uv: vec4<f32>) -> vec2<f32> {
    let second_set = ((materials[material].uv_sets >> index) & 1u) != 0u;
    let place = vec3<f32>(select(uv.xy, uv.zw, second_set), 1.0);
    let row_u = materials[material].uv_transforms[2u * index].xyz;
    let row_v = materials[material].uv_transforms[2u * index + 1u].xyz;
    return vec2<f32>(dot(row_u, place), dot(row_v, place));
}

// Base colour, linear, and alpha: factor times texture times vertex colour.
fn base_color_at(material: u32, uv: vec4<f32>, vertex_color: vec4<f32>) -> vec4<f32> {
    let place = texture_coordinates(material, BASE_COLOR, uv);
    return materials[material].base_color * textureSample(base_color_texture, base_color_sampler, place) * vertex_color;
}

// Metallic and roughness, both 0 to 1. The texture holds roughness in green and metallic in blue.
fn metallic_roughness_at(material: u32, uv: vec4<f32>) -> vec2<f32> {
    let place = texture_coordinates(material, METALLIC_ROUGHNESS, uv);
    let texel = textureSample(metallic_roughness_texture, metallic_roughness_sampler, place);
    return saturate(vec2<f32>(materials[material].metallic, materials[material].roughness) * texel.bg);
}

// The normal in tangent space, not of unit length.
fn tangent_space_normal_at(material: u32, uv: vec4<f32>) -> vec3<f32> {
    let place = texture_coordinates(material, NORMAL, uv);
    let texel = textureSample(normal_texture, normal_sampler, place).xyz;
    let scale = materials[material].normal_scale;
    return (texel * 2.0 - 1.0) * vec3<f32>(scale, scale, 1.0);
}

// How much indirect light arrives, by the material's author: for pipelines that cannot compute it.
fn occlusion_at(material: u32, uv: vec4<f32>) -> f32 {
    let place = texture_coordinates(material, OCCLUSION, uv);
    let texel = textureSample(occlusion_texture, occlusion_sampler, place).r;
    return mix(1.0, texel, materials[material].occlusion_strength);
}

// Emitted radiance, nits.
fn emission_at(material: u32, uv: vec4<f32>) -> vec3<f32> {
    let place = texture_coordinates(material, EMISSIVE, uv);
    return materials[material].emissive * textureSample(emissive_texture, emissive_sampler, place).rgb;
}

// KHR_materials_specular: strength of a dielectric's reflection, which is also its reflectance at grazing angles.
fn specular_weight_at(material: u32, uv: vec4<f32>) -> f32 {
    let place = texture_coordinates(material, SPECULAR, uv);
    return saturate(materials[material].specular * textureSample(specular_texture, specular_sampler, place).a);
}

// KHR_materials_specular and _ior: a dielectric's reflectance at normal incidence, before the weight.
fn dielectric_f0_at(material: u32, uv: vec4<f32>) -> vec3<f32> {
    let place = texture_coordinates(material, SPECULAR_COLOR, uv);
    let tint = materials[material].specular_color
        * textureSample(specular_color_texture, specular_color_sampler, place).rgb;
    return dielectric_f0(materials[material].ior, tint);
}
