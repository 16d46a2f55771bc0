// Rays through the shell of air around the planet. A place is its altitude in kilometres, a direction the sine of its elevation.
//
// A radius of 6360 km leaves 32-bit floats half a metre. So altitudes are never taken as a difference of radii, nor distances as one
// of squares: each formula below is rearranged until what nearly cancels is a product.

#import "sky/atmosphere.wgsl"

// Distance along a level ray's tangent to the horizon: the square root of r^2 - planet^2.
fn horizon_distance(altitude: f32) -> f32 {
    return sqrt(altitude * (2.0 * PLANET_RADIUS + altitude));
}

// How far the horizon lies below the level, radians.
fn horizon_dip(altitude: f32) -> f32 {
    return atan2(horizon_distance(altitude), PLANET_RADIUS);
}

// Sine of the horizon's elevation: 0 or less.
fn horizon_sine(altitude: f32) -> f32 {
    return -horizon_distance(altitude) / (PLANET_RADIUS + altitude);
}

// The altitude after a distance.
fn altitude_along(altitude: f32, sine: f32, distance: f32) -> f32 {
    let gain = distance * (2.0 * (PLANET_RADIUS + altitude) * sine + distance);
    let squares = altitude * (2.0 * PLANET_RADIUS + altitude) + gain;
    return clamp(squares / (PLANET_RADIUS + sqrt(max(square(PLANET_RADIUS) + squares, 0.0))), 0.0, AIR_TOP);
}

// To where the air ends, for rays that meet no ground.
fn distance_to_top(altitude: f32, sine: f32) -> f32 {
    let along = (PLANET_RADIUS + altitude) * sine;
    let room = (AIR_TOP - altitude) * (2.0 * PLANET_RADIUS + AIR_TOP + altitude);
    let root = sqrt(square(along) + room);
    if along > 0.0 {
        return room / (along + root);
    }
    return root - along;
}

// To the ground, for rays that meet it.
fn distance_to_ground(altitude: f32, sine: f32) -> f32 {
    let down = -(PLANET_RADIUS + altitude) * sine;
    let horizon = horizon_distance(altitude);
    let root = sqrt(max((down - horizon) * (down + horizon), 0.0));
    return square(horizon) / max(down + root, 1.0e-6);
}

// A point on a ray, and the light of the sun there.
struct RayPoint {
    altitude: f32,
    // Sine of the sun's elevation over the level of this point.
    sun_sine: f32,
}

// After a distance; `sun_cosine` is the cosine between the ray and the way to the sun.
fn point_along(altitude: f32, sine: f32, sun_sine: f32, sun_cosine: f32, distance: f32) -> RayPoint {
    let there = altitude_along(altitude, sine, distance);
    let up = (PLANET_RADIUS + altitude) * sun_sine + distance * sun_cosine;
    return RayPoint(there, clamp(up / (PLANET_RADIUS + there), -1.0, 1.0));
}

// Cosine between two directions, by the sines of their elevations and the cosine of the angle between their azimuths.
fn cosine_between(sine: f32, other_sine: f32, azimuth_cosine: f32) -> f32 {
    let level = sqrt(max((1.0 - square(sine)) * (1.0 - square(other_sine)), 0.0));
    return clamp(sine * other_sine + level * azimuth_cosine, -1.0, 1.0);
}

// Steps along a ray get longer with distance: the k-th of n begins at (k / n)^2 of the way.
struct Step {
    middle: f32,
    length: f32,
}

fn step_along(distance: f32, index: u32, steps: u32) -> Step {
    let n = f32(steps);
    let k = f32(index);
    return Step(distance * square((k + 0.5) / n), distance * (2.0 * k + 1.0) / square(n));
}
