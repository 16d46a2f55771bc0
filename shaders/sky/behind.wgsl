// The physical sky with the sun's disc where nothing stands.

#import "shared/camera.wgsl"
#import "shared/jitter.wgsl"
#import "sky/sky.wgsl"

var surface_depth: texture_depth_2d;

struct Targets {
    // Radiance / light_unit.
    light: vec4<f32>,
}

@fragment
fn draw(@builtin(position) place: vec4<f32>, @location(0) uv: vec2<f32>) -> Targets {
    if textureLoad(surface_depth, vec2<i32>(place.xy), 0) != NOTHING_THERE {
        discard;
    }
    let direction = direction_through(unjittered_uv(uv));
    let radiance = sky_radiance(direction) + sun_disc_radiance(direction);
    return Targets(vec4<f32>(fit_half(radiance * environment.inverse_light_unit), 1.0));
}
