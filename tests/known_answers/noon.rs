//! The sun at noon, 100,000 lx, on metal and plastic: light that half floats could not hold in nits.

use std::f64::consts::PI;

use glam::DVec3;
use libtest_mimic::Failed;
use luminaire::image_file::srgb_encode;

use crate::Case;
use crate::support::picture::{Eye, Shot, near, places, texel};

pub const CASES: &[Case] = &[
    ("noon::highlights are as bright as the BRDF says", highlights),
    ("noon::every output is finite", all_finite),
    ("noon::exposure changes the picture and no radiance", exposure),
    ("noon::an eighth of the light is an eighth of the radiance", eighth),
];

const LUX: f64 = 100_000.0;
const SKY: [f64; 3] = [3000.0, 5000.0, 9000.0];
const METAL: [f64; 3] = [0.95, 0.64, 0.54];
const PLASTIC: [f64; 3] = [0.8, 0.1, 0.2];
const ROUGHNESS: f64 = 0.3;

/// The plane z = 0: metal on the left, plastic on the right. `to_sun` need not have unit length.
fn halves(eye: &Eye, to_sun: DVec3) -> String {
    let plane = |x: f64, color: [f64; 3], metallic: f64| {
        let [r, g, b] = color;
        format!(
            "(shape: Plane(size: (10, 20)), rotation: (90, 0, 0), translation: ({x}, 0, 0),
                surface: (base_color: ({r}, {g}, {b}), metallic: {metallic}, roughness: {ROUGHNESS}))"
        )
    };
    let [r, g, b] = SKY;
    format!(
        "({} environment: (sky_radiance: ({r}, {g}, {b})),
            lights: {{ \"sun\": Directional(lux: {LUX}, direction: ({}, {}, {})) }},
            objects: {{ \"metal\": {}, \"plastic\": {} }})",
        eye.ron(),
        -to_sun.x,
        -to_sun.y,
        -to_sun.z,
        plane(-5.0, METAL, 1.0),
        plane(5.0, PLASTIC, 0.0),
    )
}

/// Nits from the plane z = 0 towards `to_eye`: glTF 2.0, Appendix B, with the height-correlated Smith term.
fn reflected(color: f64, metal: bool, to_sun: DVec3, to_eye: DVec3) -> f64 {
    let half = (to_sun + to_eye).normalize();
    let alpha = ROUGHNESS * ROUGHNESS;
    let distribution = (alpha / (1.0 - half.z * half.z * (1.0 - alpha * alpha))).powi(2) / PI;
    let smith = |a: f64, b: f64| a * (b * b * (1.0 - alpha * alpha) + alpha * alpha).sqrt();
    let visibility = 0.5 / (smith(to_sun.z, to_eye.z) + smith(to_eye.z, to_sun.z));
    let fresnel = |f0: f64| f0 + (1.0 - f0) * (1.0 - to_eye.dot(half)).powi(5);
    let lobe = distribution * visibility;
    let brdf = if metal { fresnel(color) * lobe } else { color / PI * (1.0 - fresnel(0.04)) + fresnel(0.04) * lobe };
    LUX * to_sun.z * brdf
}

/// A high sun seen from above, and a low one whose glint is far brighter than anything that scatters.
fn highlights() -> Result<(), Failed> {
    let views = [
        (Eye::new([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 50.0), DVec3::new(0.0, 0.3, 1.0), 0.9e6),
        (Eye::new([0.0, -4.0, 1.0], [0.0, 0.0, 0.0], 40.0), DVec3::new(0.0, 1.0, 0.25), 3.0e6),
    ];
    for (eye, to_sun, least_peak) in views {
        let image = Shot::pbr(128, &["radiance"]).one(&halves(&eye, to_sun))?;
        let to_sun = to_sun.normalize();
        let (mut worst, mut peak, mut seen) = (0.0f64, 0.0f64, 0);
        for place in places(&image) {
            // The edges of the planes may fall to either side.
            let point = eye.on_plane(&image, place, DVec3::ZERO, DVec3::Z).filter(|point| point.x.abs() > 0.05 && point.y.abs() < 9.5);
            let Some(point) = point.filter(|point| point.x.abs() < 9.5) else { continue };
            let to_eye = (eye.position - point).normalize();
            let (colors, metal) = if point.x < 0.0 { (METAL, true) } else { (PLASTIC, false) };
            let found = texel(&image, place.0, place.1);
            for channel in 0..3 {
                let expected = reflected(colors[channel], metal, to_sun, to_eye);
                worst = worst.max((found[channel] / expected - 1.0).abs());
                peak = peak.max(found[channel]);
                near(&format!("{place:?}"), found[channel], expected, 0.003)?;
            }
            seen += 1;
        }
        println!("worst relative error {worst:.5}, peak {peak:.0} nits in {seen} pixels");
        if seen < 8000 || peak < least_peak {
            return Err(format!("the brightest of {seen} pixels has {peak} nits").into());
        }
    }
    Ok(())
}

/// Balls from a mirror to chalk, one of them see-through, on a glossy floor.
fn still_life(sun: f64, sky: f64, camera: &str) -> String {
    let ball = |name: &str, x: f64, surface: &str| {
        format!("\"{name}\": (shape: Sphere(radius: 0.45), translation: ({x}, 0.45, 0), surface: ({surface})),")
    };
    format!(
        "(cameras: {{ \"eye\": (position: (0, 1.4, 4), target: (0, 0.4, 0), fov: 50{camera}) }},
            environment: (sky_radiance: ({}, {}, {})),
            lights: {{ \"sun\": Directional(lux: {sun}, direction: (-0.2, -0.8, 1.6)) }},
            objects: {{ {}{}{}{}{}
                \"floor\": (shape: Plane(size: (12, 12)), surface: (base_color: (0.9, 0.9, 0.9), roughness: 0.05)) }})",
        SKY[0] * sky,
        SKY[1] * sky,
        SKY[2] * sky,
        ball("metal", -1.0, "base_color: (1, 0.9, 0.7), metallic: 1, roughness: 0.3"),
        ball("mirror", -2.0, "base_color: (1, 1, 1), metallic: 1, roughness: 0"),
        ball("plastic", 0.0, "base_color: (0.1, 0.5, 0.9), roughness: 0.3"),
        ball("clear", 1.0, "base_color: (0.5, 1, 0.5), roughness: 0, alpha: 0.4"),
        ball("chalk", 2.0, "base_color: (1, 1, 1), specular: 0"),
    )
}

fn all_finite() -> Result<(), Failed> {
    let outputs = ["color", "radiance", "direct", "indirect", "albedo", "normal", "depth"];
    let images = Shot::pbr(256, &outputs).take(&still_life(LUX, 1.0, ", ev100: 15"))?;
    for name in outputs {
        let image = images.get(name).ok_or("no output")?;
        if let Some(wrong) = image.texels.iter().flatten().find(|value| !value.is_finite()) {
            return Err(format!("`{name}` has {wrong}").into());
        }
    }
    let peak = images["radiance"].texels.iter().map(|texel| texel[0]).fold(0.0f32, f32::max);
    println!("the brightest pixel has {peak} nits");
    // The glint on the floor is brighter than half floats hold, which end at 65,504 units of light.
    if peak > 3e7 { Ok(()) } else { Err(format!("the brightest pixel has {peak} nits").into()) }
}

/// Three stops apart, by `ev100` and by `exposure`.
fn exposure() -> Result<(), Failed> {
    let shot = Shot::pbr(128, &["color", "radiance"]).set("tone_mapping", "none");
    let ev = |ev100: f64| (format!(", ev100: {ev100}"), 1.0 / (1.2 * ev100.exp2()));
    let factor = |factor: f64| (format!(", exposure: {factor}"), factor);
    let mut first = None;
    for (camera, factor) in [ev(15.0), ev(12.0), factor(0.00002), factor(0.00016)] {
        let images = shot.take(&still_life(LUX, 1.0, &camera))?;
        let radiance = &images["radiance"];
        for (x, y) in places(radiance) {
            let expected = srgb_encode((texel(radiance, x, y)[1] * factor) as f32);
            let found = srgb_encode(texel(&images["color"], x, y)[1] as f32);
            // Rounding is half a step; half a step more for the driver's own sRGB encoding.
            if (found - expected).abs() > 1.0 / 255.0 {
                return Err(format!("{found} and not {expected} at {x}, {y}{camera}").into());
            }
        }
        if first.get_or_insert_with(|| radiance.clone()) != radiance {
            return Err(format!("another radiance with{camera}").into());
        }
    }
    Ok(())
}

/// Light is accumulated in another unit then, which must not show.
fn eighth() -> Result<(), Failed> {
    let shot = Shot::pbr(128, &["radiance"]);
    let (bright, dim) = (shot.one(&still_life(LUX, 1.0, ""))?, shot.one(&still_life(LUX / 8.0, 0.125, ""))?);
    for place in places(&bright) {
        let (found, expected) = (texel(&dim, place.0, place.1), texel(&bright, place.0, place.1));
        for channel in 0..3 {
            near(&format!("{place:?}"), found[channel], expected[channel] / 8.0, 0.001)?;
        }
    }
    Ok(())
}
