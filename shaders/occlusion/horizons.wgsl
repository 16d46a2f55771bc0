// Looks from each pixel along lines of the image for what rises above its surface, and adds up the light that this keeps away.
//
// Jimenez et al. 2016, "Practical Realtime Strategies for Accurate Indirect Occlusion" (GTAO), with three differences. Slices are spread
// evenly about the line of sight, not about the middle of the image. Horizons are counted from the surface's own plane, so that a plane hides
// nothing of itself, however coarse depth is and however a normal map tilts its normal. And what is hidden is set against what the same
// slices would see without occluders, so that few of them err only where something is hidden.

#import "occlusion/pattern.wgsl"
#import "occlusion/slice.wgsl"
#import "occlusion/surface.wgsl"
#import "shared/math.wgsl"

struct Params {
    // Metres.
    radius: f32,
    thin: f32,
    slices: u32,
    steps: u32,
}

var<uniform> params: Params;

// The part of the radius in which occluders fade.
const FADE: f32 = 0.6;
// What rises less than this angle, radians, is taken for the surface itself: the normals of large triangles are off by so much.
const LEAST_RISE: f32 = 0.005;
// The same, times the square of the cosine to the eye: what is seen edge on bends within a pixel. Without it single pixels on the outlines of
// round things are black.
const EDGE_ON_RISE: f32 = 0.0006;
// Of that cosine: below, nothing counts.
const LEAST_COSINE: f32 = 0.01;

struct Targets {
    // Sums over slices, as SliceLight has them.
    hidden: vec4<f32>,
    open: f32,
}

// By how many pixels the image of a point moves with each metre that it moves along `direction`.
fn pixels_per_metre(position: vec3<f32>, direction: vec3<f32>) -> vec2<f32> {
    let at = camera.projection_from_world * vec4<f32>(position, 1.0);
    let change = camera.projection_from_world * vec4<f32>(direction, 0.0);
    let projected = (change.xy * at.w - at.xy * change.w) / square(at.w);
    return projected * vec2<f32>(0.5, -0.5) * image_size();
}

// Pixels from `place` along `direction` to the middles of the outermost ones.
fn way_to_edge(place: vec2<f32>, direction: vec2<f32>) -> f32 {
    let ahead = select(place - 0.5, image_size() - 0.5 - place, direction > vec2<f32>(0.0));
    let ways = ahead / max(abs(direction), vec2<f32>(1.0e-6));
    return min(ways.x, ways.y);
}

// How far what is seen along a line of the image rises above the surface's plane, radians. `side` is 1 towards `across`, -1 away from it.
fn risen(surface: Surface, slice: Slice, side: f32, start: f32) -> f32 {
    let along = side * pixels_per_metre(surface.position, slice.across);
    let pixels = length(along);
    let direction = along / max(pixels, 1.0e-6);
    let way = min(params.radius * pixels, way_to_edge(surface.place, direction));
    // Nothing to look at is nearer than the next pixel.
    if way < 1.0 {
        return 0.0;
    }
    let outwards = side * tangent_of(slice);
    let edge_on = EDGE_ON_RISE / square(max(dot(surface.geometric_normal, surface.to_eye), LEAST_COSINE));
    // Of the highest occluder so far: the cosine of the angle from the plane, negative, so that it grows.
    var highest = -1.0;
    for (var i = 0u; i < params.steps; i++) {
        // Steps get longer with the way.
        let texel = vec2<i32>(surface.place + direction * mix(1.0, way, square((f32(i) + start) / f32(params.steps))));
        let stored_depth = textureLoad(depth, texel, 0);
        if stored_depth == NOTHING_THERE {
            continue;
        }
        let to_occluder = position_at(texel, stored_depth) - surface.position;
        // Seen within the slice, but above the plane as it is: of a plane nothing is, though pixels lie beside the line.
        let over_plane = dot(to_occluder, surface.geometric_normal) - (LEAST_RISE + edge_on) * length(to_occluder);
        let above = over_plane / slice.plane_length;
        let beside = dot(to_occluder, outwards);
        if above > 0.0 {
            let towards_eye = max(dot(to_occluder, surface.to_eye), 0.0);
            let distance = length(to_occluder + params.thin * towards_eye * surface.to_eye);
            let weight = saturate((1.0 - distance / params.radius) / FADE);
            highest = max(highest, mix(-1.0, -beside * inverseSqrt(square(beside) + square(above)), weight));
        }
    }
    return acos(clamp(-highest, -1.0, 1.0));
}

@fragment
fn search(@builtin(position) place: vec4<f32>) -> Targets {
    let texel = vec2<i32>(place.xy);
    let stored_depth = textureLoad(depth, texel, 0);
    if stored_depth == NOTHING_THERE {
        return Targets(vec4<f32>(0.0), 1.0);
    }
    let surface = surface_at(texel, stored_depth);
    // Two numbers that differ from sample to sample.
    let shifts = textureLoad(jitter, vec2<i32>(1, 0), 0).yz;
    let turn = turn_of(vec2<u32>(texel), shifts.x);
    // Any two directions across the line of sight that change evenly over the image.
    let right = camera.world_from_view[0].xyz;
    let x = normalize(right - surface.to_eye * dot(surface.to_eye, right));
    let y = cross(surface.to_eye, x);
    var hidden = vec4<f32>(0.0);
    var open = 0.0;
    for (var i = 0u; i < params.slices; i++) {
        let angle = PI * (f32(i) + turn) / f32(params.slices);
        let slice = slice_through(surface.to_eye, cos(angle) * x + sin(angle) * y, surface.normal, surface.geometric_normal);
        let start = start_of(vec2<u32>(texel), i, shifts.y);
        let light = slice_light(slice, risen(surface, slice, -1.0, start), risen(surface, slice, 1.0, start));
        hidden += light.hidden;
        open += light.open;
    }
    return Targets(hidden, open);
}
