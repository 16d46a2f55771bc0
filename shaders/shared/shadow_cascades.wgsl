// The shadow maps of directional lights, in slot `cascade_maps`: depth, square, a layer for each row of the table `cascades`.
//
// Guarantees: see shared/shadow_receiver.wgsl. What lies outside of a map is lit. An empty map (depth 1) shadows nothing.

#import "shared/lights.wgsl"
#import "shared/shadow_receiver.wgsl"

struct Cascade {
    // Clip space of the shadow view: orthographic.
    shadow_from_world: mat4x4<f32>,
    // Metres along the edge of a texel; 0 where there is no map.
    texel_size: f32,
    // Metres between depth 0 and depth 1.
    depth_range: f32,
    // Metres along the camera's axis to where its part of the frustum ends.
    end: f32,
    // Metres along the camera's axis to where shadows end; very far where the scene ends first.
    fade_end: f32,
}

var<storage, read> cascades: array<Cascade>;
var cascade_maps: texture_depth_2d_array;

// Where a point of the world falls: texels to the right, down, and away from the near plane. The shadow view turns and scales but does not
// shear: in this space angles are as in the world.
fn cascade_place(row: u32, size: f32, position: vec3<f32>) -> vec3<f32> {
    let projected = (cascades[row].shadow_from_world * vec4<f32>(position, 1.0)).xyz;
    return projected * cascade_scale(row, size) + vec3<f32>(0.5 * size, 0.5 * size, 0.0);
}

// Texels of the map for each unit of clip space.
fn cascade_scale(row: u32, size: f32) -> vec3<f32> {
    return vec3<f32>(0.5 * size, -0.5 * size, cascades[row].depth_range / cascades[row].texel_size);
}

fn cascade_receiver(row: u32, position: vec3<f32>, geometric_normal: vec3<f32>) -> ShadowReceiver {
    let size = f32(textureDimensions(cascade_maps).x);
    let scale = cascade_scale(row, size);
    let normal = (cascades[row].shadow_from_world * vec4<f32>(geometric_normal, 0.0)).xyz * scale;
    var receiver = parallel_receiver(row, size, cascade_place(row, size, position), normal, cascades[row].texel_size);
    // A step of 32-bit floats just below 1 is 2^-24; projecting costs a few of them.
    receiver.uncertainty = scale.z * exp2(-22.0);
    return receiver;
}

// What a texel holds. Outside of the map that is nothing.
fn cascade_texel(receiver: ShadowReceiver, texel: vec2<f32>) -> ShadowTexel {
    let middle = texel + 0.5;
    if any(texel < vec2<f32>(0.0)) || any(texel >= vec2<f32>(receiver.size)) {
        return ShadowTexel(middle, VERY_FAR);
    }
    let depth = textureLoad(cascade_maps, vec2<i32>(texel), receiver.row, 0);
    let distance = depth * cascades[receiver.row].depth_range / receiver.texel_size;
    return ShadowTexel(middle, select(distance, VERY_FAR, depth >= 1.0));
}

// The depth that the map holds for a distance.
fn cascade_depth(receiver: ShadowReceiver, distance: f32) -> f32 {
    return distance * receiver.texel_size / cascades[receiver.row].depth_range;
}
