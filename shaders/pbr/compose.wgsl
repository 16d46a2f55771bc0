// Direct and indirect light together.

#import "shared/math.wgsl"

var direct: texture_2d<f32>;
var indirect: texture_2d<f32>;

struct Targets {
    // Radiance / light_unit.
    light: vec4<f32>,
}

@fragment
fn add(@builtin(position) place: vec4<f32>) -> Targets {
    let texel = vec2<i32>(place.xy);
    let sum = textureLoad(direct, texel, 0).rgb + textureLoad(indirect, texel, 0).rgb;
    return Targets(vec4<f32>(fit_half(sum), 1.0));
}
