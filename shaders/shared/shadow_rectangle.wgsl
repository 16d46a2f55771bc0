// The shadow maps of rectangles of light, from the cube maps in slot `rectangle_maps`: depth, six layers for each row of the table
// `rectangle_lights`, in WebGPU's order of faces, as seen from the point that stands for the rectangle (area/eye.wgsl).
//
// Guarantees: see shared/shadow_receiver.wgsl and shared/shadow_cube.wgsl. What lies in the rectangle's plane blocks nothing: the surface that
// glows is seen along its edge by all of its points, and rounding leaves a texel of it here and there.

#import "area/eye.wgsl"
#import "shared/shadow_cube.wgsl"

var rectangle_maps: texture_depth_2d_array;

fn rectangle_receiver(row: u32, position: vec3<f32>, geometric_normal: vec3<f32>) -> ShadowReceiver {
    let away = position - rectangle_lights[row].position - rectangle_eye(row);
    let size = f32(textureDimensions(rectangle_maps).x);
    return cube_receiver(RECTANGLE_MAP, row, size, away, geometric_normal, rectangle_lights[row].near);
}

// What a texel holds; it may lie beyond an edge of the face.
fn rectangle_texel(receiver: ShadowReceiver, texel: vec2<f32>) -> ShadowTexel {
    let found = cube_texel(receiver, texel);
    let depth = textureLoad(rectangle_maps, found.texel, receiver.row * 6u + found.face, 0);
    let distance = rectangle_distance(receiver.row, depth);
    let in_plane = abs(rectangle_height(receiver.row, found.ray * distance)) <= LEAST_HEIGHT * rectangle_lights[receiver.row].radius;
    return ShadowTexel(found.middle, select(distance * found.scale, VERY_FAR, depth >= 1.0 || in_plane));
}

// Metres along the face's axis, from what the map holds; see `point_distance`.
fn rectangle_distance(row: u32, depth: f32) -> f32 {
    return 1.0 / ((1.0 - depth) / rectangle_lights[row].near + depth / rectangle_lights[row].far);
}

// How far something stands in front of the rectangle's plane, metres, by its place as seen from a point of the rectangle.
fn rectangle_height(row: u32, away: vec3<f32>) -> f32 {
    return dot(normalize(cross(rectangle_lights[row].half_width, rectangle_lights[row].half_height)), away);
}
