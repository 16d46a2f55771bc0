// How much light comes through the air: the table `transmittance`, and looking it up.
//
// It holds the amounts of air molecules, aerosols and ozone from a place to where the air ends (densities integrated over kilometres).
// They are smoother than the transmittance itself, so that 256 x 64 texels are enough near the horizon; and they depend on no parameter.
// Directions that meet the ground are not in it. Places of texels are those of Bruneton 2017, "Precomputed Atmospheric Scattering: a
// New Implementation", which Hillaire 2020 keeps: x by the distance to the top, y by the distance to the horizon; but y goes by its
// square root, since eyes stand near the ground.

#import "sky/interpolate.wgsl"
#import "sky/shell.wgsl"

var transmittance: texture_2d<f32>;

// Sine of the sun's angular radius, 0.2666 degrees.
const SUN_SINE: f32 = 0.004653;

// An altitude, and the sine of an elevation that is not below the horizon.
struct PlaceAndRay {
    altitude: f32,
    sine: f32,
}

fn transmittance_ray(place: vec2<f32>) -> PlaceAndRay {
    let longest = horizon_distance(AIR_TOP);
    let horizon = longest * square(place.y);
    let altitude = square(horizon) / (PLANET_RADIUS + sqrt(square(PLANET_RADIUS) + square(horizon)));
    let shortest = AIR_TOP - altitude;
    let distance = mix(shortest, horizon + longest, place.x);
    if distance <= 0.0 {
        return PlaceAndRay(altitude, 1.0);
    }
    let sine = ((longest - horizon) * (longest + horizon) - square(distance)) / (2.0 * (PLANET_RADIUS + altitude) * distance);
    return PlaceAndRay(altitude, clamp(sine, -1.0, 1.0));
}

fn transmittance_place(ray: PlaceAndRay) -> vec2<f32> {
    let longest = horizon_distance(AIR_TOP);
    let horizon = horizon_distance(ray.altitude);
    let shortest = AIR_TOP - ray.altitude;
    let distance = distance_to_top(ray.altitude, ray.sine);
    return vec2<f32>((distance - shortest) / max(horizon + longest - shortest, 1.0e-3), sqrt(horizon / longest));
}

// From a place to where the air ends. Below the horizon it is as at the horizon.
fn transmittance_to_top(altitude: f32, sine: f32, mie_scale: f32) -> vec3<f32> {
    let ray = PlaceAndRay(altitude, max(sine, horizon_sine(altitude)));
    return exp(-extinction(interpolate(transmittance, transmittance_place(ray)).xyz, mie_scale));
}

// How much of the sun's light arrives, as a part of what arrives outside of the air: 0 when the sun is behind the planet, and in
// between while the horizon cuts its disc.
fn sun_transmittance(altitude: f32, sun_sine: f32, mie_scale: f32) -> vec3<f32> {
    let risen = smoothstep(-SUN_SINE, SUN_SINE, sun_sine - horizon_sine(altitude));
    return risen * transmittance_to_top(altitude, sun_sine, mie_scale);
}
