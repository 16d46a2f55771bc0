// What the Earth's air is made of, after Hillaire 2020, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique"
// (EGSR), table 1. Lengths are in kilometres, coefficients per kilometre, the three channels those of linear Rec.709.
//
// One deviation: the paper prints 4.40e-6 per metre as what aerosols absorb. That is what they take away altogether (4.44e-6, of which
// 3.996e-6 are scattered), in Bruneton 2017, where the coefficients come from, and in the paper's own implementation.

#import "shared/math.wgsl"

const PLANET_RADIUS: f32 = 6360.0;
// Altitude above which there is no air.
const AIR_TOP: f32 = 100.0;

const RAYLEIGH_SCATTERING: vec3<f32> = vec3<f32>(0.005802, 0.013558, 0.0331);
const RAYLEIGH_SCALE_HEIGHT: f32 = 8.0;
// Of clear air; a scale of 1.
const MIE_SCATTERING: f32 = 0.003996;
const MIE_EXTINCTION: f32 = 0.00444;
const MIE_SCALE_HEIGHT: f32 = 1.2;
const MIE_ANISOTROPY: f32 = 0.8;
// Ozone only absorbs. Its density is a tent around 25 km.
const OZONE_ABSORPTION: vec3<f32> = vec3<f32>(0.00065, 0.001881, 0.000085);
const OZONE_ALTITUDE: f32 = 25.0;
const OZONE_HALF_WIDTH: f32 = 15.0;

// Densities at an altitude: of air molecules and aerosols as a part of that at the ground, of ozone as a part of the largest.
fn densities(altitude: f32) -> vec3<f32> {
    return vec3<f32>(
        exp(-altitude / RAYLEIGH_SCALE_HEIGHT),
        exp(-altitude / MIE_SCALE_HEIGHT),
        max(0.0, 1.0 - abs(altitude - OZONE_ALTITUDE) / OZONE_HALF_WIDTH),
    );
}

// What `amounts` of the three take away: per kilometre for densities, optical depth for densities integrated along a path.
fn extinction(amounts: vec3<f32>, mie_scale: f32) -> vec3<f32> {
    return amounts.x * RAYLEIGH_SCATTERING + vec3<f32>(amounts.y * mie_scale * MIE_EXTINCTION) + amounts.z * OZONE_ABSORPTION;
}

// Per steradian.
fn rayleigh_phase(cosine: f32) -> f32 {
    return 3.0 / (16.0 * PI) * (1.0 + square(cosine));
}

// Cornette and Shanks 1992, per steradian. The cosine is 1 where light goes straight on.
fn mie_phase(cosine: f32) -> f32 {
    let g = MIE_ANISOTROPY;
    let base = 1.0 + g * g - 2.0 * g * cosine;
    return 3.0 / (8.0 * PI) * (1.0 - g * g) / (2.0 + g * g) * (1.0 + square(cosine)) / (base * sqrt(base));
}

// The mean of exp(-x) from 0 to `depth`: how much of a light that is the same all along a step arrives at its beginning.
fn mean_transmittance(depth: vec3<f32>) -> vec3<f32> {
    // The difference in the quotient loses its digits where the air is thin.
    let thin = 1.0 - depth * (0.5 - depth / 6.0);
    return select((1.0 - exp(-depth)) / max(depth, vec3<f32>(1.0e-6)), thin, depth < vec3<f32>(0.02));
}
