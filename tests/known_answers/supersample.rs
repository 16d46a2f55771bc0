//! The mean over each pixel's area: against areas that are known, and what runs for it.

use glam::DVec2;
use libtest_mimic::Failed;

use crate::Case;
use crate::support::picture::{Eye, Shot, near, places, settle, shown, texel, world};

pub const CASES: &[Case] = &[
    ("supersample::a pixel has the part that is covered", pixels_are_covered),
    ("supersample::one sample is the pixel's centre", one_sample_is_the_centre),
    ("supersample::a sample runs what the shift reaches", a_sample_runs_what_the_shift_reaches),
    ("supersample::exposure takes no new samples", exposure_takes_no_samples),
];

pub(super) const EDGE: u32 = 32;
/// Degrees by which the square is turned.
const TURN: f64 = 17.0;
const HALF_WIDTH: f64 = 1.1;
const CENTRE: DVec2 = DVec2::new(0.13, -0.21);

/// From z = 5 the picture shows x and y from -2 to 2.
fn eye() -> Eye {
    Eye::new([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 2.0 * (2.0f64 / 5.0).atan().to_degrees())
}

/// A square in the picture's plane that sends 1 nit, before nothing.
pub(super) fn square() -> String {
    format!(
        "({} objects: {{ \"square\": (shape: Box(size: ({width}, {width}, 0.0001)), translation: ({}, {}, -0.00005), rotation: (0, 0, {TURN}),
            surface: (base_color: (0, 0, 0), emissive: (1, 1, 1))) }})",
        eye().ron(),
        CENTRE.x,
        CENTRE.y,
        width = 2.0 * HALF_WIDTH
    )
}

/// The part of a pixel that the square covers, by cutting the pixel with each of its sides.
pub(super) fn coverage(x: u32, y: u32) -> f64 {
    let size = 4.0 / f64::from(EDGE);
    let corner = DVec2::new(-2.0 + f64::from(x) * size, 2.0 - f64::from(y) * size);
    let mut polygon = [(0.0, 0.0), (1.0, 0.0), (1.0, -1.0), (0.0, -1.0)].map(|(u, v)| corner + DVec2::new(u, v) * size).to_vec();
    for side in 0..4 {
        let outwards = DVec2::from_angle(TURN.to_radians() + f64::from(side) * std::f64::consts::FRAC_PI_2);
        let beyond = |point: DVec2| (point - CENTRE).dot(outwards) - HALF_WIDTH;
        let mut inside = Vec::new();
        for (index, a) in polygon.iter().enumerate() {
            let b = polygon[(index + 1) % polygon.len()];
            let (from, to) = (beyond(*a), beyond(b));
            if from <= 0.0 {
                inside.push(*a);
            }
            if from.signum() != to.signum() {
                inside.push(a.lerp(b, from / (from - to)));
            }
        }
        polygon = inside;
        if polygon.is_empty() {
            return 0.0;
        }
    }
    let doubled: f64 = polygon.iter().zip(polygon.iter().cycle().skip(1)).map(|(a, b)| a.perp_dot(*b)).sum();
    doubled.abs() * 0.5 / (size * size)
}

/// Where an edge crosses a pixel, stratified points err by about n^(-3/4) / 3: measured 0.0134 in the root of the mean square with 64
/// samples, at most 0.038.
fn pixels_are_covered() -> Result<(), Failed> {
    for (samples, most, usual) in [(64, 0.045, 0.016), (256, 0.018, 0.006)] {
        let image = Shot::pbr(EDGE, &["radiance"]).set("samples", samples).one(&square())?;
        let (mut worst, mut sum, mut crossed) = (0.0f64, 0.0, 0);
        let mut area = [0.0; 2];
        for (x, y) in places(&image) {
            let (found, expected) = (texel(&image, x, y)[0], coverage(x, y));
            worst = worst.max((found - expected).abs());
            if expected > 0.0 && expected < 1.0 {
                sum += (found - expected).powi(2);
                crossed += 1;
            }
            area = [area[0] + found, area[1] + expected];
        }
        let mean = (sum / f64::from(crossed)).sqrt();
        println!("{samples} samples: {crossed} pixels on edges are off by {mean:.4}, the worst by {worst:.4}; areas {area:?}");
        near("the square's area", area[0], area[1], 0.002)?;
        if worst > most || mean > usual || crossed < 60 {
            return Err(format!("{samples} samples: {crossed} pixels on edges are off by {mean}, the worst by {worst}").into());
        }
    }
    Ok(())
}

