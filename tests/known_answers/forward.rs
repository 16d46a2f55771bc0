//! Forward shading: the same picture as by the G-buffer, and Blinn-Phong by its formula.

use glam::DVec3;
use libtest_mimic::Failed;

use crate::Case;
use crate::support::picture::{Eye, Shot, near, places, texel};

pub const CASES: &[Case] = &[
    ("forward::it is what deferred shading gives", as_deferred),
    ("forward::blinn-phong is its formula", blinn_phong),
    ("forward::the sky stands behind", the_sky_stands_behind),
];

const BASIC: &str = "pipelines/basic.ron";
const FORWARD: &str = "pipelines/pbr_forward.ron";

fn busy() -> String {
    let eye = Eye::new([0.0, 2.0, 5.0], [0.0, 0.3, 0.0], 45.0);
    format!(
        "({} environment: (sky_radiance: (0.1, 0.2, 0.4)),
        lights: {{ \"sun\": Directional(lux: 2, direction: (-1, -2, -1)), \"lamp\": Point(candela: 3, position: (1, 1.5, 1)),
            \"spot\": Spot(candela: 6, position: (-2, 3, 1), direction: (1, -1.5, -0.5), inner: 10, outer: 25) }},
        objects: {{
            \"floor\": (shape: Plane(size: (8, 8)), surface: (roughness: 0.6)),
            \"ball\": (shape: Sphere(radius: 0.6), translation: (-0.8, 0.6, 0), surface: (metallic: 1, roughness: 0.3)),
            \"glow\": (shape: Box(size: (0.4, 0.4, 0.4)), translation: (0.9, 0.2, -0.5), surface: (emissive: (1, 0.5, 0.2))),
            \"glass\": (shape: Plane(size: (1, 1)), rotation: (90, 0, 0), translation: (0.3, 0.6, 1), surface: (alpha: 0.4)) }})",
        eye.ron()
    )
}

/// The G-buffer rounds normals to 16 bits, colours to half floats and places to what depth says: measured 0.15 % on average, more than 2 %
/// only on edges of shadows.
fn as_deferred() -> Result<(), Failed> {
    for unlisted in [0, 100] {
        let outputs = ["radiance", "depth"];
        let deferred = Shot::pbr(96, &outputs).set("unlisted_lights", unlisted).take(&busy())?;
        let forward = Shot::of(FORWARD, [96, 96], &outputs).set("unlisted_lights", unlisted).take(&busy())?;
        let (mut sum, mut far_off) = (0.0, 0);
        for (x, y) in places(&deferred["radiance"]) {
            let (a, b) = (texel(&deferred["radiance"], x, y), texel(&forward["radiance"], x, y));
            let off = (0..3).map(|channel| (a[channel] - b[channel]).abs() / (a[channel] + 0.1)).fold(0.0, f64::max);
            sum += off;
            far_off += u32::from(off > 0.02);
            if texel(&deferred["depth"], x, y) != texel(&forward["depth"], x, y) {
                return Err(format!("another depth at {x}, {y}").into());
            }
        }
        let mean = sum / f64::from(96 * 96);
        println!("forward and deferred differ by {mean:.5}, {far_off} pixels by more than 2 %");
        if mean > 0.003 || far_off > 50 {
            return Err(format!("forward and deferred differ by {mean}, {far_off} pixels by more than 2 %").into());
        }
    }
    Ok(())
}

/// A plane below a lamp and a camera, both off to the side.
fn blinn_phong() -> Result<(), Failed> {
    let eye = Eye::new([0.0, 3.0, 3.0], [0.0, 0.0, 0.0], 40.0);
    let lamp = DVec3::new(0.8, 2.0, -1.5);
    for (metallic, roughness) in [(0.0f64, 0.5f64), (1.0, 0.3), (0.0, 1.0)] {
        let scene = format!(
            "({} lights: {{ \"lamp\": Point(candela: 10, position: ({}, {}, {})) }}, objects: {{ \"floor\": (shape: Plane(size: (8, 8)),
                surface: (base_color: (0.5, 0.3, 0.8), metallic: {metallic}, roughness: {roughness})) }})",
            eye.ron(),
            lamp.x,
            lamp.y,
            lamp.z
        );
        let image = Shot::of(BASIC, [48, 48], &["radiance"]).one(&scene)?;
        for (x, y) in places(&image).filter(|(x, y)| x % 5 == 0 && y % 5 == 0) {
            let Some(point) = eye.on_plane(&image, (x, y), DVec3::ZERO, DVec3::Y).filter(|point| point.abs().max_element() < 3.9) else {
                continue;
            };
            let to_light = (lamp - point).normalize();
            let half = (to_light + (eye.position - point).normalize()).normalize();
            let exponent = (2.0 / roughness.powi(4) - 2.0).clamp(0.0, 2048.0);
            let highlight = half.y.powf(exponent) * (exponent + 8.0) / (8.0 * std::f64::consts::PI);
            for (channel, base) in [0.5, 0.3, 0.8].into_iter().enumerate() {
                let specular = 0.04 * (1.0 - metallic) + base * metallic;
                let reflected = base * (1.0 - metallic) / std::f64::consts::PI + specular * highlight;
                let expected = reflected * 10.0 * to_light.y / (lamp - point).length_squared();
                // Half floats, and a position from 32-bit interpolation in the exponent.
                let found = texel(&image, x, y)[channel];
                if expected > 1e-3 || found > 2e-3 {
                    near(&format!("channel {channel} at {x}, {y}"), found, expected, 0.004)?;
                }
            }
        }
    }
    Ok(())
}

fn the_sky_stands_behind() -> Result<(), Failed> {
    let scene = "(cameras: { \"eye\": (position: (0, 0, 4), target: (0, 0, 0)) }, environment: (sky_radiance: (0.25, 0.5, 3)),
        objects: { \"ball\": (shape: Sphere(radius: 1), surface: (base_color: (0, 0, 0))) })";
    for pipeline in [BASIC, FORWARD] {
        let image = Shot::of(pipeline, [32, 32], &["radiance"]).one(scene)?;
        let corner = texel(&image, 0, 0);
        if corner[..3] != [0.25, 0.5, 3.0] {
            return Err(format!("{pipeline}: {corner:?} in the corner").into());
        }
        let middle = texel(&image, 16, 16);
        if middle[..3] != [0.0; 3] {
            return Err(format!("{pipeline}: {middle:?} on a black ball that takes no light").into());
        }
    }
    Ok(())
}
