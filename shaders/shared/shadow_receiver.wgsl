// A receiver as a shadow map sees it, and the comparison that all kinds of maps and filters share: without acne and without leaks.
//
// A shadow map knows one distance per texel, but a surface that is tilted against the light covers a range of them within that
// texel. The usual remedy, a bias large enough for any slope, lets light through thin walls. Here each texel is compared with the
// distance at which *its own* ray meets the receiver's plane, so that a plane never shadows itself, whatever its slope, and the bias
// only has to cover what is not plane.
//
// A texel lets light through
//   a. if it holds the receiver's plane itself, give or take a small bend; or
//   b. if it holds nothing nearer than that plane less half a texel. The plane is followed by one texel at most for each texel to the
//      side: near grazing angles it would soon lead through the wall behind which the receiver stands; or
//   c. if (a) holds for one of the four texels around the receiver, and it holds nothing nearer than the receiver less a texel for each
//      texel to the side, and half of one: this keeps the foot of a wall free of a dark line.
// So among the four nearest texels whatever stands more than 1.5 texels in front of the receiver shadows it: no light leaks through a wall
// thicker than that, seen along the ray; a filter that looks n texels to the side needs walls of n + 0.5 texels. Accepted: what is nearer
// to the receiver may miss its shadow; and (a) can take the lit front of a thin wall for the plane, where the plane is so steep that
// within one texel it leads through the wall.
//
// Everything is in units of the size that a texel has at the receiver, so that nothing here depends on the scene's scale.

#import "shared/map_shift.wgsl"
#import "shared/math.wgsl"

// How far the plane is followed for each texel to the side.
const PLANE_REACH: f32 = 1.0;
// For what is not plane: meshes finer than the map, the foot of walls.
const BIAS: f32 = 0.5;
// (a) allows for a surface that bends by this angle (radians) between texels. On a slope s, distances per texel, that moves it by
// (1 + s^2) times the angle, and over several texels with their square. What the rasteriser adds, by placing vertices to 1/256 of a
// texel, is less.
const PLANE_BEND: f32 = 1.0 / 32.0;

// Kinds of maps.
const CASCADE_MAP: u32 = 0u;
const POINT_MAP: u32 = 1u;
const SPOT_MAP: u32 = 2u;
const RECTANGLE_MAP: u32 = 3u;

struct ShadowReceiver {
    kind: u32,
    // Row of the kind's table: `cascades`, `point_lights`, `spot_lights`, `rectangle_lights`; for cascades and spots the layer of the map, too.
    row: u32,
    // The face of a cube on which it falls.
    face: u32,
    // Texels along an edge of the map.
    size: f32,
    // Where it falls, texels from the upper left corner; on a map that is shifted, with the shift.
    place: vec2<f32>,
    // Distance from the light along the view's axis: from its near plane where rays are parallel, from the light elsewhere.
    distance: f32,
    // Metres of a texel at the receiver's distance.
    texel_size: f32,
    // How the distance of its plane grows to the right and down: the distance itself where rays are parallel, its inverse elsewhere.
    gradient: vec2<f32>,
    // Distance per texel, to the right and down together.
    slope: f32,
    // How far off distances may be, by the precision of the map's format.
    uncertainty: f32,
}

// What one texel of a map holds.
struct ShadowTexel {
    // Its middle, in the texels of the receiver's face.
    middle: vec2<f32>,
    // Distance of what it holds, as the receiver's.
    occluder: f32,
}

// A receiver that is seen along parallel rays. `normal` is as seen by the light: right, down, away from the light.
fn parallel_receiver(row: u32, size: f32, place: vec3<f32>, normal: vec3<f32>, texel_size: f32) -> ShadowReceiver {
    var receiver: ShadowReceiver;
    receiver.kind = CASCADE_MAP;
    receiver.row = row;
    receiver.size = size;
    receiver.place = place.xy + map_shift();
    receiver.distance = place.z;
    receiver.texel_size = texel_size;
    receiver.gradient = -normal.xy / normal.z;
    receiver.slope = abs(receiver.gradient.x) + abs(receiver.gradient.y);
    return receiver;
}

