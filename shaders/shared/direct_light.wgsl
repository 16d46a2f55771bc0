// Light that reaches a surface straight from the scene's lights, shadows included, and leaves it towards the eye.
//
// The first directional light has a shadow map, and so have the first point and spot lights, as many as `local_shadow` has cubes;
// the others give light without shadow. The sky gives none: it is no punctual light.

#import "shared/brdf.wgsl"
#import "shared/lights.wgsl"
#import "shared/shadow_local.wgsl"
#import "shared/shadow_sun.wgsl"

// Radiance towards the eye from one light that nothing blocks, in units of `light_unit`. Exactly 0 where the light stands behind
// the triangle or behind the shading normal.
fn unblocked_light(point: SurfacePoint, light: Illumination) -> vec3<f32> {
    if dot(point.geometric_normal, light.to_light) <= 0.0 {
        return vec3<f32>(0.0);
    }
    let cosine = max(dot(point.normal, light.to_light), 0.0);
    return surface_brdf(point, light.to_light) * light.illuminance * (cosine * environment.inverse_light_unit);
}

// Radiance towards the eye from all lights, in units of `light_unit`.
fn direct_light(point: SurfacePoint) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < environment.directional_count; i++) {
        var light = unblocked_light(point, directional_illumination(i));
        if i == 0u && any(light > vec3<f32>(0.0)) {
            light *= sun_visibility(point.position, point.geometric_normal);
        }
        sum += light;
    }
    for (var i = 0u; i < environment.local_count; i++) {
        var light = unblocked_light(point, local_illumination(i, point.position));
        if any(light > vec3<f32>(0.0)) {
            light *= local_visibility(i, point.position, point.geometric_normal);
        }
        sum += light;
    }
    return sum;
}

// The same with what the point emits itself; that alone where it is unlit.
fn emitted_and_direct_light(point: SurfacePoint) -> vec3<f32> {
    let emitted = point.emission * environment.inverse_light_unit;
    if point.unlit {
        return emitted;
    }
    return emitted + direct_light(point);
}
