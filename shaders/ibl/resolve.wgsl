// Light from around each texel of the G-buffer; nothing where nothing stands, or where a surface takes no light.
//
// Around it are the sky, and where reflection probes have captured the scene, what they saw.

#import "environment/lookup.wgsl"
#import "ibl/split_sum.wgsl"
#import "irradiance/coefficients.wgsl"
#import "prefilter/lookup.wgsl"
#import "shared/box_projection.wgsl"
#import "shared/gbuffer_textures.wgsl"
#import "shared/jitter.wgsl"
#import "shared/reflection_probes.wgsl"
#import "shared/specular_occlusion.wgsl"

// The environment itself, means of it over lobes, and irradiance / pi.
var environment_cube: texture_cube_array<f32>;
var prefiltered: texture_cube_array<f32>;
var irradiance_cube: texture_cube<f32>;
// The same of what probes captured, one after the other, in units of light_unit.
var captured: texture_cube_array<f32>;
var captured_lobes: texture_cube_array<f32>;
var<storage, read> captured_coefficients: array<vec4<f32>>;
// Bent normal, and visibility in alpha (blocks/ambient_occlusion.ron); or one texel that hides nothing.
var occlusion: texture_2d<f32>;

// Whether irradiance comes from the cube, and not from the coefficients.
override irradiance_is_cube: bool = false;
// How many probes have captured the scene.
override probes: u32 = 0;
// Metres over which a probe fades out beyond its box.
override box_margin: f32 = 0.0;

struct Targets {
    // Radiance / light_unit.
    light: vec4<f32>,
}

// Light / light_unit that arrives: irradiance / pi, and the mean over the lobe.
struct Surroundings {
    irradiance: vec3<f32>,
    lobe: vec3<f32>,
}

fn sky_around(normal: vec3<f32>, mirrored: vec3<f32>, roughness: f32) -> Surroundings {
    var irradiance: vec3<f32>;
    if irradiance_is_cube {
        irradiance = textureSampleLevel(irradiance_cube, linear_clamp, in_environment(normal), 0.0).rgb;
    } else {
        irradiance = sh_irradiance(sh_of_sky(), in_environment(normal));
    }
    let lobe = mean_over_lobe(environment_cube, prefiltered, 0u, in_environment(mirrored), roughness);
    return Surroundings(environment_light(irradiance), environment_light(lobe));
}

fn sh_of_sky() -> array<vec3<f32>, 9> {
    var found: array<vec3<f32>, 9>;
    for (var i = 0u; i < SH_COUNT; i++) {
        found[i] = coefficients[i].rgb;
    }
    return found;
}

fn sh_of_probe(probe: u32) -> array<vec3<f32>, 9> {
    var found: array<vec3<f32>, 9>;
    for (var i = 0u; i < SH_COUNT; i++) {
        found[i] = captured_coefficients[probe * SH_COUNT + i].rgb;
    }
    return found;
}

// Earlier probes come before later ones, and what none of them holds is the sky's, of which `seen` reaches the lobe. What stands nearby is in
// the probes' cubes, and hides nothing of them.
fn around(point: SurfacePoint, normal: vec3<f32>, mirrored: vec3<f32>, seen: f32) -> Surroundings {
    var sum = Surroundings(vec3<f32>(0.0), vec3<f32>(0.0));
    var left = 1.0;
    for (var i = 0u; i < probes; i++) {
        let to_box = reflection_probes[i].box_from_world;
        let weight = left * box_weight(to_box, point.position, box_margin);
        if weight > 0.0 {
            let axis = box_projected(to_box, reflection_probes[i].position, point.position, mirrored);
            sum.irradiance += weight * sh_irradiance(sh_of_probe(i), normal);
            sum.lobe += weight * mean_over_lobe(captured, captured_lobes, i, axis, point.roughness);
            left -= weight;
        }
    }
    if left > 0.0 {
        let sky = sky_around(normal, mirrored, point.roughness);
        sum.irradiance += left * sky.irradiance;
        sum.lobe += left * seen * sky.lobe;
    }
    return sum;
}

@fragment
fn resolve(@builtin(position) place: vec4<f32>, @location(0) uv: vec2<f32>) -> Targets {
    let texel = vec2<i32>(place.xy);
    let stored_depth = textureLoad(depth, texel, 0);
    if stored_depth == NOTHING_THERE {
        return Targets(vec4<f32>(0.0));
    }
    let point = load_gbuffer(texel, unjittered_uv(uv), stored_depth);
    if point.unlit {
        return Targets(vec4<f32>(0.0));
    }
    let hidden = textureLoad(occlusion, min(texel, vec2<i32>(textureDimensions(occlusion)) - 1), 0);
    let open_side = select(hidden.xyz, point.normal, all(hidden.xyz == vec3<f32>(0.0)));
    let n_dot_v = saturate(dot(point.normal, point.to_eye));
    let mirrored = reflect(-point.to_eye, point.normal);
    let seen = specular_occlusion(hidden.w, hidden.xyz, mirrored, point.roughness, n_dot_v);
    let light = around(point, open_side, mirrored, seen);
    let reflectance = split_sum(point, n_dot_v);
    let diffuse = reflectance.diffuse * light.irradiance * multi_bounce(hidden.w, reflectance.diffuse);
    return Targets(vec4<f32>(fit_half(diffuse + reflectance.specular * light.lobe), 0.0));
}
