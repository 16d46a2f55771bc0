// The views of a rectangle's cube are from its middle; here they move to the point that stands for it.

#import "area/eye.wgsl"
#import "shared/map_shift.wgsl"
#import "shared/view.wgsl"

struct Params {
    // Face of all faces of all rectangles, six each.
    i: u32,
    // Along an edge of the map.
    texels: u32,
}

var<uniform> params: Params;

// A position in the view's clip space, as it is seen from the point.
fn seen_from_rectangle(clip_position: vec4<f32>) -> vec4<f32> {
    let moved = clip_position - view.projection_from_world * vec4<f32>(rectangle_eye(params.i / 6u), 0.0);
    return shifted_on_map(moved, params.texels);
}
