// From a point to the eye, for perspective and orthographic projections alike.

// A perspective projection takes its clip space w from the depth, an orthographic one has w = 1 everywhere: then the fourth
// row of the matrix is (0, 0, 0, 1), and all rays to the eye are parallel.
fn is_orthographic(projection: mat4x4<f32>) -> bool {
    return all(vec3<f32>(projection[0].w, projection[1].w, projection[2].w) == vec3<f32>(0.0));
}

// Unit vector from `position` to an eye with this projection, place and direction.
fn direction_to_eye(projection: mat4x4<f32>, eye: vec3<f32>, forward: vec3<f32>, position: vec3<f32>) -> vec3<f32> {
    if is_orthographic(projection) {
        return -forward;
    }
    return normalize(eye - position);
}
