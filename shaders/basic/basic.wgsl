// Blinn-Phong, shaded as it is drawn: the smallest shader that lights a scene.
//
// The material is the scene's own (metallic-roughness): its roughness becomes the exponent of the highlight that is as wide as that of the
// microfacets (Walter et al. 2007, eq. 8 of Blinn's distribution), its colours become the diffuse and the specular one.

#import "shared/forward_surface.wgsl"
#import "shared/lights.wgsl"
#import "shared/math.wgsl"

struct Params {
    // Part of the sky's radiance that stands for all indirect light.
    ambient: f32,
}

var<uniform> params: Params;

struct Targets {
    // Radiance / light_unit, and how much of what is behind is covered.
    light: vec4<f32>,
}

// Highlights sharper than this fall between the pixels.
const MOST_EXPONENT: f32 = 2048.0;

@vertex
fn transform(vertex: MeshVertex, @builtin(instance_index) instance_index: u32) -> MeshFragment {
    return transform_mesh_vertex(vertex, instance_index);
}

// Radiance per lux on a surface that faces the light, 1/sr. The factor (n + 8) / 8 pi keeps the energy of a highlight, whatever its
// exponent (Akenine-Moeller et al. 2008, "Real-Time Rendering", 3rd edition, eq. 7.48).
fn blinn_phong(point: SurfacePoint, to_light: vec3<f32>) -> vec3<f32> {
    let halfway = normalize(to_light + point.to_eye);
    let alpha = square(point.roughness);
    let exponent = clamp(2.0 / max(square(alpha), 1.0e-6) - 2.0, 0.0, MOST_EXPONENT);
    let diffuse = point.base_color * (1.0 - point.metallic);
    let specular = mix(point.dielectric_f0 * point.specular_weight, point.base_color, point.metallic);
    let highlight = pow(max(dot(point.normal, halfway), 0.0), exponent) * (exponent + 8.0) / (8.0 * PI);
    return diffuse / PI + specular * highlight;
}

fn lit_by(point: SurfacePoint, light: Illumination) -> vec3<f32> {
    let cosine = dot(point.normal, light.to_light);
    if cosine <= 0.0 || dot(point.geometric_normal, light.to_light) <= 0.0 {
        return vec3<f32>(0.0);
    }
    return blinn_phong(point, light.to_light) * light.illuminance * cosine;
}

@fragment
fn shade(fragment: MeshFragment, @builtin(front_facing) front_facing: bool) -> Targets {
    let drawn = drawn_surface(fragment, front_facing);
    if is_cut_out(fragment.material, drawn.alpha) {
        discard;
    }
    var radiance = drawn.point.emission;
    if !drawn.point.unlit {
        radiance += drawn.point.base_color * environment.sky_radiance * params.ambient;
        for (var i = 0u; i < environment.directional_count; i++) {
            radiance += lit_by(drawn.point, directional_illumination(i));
        }
        for (var i = 0u; i < environment.local_count; i++) {
            radiance += lit_by(drawn.point, local_illumination(i, drawn.point.position));
        }
    }
    return Targets(vec4<f32>(fit_half(radiance * environment.inverse_light_unit), saturate(drawn.alpha)));
}
