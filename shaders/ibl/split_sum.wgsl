// How much of the light around a surface leaves it towards the eye: the split sum, lobe by lobe.
//
// Karis 2013, "Real Shading in Unreal Engine 4". Light that bounces within the microsurface is given back by scaling the lobe (Turquin
// 2019, "Practical multiple scattering compensation for microfacet models", eq. 16; F0 (1 / E - 1) more of it), the dielectric's and the
// metal's each for itself: mixed first, a half-metal would get neither's. With it the diffuse part has what the dielectric's lobe leaves, so
// that a white surface in white light is white; without, it has what Fresnel lets through at single facets.

#import "brdf_lut/lookup.wgsl"
#import "shared/math.wgsl"
#import "shared/surface_point.wgsl"

// Of blocks/brdf_lut.ron.
var brdf_lut: texture_2d<f32>;

// Light that bounces between facets is given back.
override compensated: bool = true;

struct Reflectance {
    // Factor on irradiance / pi.
    diffuse: vec3<f32>,
    // Factor on the mean radiance over the lobe.
    specular: vec3<f32>,
}

// The part of light from everywhere that a facet's Fresnel lets through to a diffuse surface, (1 - F0) C(n.v), has this C: a fit of its
// integral, to 0.0002.
fn diffuse_transmission(n_dot_v: f32) -> f32 {
    return 0.971839 + n_dot_v * (0.079826 + n_dot_v * (-0.086335 + n_dot_v * (0.043477 - n_dot_v * 0.008889)));
}

// All that a lobe reflects, and with what comes back out of the microsurface.
fn lobe_reflectance(f0: vec3<f32>, f90: f32, factors: vec2<f32>) -> vec3<f32> {
    let single = f0 * factors.x + f90 * factors.y;
    return select(single, single * (1.0 + f0 * (1.0 / (factors.x + factors.y) - 1.0)), compensated);
}

fn split_sum(point: SurfacePoint, n_dot_v: f32) -> Reflectance {
    let factors = lobe_factors(brdf_lut, n_dot_v, point.roughness);
    let dielectric = lobe_reflectance(point.specular_weight * point.dielectric_f0, point.specular_weight, factors);
    let metal = lobe_reflectance(point.base_color, 1.0, factors);
    let f0 = point.specular_weight * largest(point.dielectric_f0);
    let passed = 1.0 - f0 - (point.specular_weight - f0) * (1.0 - diffuse_transmission(n_dot_v));
    let left = select(passed, 1.0 - largest(dielectric), compensated);
    return Reflectance(point.base_color * ((1.0 - point.metallic) * left), mix(dielectric, metal, point.metallic));
}
