// Light that was scattered more than once: the table `scattering`, and looking it up.
//
// Hillaire 2020, section 5.5: from the second time on light is taken to be scattered evenly in all directions, and each further
// scattering to send on the same part of what arrives. Then what arrives at a place depends on its altitude and the sun's
// elevation alone.
//
// The light of dusk falls by half within a degree of the sun's way. So the table holds logarithms, and most of its columns stand near a
// sun at the horizon; they end at -0.4, about 24 degrees below it, after which there is no light. The paper's 32 columns are off by up to
// 2.4 % at dusk and sunset; 64 keep the sky within 1 %.

#import "sky/interpolate.wgsl"
#import "sky/shell.wgsl"

var scattering: texture_2d<f32>;

// log2 of what counts as nothing.
const NO_LIGHT: f32 = -120.0;

const LOWEST_SUN: f32 = -0.4;
// The part of the columns that lies below the horizon.
const LOW_PART: f32 = 0.6;

// An altitude, and the sine of the sun's elevation there.
struct PlaceAndSun {
    altitude: f32,
    sun_sine: f32,
}

fn scattering_place(at: PlaceAndSun) -> vec2<f32> {
    var x = mix(LOW_PART, 1.0, sqrt(max(at.sun_sine, 0.0)));
    if at.sun_sine < 0.0 {
        x = LOW_PART * (1.0 - sqrt(min(at.sun_sine / LOWEST_SUN, 1.0)));
    }
    return vec2<f32>(x, sqrt(at.altitude / AIR_TOP));
}

fn scattering_at(place: vec2<f32>) -> PlaceAndSun {
    let altitude = AIR_TOP * square(place.y);
    if place.x < LOW_PART {
        return PlaceAndSun(altitude, LOWEST_SUN * square(1.0 - place.x / LOW_PART));
    }
    return PlaceAndSun(altitude, square((place.x - LOW_PART) / (1.0 - LOW_PART)));
}

// Radiance of light that has been scattered before, as its mean over all directions, in parts of the sun's illuminance outside of the
// air. Times a scattering coefficient it is what comes into a ray.
fn scattered_before(altitude: f32, sun_sine: f32) -> vec3<f32> {
    return exp2(interpolate(scattering, scattering_place(PlaceAndSun(altitude, sun_sine))).xyz);
}
