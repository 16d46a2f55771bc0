// Light that reaches a surface straight from the scene's lights, shadows included, and leaves it towards the eye.
//
// The first lights of each kind have shadow maps (shared/shadow.wgsl, area/visibility.wgsl), the others give light without shadow. The sky
// gives none: it is no punctual light.

#import "area/rectangle_light.wgsl"
#import "shared/brdf.wgsl"
#import "shared/light_lists.wgsl"
#import "shared/lights.wgsl"
#import "shared/shadow.wgsl"
#import "sky/light_table.wgsl"

var<storage, read> light_lists: array<u32>;
// Width of the image in pixels.
override light_list_width: u32 = 1;

// Radiance towards the eye from one light that nothing blocks, in units of `light_unit`. Exactly 0 where the light stands behind
// the triangle or behind the shading normal.
fn unblocked_light(point: SurfacePoint, light: Illumination) -> vec3<f32> {
    if dot(point.geometric_normal, light.to_light) <= 0.0 {
        return vec3<f32>(0.0);
    }
    let cosine = max(dot(point.normal, light.to_light), 0.0);
    return surface_brdf(point, light.to_light) * light.illuminance * (cosine * environment.inverse_light_unit);
}

// The same from one directional light, shadow included. The first one is the sun, of which the air takes its part.
fn directional_light(point: SurfacePoint, index: u32) -> vec3<f32> {
    var illumination = directional_illumination(index);
    if index == 0u {
        illumination.illuminance *= sky_light_texel(SUN_HERE).rgb;
    }
    let light = unblocked_light(point, illumination);
    if all(light <= vec3<f32>(0.0)) {
        return vec3<f32>(0.0);
    }
    return light * directional_visibility(index, point);
}

// The same from one point or spot light, shadow included.
fn local_light(point: SurfacePoint, index: u32) -> vec3<f32> {
    let light = unblocked_light(point, local_illumination(index, point.position));
    if all(light <= vec3<f32>(0.0)) {
        return vec3<f32>(0.0);
    }
    return light * local_visibility(index, point);
}

// The same from those that may reach a pixel, in their own order.
fn all_local_light(point: SurfacePoint, texel: vec2<u32>) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    if !lights_are_listed {
        for (var i = 0u; i < environment.local_count; i++) {
            sum += local_light(point, i);
        }
        return sum;
    }
    let start = light_list_start(texel, light_list_width);
    for (var word = 0u; word < light_words(); word++) {
        for (var bits = light_lists[start + word]; bits != 0u; bits &= bits - 1u) {
            sum += local_light(point, 32u * word + countTrailingZeros(bits));
        }
    }
    return sum;
}

// Radiance towards the eye from all lights, in units of `light_unit`, at a pixel of the image.
fn direct_light(point: SurfacePoint, texel: vec2<u32>) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < environment.directional_count; i++) {
        sum += directional_light(point, i);
    }
    return sum + all_local_light(point, texel) + all_rectangle_light(point);
}

// The same with what the point emits itself; that alone where it is unlit.
fn emitted_and_direct_light(point: SurfacePoint, texel: vec2<u32>) -> vec3<f32> {
    let emitted = point.emission * environment.inverse_light_unit;
    if point.unlit {
        return emitted;
    }
    return emitted + direct_light(point, texel);
}
