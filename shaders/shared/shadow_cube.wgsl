// What shadow cubes have in common, whatever light they are of.
//
// Guarantees: see shared/shadow_receiver.wgsl; edges between faces make no seam, for places up to half a face beyond an edge.

#import "shared/cube.wgsl"
#import "shared/shadow_receiver.wgsl"

// A texel of a cube that may lie beyond an edge of the receiver's face: then the texel of the face that continues there.
struct CubeTexel {
    face: u32,
    texel: vec2<i32>,
    // Its direction; 1 along the axis of its own face.
    ray: vec3<f32>,
    // Its middle, in the texels of the receiver's face.
    middle: vec2<f32>,
    // From metres along the axis of its face to the distances of the receiver.
    scale: f32,
}

// The receiver in a cube, `away` metres from the light.
fn cube_receiver(kind: u32, row: u32, size: f32, away: vec3<f32>, geometric_normal: vec3<f32>, near: f32) -> ShadowReceiver {
    let face = cube_face(away);
    let normal = into_cube_face(face, geometric_normal);
    var receiver = perspective_receiver(kind, row, size, into_cube_face(face, away), normal, 1.0, near);
    receiver.face = face;
    return receiver;
}

// `texel` is whole, on the receiver's face.
fn cube_texel(receiver: ShadowReceiver, texel: vec2<f32>) -> CubeTexel {
    var found: CubeTexel;
    found.face = receiver.face;
    var inside = texel;
    let beyond = any(texel < vec2<f32>(0.0)) || any(texel >= vec2<f32>(receiver.size));
    if beyond {
        let half_face = 0.5 * receiver.size;
        let near_by = clamp(texel, vec2<f32>(-half_face), vec2<f32>(receiver.size + half_face));
        let direction = cube_direction(receiver.face, (near_by + 0.5 - map_shift()) * (2.0 / receiver.size) - 1.0);
        found.face = cube_face(direction);
        let there = into_cube_face(found.face, direction);
        let place = (there.xy / there.z * 0.5 + 0.5) * receiver.size + map_shift();
        inside = clamp(floor(place), vec2<f32>(0.0), vec2<f32>(receiver.size - 1.0));
    }
    found.texel = vec2<i32>(inside);
    found.middle = inside + 0.5;
    found.scale = 1.0 / receiver.texel_size;
    found.ray = cube_direction(found.face, (found.middle - map_shift()) * (2.0 / receiver.size) - 1.0);
    if beyond {
        let ray = into_cube_face(receiver.face, found.ray);
        found.middle = (ray.xy / ray.z * 0.5 + 0.5) * receiver.size + map_shift();
        found.scale *= ray.z;
    }
    return found;
}
