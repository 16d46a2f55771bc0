// The G-buffer's normals and depth in a form that people and other programs read.

#import "shared/gbuffer_textures.wgsl"

struct Targets {
    // Shading normal in the world, each component -1 to 1; alpha 1 where something was drawn, else all 0.
    normal: vec4<f32>,
    // Metres from the camera along its axis; 0 where nothing was drawn.
    distance: f32,
}

@fragment
fn show(@builtin(position) place: vec4<f32>, @location(0) uv: vec2<f32>) -> Targets {
    let texel = vec2<i32>(place.xy);
    let stored_depth = textureLoad(depth, texel, 0);
    if stored_depth == NOTHING_THERE {
        return Targets(vec4<f32>(0.0), 0.0);
    }
    let shading_normal = octahedral_decode(unpack2x16snorm(textureLoad(normals, texel, 0).x));
    let metres = distance_along_axis(position_from_depth(uv, stored_depth));
    return Targets(vec4<f32>(shading_normal, 1.0), metres);
}
