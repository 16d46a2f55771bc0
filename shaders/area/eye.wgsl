// Which point of a rectangle of light stands for it: another one for each sample of the image where rectangles are sampled, else its
// middle. Light and shadow take the same one.

#import "area/rectangles.wgsl"
#import "shared/jitter.wgsl"

override rectangles_are_sampled: bool = false;

// From one rectangle's place to the next one's, so that they are not sampled in step.
const NEXT_RECTANGLE: vec2<f32> = vec2<f32>(0.7548776662466927, 0.5698402909980532);

// From the rectangle's middle to the point, metres. The sample's own two numbers say where, turned on from rectangle to rectangle.
fn rectangle_eye(index: u32) -> vec3<f32> {
    if !rectangles_are_sampled {
        return vec3<f32>(0.0);
    }
    let numbers = textureLoad(jitter, vec2<i32>(1, 0), 0).yz;
    let at = 2.0 * fract(0.5 + numbers + f32(index) * NEXT_RECTANGLE) - 1.0;
    return at.x * rectangle_lights[index].half_width + at.y * rectangle_lights[index].half_height;
}
