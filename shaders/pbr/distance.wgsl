// The depth buffer in a form that people and other programs read.

#import "shared/camera.wgsl"

var depth: texture_depth_2d;

struct Targets {
    // Metres from the camera along its axis; 0 where nothing was drawn.
    distance: f32,
}

@fragment
fn show(@builtin(position) place: vec4<f32>, @location(0) uv: vec2<f32>) -> Targets {
    let stored_depth = textureLoad(depth, vec2<i32>(place.xy), 0);
    if stored_depth == NOTHING_THERE {
        return Targets(0.0);
    }
    return Targets(distance_along_axis(position_from_depth(uv, stored_depth)));
}
