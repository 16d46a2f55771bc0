// Shadow maps without acne and without leaks: the comparison that all kinds of maps share.
//
// A shadow map knows one distance per texel, but a surface that is tilted against the light covers a range of them within that
// texel. The usual remedy, a bias large enough for any slope, lets light through thin walls. Here each of the four nearest texels
// is compared with the distance at which *its own* ray meets the receiver's plane, so that a plane never shadows itself,
// whatever its slope, and the bias only has to cover what is not plane.
//
// A texel lets light through
//   a. if it holds the receiver's plane itself, give or take a small bend; or
//   b. if it holds nothing nearer than that plane less half a texel. The plane is followed by one texel at most: near grazing
//      angles it would soon lead through the wall behind which the receiver stands; or
//   c. if (a) holds for one of the four and it holds nothing nearer than the receiver less 1.5 texels: this keeps the foot of a
//      wall free of a dark line.
// So whatever stands more than 1.5 texels in front of the receiver shadows it: no light leaks through a wall thicker than that,
// seen along the ray. Accepted: what is nearer to the receiver may miss its shadow; and (a) can take the lit front of a thin wall
// for the plane, where the plane is so steep that within one texel it leads through the wall.
//
// Everything is in units of the size that a texel has at the receiver, so that nothing here depends on the scene's scale.

// How far the plane is followed.
const PLANE_REACH: f32 = 1.0;
// For what is not plane: meshes finer than the map, the foot of walls.
const BIAS: f32 = 0.5;
// (a) allows for a surface that bends by this angle (radians) between texels. On a slope s, distances per texel, that moves it by
// (1 + s^2) times the angle. What the rasteriser adds, by placing vertices to 1/256 of a texel, is less.
const PLANE_BEND: f32 = 1.0 / 32.0;
// But on the steepest slopes it must not swallow occluders: not more than (c) forgives.
const PLANE_TOLERANCE_MOST: f32 = PLANE_REACH + BIAS;

// The four nearest texels of a map, as (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1). Distances from the light, in texels.
struct ShadowTaps {
    // What the map holds.
    occluder: vec4<f32>,
    // Where the texel's ray meets the receiver's plane.
    plane: vec4<f32>,
    // The receiver's own distance.
    receiver: f32,
    // How far off distances may be, by the precision of the map's format.
    uncertainty: f32,
    // The receiver's place among the four, 0 to 1.
    place: vec2<f32>,
}

// How much of the light arrives: 0 to 1. Each texel is lit or not; they are weighed by nearness, which makes an edge one texel
// wide.
fn shadow_visibility(taps: ShadowTaps) -> f32 {
    let nearest = min(min(taps.plane.x, taps.plane.y), min(taps.plane.z, taps.plane.w));
    let farthest = max(max(taps.plane.x, taps.plane.y), max(taps.plane.z, taps.plane.w));
    let slope = farthest - nearest;
    let tolerance = min(PLANE_BEND * (1.0 + slope * slope), PLANE_TOLERANCE_MOST) + taps.uncertainty;

    let holds_plane = abs(taps.occluder - taps.plane) <= vec4<f32>(tolerance);
    let limit = clamp(
        taps.plane,
        vec4<f32>(taps.receiver - PLANE_REACH),
        vec4<f32>(taps.receiver + PLANE_REACH),
    );
    var lit = holds_plane | (taps.occluder >= limit - vec4<f32>(BIAS + taps.uncertainty));
    if any(holds_plane) {
        lit = lit | (taps.occluder >= vec4<f32>(taps.receiver - PLANE_REACH - BIAS));
    }

    let weight_x = vec4<f32>(1.0 - taps.place.x, taps.place.x, 1.0 - taps.place.x, taps.place.x);
    let weight_y = vec4<f32>(1.0 - taps.place.y, 1.0 - taps.place.y, taps.place.y, taps.place.y);
    return dot(weight_x * weight_y, select(vec4<f32>(0.0), vec4<f32>(1.0), lit));
}
