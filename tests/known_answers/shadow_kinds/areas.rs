//! The shadow of a sphere on a plane: an ellipse, whose area has a closed form for each kind of light.

use std::f64::consts::PI;

use glam::DVec3;
use libtest_mimic::Failed;

use super::{below, shot};
use crate::shadows::FILTERS;
use crate::support::picture::{Series, near, places, texel};

const RADIUS: f64 = 0.5;
const CENTER: DVec3 = DVec3::new(0.0, 1.2, 0.0);
/// Metres across the image.
const HEIGHT: f64 = 5.0;

/// The cone from a light around the sphere meets the plane y = 0 in an ellipse. With the half angle a of the cone, the angle b of its axis
/// against the plane's normal and the light's height h, the ellipse has the half axes h sin 2a / (2 cos(b + a) cos(b - a)) and that times
/// the root of 1 - (sin b / cos a)^2.
fn cone_area(light: DVec3) -> f64 {
    let axis = CENTER - light;
    let a = (RADIUS / axis.length()).asin();
    let b = (-axis.y / axis.length()).acos();
    let major = light.y * (2.0 * a).sin() / (2.0 * (b + a).cos() * (b - a).cos());
    PI * major * major * (1.0 - (b.sin() / a.cos()).powi(2)).sqrt()
}

pub fn of_a_sphere() -> Result<(), Failed> {
    let to_sun = DVec3::new(0.5, 1.0, 0.25).normalize();
    let lamp = DVec3::new(0.9, 3.2, 0.4);
    let to_ball = CENTER - lamp;
    let place = |v: DVec3| format!("({}, {}, {})", v.x, v.y, v.z);
    // Where the shadow lies, roughly.
    let beside = |light: DVec3| CENTER + (CENTER - light) * (CENTER.y / (light.y - CENTER.y));
    let cases = [
        ("sun", format!("Directional(lux: 1, direction: {})", place(-to_sun)), PI * RADIUS * RADIUS / to_sun.y, beside(CENTER + to_sun)),
        ("lamp", format!("Point(candela: 5, position: {})", place(lamp)), cone_area(lamp), beside(lamp)),
        (
            "spot",
            format!("Spot(candela: 5, position: {}, direction: {}, inner: 34, outer: 35)", place(lamp), place(to_ball)),
            cone_area(lamp),
            beside(lamp),
        ),
    ];
    let mut series = Series::default();
    for (filter, (name, light, expected, middle)) in FILTERS.into_iter().flat_map(|filter| cases.iter().map(move |case| (filter, case))) {
        let scene = format!(
            "({} lights: {{ \"light\": {light} }}, objects: {{
                \"floor\": (shape: Plane(size: (12, 12)), surface: (specular: 0)),
                \"ball\": (shape: Sphere(radius: {RADIUS}, sectors: 256, stacks: 128), surface: (specular: 0), translation: {}) }})",
            below([middle.x, middle.z], HEIGHT),
            place(CENTER)
        );
        let shot = shot(256, &["visibility"]).set("shadow_filter", filter).set("light_radius", 0.02);
        let image = series.one(&shot, &scene)?;
        let pixel = (HEIGHT / 256.0) * (HEIGHT / 256.0);
        // A spot's light ends around its shadow: what it does not reach is not counted.
        let within = |(x, y): (u32, u32)| (f64::from(x) - 127.5).hypot(f64::from(y) - 127.5) * HEIGHT / 256.0 < 1.35;
        let area: f64 = places(&image).filter(|place| within(*place)).map(|(x, y)| (1.0 - texel(&image, x, y)[0]) * pixel).sum();
        println!("{name}, {filter}: {area:.4} m2, {:+.2} %", (area / expected - 1.0) * 100.0);
        near(&format!("the area of the shadow, {name}, {filter}"), area, *expected, 0.01)?;
    }
    Ok(())
}
