// The nine coefficients of radiance, as `irradiance/project.wgsl` and `sum.wgsl` leave them: rgb of each, cube after cube.

#import "shared/spherical_harmonics.wgsl"

var<storage, read> coefficients: array<vec4<f32>>;

// Irradiance / pi on a surface that faces `normal`, in units of the cube. Never negative: order 2 rings where light comes from one side.
fn sh_irradiance(cube: u32, normal: vec3<f32>) -> vec3<f32> {
    let basis = sh_basis(normal);
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < SH_COUNT; i++) {
        sum += coefficients[cube * SH_COUNT + i].rgb * (basis[i] * sh_cosine_band(i));
    }
    return max(sum, vec3<f32>(0.0));
}
