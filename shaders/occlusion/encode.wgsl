// The mean of all samples as a picture. What is stored is linear; the target's format encodes it.

var light: texture_2d<f32>;

struct Targets {
    color: vec4<f32>,
}

@fragment
fn encode(@builtin(position) place: vec4<f32>) -> Targets {
    return Targets(vec4<f32>(textureLoad(light, vec2<i32>(place.xy), 0).rgb, 1.0));
}
