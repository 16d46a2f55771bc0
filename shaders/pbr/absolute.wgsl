// Accumulated light in absolute units: radiance in nits, as 32-bit floats.

#import "shared/environment.wgsl"

// Radiance / light_unit.
var light: texture_2d<f32>;

struct Targets {
    absolute: vec4<f32>,
}

@fragment
fn scale(@builtin(position) place: vec4<f32>) -> Targets {
    let accumulated = textureLoad(light, vec2<i32>(place.xy), 0).rgb;
    return Targets(vec4<f32>(accumulated * environment.light_unit, 1.0));
}
