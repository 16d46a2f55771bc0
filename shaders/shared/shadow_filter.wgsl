// Filters of shadow maps: how much of the light arrives at a receiver. `shadow_filter` chooses one when the pipeline is made.
//
//   plane     each of the four nearest texels against the receiver's plane, weighed by nearness: sharp, one texel wide, no bias to set
//   hardware  a sampler compares the four with one distance, which is biased by the slope: cheapest; lets light through thin walls where a
//             surface is steep against the light
//   pcf3      the same comparison as `plane` over 3 by 3 texels (percentage closer filtering: Reeves, Salesin and Cook 1987)
//   poisson   over 16 samples of a disc of `shadow_radius` texels, turned from pixel to pixel: softer, with a grain
//   pcss      over a disc as wide as the penumbra of a light with an extent (percentage closer soft shadows: Fernando 2005); near what a map
//             can't show, as the walls below a roof, it takes the roof's outline for the occluder, and lets light in beside it

#import "shared/shadow_disc.wgsl"
#import "shared/shadow_maps.wgsl"

const FILTER_PLANE: u32 = 0u;
const FILTER_HARDWARE: u32 = 1u;
const FILTER_PCF3: u32 = 2u;
const FILTER_POISSON: u32 = 3u;
const FILTER_PCSS: u32 = 4u;

override shadow_filter: u32 = 0u;
// Radius of the disc of `poisson`, texels.
override shadow_radius: f32 = 2.0;
// Angle under which a directional light is seen, degrees. The sun from the Earth: 0.53.
override sun_angle: f32 = 0.53;
// Radius of point and spot lights, metres.
override light_radius: f32 = 0.05;

const POISSON_SAMPLES: u32 = 16u;
// Of the search: with r from 0 to 1 of its area, samples lie at the power of r to (1 + this) / 2.
const SEARCH_CROWDING: f32 = 5.0;
// The widest penumbra, as a part of the map's width.
const WIDEST_PENUMBRA: f32 = 0.125;

// How many texels from the receiver a filter looks at. `pcss` takes what is there.
fn filter_reach() -> f32 {
    switch shadow_filter {
        case FILTER_PCF3: { return 2.0; }
        case FILTER_POISSON: { return shadow_radius + 1.0; }
        default: { return 1.0; }
    }
}

// How much of the light arrives: 0 to 1.
fn filtered_shadow(receiver: ShadowReceiver, pixel: vec2<f32>) -> f32 {
    if shadow_filter == FILTER_HARDWARE {
        return compared_shadow(receiver, biased_distance(receiver));
    }
    let nearest = nearest_four(receiver);
    switch shadow_filter {
        case FILTER_PCF3: { return box_of_three(receiver, nearest.seen); }
        case FILTER_POISSON: { return disc_of_samples(receiver, shadow_radius, POISSON_SAMPLES, random_turn(pixel), nearest.seen); }
        case FILTER_PCSS: { return soft_shadow(receiver, nearest, random_turn(pixel)); }
        default: { return nearest.visibility; }
    }
}

fn nearest_four(receiver: ShadowReceiver) -> NearestFour {
    let corner = floor(receiver.place - 0.5);
    return compared_four(
        receiver,
        shadow_texel(receiver, corner),
        shadow_texel(receiver, corner + vec2<f32>(1.0, 0.0)),
        shadow_texel(receiver, corner + vec2<f32>(0.0, 1.0)),
        shadow_texel(receiver, corner + vec2<f32>(1.0, 1.0)),
    );
}

// The nearest distance at which the receiver's plane stands in the four texels, less what (c) forgives everywhere: a plane does not shadow
// itself, the foot of a wall stays free of a dark line, and so do edges of cubes, beyond which distances are along another axis.
fn biased_distance(receiver: ShadowReceiver) -> f32 {
    let corner = floor(receiver.place - 0.5) + 0.5;
    let nearest = min(
        min(plane_distance(receiver, corner), plane_distance(receiver, corner + vec2<f32>(1.0, 0.0))),
        min(plane_distance(receiver, corner + vec2<f32>(0.0, 1.0)), plane_distance(receiver, corner + vec2<f32>(1.0, 1.0))),
    );
    return min(nearest, receiver.distance) - PLANE_REACH - BIAS - receiver.uncertainty;
}

