// The physical sky, on a face of a cube. Without the sun's disc: it is narrower than a texel, and shines as a light does.

#import "shared/cube.wgsl"
#import "sky/sky.wgsl"

struct Params {
    // Face of all faces of all cubes, six each.
    i: u32,
}

var<uniform> params: Params;

struct Targets {
    // Radiance / light_unit.
    light: vec4<f32>,
}

@fragment
fn draw(@location(0) uv: vec2<f32>) -> Targets {
    let direction = normalize(cube_direction(params.i % 6u, uv * 2.0 - 1.0));
    return Targets(vec4<f32>(fit_half(sky_radiance(direction) * environment.inverse_light_unit), 1.0));
}
