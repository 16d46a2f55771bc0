// One face of the environment cube: the physical sky, without the sun's disc. It is smooth but for the horizon.

#import "environment/cube_texel.wgsl"
#import "shared/environment.wgsl"
#import "shared/round_stored.wgsl"
#import "sky/sky.wgsl"

struct Params {
    // The face.
    f: u32,
    // Samples along the edge of a texel.
    samples: u32,
}

var<uniform> params: Params;

// Edge of the face in texels.
override edge: u32 = 1;

struct Targets {
    // Radiance / light_unit.
    radiance: vec4<f32>,
}

@fragment
fn fill(@builtin(position) position: vec4<f32>) -> Targets {
    let corner = floor(position.xy);
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < params.samples * params.samples; i++) {
        let part = (vec2<f32>(vec2<u32>(i % params.samples, i / params.samples)) + 0.5) / f32(params.samples);
        sum += sky_radiance(normalize(cube_direction(params.f, place_on_face(corner + part, f32(edge)))));
    }
    let mean = sum * (environment.inverse_light_unit / f32(params.samples * params.samples));
    return Targets(vec4<f32>(round_stored(fit_half(mean)), 1.0));
}
