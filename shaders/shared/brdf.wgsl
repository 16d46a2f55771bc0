// How surfaces reflect light: the metallic-roughness BRDF of glTF 2.0, Appendix B, with KHR_materials_specular and _ior.
//
//   f = mix(dielectric, metal, metallic)
//   dielectric = (1 - w max(F_d)) base / pi + w F_d D V      w = specular weight, F_d from the dielectric's F0
//   metal      = F_m D V                                     F_m from the base colour as F0
//
// D is GGX (Walter et al. 2007) with alpha = roughness^2; V is the height-correlated Smith term (Heitz 2014, "Understanding the
// Masking-Shadowing Function", eq. 99), as in Filament and the Khronos viewer, where the appendix prints the separable one; F is
// Schlick's. Light is scattered once: there is no compensation for what bounces within the microsurface, so rough surfaces lose
// some energy (a white metal of roughness 1 reflects about half).

#import "shared/math.wgsl"
#import "shared/surface_point.wgsl"

// Below this GGX is so narrow that a point light's highlight falls between the pixels.
const LEAST_ALPHA: f32 = 0.001;

// Width of the microfacet distribution.
fn ggx_alpha(roughness: f32) -> f32 {
    return max(square(roughness), LEAST_ALPHA);
}

// Density of microfacets that face `h`. The usual form takes (n.h)^2 from 1, which cancels for small alpha; |n x h|^2 is the
// same number without the loss.
fn ggx_distribution(alpha: f32, n: vec3<f32>, h: vec3<f32>) -> f32 {
    let across = cross(n, h);
    let spread = square(alpha * dot(n, h)) + dot(across, across);
    return square(alpha / spread) / PI;
}

// Height-correlated masking and shadowing, divided by 4 (n.l) (n.v).
fn smith_visibility(alpha: f32, n_dot_l: f32, n_dot_v: f32) -> f32 {
    let alpha_squared = square(alpha);
    let from_eye = n_dot_l * sqrt(square(n_dot_v) * (1.0 - alpha_squared) + alpha_squared);
    let from_light = n_dot_v * sqrt(square(n_dot_l) * (1.0 - alpha_squared) + alpha_squared);
    return 0.5 / (from_eye + from_light);
}

// Schlick 1994. All but F0 is in the weight (1 - v.h)^5.
fn schlick_fresnel(f0: vec3<f32>, v_dot_h: f32) -> vec3<f32> {
    let missing = saturate(1.0 - v_dot_h);
    let weight = square(square(missing)) * missing;
    return f0 + (1.0 - f0) * weight;
}

// Radiance that leaves towards the eye, per lux that arrives on the surface from `to_light`. 1/sr.
fn surface_brdf(point: SurfacePoint, to_light: vec3<f32>) -> vec3<f32> {
    let n_dot_l = dot(point.normal, to_light);
    let n_dot_v = dot(point.normal, point.to_eye);
    if n_dot_l <= 0.0 || n_dot_v <= 0.0 {
        return vec3<f32>(0.0);
    }
    let halfway = normalize(to_light + point.to_eye);
    let v_dot_h = dot(point.to_eye, halfway);
    let alpha = ggx_alpha(point.roughness);
    let lobe = ggx_distribution(alpha, point.normal, halfway) * smith_visibility(alpha, n_dot_l, n_dot_v);

    let dielectric_fresnel = point.specular_weight * schlick_fresnel(point.dielectric_f0, v_dot_h);
    let metal_fresnel = schlick_fresnel(point.base_color, v_dot_h);
    let diffuse = point.base_color * ((1.0 - point.metallic) * (1.0 - largest(dielectric_fresnel)) / PI);
    return diffuse + mix(dielectric_fresnel, metal_fresnel, point.metallic) * lobe;
}
