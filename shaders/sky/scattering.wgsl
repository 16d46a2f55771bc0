// Makes the table `scattering` (Hillaire 2020, equations 5 to 10): from each place rays go out in all directions, and gather what arrives
// from the second scattering, and which part of an even light of 1 would be scattered towards the place.

#import "sky/scattering_table.wgsl"
#import "sky/transmittance_table.wgsl"

var logarithms: texture_storage_2d<rgba32float, write>;

struct Params {
    mie_scale: f32,
    ground_albedo: vec3<f32>,
    scattering_steps: u32,
}

var<uniform> params: Params;

// Rays above the horizon, as many below it, and for each half as many azimuths on one side of the sun: the other side is its mirror
// image. Mesa's software driver ends loops after 65,535 rounds of an invocation: with 64 steps these are 16,384.
const ELEVATIONS: u32 = 16u;
const AZIMUTHS: u32 = 8u;

struct Gathered {
    // Radiance after one scattering, as if that were even in all directions, or from the lit ground.
    light: vec3<f32>,
    // Of a light of 1 from everywhere.
    part: vec3<f32>,
}

// Along one ray, which meets the ground or the end of the air.
fn gather(at: PlaceAndSun, sine: f32, azimuth_cosine: f32, down: bool) -> Gathered {
    let sun_cosine = cosine_between(sine, at.sun_sine, azimuth_cosine);
    var distance: f32;
    if down {
        distance = distance_to_ground(at.altitude, sine);
    } else {
        distance = distance_to_top(at.altitude, sine);
    }
    var sum = Gathered(vec3<f32>(0.0), vec3<f32>(0.0));
    var depth = vec3<f32>(0.0);
    for (var k = 0u; k < params.scattering_steps; k++) {
        let step = step_along(distance, k, params.scattering_steps);
        let point = point_along(at.altitude, sine, at.sun_sine, sun_cosine, step.middle);
        let amounts = densities(point.altitude);
        let scattered = amounts.x * RAYLEIGH_SCATTERING + vec3<f32>(amounts.y * params.mie_scale * MIE_SCATTERING);
        let step_depth = extinction(amounts, params.mie_scale) * step.length;
        let arriving = scattered * (step.length * exp(-depth) * mean_transmittance(step_depth));
        sum.part += arriving;
        sum.light += arriving * sun_transmittance(point.altitude, point.sun_sine, params.mie_scale) / (4.0 * PI);
        depth += step_depth;
    }
    if down {
        let ground = point_along(at.altitude, sine, at.sun_sine, sun_cosine, distance);
        let sun = sun_transmittance(0.0, ground.sun_sine, params.mie_scale) * max(ground.sun_sine, 0.0);
        sum.light += exp(-depth) * saturate(params.ground_albedo) / PI * sun;
    }
    return sum;
}

@compute @workgroup_size(8, 8)
fn spread(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(logarithms);
    if any(id.xy >= size) {
        return;
    }
    let at = scattering_at(vec2<f32>(id.xy) / vec2<f32>(size - 1u));
    let dip = horizon_dip(at.altitude);
    var light = vec3<f32>(0.0);
    var part = vec3<f32>(0.0);
    for (var i = 0u; i < 2u * ELEVATIONS; i++) {
        // Angles from the horizon, denser near it: range * s^2.
        let down = i >= ELEVATIONS;
        let range = select(0.5 * PI + dip, 0.5 * PI - dip, down);
        let s = (f32(i % ELEVATIONS) + 0.5) / f32(ELEVATIONS);
        let elevation = select(range * s * s, -range * s * s, down) - dip;
        let solid_angle = cos(elevation) * 2.0 * range * s / f32(ELEVATIONS) * 2.0 * PI / f32(AZIMUTHS);
        for (var j = 0u; j < AZIMUTHS; j++) {
            let azimuth_cosine = cos((f32(j) + 0.5) * PI / f32(AZIMUTHS));
            let gathered = gather(at, sin(elevation), azimuth_cosine, down);
            light += gathered.light * solid_angle;
            part += gathered.part * solid_angle;
        }
    }
    // The mean over directions of all orders, a geometric series.
    let mean = light / (4.0 * PI) / (1.0 - part / (4.0 * PI));
    textureStore(logarithms, id.xy, vec4<f32>(max(log2(max(mean, vec3<f32>(1.0e-36))), vec3<f32>(NO_LIGHT)), 1.0));
}
