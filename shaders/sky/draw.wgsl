// The sky as the camera sees it, with the sun's disc.

#import "shared/camera.wgsl"
#import "sky/sky.wgsl"

struct Targets {
    // Radiance / light_unit.
    light: vec4<f32>,
}

@fragment
fn draw(@location(0) uv: vec2<f32>) -> Targets {
    let direction = direction_through(uv);
    let radiance = sky_radiance(direction) + sun_disc_radiance(direction);
    return Targets(vec4<f32>(radiance * environment.inverse_light_unit, 1.0));
}
