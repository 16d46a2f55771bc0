// The shadow maps of point lights, from the cube maps in slot `point_maps`: depth, six layers for each row of the table `point_lights`,
// in WebGPU's order of faces. The map is seen as an array of images, since single texels must be looked at; in slot `point_cubes` the
// same as cubes, for samplers.
//
// Guarantees: see shared/shadow_receiver.wgsl; edges between faces make no seam, for places up to half a face beyond an edge.

#import "shared/cube.wgsl"
#import "shared/lights.wgsl"
#import "shared/shadow_receiver.wgsl"

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

// Where a point of the world stands, as its face sees it: metres to the right, down, and along the axis.
fn point_place(row: u32, face: u32, position: vec3<f32>) -> vec3<f32> {
    return into_cube_face(face, position - point_lights[row].position);
}

fn point_receiver(row: u32, position: vec3<f32>, geometric_normal: vec3<f32>) -> ShadowReceiver {
    let face = cube_face(position - point_lights[row].position);
    let size = f32(textureDimensions(point_maps).x);
    let normal = into_cube_face(face, geometric_normal);
    let near = point_lights[row].near;
    var receiver = perspective_receiver(POINT_MAP, row, size, point_place(row, face, position), normal, 1.0, near);
    receiver.face = face;
    return receiver;
}

// What a texel holds. It may lie beyond an edge of the face: then the texel of the face that continues there is taken, and seen from the
// receiver's face.
fn point_texel(receiver: ShadowReceiver, texel: vec2<f32>) -> ShadowTexel {
    var face = receiver.face;
    var inside = texel;
    let beyond = any(texel < vec2<f32>(0.0)) || any(texel >= vec2<f32>(receiver.size));
    if beyond {
        let half_face = 0.5 * receiver.size;
        let near_by = clamp(texel, vec2<f32>(-half_face), vec2<f32>(receiver.size + half_face));
        let direction = cube_direction(face, (near_by + 0.5 - map_shift()) * (2.0 / receiver.size) - 1.0);
        face = cube_face(direction);
        let there = into_cube_face(face, direction);
        let place = (there.xy / there.z * 0.5 + 0.5) * receiver.size + map_shift();
        inside = clamp(floor(place), vec2<f32>(0.0), vec2<f32>(receiver.size - 1.0));
    }
    let depth = textureLoad(point_maps, vec2<i32>(inside), receiver.row * 6u + face, 0);
    var middle = inside + 0.5;
    var scale = 1.0 / receiver.texel_size;
    if beyond {
        let ray = into_cube_face(receiver.face, cube_direction(face, (middle - map_shift()) * (2.0 / receiver.size) - 1.0));
        middle = (ray.xy / ray.z * 0.5 + 0.5) * receiver.size + map_shift();
        scale *= ray.z;
    }
    return ShadowTexel(middle, select(point_distance(receiver.row, depth) * scale, VERY_FAR, depth >= 1.0));
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
