// Visibility as a picture in grey: what a white surface shows under a white sky, without light that bounces.

var occlusion: texture_2d<f32>;

struct Targets {
    grey: vec4<f32>,
}

@fragment
fn show(@builtin(position) place: vec4<f32>) -> Targets {
    return Targets(vec4<f32>(textureLoad(occlusion, vec2<i32>(place.xy), 0).aaa, 1.0));
}
