// The G-buffer: a surface point in four targets, 32 bytes as WebGPU counts them, which is the most that every device takes.
//
//   albedo    rgba16float  base colour, linear; alpha 1 where something was drawn
//   normals   rg32uint     shading normal, geometric normal: octahedral, 2 x 16 bits each
//   surface   rg32uint     x: roughness 16 bits, metallic 8, flags 8; y: square root of the dielectric F0 3 x 8, weight 8
//   emission  rg32uint     nits, with a shared exponent
//
// Nothing in it depends on lights or on exposure, so that it stays as it is while those change. Half floats keep base colours to
// 0.05 %, where 8 bit sRGB is up to 0.4 % off and counts just as much. Roughness has 16 bits because GGX highlights go with its
// fourth power. The position comes from depth.

#import "shared/octahedral.wgsl"
#import "shared/packing.wgsl"
#import "shared/surface_point.wgsl"

struct GbufferTexel {
    albedo: vec4<f32>,
    normals: vec2<u32>,
    surface: vec2<u32>,
    emission: vec2<u32>,
}

const GBUFFER_UNLIT: u32 = 1u;

fn encode_gbuffer(point: SurfacePoint) -> GbufferTexel {
    let flags = select(0u, GBUFFER_UNLIT, point.unlit);
    return GbufferTexel(
        vec4<f32>(point.base_color, 1.0),
        vec2<u32>(
            pack2x16snorm(octahedral_encode(point.normal)),
            pack2x16snorm(octahedral_encode(point.geometric_normal)),
        ),
        vec2<u32>(
            pack_16_8_8(point.roughness, point.metallic, flags),
            pack4x8unorm(vec4<f32>(sqrt(point.dielectric_f0), point.specular_weight)),
        ),
        pack_shared_exponent(point.emission),
    );
}

// All but the pixel.
fn decode_gbuffer(texel: GbufferTexel, position: vec3<f32>, to_eye: vec3<f32>) -> SurfacePoint {
    let roughness_metallic = unpack_16_8(texel.surface.x);
    let dielectric = unpack4x8unorm(texel.surface.y);

    var point: SurfacePoint;
    point.position = position;
    point.to_eye = to_eye;
    point.normal = octahedral_decode(unpack2x16snorm(texel.normals.x));
    point.geometric_normal = octahedral_decode(unpack2x16snorm(texel.normals.y));
    point.base_color = texel.albedo.rgb;
    point.roughness = roughness_metallic.x;
    point.metallic = roughness_metallic.y;
    point.dielectric_f0 = dielectric.rgb * dielectric.rgb;
    point.specular_weight = dielectric.a;
    point.emission = unpack_shared_exponent(texel.emission);
    point.unlit = ((texel.surface.x >> 24u) & GBUFFER_UNLIT) != 0u;
    return point;
}
