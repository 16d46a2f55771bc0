// A frame around an axis, without a branch: Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1).

// The columns are two unit vectors across and `axis` itself.
fn frame_around(axis: vec3<f32>) -> mat3x3<f32> {
    let side = select(-1.0, 1.0, axis.z >= 0.0);
    let a = -1.0 / (side + axis.z);
    let b = axis.x * axis.y * a;
    return mat3x3<f32>(
        vec3<f32>(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x),
        vec3<f32>(b, side + axis.y * axis.y * a, -axis.y),
        axis,
    );
}
