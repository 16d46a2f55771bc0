// Texels of a cube that a pass fills face by face, and what of all directions each of them takes up.

#import "shared/cube.wgsl"
#import "shared/math.wgsl"

// From -1 to 1 on a face: where a texel, or a part of it, has its middle.
fn place_on_face(texel: vec2<f32>, edge: f32) -> vec2<f32> {
    return texel * (2.0 / edge) - 1.0;
}

// Solid angle of a small piece of a face around a place, over the piece's area on the face (which runs from -1 to 1).
fn solid_angle_density(place: vec2<f32>) -> f32 {
    let squared = 1.0 + dot(place, place);
    return 1.0 / (squared * sqrt(squared));
}

// The solid angle of the part of a face from its middle to a corner at `place`: its sign is that of x y.
fn corner_solid_angle(place: vec2<f32>) -> f32 {
    return atan2(place.x * place.y, sqrt(1.0 + dot(place, place)));
}

// Texels along an edge from where the middle of a texel tells its solid angle better than its corners do: to 0.0001 of it, where the
// difference of corners loses its digits.
const FINE_EDGE: u32 = 64u;

// Solid angle of a texel, steradians.
fn texel_solid_angle(texel: vec2<u32>, edge: u32) -> f32 {
    let size = 2.0 / f32(edge);
    if edge >= FINE_EDGE {
        return solid_angle_density(place_on_face(vec2<f32>(texel) + 0.5, f32(edge))) * size * size;
    }
    let low = place_on_face(vec2<f32>(texel), f32(edge));
    let high = low + size;
    return corner_solid_angle(high) - corner_solid_angle(vec2<f32>(low.x, high.y)) - corner_solid_angle(vec2<f32>(high.x, low.y))
        + corner_solid_angle(low);
}
