// Light from all rectangles: integrated, or one point of each a sample of the image.

#import "area/integrated.wgsl"
#import "area/sampled.wgsl"
#import "shared/environment.wgsl"
#import "shared/jitter.wgsl"

override rectangles_are_sampled: bool = false;

// From one rectangle's place to the next one's, so that they are not sampled in step.
const NEXT_RECTANGLE: vec2<f32> = vec2<f32>(0.7548776662466927, 0.5698402909980532);

// Where a rectangle is sampled, both 0 to 1: the sample's own two numbers, turned on. Its middle where there is one sample alone.
fn sampled_place(index: u32) -> vec2<f32> {
    let numbers = textureLoad(jitter, vec2<i32>(1, 0), 0).yz;
    return fract(0.5 + numbers + f32(index) * NEXT_RECTANGLE);
}

// Radiance towards the eye in units of `light_unit`, if nothing stands between.
fn all_rectangle_light(point: SurfacePoint) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < environment.rectangle_count; i++) {
        let light = rectangle_lights[i];
        if rectangles_are_sampled {
            sum += sampled_rectangle(point, light, sampled_place(i));
        } else {
            sum += integrated_rectangle(point, light);
        }
    }
    return sum * environment.inverse_light_unit;
}
