// The sky where nothing was drawn.

#import "shared/camera.wgsl"
#import "shared/jitter.wgsl"
#import "skybox/sky_image.wgsl"

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
    let radiance = scene_sky_radiance(direction_through(unjittered_uv(uv)));
    return Targets(vec4<f32>(fit_half(radiance * environment.inverse_light_unit), 1.0));
}