// A receiver that is seen from a point. `position`, metres, and `normal` are as seen by the light: right, down, away from the light.
// `half_width` is half the map's width a metre from the light.
fn perspective_receiver(kind: u32, row: u32, size: f32, position: vec3<f32>, normal: vec3<f32>, half_width: f32, near: f32) -> ShadowReceiver {
    var receiver: ShadowReceiver;
    receiver.kind = kind;
    receiver.row = row;
    receiver.size = size;
    receiver.texel_size = 2.0 * half_width * position.z / size;
    receiver.place = (position.xy / (position.z * half_width) * 0.5 + 0.5) * size + map_shift();
    receiver.distance = position.z / receiver.texel_size;
    // Along the ray through a texel the plane is where dot(normal, x - position) = 0.
    receiver.gradient = normal.xy * (square(receiver.texel_size) / (position.z * dot(normal, position)));
    receiver.slope = min(square(receiver.distance) * (abs(receiver.gradient.x) + abs(receiver.gradient.y)), VERY_FAR);
    // A step of 32-bit floats just below 1 is 2^-24, which at distance z is z^2 / near of it in metres; projecting costs a few.
    receiver.uncertainty = square(position.z) / near * exp2(-22.0) / receiver.texel_size;
    return receiver;
}

// Texels between the receiver and the map's edge.
fn texels_inside(receiver: ShadowReceiver) -> f32 {
    return min(min(receiver.place.x, receiver.place.y), receiver.size - max(receiver.place.x, receiver.place.y));
}

// Where the ray through a place of the map meets the receiver's plane; a ray that does not fall on its front never meets it.
fn plane_distance(receiver: ShadowReceiver, place: vec2<f32>) -> f32 {
    let along = dot(receiver.gradient, place - receiver.place);
    if receiver.kind == CASCADE_MAP {
        return receiver.distance + along;
    }
    let inverse = 1.0 / receiver.distance + along;
    if inverse <= 0.0 {
        return VERY_FAR;
    }
    return 1.0 / inverse;
}

// (a). `reach` is how many texels it is away from the receiver, at least 1.
fn holds_plane(receiver: ShadowReceiver, texel: ShadowTexel, reach: f32) -> bool {
    // On the steepest slopes it must not swallow occluders: not more than (c) forgives.
    let bend = min(PLANE_BEND * (1.0 + square(receiver.slope)) * square(reach), PLANE_REACH + BIAS);
    return abs(texel.occluder - plane_distance(receiver, texel.middle)) <= bend + receiver.uncertainty;
}

// Whether a texel lets light through; `seen` is whether (a) holds for one of the four nearest ones.
fn lets_light_through(receiver: ShadowReceiver, texel: ShadowTexel, reach: f32, seen: bool) -> bool {
    let plane = plane_distance(receiver, texel.middle);
    let follow = PLANE_REACH * reach;
    let limit = clamp(plane, receiver.distance - follow, receiver.distance + follow) - BIAS - receiver.uncertainty;
    return texel.occluder >= limit
        || (seen && texel.occluder >= receiver.distance - follow - BIAS)
        || holds_plane(receiver, texel, reach);
}

// The four texels around the receiver.
struct NearestFour {
    visibility: f32,
    // Whether one of them holds the receiver's plane.
    seen: bool,
}

// Each texel is lit or not; they are weighed by nearness, which makes an edge one texel wide. From the upper left one row by row.
fn compared_four(receiver: ShadowReceiver, a: ShadowTexel, b: ShadowTexel, c: ShadowTexel, d: ShadowTexel) -> NearestFour {
    let seen = holds_plane(receiver, a, 1.0) || holds_plane(receiver, b, 1.0)
        || holds_plane(receiver, c, 1.0) || holds_plane(receiver, d, 1.0);
    let lit = vec4<bool>(
        lets_light_through(receiver, a, 1.0, seen),
        lets_light_through(receiver, b, 1.0, seen),
        lets_light_through(receiver, c, 1.0, seen),
        lets_light_through(receiver, d, 1.0, seen),
    );
    let place = fract(receiver.place - 0.5);
    let weight_x = vec4<f32>(1.0 - place.x, place.x, 1.0 - place.x, place.x);
    let weight_y = vec4<f32>(1.0 - place.y, 1.0 - place.y, place.y, place.y);
    return NearestFour(dot(weight_x * weight_y, select(vec4<f32>(0.0), vec4<f32>(1.0), lit)), seen);
}
