// From a point to the eye, for perspective and orthographic projections alike.

// Unit vector from `position` to an eye with this projection, place and direction.
//
// A perspective projection takes its clip space w from the depth, an orthographic one has w = 1 everywhere: then the fourth
// row of the matrix is (0, 0, 0, 1), and all rays to the eye are parallel.
fn direction_to_eye(projection: mat4x4<f32>, eye: vec3<f32>, forward: vec3<f32>, position: vec3<f32>) -> vec3<f32> {
    let w_by_place = vec3<f32>(projection[0].w, projection[1].w, projection[2].w);
    if all(w_by_place == vec3<f32>(0.0)) {
        return -forward;
    }
    return normalize(eye - position);
}
