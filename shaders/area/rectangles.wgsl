// Rectangles that glow: the published table `rectangle_lights`, and which points each of them lights.

struct RectangleLight {
    // The middle.
    position: vec3<f32>,
    // Not 0 where it emits to both sides.
    two_sided: u32,
    // From the middle to the end of its width, metres. It faces along cross(half_width, half_height).
    half_width: vec3<f32>,
    // From the middle to a corner, metres.
    radius: f32,
    // From the middle to the end of its height, metres.
    half_height: vec3<f32>,
    // Square metres; 0 where there is no light.
    area: f32,
    // Nits, the same in all directions.
    radiance: vec3<f32>,
    // Near plane of the faces of its shadow cube, metres.
    near: f32,
    // Far plane of the faces, metres; 0 where there is no light.
    far: f32,
}

var<storage, read> rectangle_lights: array<RectangleLight>;

// A point as near to a rectangle's plane as this part of its radius gets no light from it: what lies in the plane would see it along
// its edge, and rounding would decide whether the half space in front is bright or dark.
const LEAST_HEIGHT: f32 = 1.0e-3;

// +1 where the rectangle lights a point with its front, -1 with its back, 0 where not at all.
fn lit_side(light: RectangleLight, position: vec3<f32>) -> f32 {
    if light.area == 0.0 {
        return 0.0;
    }
    let front = normalize(cross(light.half_width, light.half_height));
    let height = dot(front, position - light.position);
    if abs(height) <= LEAST_HEIGHT * light.radius {
        return 0.0;
    }
    return select(select(0.0, -1.0, light.two_sided != 0u), 1.0, height > 0.0);
}
