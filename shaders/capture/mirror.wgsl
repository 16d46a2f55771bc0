// What perfectly smooth surfaces reflect, per texel of the G-buffer: the cubes of all probes whose box holds the point, as much of each
// as its box holds it. Black on all others, and where no box is.

#import "shared/box_projection.wgsl"
#import "shared/brdf.wgsl"
#import "shared/gbuffer_textures.wgsl"
#import "shared/jitter.wgsl"
#import "shared/linear_clamp.wgsl"
#import "shared/reflection_probes.wgsl"

// Radiance / light_unit, a cube for each of the first probes.
var cubes: texture_cube_array<f32>;
struct Params {
    // Metres over which a box ends.
    box_margin: f32,
}

var<uniform> params: Params;

struct Targets {
    // Radiance / light_unit.
    light: vec4<f32>,
}

// From all probes, towards `direction`.
fn captured_light(position: vec3<f32>, direction: vec3<f32>) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var i = 0u; i < min(textureNumLayers(cubes), arrayLength(&reflection_probes)); i++) {
        if reflection_probes[i].far == 0.0 {
            continue;
        }
        let weight = box_weight(reflection_probes[i].box_from_world, position, params.box_margin);
        if weight > 0.0 {
            let ray = box_projected(reflection_probes[i].box_from_world, reflection_probes[i].position, position, direction);
            sum += weight * textureSampleLevel(cubes, linear_clamp, ray, i, 0.0).rgb;
            weights += weight;
        }
    }
    return select(vec3<f32>(0.0), sum / weights, weights > 0.0);
}

// The part of light that a smooth surface throws back towards the eye.
fn mirror_reflectance(point: SurfacePoint) -> vec3<f32> {
    let n_dot_v = saturate(dot(point.normal, point.to_eye));
    let dielectric = point.specular_weight * schlick_fresnel(point.dielectric_f0, n_dot_v);
    return mix(dielectric, schlick_fresnel(point.base_color, n_dot_v), point.metallic);
}

@fragment
fn reflect_cubes(@builtin(position) place: vec4<f32>, @location(0) uv: vec2<f32>) -> Targets {
    let texel = vec2<i32>(place.xy);
    let stored_depth = textureLoad(depth, texel, 0);
    var light = vec3<f32>(0.0);
    if stored_depth != NOTHING_THERE {
        let point = load_gbuffer(texel, unjittered_uv(uv), stored_depth);
        if point.roughness == 0.0 && !point.unlit {
            light = mirror_reflectance(point) * captured_light(point.position, reflect(-point.to_eye, point.normal));
        }
    }
    return Targets(vec4<f32>(fit_half(light), 1.0));
}
