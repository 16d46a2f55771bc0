// A slice of the hemisphere over a point: the plane through the line of sight and a direction across it. In it angles are counted from the
// way to the eye, positive towards `across`. What is integrated over a slice, and then over slices by their angle about the line of sight,
// is an integral over the sphere: |sin| of the angle is the width of a slice (Jimenez et al. 2016, "Practical Realtime Strategies for
// Accurate Indirect Occlusion", section 4).

#import "shared/math.wgsl"

struct Slice {
    // Unit vectors in the plane: to the eye, and across.
    to_eye: vec3<f32>,
    across: vec3<f32>,
    // The shading normal within the plane: its angle, and the length of what is left of it.
    normal_angle: f32,
    normal_length: f32,
    // The same of the geometric normal.
    plane_angle: f32,
    plane_length: f32,
}

// So much of the geometric normal is left in any slice: a plane that holds it not at all is seen edge on.
const LEAST_LENGTH: f32 = 1.0e-4;

fn slice_through(to_eye: vec3<f32>, across: vec3<f32>, normal: vec3<f32>, geometric_normal: vec3<f32>) -> Slice {
    let shading = vec2<f32>(dot(normal, to_eye), dot(normal, across));
    let plane = vec2<f32>(dot(geometric_normal, to_eye), dot(geometric_normal, across));
    return Slice(
        to_eye, across,
        atan2(shading.y, shading.x), length(shading),
        atan2(plane.y, plane.x), max(length(plane), LEAST_LENGTH),
    );
}

// The surface's own plane within the slice, on the side of `across`.
fn tangent_of(slice: Slice) -> vec3<f32> {
    return cos(slice.plane_angle) * slice.across - sin(slice.plane_angle) * slice.to_eye;
}

// What comes from between the eye and the angle `end`, by the cosine to the shading normal (at angle g): the integral of
// cos(t - g) |sin t|, which is even in the sign of `end`.
fn light_up_to(end: f32, g: f32) -> f32 {
    return 0.25 * (cos(g) - cos(2.0 * end - g)) + 0.5 * end * sin(g);
}

// Where it comes from on the mean, times how much that is: the integrals of (cos t, sin t) cos(t - g) |sin t|, along the way to the eye and
// across.
fn direction_up_to(end: f32, g: f32) -> vec2<f32> {
    let to_eye = 4.0 * cos(g) - cos(3.0 * end - g) - 3.0 * cos(end + g);
    let across = 6.0 * sin(end - g) - sin(3.0 * end - g) - 3.0 * sin(end + g) + 8.0 * sin(g);
    return vec2<f32>(to_eye, across) / 12.0;
}

struct SliceLight {
    // What occluders keep away: xyz is its mean direction times its amount, w the amount.
    hidden: vec4<f32>,
    // What would come without them.
    open: f32,
}

// `before` and `behind` are how far occluders rise above the surface's own plane on either side (behind is that of `across`), radians.
fn slice_light(slice: Slice, before: f32, behind: f32) -> SliceLight {
    let g = slice.normal_angle;
    // Light comes from above the surface's plane, and from before the shading normal.
    let open = vec2<f32>(max(slice.plane_angle, g), min(slice.plane_angle, g)) + vec2<f32>(-0.5, 0.5) * PI;
    let risen = slice.plane_angle + vec2<f32>(before - 0.5 * PI, 0.5 * PI - behind);
    // Whatever is seen beside the point is on that side of the line of sight.
    let seen = vec2<f32>(clamp(risen.x, open.x, 0.0), clamp(risen.y, 0.0, open.y));
    let all = light_up_to(open.x, g) + light_up_to(open.y, g);
    let hidden = all - light_up_to(seen.x, g) - light_up_to(seen.y, g);
    let inward = direction_up_to(open.x, g) + direction_up_to(open.y, g) - direction_up_to(seen.x, g) - direction_up_to(seen.y, g);
    let direction = inward.x * slice.to_eye + inward.y * slice.across;
    return SliceLight(slice.normal_length * vec4<f32>(direction, hidden), slice.normal_length * all);
}
