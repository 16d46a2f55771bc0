// Reading the G-buffer: the slots `albedo`, `normals`, `surface`, `emission` and `depth`, and the surface point in a texel.

#import "shared/camera.wgsl"
#import "shared/gbuffer.wgsl"

var albedo: texture_2d<f32>;
var normals: texture_2d<u32>;
var surface: texture_2d<u32>;
var emission: texture_2d<u32>;
var depth: texture_depth_2d;

// What stands in a texel. `stored_depth` must not be NOTHING_THERE; `uv` is (0, 0) at the top left of the image.
fn load_gbuffer(texel: vec2<i32>, uv: vec2<f32>, stored_depth: f32) -> SurfacePoint {
    let position = position_from_depth(uv, stored_depth);
    let stored = GbufferTexel(
        textureLoad(albedo, texel, 0),
        textureLoad(normals, texel, 0).xy,
        textureLoad(surface, texel, 0).xy,
        textureLoad(emission, texel, 0).xy,
    );
    var point = decode_gbuffer(stored, position, direction_to_camera(position));
    point.pixel = vec2<f32>(texel) + 0.5;
    return point;
}
