//! Spot lights: how strong they are, and that a wide one loses no shadow.

use std::f64::consts::PI;

use glam::DVec3;
use libtest_mimic::Failed;

use super::{below, shot};
use crate::support::picture::{Eye, places, texel};

/// KHR_lights_punctual: inverse squares, the window of the range, and the square of the cosine between those of both cones.
pub fn falloff() -> Result<(), Failed> {
    let eye = Eye::new([0.0, 4.0, 0.5], [0.0, 0.0, 0.0], 60.0);
    let light = DVec3::new(0.3, 2.5, 0.2);
    let direction = DVec3::new(0.1, -1.0, 0.05).normalize();
    let [inner, outer, range, candela] = [12.0_f64, 34.0_f64, 3.4_f64, 40.0_f64];
    let scene = format!(
        "({} lights: {{ \"spot\": Spot(candela: {candela}, position: (0.3, 2.5, 0.2), direction: (0.1, -1, 0.05), inner: {inner}, outer: {outer},
            range: {range}) }}, objects: {{ \"floor\": (shape: Plane(size: (8, 8)), surface: (specular: 0)) }})",
        eye.ron()
    );
    let image = shot(192, &["radiance"]).one(&scene)?;
    let (mut worst, mut lit): (f64, u32) = (0.0, 0);
    let peak = candela / 2.5 / 2.5 / PI;
    for place in places(&image) {
        let Some(point) = eye.on_plane(&image, place, DVec3::ZERO, DVec3::Y) else { continue };
        if point.x.abs().max(point.z.abs()) > 3.9 {
            continue;
        }
        let to_light = light - point;
        let distance = to_light.length();
        let window = (1.0 - (distance / range).powi(4)).clamp(0.0, 1.0);
        let scale = 1.0 / (inner.to_radians().cos() - outer.to_radians().cos());
        let cosine = direction.dot(-to_light / distance);
        let cone = (cosine * scale - outer.to_radians().cos() * scale).clamp(0.0, 1.0).powi(2);
        let expected = candela * window * cone / (distance * distance) * (to_light.y / distance) / PI;
        worst = worst.max((texel(&image, place.0, place.1)[0] - expected).abs() / peak);
        lit += u32::from(expected > 0.01 * peak);
    }
    println!("the falloff is off by {worst:.2e} of the peak, {lit} pixels are lit");
    if worst > 1e-4 || lit < 5000 { Err(format!("off by {worst} of the peak, {lit} lit").into()) } else { Ok(()) }
}

/// A spot with a half angle of 85 degrees, a plate that it sees at 78 degrees: the shadow is there, and none is on the other side.
pub fn wide() -> Result<(), Failed> {
    let (light, middle) = (DVec3::new(0.0, 1.0, 0.0), 3.4);
    let scene = format!(
        "({} lights: {{ \"spot\": Spot(candela: 20, position: (0, 1, 0), direction: (0, -1, 0), inner: 80, outer: 85) }}, objects: {{
            \"floor\": (shape: Plane(size: (12, 12)), surface: (specular: 0)),
            \"plate\": (shape: Box(size: (0.02, 0.3, 0.6)), surface: (specular: 0), translation: (1.7, 0.45, 0)) }})",
        below([middle, 0.0], 2.0)
    );
    for light_kind in ["point", "spot"] {
        let image = shot(128, &["visibility"]).set("light", light_kind).one(&scene)?;
        let (mut wrong, mut dark, mut lit) = (0, 0, 0);
        for (x, y) in places(&image) {
            // The camera looks down; which way its image is turned does not matter for what is symmetric.
            let [u, v] = [x, y].map(|at| (f64::from(at) + 0.5) / 64.0 - 1.0);
            {
                let point = DVec3::new(middle + u, 0.0, v);
                let crossing = light + (point - light) * (1.7 / point.x);
                let beyond = (crossing.y - 0.45).abs() - 0.15;
                let beyond = beyond.max(crossing.z.abs() - 0.3);
                let found = texel(&image, x, y)[0];
                if beyond < -0.02 {
                    dark += 1;
                    wrong += u32::from(found != 0.0);
                } else if beyond > 0.02 {
                    lit += 1;
                    // Four weights need not add up to 1 exactly.
                    wrong += u32::from((found - 1.0).abs() > 1e-6);
                }
            }
        }
        println!("{light_kind}: {dark} dark, {lit} lit, {wrong} wrong");
        let expected = if light_kind == "point" { wrong == 0 } else { wrong == lit };
        if !expected || dark < 1000 || lit < 1000 {
            return Err(format!("{light_kind}: {dark} dark, {lit} lit, {wrong} wrong").into());
        }
    }
    Ok(())
}
