// The shadow maps of point lights, from the cube maps in slot `point_maps`: depth, six layers for each row of the table `point_lights`,
// in WebGPU's order of faces. The map is seen as an array of images, since single texels must be looked at; in slot `point_cubes` the
// same as cubes, for samplers.
//
// Guarantees: see shared/shadow_receiver.wgsl and shared/shadow_cube.wgsl.

#import "shared/lights.wgsl"
#import "shared/shadow_cube.wgsl"

struct PointLight {
    position: vec3<f32>,
    // Near plane of the faces, metres.
    near: f32,
    // Far plane of the faces, metres; 0 where there is no light.
    far: f32,
    // Row of `local_lights`.
    light: u32,
}

var<storage, read> point_lights: array<PointLight>;
var point_maps: texture_depth_2d_array;
var point_cubes: texture_depth_cube_array;

fn point_receiver(row: u32, position: vec3<f32>, geometric_normal: vec3<f32>) -> ShadowReceiver {
    let away = position - point_lights[row].position;
    let size = f32(textureDimensions(point_maps).x);
    return cube_receiver(POINT_MAP, row, size, away, geometric_normal, point_lights[row].near);
}

// What a texel holds; it may lie beyond an edge of the face.
fn point_texel(receiver: ShadowReceiver, texel: vec2<f32>) -> ShadowTexel {
    let found = cube_texel(receiver, texel);
    let depth = textureLoad(point_maps, found.texel, receiver.row * 6u + found.face, 0);
    return ShadowTexel(found.middle, select(point_distance(receiver.row, depth) * found.scale, VERY_FAR, depth >= 1.0));
}

// Metres from the light along the face's axis, from what the map holds. The shadow view's depth is far (z - near) / (z (far - near)); in
// this form of the inverse nothing cancels.
fn point_distance(row: u32, depth: f32) -> f32 {
    return 1.0 / ((1.0 - depth) / point_lights[row].near + depth / point_lights[row].far);
}

// The depth that the map holds for a distance.
fn point_depth(receiver: ShadowReceiver, distance: f32) -> f32 {
    let light_near = point_lights[receiver.row].near;
    let light_far = point_lights[receiver.row].far;
    return light_far * (1.0 - light_near / (distance * receiver.texel_size)) / (light_far - light_near);
}
