// The sky where nothing stands.

#import "shared/camera.wgsl"
#import "shared/environment.wgsl"
#import "shared/math.wgsl"

var surface_depth: texture_depth_2d;

struct Targets {
    // Radiance / light_unit.
    light: vec4<f32>,
}

@fragment
fn fill(@builtin(position) place: vec4<f32>) -> Targets {
    if textureLoad(surface_depth, vec2<i32>(place.xy), 0) != NOTHING_THERE {
        discard;
    }
    return Targets(vec4<f32>(fit_half(environment.sky_radiance * environment.inverse_light_unit), 1.0));
}
