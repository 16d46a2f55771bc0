// Light from the environment per texel of the G-buffer; nothing where nothing stands, or where a surface takes no light.

#import "environment/lookup.wgsl"
#import "ibl/split_sum.wgsl"
#import "irradiance/coefficients.wgsl"
#import "prefilter/lookup.wgsl"
#import "shared/gbuffer_textures.wgsl"
#import "shared/jitter.wgsl"

// Irradiance / pi.
var irradiance_cube: texture_cube<f32>;

// Whether irradiance comes from that, and not from the coefficients.
override irradiance_is_cube: bool = false;

struct Targets {
    // Radiance / light_unit.
    light: vec4<f32>,
}

fn irradiance(normal: vec3<f32>) -> vec3<f32> {
    if irradiance_is_cube {
        return textureSampleLevel(irradiance_cube, linear_clamp, normal, 0.0).rgb;
    }
    return sh_irradiance(0u, normal);
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
    let n_dot_v = saturate(dot(point.normal, point.to_eye));
    let reflectance = split_sum(point, n_dot_v);
    let diffuse = environment_light(irradiance(in_environment(point.normal)));
    let mirrored = reflect(-point.to_eye, point.normal);
    let specular = environment_light(mean_over_lobe(0u, in_environment(mirrored), point.roughness));
    return Targets(vec4<f32>(fit_half(reflectance.diffuse * diffuse + reflectance.specular * specular), 0.0));
}
