//! The physical sky of `pipelines/blocks/sky.ron`: against an integration in 64 bits, in lux, at its limits, and what runs when.

mod agreement;
mod limits;
mod reference;
mod runs;

use crate::Case;
use crate::support::picture::Shot;

pub const CASES: &[Case] = &[
    ("sky::noon agrees with an integration", agreement::noon),
    ("sky::sunset agrees with an integration", agreement::sunset),
    ("sky::twilight agrees with an integration", agreement::twilight),
    ("sky::a hazy mountain agrees with an integration", agreement::mountain),
    ("sky::the sun through the air", agreement::sun_through_the_air),
    ("sky::lux at noon", agreement::lux_at_noon),
    ("sky::every sun gives finite light", limits::finite),
    ("sky::both sides of the sun are equal", limits::symmetric),
    ("sky::the disc sends what the sun sends", limits::disc),
    ("sky::without a sun it is black", limits::no_sun),
    ("sky::what turns and changes runs what reads it", runs::what_reads_it),
];

/// Lux outside of the air, as a mean over the year.
const OUTSIDE: f64 = 128_000.0;

/// Degrees; the same as in `sky_directions.wgsl`.
const ELEVATIONS: [f64; 18] = [-60.0, -10.0, -1.5, 0.1, 0.4, 0.8, 1.4, 2.2, 3.3, 5.0, 7.5, 11.0, 17.0, 26.0, 40.0, 58.0, 77.0, 90.0];
const AZIMUTHS: [f64; 8] = [0.0, 20.0, 70.0, 180.0, 8.0, -8.0, 131.0, -131.0];

fn shot(outputs: &[&str]) -> Shot {
    Shot::of("tests/fixtures/gpu/sky.ron", [8, 8], outputs)
}

/// A scene whose sun stands there, degrees. Azimuth 0 is +X, 90 is +Z.
fn scene(elevation: f64, azimuth: f64) -> String {
    let to_sun = reference::direction(elevation.to_radians(), azimuth.to_radians());
    let [x, y, z] = (-to_sun).to_array();
    format!(
        "(cameras: {{ \"eye\": (position: (0, 2, 0), target: (1, 2, 0), fov: 60) }},
            lights: {{ \"sun\": Directional(lux: {OUTSIDE}, direction: ({x:.9}, {y:.9}, {z:.9})) }})"
    )
}
