// Normals on the eye's side: of the triangle, and for shading.

// A shading normal must see the eye at least at this cosine, else the BRDF is meaningless there.
const LEAST_COSINE_TO_EYE: f32 = 1.0e-3;

// The triangle's own normal, from how the position changes between neighbouring fragments. Call it where all invocations come
// by. `fallback` stands in for triangles so thin that the differences vanish.
fn geometric_normal_of(from_eye: vec3<f32>, to_eye: vec3<f32>, fallback: vec3<f32>) -> vec3<f32> {
    let across = cross(dpdx(from_eye), dpdy(from_eye));
    let length_squared = dot(across, across);
    let normal = select(normalize(fallback), across * inverseSqrt(length_squared), length_squared > 0.0);
    return select(-normal, normal, dot(normal, to_eye) >= 0.0);
}

// The normal to shade with. `normal` and `tangent` are interpolated, in the world, of any length; `mapped` is the normal
// texture's value.
//
// On a back face the whole mapped normal turns (glTF 2.0, section 3.9.5). A normal that turns away from the eye, which is what
// maps and coarse meshes do near silhouettes, gives way to the unmapped one, and that one to the triangle's.
fn shading_normal_of(
    normal: vec3<f32>,
    tangent: vec4<f32>,
    mapped: vec3<f32>,
    has_map: bool,
    front_facing: bool,
    geometric_normal: vec3<f32>,
    to_eye: vec3<f32>,
) -> vec3<f32> {
    let side = select(-1.0, 1.0, front_facing);
    let up = normalize(normal);
    var shading = up * side;
    if !(dot(shading, to_eye) > LEAST_COSINE_TO_EYE) {
        shading = geometric_normal;
    }
    if has_map {
        let along = tangent.xyz - up * dot(up, tangent.xyz);
        let length_squared = dot(along, along);
        if length_squared > 0.0 {
            let t = along * inverseSqrt(length_squared);
            let b = cross(up, t) * sign(tangent.w);
            let candidate = normalize(t * mapped.x + b * mapped.y + up * mapped.z) * side;
            if dot(candidate, to_eye) > LEAST_COSINE_TO_EYE {
                shading = candidate;
            }
        }
    }
    return shading;
}
