//! Tone mapping curves at known values, and the parameters that lead to them.

use libtest_mimic::Failed;
use luminaire::image_file::{LinearImage, srgb_encode};

use crate::Case;
use crate::support::picture::{Shot, places, texel};

pub const CASES: &[Case] = &[
    ("tone mapping::none clips", none_clips),
    ("tone mapping::reinhard", reinhard),
    ("tone mapping::neutral", neutral),
    ("tone mapping::every curve rises from black to white", every_curve_rises),
    ("tone mapping::exposure doubles per stop", exposure_doubles),
    ("tone mapping::the picture follows the parameters", parameters_reach_the_picture),
];

const NO_SCENE: &str = "(cameras: { \"eye\": (position: (0, 0, 1), target: (0, 0, 0)) })";

/// What comes in and what goes out.
fn curve(name: &str, exposure: f64) -> Result<(LinearImage, LinearImage), Failed> {
    let shot = Shot::of("tests/fixtures/gpu/tone_mapping.ron", [8, 8], &["ramp", "curve"]);
    let mut images = shot.set("tone_mapping", name).set("exposure", exposure).take(NO_SCENE)?;
    Ok((images.remove("ramp").ok_or("no ramp")?, images.remove("curve").ok_or("no curve")?))
}

/// Compares a curve with a formula on each texel. Measured: 1.0e-7 at most, of values up to 1.
fn agrees(name: &str, exposure: f64, formula: impl Fn([f64; 3]) -> [f64; 3]) -> Result<(), Failed> {
    let (ramp, curve) = curve(name, exposure)?;
    let mut worst = 0.0f64;
    for (x, y) in places(&ramp) {
        let [r, g, b, _] = texel(&ramp, x, y).map(|value| value * exposure.exp2());
        let (expected, found) = (formula([r, g, b]), texel(&curve, x, y));
        for channel in 0..3 {
            let error = (found[channel] - expected[channel].clamp(0.0, 1.0)).abs();
            worst = worst.max(error);
            if error > 5e-7 {
                return Err(format!("{name} makes {found:?} of {:?}, not {expected:?}", [r, g, b]).into());
            }
        }
    }
    println!("{name}: worst error {worst:.2e}");
    Ok(())
}

fn none_clips() -> Result<(), Failed> {
    agrees("none", 0.0, |color| color)
}

/// L / (1 + L) on luminance.
fn reinhard() -> Result<(), Failed> {
    agrees("reinhard", 0.0, |[r, g, b]| {
        let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        [r, g, b].map(|value| value / (1.0 + luminance))
    })
}

/// The Khronos PBR Neutral specification: below the knee nothing changes but the offset, which takes off the 4 % that a dielectric
/// reflects: 0.04, and less near black.
fn neutral() -> Result<(), Failed> {
    agrees("neutral", 0.0, |color| {
        let (start, desaturation) = (0.8 - 0.04, 0.15);
        let low = color.into_iter().fold(f64::INFINITY, f64::min);
        let offset = if low < 0.08 { low - 6.25 * low * low } else { 0.04 };
        let color = color.map(|value| value - offset);
        let peak = color.into_iter().fold(0.0, f64::max);
        if peak < start {
            return color;
        }
        let d = 1.0 - start;
        let new_peak = 1.0 - d * d / (peak + d - start);
        let g = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
        color.map(|value| value * new_peak / peak * (1.0 - g) + new_peak * g)
    })
}

fn every_curve_rises() -> Result<(), Failed> {
    for name in ["none", "reinhard", "aces", "agx", "neutral"] {
        let (_, curve) = curve(name, 0.0)?;
        // Black stays black, in 8 bits; white comes near 1; gray stays gray. Measured: AgX ends at
        // 0.9965, and its matrices are off gray by 5e-4; black is 0.
        let (black, white) = (texel(&curve, 0, 0), texel(&curve, 255, 0));
        if black[..3].iter().any(|value| *value > 0.0) || white[..3].iter().any(|value| *value < 0.99) {
            return Err(format!("{name}: black is {black:?}, white {white:?}").into());
        }
        let mut before = [0.0; 3];
        for x in 0..curve.width {
            let [r, g, b, _] = texel(&curve, x, 0);
            if (0..3).any(|channel| !(-1e-6..=1.0).contains(&[r, g, b][channel]) || [r, g, b][channel] < before[channel] - 1e-6) {
                return Err(format!("{name} falls from {before:?} to {:?} at column {x}", [r, g, b]).into());
            }
            if (r - g).abs().max((g - b).abs()) > 1e-3 {
                return Err(format!("{name} colours gray: {:?}", [r, g, b]).into());
            }
            before = [r, g, b];
        }
    }
    Ok(())
}

fn exposure_doubles() -> Result<(), Failed> {
    agrees("none", 1.0, |color| color)?;
    agrees("none", -3.0, |color| color)?;
    agrees("reinhard", 2.0, |[r, g, b]| {
        let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        [r, g, b].map(|value| value / (1.0 + luminance))
    })
}

/// The pipeline `pbr` by itself: `color` is what its parameters and the camera's exposure make of `radiance`, in 8 bits.
fn parameters_reach_the_picture() -> Result<(), Failed> {
    let scene = |ev100: &str| {
        format!(
            "(cameras: {{ \"eye\": (position: (0, 0, 2), target: (0, 0, 0){ev100}) }},
            lights: {{ \"lamp\": Point(candela: 1.2, position: (0.5, 0.5, 1)) }},
            objects: {{ \"plane\": (shape: Plane(size: (9, 9)), rotation: (90, 0, 0), surface: (specular: 0)) }})"
        )
    };
    let shot = Shot::pbr(32, &["color", "radiance"]);
    // 1 / (1.2 * 2^EV100) is the camera's factor.
    let cases = [("none", 0.0, "", 1.0), ("none", 1.0, "", 2.0), ("none", -2.0, "", 0.25), ("none", 1.0, ", ev100: 1", 1.0 / 1.2)];
    let mut pictures = Vec::new();
    for (tone_mapping, exposure, ev100, factor) in cases {
        let images = shot.clone().set("tone_mapping", tone_mapping).set("exposure", exposure).take(&scene(ev100))?;
        for (x, y) in places(&images["color"]) {
            let expected = srgb_encode((texel(&images["radiance"], x, y)[0] * factor) as f32);
            let found = srgb_encode(texel(&images["color"], x, y)[0] as f32);
            // Rounding is half a step; half a step more for the driver's own sRGB encoding.
            if (found - expected).abs() > 1.0 / 255.0 {
                return Err(format!("{found} and not {expected} at {x}, {y} with {exposure} EV{ev100}").into());
            }
        }
        pictures.push(images);
    }
    let other = shot.set("tone_mapping", "agx").take(&scene(""))?;
    if other["color"] == pictures[0]["color"] { Err("tone mapping changes nothing".into()) } else { Ok(()) }
}
