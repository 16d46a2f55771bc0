// Diffuse light from nine coefficients of radiance, as `irradiance/project.wgsl` and `sum.wgsl` leave them.

#import "shared/spherical_harmonics.wgsl"

// rgb of each, cube after cube.
var<storage, read> coefficients: array<vec4<f32>>;

// Irradiance / pi on a surface that faces `normal`, in units of the radiance. Never negative: order 2 rings where light comes from one side.
fn sh_irradiance(radiance: array<vec3<f32>, 9>, normal: vec3<f32>) -> vec3<f32> {
    let basis = sh_basis(normal);
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < SH_COUNT; i++) {
        sum += radiance[i] * (basis[i] * sh_cosine_band(i));
    }
    return max(sum, vec3<f32>(0.0));
}
