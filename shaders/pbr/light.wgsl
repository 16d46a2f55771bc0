// Emission and direct light per texel of the G-buffer; black where nothing stands.

#import "shared/direct_light.wgsl"
#import "shared/gbuffer_textures.wgsl"
#import "shared/jitter.wgsl"

struct Targets {
    // Radiance / light_unit.
    light: vec4<f32>,
}

@fragment
fn shade(@builtin(position) place: vec4<f32>, @location(0) uv: vec2<f32>) -> Targets {
    let texel = vec2<i32>(place.xy);
    let stored_depth = textureLoad(depth, texel, 0);
    if stored_depth == NOTHING_THERE {
        return Targets(vec4<f32>(0.0, 0.0, 0.0, 1.0));
    }
    var point = load_gbuffer(texel, unjittered_uv(uv), stored_depth);
    point.pixel = pixel_of_sample(point.pixel);
    return Targets(vec4<f32>(fit_half(emitted_and_direct_light(point, vec2<u32>(texel))), 1.0));
}
