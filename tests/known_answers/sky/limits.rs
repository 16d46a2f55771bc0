//! Where formulas could break: suns at the zenith, the nadir and the horizon, eyes on the ground and in the mountains, no sun at all.

use std::f64::consts::PI;

use libtest_mimic::Failed;

use super::{OUTSIDE, scene, shot};
use crate::support::picture::{Eye, Shot, near, places, shown, texel, world};

const SUNS: [f64; 14] = [90.0, 89.9999, 45.0, 0.3, 0.2666, 1e-5, 0.0, -1e-5, -0.2666, -1.25, -6.0, -18.0, -45.0, -90.0];

/// Finite and never negative, in the whole sphere; and darker the lower the sun stands.
pub fn finite() -> Result<(), Failed> {
    for (altitude, mie_scale) in [("0.0", "1.0"), ("2.0", "0.0"), ("2.0", "20.0"), ("10000.0", "1.0")] {
        let shot = shot(&["everywhere", "light", "transmittance", "scattering"]).set("altitude", altitude).set("mie_scale", mie_scale);
        let mut session = shot.poisoned_session(&mut world(&scene(SUNS[0], 30.0))?)?;
        let mut before = f64::INFINITY;
        for sun in SUNS {
            let place = format!("the sun at {sun}, the eye at {altitude} m, {mie_scale} of aerosols");
            session.update(&mut world(&scene(sun, 30.0))?).map_err(shown)?;
            session.render_frame().map_err(shown)?;
            for name in &shot.outputs {
                let image = session.read_output(name).map_err(shown)?;
                let wrong = |value: &&f32| !value.is_finite() || (name == "everywhere" && **value < 0.0);
                if let Some(wrong) = image.texels.iter().flatten().find(wrong) {
                    return Err(format!("`{name}` has {wrong} with {place}").into());
                }
            }
            // The sky's lux. Hazy air lets less come through from a low sun, and the zenith has no more of it than 45 degrees.
            let sky = texel(&session.read_output("light").map_err(shown)?, 1, 0)[1] * OUTSIDE;
            if sun < 45.0 && sky > before {
                return Err(format!("the sky sends {sky} lx, more than {before} lx with a higher sun, with {place}").into());
            }
            if sun == -45.0 && sky > 1e-3 {
                return Err(format!("{sky} lx by night with {place}").into());
            }
            before = sky;
        }
    }
    Ok(())
}

/// Mirrored about the plane through the sun and the zenith: with the sun in a column's plane, and between columns.
pub fn symmetric() -> Result<(), Failed> {
    for (sun, azimuth, pairs) in [(25.0, 0.0, vec![(4, 5), (6, 7)]), (25.0, 69.5, vec![(4, 6)]), (-3.0, 0.0, vec![(4, 5), (6, 7)])] {
        let image = shot(&["directions"]).one(&scene(sun, azimuth))?;
        for y in 0..image.height {
            for (a, b) in &pairs {
                for c in 0..3 {
                    // Measured: 2e-5, from the azimuths of 32-bit vectors.
                    near(&format!("row {y}, sun {azimuth}"), texel(&image, *a, y)[c], texel(&image, *b, y)[c], 1e-4)?;
                }
            }
        }
        let (left, right) = (texel(&image, 2, 8), texel(&image, 3, 8));
        if left == right {
            return Err("all azimuths are equal".into());
        }
    }
    Ok(())
}

/// What the sky's own pass adds around the sun, over all of its disc, is the sun's illuminance through the air.
pub fn disc() -> Result<(), Failed> {
    let eye = Eye::new([0.0, 2.0, 0.0], [1.0, 2.0 + 30f64.to_radians().tan(), 0.0], 1.0);
    let [x, y] = [-30f64.to_radians().cos(), -30f64.to_radians().sin()];
    let scene = format!("({} lights: {{ \"sun\": Directional(lux: {OUTSIDE}, direction: ({x:.9}, {y:.9}, 0)) }})", eye.ron());
    let image = Shot::of("pipelines/sky.ron", [128, 128], &["radiance"]).one(&scene)?;
    let illuminance = shot(&["illuminances"]).one(&scene)?;
    let around = texel(&image, 0, 0);
    let mut sum = [0.0; 3];
    for (x, y) in places(&image) {
        let cosine = 1.0 / eye.ray(&image, x, y).length();
        let solid_angle = (2.0 * 0.5f64.to_radians().tan() / 128.0).powi(2) * cosine.powi(3);
        let found = texel(&image, x, y);
        for c in 0..3 {
            sum[c] += (found[c] - around[c]) * solid_angle;
        }
    }
    // The sky itself is brighter near the sun than in the corner, by less than a thousandth of the sum.
    let expected = texel(&illuminance, 0, 0);
    println!("{sum:?} of {expected:?} lx; {:.0} nits in the middle", texel(&image, 64, 64)[1]);
    if texel(&image, 64, 64)[1] < 0.5 * OUTSIDE / (PI * 0.00466f64.powi(2)) {
        return Err("the disc is not where the sun stands".into());
    }
    (0..3).try_for_each(|c| near(&format!("channel {c}"), sum[c], expected[c], 0.01))
}

pub fn no_sun() -> Result<(), Failed> {
    let mut dark = world("(cameras: { \"eye\": (position: (0, 2, 0), target: (1, 2, 0)) })")?;
    let images = Shot::of("pipelines/sky.ron", [16, 16], &["radiance"]).take_world(&mut dark)?;
    if images["radiance"].texels.iter().all(|texel| texel[..3] == [0.0; 3]) { Ok(()) } else { Err("there is light without a sun".into()) }
}
