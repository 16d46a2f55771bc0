// How much of a rectangle's light arrives at a surface, from its shadow cube. A rectangle without one shadows nothing.

#import "area/soft_shadow.wgsl"
#import "shared/surface_point.wgsl"

// 0 to 1, for a point that the rectangle lights: of the one point that is sampled, or of all of the rectangle.
fn rectangle_visibility(index: u32, point: SurfacePoint) -> f32 {
    if index * 6u + 5u >= textureNumLayers(rectangle_maps) {
        return 1.0;
    }
    let receiver = rectangle_receiver(index, point.position, point.geometric_normal);
    let corner = floor(receiver.place - 0.5);
    let nearest = compared_four(
        receiver,
        rectangle_texel(receiver, corner),
        rectangle_texel(receiver, corner + vec2<f32>(1.0, 0.0)),
        rectangle_texel(receiver, corner + vec2<f32>(0.0, 1.0)),
        rectangle_texel(receiver, corner + vec2<f32>(1.0, 1.0)),
    );
    if rectangles_are_sampled {
        return nearest.visibility;
    }
    return soft_rectangle_shadow(index, point, nearest.visibility);
}
