// A point of a surface, ready to be shaded. The G-buffer and forward shading both produce it; light functions take it.

struct SurfacePoint {
    // Where it shows in the image, texels from the upper left corner. What must differ from texel to texel starts from it.
    pixel: vec2<f32>,
    position: vec3<f32>,
    // Unit vector to the eye.
    to_eye: vec3<f32>,
    // Of the triangle itself, on the eye's side. Decides what can be lit at all, and is what shadows are tested with.
    geometric_normal: vec3<f32>,
    // Interpolated and normal-mapped, on the eye's side.
    normal: vec3<f32>,
    base_color: vec3<f32>,
    metallic: f32,
    // Perceptual.
    roughness: f32,
    // Reflectance of the dielectric part at normal incidence, before `specular_weight`.
    dielectric_f0: vec3<f32>,
    // Strength of the dielectric part's reflection.
    specular_weight: f32,
    // Nits that leave the point whatever light arrives.
    emission: vec3<f32>,
    // Takes no light: `emission` is all that is seen.
    unlit: bool,
}
