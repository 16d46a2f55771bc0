//! Cascades: in motion, at their seams, and where they end.

use glam::DVec3;
use libtest_mimic::Failed;

use super::shot;
use crate::support::picture::{Eye, Series, Shot, places, texel};

/// Pixels across the image, metres across a pixel, steps of the camera.
const EDGE: u32 = 128;
const PIXEL: f64 = 0.0173;
const STEPS: u32 = 32;

/// The flicker under a camera that moves by one pixel in each of 32 steps, less than a texel of the map: for every place of the floor that
/// all images show, the standard deviation of its light over the mean; of all places, the 95th percentile. The camera is orthographic, so
/// that the same places fall on pixels' centres again.
fn flicker(shot: &Shot) -> Result<f64, Failed> {
    let (mut images, mut series) = (Vec::new(), Series::default());
    for step in 0..=STEPS {
        let x = f64::from(step) * PIXEL;
        let scene = format!(
            "(cameras: {{ \"eye\": (position: ({x}, 0.6, 0.05), target: ({x}, 0, 0), ortho: {}, near: 0.01, far: 1.5) }},
            lights: {{ \"sun\": Directional(lux: 5, direction: (-0.5, -1, -0.35)) }},
            objects: {{
                \"floor\": (shape: Plane(size: (60, 60)), surface: (specular: 0)),
                \"bars\": (shape: Box(size: (0.1, 0.1, 30)), surface: (specular: 0), translation: (0, 1.6, 0), repeat: (count: (80, 1, 1), spacing: (0.25, 1, 1))) }})",
            f64::from(EDGE) * PIXEL
        );
        images.push(series.one(shot, &scene)?);
    }
    let shown = |image: usize, x: u32, y: u32| texel(&images[image], x, y)[0];
    let mut spreads = Vec::new();
    for y in 0..EDGE {
        for x in STEPS..EDGE {
            let light: Vec<f64> = (0..=STEPS).map(|step| shown(step as usize, x - step, y)).collect();
            let mean = light.iter().sum::<f64>() / light.len() as f64;
            let variance = light.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / light.len() as f64;
            spreads.push(if mean > 0.0 { variance.sqrt() / mean } else { 0.0 });
        }
    }
    spreads.sort_unstable_by(f64::total_cmp);
    Ok(spreads[spreads.len() * 95 / 100])
}

/// With maps that move by whole texels nothing flickers, with maps that follow the camera edges do.
pub fn stand_still() -> Result<(), Failed> {
    let shot = shot(EDGE, &["radiance"]).set("sun_shadow_texels", 128).set("shadow_cascades", 2);
    let (snapped, free) = (flicker(&shot)?, flicker(&shot.clone().set("snap", false))?);
    println!("flicker in motion: {:.3} % with whole texels, {:.1} % without", snapped * 100.0, free * 100.0);
    if snapped <= 0.01 && free > 0.05 { Ok(()) } else { Err(format!("{snapped} with whole texels, {free} without").into()) }
}

/// How wide bars are and how far apart, metres.
const BAR: f64 = 0.12;
const PERIOD: f64 = 0.4;

/// Bars run away from the camera above it, the sun stands in the zenith: along any line across, the same part of the floor is lit, whichever
/// cascade shadows it. With every cascade the mean over whole periods is that, and it makes no step from row to row.
pub fn have_no_seams() -> Result<(), Failed> {
    let eye = Eye::new([0.2, 1.5, 0.0], [0.2, 0.6, -8.0], 50.0);
    let scene = format!(
        "({} lights: {{ \"sun\": Directional(lux: 5, direction: (0, -1, 0)) }}, objects: {{
            \"floor\": (shape: Plane(size: (160, 160)), surface: (specular: 0)),
            \"bars\": (shape: Box(size: ({BAR}, 0.1, 160)), surface: (specular: 0), translation: (0, 2.5, 0), repeat: (count: (201, 1, 1), spacing: ({PERIOD}, 1, 1))) }})",
        eye.ron()
    );
    for filter in ["plane", "pcf3"] {
        let shot = shot(256, &["visibility", "cascades"]).set("shadow_filter", filter).set("shadow_distance", 40);
        let images = shot.set("sun_shadow_texels", 1024).take(&scene)?;
        let (visibility, cascades) = (&images["visibility"], &images["cascades"]);
        let (mut rows, mut worst, mut step, mut last): (u32, f64, f64, Option<f64>) = (0, 0.0, 0.0, None);
        let mut colors: Vec<[i64; 3]> = Vec::new();
        for y in 0..256 {
            let across = |x: u32| eye.on_plane(visibility, (x, y), DVec3::ZERO, DVec3::Y);
            let (Some(left), Some(right)) = (across(0), across(255)) else { continue };
            // Up to where shadows begin to fade, and a period is five pixels or more.
            if -left.z > 35.0 || (right.x - left.x) / 255.0 > PERIOD / 5.0 {
                continue;
            }
            // Whole periods around the middle, pixels at both ends in part.
            let half = (((right.x - left.x) / 2.0 / PERIOD).floor() * PERIOD).max(PERIOD);
            let middle = 0.5 * (left.x + right.x);
            let pixel = (right.x - left.x) / 255.0;
            let (mut sum, mut weight) = (0.0, 0.0);
            for x in 0..256 {
                let at = left.x + pixel * f64::from(x);
                let inside = ((half - (at - middle).abs()) / pixel + 0.5).clamp(0.0, 1.0);
                (sum, weight) = (sum + inside * texel(visibility, x, y)[0], weight + inside);
            }
            let lit = sum / weight;
            worst = worst.max((lit - (1.0 - BAR / PERIOD)).abs());
            step = step.max(last.map_or(0.0, |last: f64| (lit - last).abs()));
            last = Some(lit);
            rows += 1;
            let [r, g, b, _] = texel(cascades, 128, y);
            let most = r.max(g).max(b);
            let color = [r, g, b].map(|part| (part / most * 4.0).round() as i64);
            if !colors.contains(&color) {
                colors.push(color);
            }
        }
        println!("{filter}: {rows} rows, off by {worst:.4}, steps of {step:.4}, {} colours of cascades", colors.len());
        if rows < 60 || worst > 0.03 || step > 0.03 || colors.len() < 3 {
            return Err(format!("{filter}: {rows} rows, off by {worst}, steps of {step}, {colors:?}").into());
        }
    }
    Ok(())
}

/// Shadows are whole up to nine tenths of the greatest distance, and gone beyond it.
pub fn end_at_the_distance() -> Result<(), Failed> {
    let eye = Eye::new([0.0, 2.0, 0.0], [0.0, 1.0, -8.0], 60.0);
    let scene = format!(
        "({} lights: {{ \"sun\": Directional(lux: 5, direction: (0, -1, 0)) }}, objects: {{
            \"floor\": (shape: Plane(size: (200, 200)), surface: (specular: 0)),
            \"roof\": (shape: Box(size: (200, 0.1, 200)), surface: (specular: 0), translation: (0, 6, 0)) }})",
        eye.ron()
    );
    let image = shot(128, &["visibility"]).set("shadow_distance", 20).one(&scene)?;
    let forward = (eye.target - eye.position).normalize();
    let mut count = [0; 3];
    for place in places(&image) {
        let Some(point) = eye.on_plane(&image, place, DVec3::ZERO, DVec3::Y) else { continue };
        let along = (point - eye.position).dot(forward);
        if point.x.abs().max(point.z.abs()) > 95.0 {
            continue;
        }
        let (part, expected) = match along {
            along if along < 17.9 => (0, 0.0),
            along if along > 20.1 => (2, 1.0),
            along => (1, ((along - 18.0) / 2.0).clamp(0.0, 1.0)),
        };
        count[part] += 1;
        let found = texel(&image, place.0, place.1)[0];
        if (found - expected).abs() > 0.002 {
            return Err(format!("{found} at {along} m, and not {expected}").into());
        }
    }
    println!("{count:?} pixels before, in and beyond the end");
    if count.iter().all(|count| *count > 50) { Ok(()) } else { Err(format!("{count:?}").into()) }
}
