//! The penumbra of a straight edge with the filter pcss, against similar triangles.

use std::f64::consts::PI;

use libtest_mimic::Failed;

use super::{below, shot};
use crate::support::picture::{Series, near, texel};

/// How much of a disc of radius 1 lies to one side of a line at this distance from its middle, from -1 to 1.
fn part_of_disc(at: f64) -> f64 {
    let at = at.clamp(-1.0, 1.0);
    0.5 + (at * (1.0 - at * at).sqrt() + at.asin()) / PI
}

/// Where a rising function reaches a value.
fn reaches(value: f64, of: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if of(middle) < value { &mut low } else { &mut high }) = middle;
    }
    low
}

/// Between a tenth and nine tenths of the light, against what a disc of light gives whose half width on the floor is
/// radius * (distance of the floor - distance of the edge) / distance of the edge, or for the sun the height times the tangent of half
/// its angle.
pub fn of_an_edge() -> Result<(), Failed> {
    let tenths = 2.0 * reaches(0.9, part_of_disc, [-1.0, 1.0]);
    let (top, radius, angle) = (3.0, 0.1, 4.0_f64);
    let mut series = Series::default();
    for light in ["lamp", "spot", "sun"] {
        for height in [0.5, 1.0, 1.5] {
            let (source, half_width) = match light {
                "lamp" => (format!("Point(candela: 5, position: (0, {top}, 0))"), radius * height / (top - height)),
                "spot" => (
                    format!("Spot(candela: 5, position: (0, {top}, 0), direction: (0, -1, 0), inner: 40, outer: 45)"),
                    radius * height / (top - height),
                ),
                _ => ("Directional(lux: 1, direction: (0, -1, 0))".to_owned(), height * (0.5 * angle).to_radians().tan()),
            };
            // Eight half widths across the image.
            let across = 8.0 * half_width;
            let scene = format!(
                "({} lights: {{ \"light\": {source} }}, objects: {{
                    \"floor\": (shape: Plane(size: (5, 5)), surface: (specular: 0)),
                    \"plate\": (shape: Box(size: (2, 0.01, 4)), surface: (specular: 0), translation: (1, {}, 0)) }})",
                below([0.0, 0.0], across),
                height + 0.005
            );
            let shot = shot(192, &["visibility"]).set("shadow_filter", "pcss").set("light_radius", radius).set("sun_angle", angle);
            let image = series.one(&shot.set("sun_shadow_texels", 4096).set("shadow_cascades", 1), &scene)?;
            // Which way the image is turned: the edge runs along its rows or its columns.
            let mean = |along: &dyn Fn(u32, u32) -> f64, line: u32| (0..192).map(|at| along(line, at)).sum::<f64>() / 192.0;
            let by_column: Vec<f64> = (0..192).map(|line| mean(&|x, y| texel(&image, x, y)[0], line)).collect();
            let by_row: Vec<f64> = (0..192).map(|line| mean(&|y, x| texel(&image, x, y)[0], line)).collect();
            let range = |profile: &[f64]| (profile[0] - profile[191]).abs();
            let mut profile = if range(&by_column) > range(&by_row) { by_column } else { by_row };
            if profile[0] > profile[191] {
                profile.reverse();
            }
            if profile[0] > 0.02 || profile[191] < 0.98 {
                return Err(format!("{light}, {height} m: from {} to {}", profile[0], profile[191]).into());
            }
            let at = |value: f64| -> f64 {
                let after = profile.iter().position(|found| *found >= value).unwrap_or(0).max(1);
                let (low, high) = (profile[after - 1], profile[after]);
                (after as f64 - 1.0 + (value - low) / (high - low)) * across / 192.0
            };
            let (found, expected) = (at(0.9) - at(0.1), tenths * half_width);
            println!("{light}, {height} m: {found:.4} m, {:+.1} %", (found / expected - 1.0) * 100.0);
            near(&format!("the penumbra of the {light} at {height} m"), found, expected, 0.15)?;
        }
    }
    Ok(())
}
