// The shadow maps of spot lights, in slot `spot_maps`: depth, square, a layer for each row of the table `spot_lights`.
//
// Guarantees: see shared/shadow_receiver.wgsl. What lies outside of a map is lit, as far as its cone reaches there.

#import "shared/lights.wgsl"
#import "shared/shadow_receiver.wgsl"

struct SpotLight {
    // Clip space of the shadow view: perspective, x and y over `half_width`, w the distance along the axis.
    shadow_from_world: mat4x4<f32>,
    // Near plane, metres along the axis.
    near: f32,
    // Far plane, metres along the axis; 0 where there is no light.
    far: f32,
    // Half the map's width, a metre from the light.
    half_width: f32,
    // Row of `local_lights`.
    light: u32,
}

var<storage, read> spot_lights: array<SpotLight>;
var spot_maps: texture_depth_2d_array;

// A vector as the light sees it: right, down, and along the axis. `point` is 1 for places and 0 for directions.
fn spot_place(row: u32, v: vec3<f32>, point: f32) -> vec3<f32> {
    let projected = spot_lights[row].shadow_from_world * vec4<f32>(v, point);
    let half_width = spot_lights[row].half_width;
    return vec3<f32>(projected.x * half_width, -projected.y * half_width, projected.w);
}

// The receiver must stand in front of the light.
fn spot_receiver(row: u32, position: vec3<f32>, geometric_normal: vec3<f32>) -> ShadowReceiver {
    let size = f32(textureDimensions(spot_maps).x);
    let place = spot_place(row, position, 1.0);
    let normal = spot_place(row, geometric_normal, 0.0);
    return perspective_receiver(SPOT_MAP, row, size, place, normal, spot_lights[row].half_width, spot_lights[row].near);
}

// What a texel holds. Outside of the map that is nothing.
fn spot_texel(receiver: ShadowReceiver, texel: vec2<f32>) -> ShadowTexel {
    let middle = texel + 0.5;
    if any(texel < vec2<f32>(0.0)) || any(texel >= vec2<f32>(receiver.size)) {
        return ShadowTexel(middle, VERY_FAR);
    }
    let depth = textureLoad(spot_maps, vec2<i32>(texel), receiver.row, 0);
    return ShadowTexel(middle, select(spot_distance(receiver.row, depth) / receiver.texel_size, VERY_FAR, depth >= 1.0));
}

// Metres from the light along its axis, from what the map holds; see `point_distance`.
fn spot_distance(row: u32, depth: f32) -> f32 {
    return 1.0 / ((1.0 - depth) / spot_lights[row].near + depth / spot_lights[row].far);
}

// The depth that the map holds for a distance.
fn spot_depth(receiver: ShadowReceiver, distance: f32) -> f32 {
    let light_near = spot_lights[receiver.row].near;
    let light_far = spot_lights[receiver.row].far;
    return light_far * (1.0 - light_near / (distance * receiver.texel_size)) / (light_far - light_near);
}