fn one_sample_is_the_centre() -> Result<(), Failed> {
    let image = Shot::pbr(EDGE, &["radiance"]).one(&square())?;
    let size = 4.0 / f64::from(EDGE);
    for (x, y) in places(&image) {
        let centre = DVec2::new(-2.0 + (f64::from(x) + 0.5) * size, 2.0 - (f64::from(y) + 0.5) * size) - CENTRE;
        let turned = DVec2::from_angle(-TURN.to_radians()).rotate(centre).abs().max_element();
        let expected = if turned < HALF_WIDTH { 1.0 } else { 0.0 };
        // Within a hundredth of a pixel rounding decides.
        if (turned - HALF_WIDTH).abs() > 0.01 * size && texel(&image, x, y)[0] != expected {
            return Err(format!("{:?} at {x}, {y}, not {expected}", texel(&image, x, y)).into());
        }
    }
    Ok(())
}

/// A lamp, a sun and something blended.
fn lit() -> String {
    format!(
        "({} lights: {{ \"sun\": Directional(lux: 2, direction: (-1, -2, -1)), \"lamp\": Point(candela: 3, position: (1, 1.5, 1)) }},
        objects: {{ \"floor\": (shape: Plane(size: (4, 4)), rotation: (60, 0, 0), surface: (roughness: 0.5)),
            \"glass\": (shape: Plane(size: (1, 1)), rotation: (90, 0, 0), translation: (0, 0, 1), surface: (alpha: 0.4)) }})",
        eye().ron()
    )
}

fn a_sample_runs_what_the_shift_reaches() -> Result<(), Failed> {
    let shot = Shot::pbr(16, &["color"]).set("samples", 3);
    let mut session = shot.session(&mut world(&lit())?)?;
    let frames = settle(&mut session)?;
    let sample = ["supersample.jitter", "gbuffer", "light", "skybox.sky", "compose", "transparent", "supersample.gather", "display.expose"];
    let of_the_camera = |frame: &[String]| -> Vec<String> { frame.iter().filter(|pass| !pass.starts_with("previous")).cloned().collect() };
    // In the last one nothing is left to do but to remember the mean.
    let [first, second, third, _] = &frames[..] else { return Err(format!("{} frames", frames.len()).into()) };
    if !first.iter().any(|pass| pass.contains("shadow")) || of_the_camera(second) != sample || of_the_camera(third) != sample {
        return Err(format!("{frames:#?}").into());
    }
    // A light of another colour starts again, and draws no shadow map.
    session.update(&mut world(&lit().replace("candela: 3", "candela: 4"))?).map_err(shown)?;
    let again = settle(&mut session)?;
    if again.iter().take(3).map(|frame| of_the_camera(frame)).ne([sample; 3].map(|frame| frame.map(str::to_owned).to_vec())) {
        return Err(format!("{again:#?}").into());
    }
    Ok(())
}

fn exposure_takes_no_samples() -> Result<(), Failed> {
    let shot = Shot::pbr(16, &["color"]).set("samples", 3);
    let mut scene = world(&lit())?;
    let mut session = shot.session(&mut scene)?;
    settle(&mut session)?;
    session.reload(&mut scene, &shot.clone().set("exposure", 1).request()).map_err(shown)?;
    let frames = settle(&mut session)?;
    if frames == [["display.expose"]] { Ok(()) } else { Err(format!("{frames:#?}").into()) }
}
