// Light from all rectangles, shadows included: integrated, or one point of each a sample of the image.

#import "area/integrated.wgsl"
#import "area/sampled.wgsl"
#import "area/visibility.wgsl"
#import "shared/environment.wgsl"

// Radiance towards the eye in units of `light_unit`.
fn all_rectangle_light(point: SurfacePoint) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < environment.rectangle_count; i++) {
        var light: vec3<f32>;
        if rectangles_are_sampled {
            light = sampled_rectangle(point, rectangle_lights[i], rectangle_eye(i));
        } else {
            light = integrated_rectangle(point, rectangle_lights[i]);
        }
        if any(light > vec3<f32>(0.0)) {
            sum += light * rectangle_visibility(i, point);
        }
    }
    return sum * environment.inverse_light_unit;
}
