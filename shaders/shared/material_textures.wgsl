// The textures of the material that is drawn, and their values at a point. For Draw passes only: each draw binds its own.
//
// A missing texture is one white texel (for normals: one that points straight up), so every function below may be called for
// every material. All of them take differences, so call them where all invocations come by: before any discard or branch.

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

// How many mip levels finer than the distance of pixels asks for: where n samples are averaged in each pixel, log2(n) / 2.
override texture_detail: f32 = 0.0;

// Where to look up a texture, and how that place changes to the neighbours, which chooses the mip level.
struct TexturePlace {
    at: vec2<f32>,
    dx: vec2<f32>,
    dy: vec2<f32>,
}

// The place in texture `index`. `uv` holds the first set of coordinates in xy and the second in zw.
//
// Differences are taken of `uv` and transformed then. Taken of the transformed place they would need what the neighbours read from
// `materials`, and where a neighbour lies outside of the triangle some drivers read zeros for it: a wrong mip level along
// every edge.
fn texture_place(material: u32, index: u32, uv: vec4<f32>) -> TexturePlace {
    let scale = exp2(-texture_detail);
    let uv_dx = dpdx(uv) * scale;
    let uv_dy = dpdy(uv) * scale;
    let second_set = ((materials[material].uv_sets >> index) & 1u) != 0u;
    let row_u = materials[material].uv_transforms[2u * index].xyz;
    let row_v = materials[material].uv_transforms[2u * index + 1u].xyz;
    let place = vec3<f32>(select(uv.xy, uv.zw, second_set), 1.0);
    let dx = select(uv_dx.xy, uv_dx.zw, second_set);
    let dy = select(uv_dy.xy, uv_dy.zw, second_set);
    return TexturePlace(
        vec2<f32>(dot(row_u, place), dot(row_v, place)),
        vec2<f32>(dot(row_u.xy, dx), dot(row_v.xy, dx)),
        vec2<f32>(dot(row_u.xy, dy), dot(row_v.xy, dy)),
    );
}

// Base colour, linear, and alpha: factor times texture times vertex colour.
fn base_color_at(material: u32, uv: vec4<f32>, vertex_color: vec4<f32>) -> vec4<f32> {
    let place = texture_place(material, BASE_COLOR, uv);
    let texel = textureSampleGrad(base_color_texture, base_color_sampler, place.at, place.dx, place.dy);
    return materials[material].base_color * texel * vertex_color;
}

// Metallic and roughness, both 0 to 1. The texture holds roughness in green and metallic in blue.
fn metallic_roughness_at(material: u32, uv: vec4<f32>) -> vec2<f32> {
    let place = texture_place(material, METALLIC_ROUGHNESS, uv);
    let texel = textureSampleGrad(metallic_roughness_texture, metallic_roughness_sampler, place.at, place.dx, place.dy);
    return saturate(vec2<f32>(materials[material].metallic, materials[material].roughness) * texel.bg);
}

// The normal in tangent space, not of unit length.
fn tangent_space_normal_at(material: u32, uv: vec4<f32>) -> vec3<f32> {
    let place = texture_place(material, NORMAL, uv);
    let texel = textureSampleGrad(normal_texture, normal_sampler, place.at, place.dx, place.dy).xyz;
    let scale = materials[material].normal_scale;
    return (texel * 2.0 - 1.0) * vec3<f32>(scale, scale, 1.0);
}

// How much indirect light arrives, by the material's author: for pipelines that cannot compute it.
fn occlusion_at(material: u32, uv: vec4<f32>) -> f32 {
    let place = texture_place(material, OCCLUSION, uv);
    let texel = textureSampleGrad(occlusion_texture, occlusion_sampler, place.at, place.dx, place.dy).r;
    return mix(1.0, texel, materials[material].occlusion_strength);
}

// Emitted radiance, nits.
fn emission_at(material: u32, uv: vec4<f32>) -> vec3<f32> {
    let place = texture_place(material, EMISSIVE, uv);
    return materials[material].emissive * textureSampleGrad(emissive_texture, emissive_sampler, place.at, place.dx, place.dy).rgb;
}

// KHR_materials_specular: strength of a dielectric's reflection, which is also its reflectance at grazing angles.
fn specular_weight_at(material: u32, uv: vec4<f32>) -> f32 {
    let place = texture_place(material, SPECULAR, uv);
    return saturate(materials[material].specular * textureSampleGrad(specular_texture, specular_sampler, place.at, place.dx, place.dy).a);
}

// KHR_materials_specular and _ior: a dielectric's reflectance at normal incidence, before the weight.
fn dielectric_f0_at(material: u32, uv: vec4<f32>) -> vec3<f32> {
    let place = texture_place(material, SPECULAR_COLOR, uv);
    let tint = materials[material].specular_color
        * textureSampleGrad(specular_color_texture, specular_color_sampler, place.at, place.dx, place.dy).rgb;
    return dielectric_f0(materials[material].ior, tint);
}
