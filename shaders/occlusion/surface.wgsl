// What a pixel shows, by the slots `depth`, `normals` and `jitter`: as much as occlusion needs to know.

#import "shared/camera.wgsl"
#import "shared/jitter.wgsl"
#import "shared/octahedral.wgsl"

var depth: texture_depth_2d;
// As shared/gbuffer.wgsl has them.
var normals: texture_2d<u32>;

struct Surface {
    // In the image, pixels from the upper left corner.
    place: vec2<f32>,
    position: vec3<f32>,
    to_eye: vec3<f32>,
    normal: vec3<f32>,
    geometric_normal: vec3<f32>,
}

fn image_size() -> vec2<f32> {
    return vec2<f32>(textureDimensions(depth));
}

fn position_at(texel: vec2<i32>, stored_depth: f32) -> vec3<f32> {
    return position_from_depth(unjittered_uv((vec2<f32>(texel) + 0.5) / image_size()), stored_depth);
}

// `stored_depth` must not be NOTHING_THERE.
fn surface_at(texel: vec2<i32>, stored_depth: f32) -> Surface {
    let position = position_at(texel, stored_depth);
    let stored_normals = textureLoad(normals, texel, 0).xy;
    return Surface(
        vec2<f32>(texel) + 0.5,
        position,
        direction_to_camera(position),
        octahedral_decode(unpack2x16snorm(stored_normals.x)),
        octahedral_decode(unpack2x16snorm(stored_normals.y)),
    );
}
