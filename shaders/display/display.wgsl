// Exposure and tone mapping: from accumulated light to a picture. The only pass that depends on exposure.

#import "shared/camera.wgsl"
#import "shared/environment.wgsl"
#import "shared/tonemap.wgsl"

// Radiance / light_unit.
var light: texture_2d<f32>;

struct Params {
    // EV: +1 is twice as bright.
    exposure: f32,
    // TONE_MAP_ constants.
    tone_mapping: u32,
}

var<uniform> params: Params;

struct Targets {
    color: vec4<f32>,
}

@fragment
fn expose(@builtin(position) place: vec4<f32>) -> Targets {
    let accumulated = textureLoad(light, vec2<i32>(place.xy), 0).rgb;
    let exposed = accumulated * (environment.light_unit * camera.exposure * exp2(params.exposure));
    return Targets(vec4<f32>(tone_map(exposed, params.tone_mapping), 1.0));
}