// Whether the texel in which a place lies lets light through.
fn is_lit_at(receiver: ShadowReceiver, place: vec2<f32>, seen: bool) -> bool {
    let texel = shadow_texel(receiver, floor(place));
    return lets_light_through(receiver, texel, max(1.0, length(texel.middle - receiver.place)), seen);
}

// The mean over a square of three by three texels around the receiver: four by four of them, those at the rim in part.
fn box_of_three(receiver: ShadowReceiver, seen: bool) -> f32 {
    let corner = floor(receiver.place - 1.5);
    let part = receiver.place - 1.5 - corner;
    var sum = 0.0;
    for (var y = 0; y < 4; y++) {
        for (var x = 0; x < 4; x++) {
            let at = vec2<f32>(f32(x), f32(y));
            let weights = select(select(vec2<f32>(1.0), part, at == vec2<f32>(3.0)), 1.0 - part, at == vec2<f32>(0.0));
            if is_lit_at(receiver, corner + at + 0.5, seen) {
                sum += weights.x * weights.y;
            }
        }
    }
    return sum / 9.0;
}

// The mean over samples of a disc.
fn disc_of_samples(receiver: ShadowReceiver, radius: f32, samples: u32, turn: vec2<f32>, seen: bool) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < samples; i++) {
        if is_lit_at(receiver, receiver.place + disc_sample(i, turn) * radius, seen) {
            sum += 1.0;
        }
    }
    return sum / f32(samples);
}

// Half the width of the penumbra that an occluder throws on the receiver, by similar triangles, texels.
fn penumbra(receiver: ShadowReceiver, occluder: f32) -> f32 {
    let apart = max(receiver.distance - occluder, 0.0);
    if receiver.kind == CASCADE_MAP {
        return apart * tan(radians(0.5 * sun_angle));
    }
    return apart * (light_radius / receiver.texel_size) / max(occluder, 1.0e-4);
}

// Looks for what blocks the light, and filters over the penumbra of their mean. What is too far to the side for its own penumbra to reach
// the receiver does not count. Samples of the search crowd in the middle, so that narrow penumbras get as many as wide ones.
fn soft_shadow(receiver: ShadowReceiver, nearest: NearestFour, turn: vec2<f32>) -> f32 {
    var first = 0.0;
    if receiver.kind == POINT_MAP {
        first = point_lights[receiver.row].near / receiver.texel_size;
    } else if receiver.kind == SPOT_MAP {
        first = spot_lights[receiver.row].near / receiver.texel_size;
    }
    let widest = WIDEST_PENUMBRA * receiver.size;
    let search = min(penumbra(receiver, first), widest);
    var sum = 0.0;
    var blockers = 0.0;
    for (var i = 0u; i < 2u * DISC_SAMPLES; i++) {
        // The second time by a right angle farther.
        let place = disc_sample(i % DISC_SAMPLES, select(turn, vec2<f32>(-turn.y, turn.x), i >= DISC_SAMPLES));
        let texel = shadow_texel(receiver, floor(receiver.place + place * (pow(length(place), SEARCH_CROWDING) * search)));
        let aside = length(texel.middle - receiver.place);
        if aside <= penumbra(receiver, texel.occluder) + 1.0 && !lets_light_through(receiver, texel, max(1.0, aside), nearest.seen) {
            sum += texel.occluder;
            blockers += 1.0;
        }
    }
    if blockers == 0.0 {
        return nearest.visibility;
    }
    let radius = min(penumbra(receiver, sum / blockers), widest);
    let soft = disc_of_samples(receiver, radius, DISC_SAMPLES, turn, nearest.seen);
    // What is narrower than the map can show is as sharp as it can be.
    return mix(nearest.visibility, soft, saturate(radius - 0.5));
}
