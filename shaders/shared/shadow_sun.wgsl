// The shadow of the first directional light, from the map in slot `sun_shadow`: depth, square, drawn from the light's view.
//
// Guarantees: see shared/shadow.wgsl. What lies outside of the map is lit. An empty map (depth 1) shadows nothing.

#import "shared/lights.wgsl"
#import "shared/shadow.wgsl"

var sun_shadow: texture_depth_2d;

// What the map holds in a texel, in texels from the near plane; very far where there is nothing or no map.
fn sun_occluder(texel: vec2<i32>, size: i32, texels_deep: f32) -> f32 {
    if any(texel < vec2<i32>(0)) || any(texel >= vec2<i32>(size)) {
        return VERY_FAR;
    }
    let depth = textureLoad(sun_shadow, texel, 0);
    return select(depth * texels_deep, VERY_FAR, depth >= 1.0);
}

// How much of the light arrives at a point of a surface with this geometric normal: 0 to 1.
fn sun_visibility(position: vec3<f32>, geometric_normal: vec3<f32>) -> f32 {
    let size = i32(textureDimensions(sun_shadow).x);
    let texels_deep = directional_lights[0].shadow_depth_range / directional_lights[0].shadow_texel_size;
    // The shadow view turns and scales but does not shear: in this space, right, down and away from the light, in texels, angles
    // are as in the world.
    let to_texels = vec3<f32>(f32(size) * 0.5, f32(size) * -0.5, texels_deep);
    let centre = vec3<f32>(f32(size) * 0.5, f32(size) * 0.5, 0.0);
    let projected = directional_lights[0].shadow_from_world * vec4<f32>(position, 1.0);
    let receiver = projected.xyz * to_texels + centre;
    let normal = (directional_lights[0].shadow_from_world * vec4<f32>(geometric_normal, 0.0)).xyz * to_texels;
    if normal.z >= 0.0 {
        return 0.0;
    }

    // Far outside of the map there may be no whole number for the place.
    let place = clamp(receiver.xy - 0.5, vec2<f32>(-2.0), vec2<f32>(f32(size) + 1.0));
    let corner = floor(place);
    let first = vec2<i32>(corner);
    // Distance to the plane per texel to the right and down.
    let slope = -normal.xy / normal.z;
    let at_first = receiver.z + dot(slope, corner + 0.5 - receiver.xy);

    var taps: ShadowTaps;
    taps.occluder = vec4<f32>(
        sun_occluder(first, size, texels_deep),
        sun_occluder(first + vec2<i32>(1, 0), size, texels_deep),
        sun_occluder(first + vec2<i32>(0, 1), size, texels_deep),
        sun_occluder(first + vec2<i32>(1, 1), size, texels_deep),
    );
    taps.plane = at_first + vec4<f32>(0.0, slope.x, slope.y, slope.x + slope.y);
    taps.receiver = receiver.z;
    // A step of 32-bit floats just below 1 is 2^-24; projecting costs a few of them.
    taps.uncertainty = texels_deep * exp2(-22.0);
    taps.place = place - corner;
    return shadow_visibility(taps);
}
