//! What the environment's cube, its diffuse light and its lobes hold of images whose light is known.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use libtest_mimic::Failed;
use luminaire::scenes::linear_image::LinearImage;
use luminaire::scenes::world::{SkyImage, SkyShape};

use super::{NO_SCENE, PARTS, Pictures, image, under};
use crate::support::picture::{Shot, near, places, settle, shown, texel};

/// Of the parts at a small size, where the size does not matter.
fn parts(outputs: &[&str]) -> Shot {
    Shot::of(PARTS, [64, 32], outputs).set("texels", 64)
}

pub fn constant() -> Result<(), Failed> {
    let mut world = under(image(64, |_| 0.7), SkyShape::Equirectangular, NO_SCENE)?;
    let shot = parts(&["radiance", "irradiance_sh", "irradiance_cube", "lobes"]);
    // Half floats on both sides: measured 0.0002. The nearest numbers of six and five digits are off by 0.0045; cut off they were by 0.018.
    for (format, most) in [("rgba16float", 0.0005), ("rg11b10ufloat", 0.005)] {
        for (name, image) in shot.clone().set("format", format).take_world(&mut world)? {
            for (x, y) in places(&image) {
                for (channel, expected) in [0.7, 0.35, 1.4].into_iter().enumerate() {
                    near(&format!("{name} of {format} at {x}, {y}"), texel(&image, x, y)[channel], expected, most)?;
                }
            }
        }
    }
    Ok(())
}

/// Of max(0, y): pi/4 + pi/3 c + 5 pi/64 (3 c^2 - 1) / 2.
pub fn clamped_cosine() -> Result<(), Failed> {
    let mut world = under(image(1024, |direction| direction.y.max(0.0) as f32), SkyShape::Equirectangular, NO_SCENE)?;
    let shot = Shot::of(PARTS, [64, 32], &["irradiance_sh", "irradiance_cube"]);
    let images = shot.take_world(&mut world)?;
    let (mut worst, mut apart) = (0.0f64, 0.0f64);
    for (x, y) in places(&images["irradiance_sh"]) {
        let c = ((f64::from(y) + 0.5) / 32.0 * PI).cos();
        let expected = PI / 4.0 + PI / 3.0 * c + 5.0 * PI / 64.0 * (3.0 * c * c - 1.0) / 2.0;
        worst = worst.max((PI * texel(&images["irradiance_sh"], x, y)[0] - expected.max(0.0)).abs());
        apart = apart.max((PI * texel(&images["irradiance_cube"], x, y)[0] - convolved_cosine(c)).abs());
    }
    // Measured: 0.00001, and 0.0082 by the texels of the convolved cube.
    println!("worst error {worst:.6} of the coefficients, {apart:.6} of the cube");
    if worst < 1e-4 && apart < 0.01 { Ok(()) } else { Err(format!("{worst}, {apart}").into()) }
}

/// Irradiance under max(0, y) on a surface whose normal has this cosine to +Y, by a sum over directions.
fn convolved_cosine(c: f64) -> f64 {
    let (s, rings, spokes) = ((1.0 - c * c).sqrt(), 200, 200);
    let part = |index: u32, count: u32| (f64::from(index) + 0.5) / f64::from(count);
    (0..rings * spokes)
        .map(|i| {
            let (y, around) = (part(i / spokes, rings), part(i % spokes, spokes) * 2.0 * PI);
            let level = (1.0 - y * y).sqrt();
            y * (c * y + s * level * around.cos()).max(0.0)
        })
        .sum::<f64>()
        * 2.0
        * PI
        / f64::from(rings * spokes)
}

/// Of the sines of the angles from the pole that a row's tent covers, by its height there; the outermost rows go on to the poles.
fn height_integral(row: u32, height: u32) -> f64 {
    let steps = 2000;
    (0..steps)
        .map(|step| {
            let down = (f64::from(step) + 0.5) / f64::from(steps);
            let at = (down * f64::from(height) - 0.5).clamp(0.0, f64::from(height - 1));
            (1.0 - (at - f64::from(row)).abs()).max(0.0) * (down * PI).sin() * PI / f64::from(steps)
        })
        .sum()
}

/// The light of all directions, from the first coefficient.
fn flux(images: &Pictures) -> f64 {
    texel(&images["coefficients"], 0, 0)[0] * (4.0 * PI).sqrt()
}

pub fn one_bright_texel() -> Result<(), Failed> {
    let (width, height) = (128u32, 64u32);
    let mut world = under(image(width, |_| 0.0), SkyShape::Equirectangular, NO_SCENE)?;
    let mut session = Shot::of(PARTS, [64, 32], &["coefficients"]).session(&mut world)?;
    let mut worst = 0.0f64;
    for index in 0..64u32 {
        // Columns and rows by turns. Next to the poles a texel is a wedge that is thinner than those of the cube.
        let (x, y) = (index * 37 % width, 3 + index * 57 / 63);
        let mut sky = image(width, |_| 0.0);
        sky.texels[(y * width + x) as usize] = [60_000.0, 0.0, 0.0, 1.0];
        world.resource_mut::<SkyImage>().image = Arc::new(sky);
        session.update(&mut world).map_err(shown)?;
        settle(&mut session)?;
        let images = [("coefficients".to_owned(), session.read_output("coefficients").map_err(shown)?)].into_iter().collect();
        let expected = 60_000.0 * 2.0 * PI / f64::from(width) * height_integral(y, height);
        let error = (flux(&images) / expected - 1.0).abs();
        worst = worst.max(error);
        if error > 0.01 {
            return Err(format!("the light of texel {x}, {y} is off by {error}").into());
        }
    }
    println!("worst {worst:.5} of its light");
    Ok(())
}

/// A cube of directions, and the same as an equirectangular image.
pub fn six_faces() -> Result<(), Failed> {
    let of = |d: DVec3| (0.5 + 0.3 * d.x + 0.15 * d.y - 0.2 * d.z + 0.1 * d.x * d.z) as f32;
    let edge = 64u32;
    // As WebGPU has faces: right, down and outwards of each.
    let frames = [
        (DVec3::NEG_Z, DVec3::NEG_Y, DVec3::X),
        (DVec3::Z, DVec3::NEG_Y, DVec3::NEG_X),
        (DVec3::X, DVec3::Z, DVec3::Y),
        (DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y),
        (DVec3::X, DVec3::NEG_Y, DVec3::Z),
        (DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z),
    ];
    let faces = LinearImage {
        width: 2 * edge,
        height: 3 * edge,
        texels: (0..3 * edge)
            .flat_map(|y| (0..2 * edge).map(move |x| (x, y)))
            .map(|(x, y)| {
                let (right, down, out) = frames[(2 * (y / edge) + x / edge) as usize];
                let place = |at: u32| (f64::from(at % edge) + 0.5) * 2.0 / f64::from(edge) - 1.0;
                let value = of((out + right * place(x) + down * place(y)).normalize());
                [value, 0.5 * value, 2.0 * value, 1.0]
            })
            .collect(),
    };
    let shot = parts(&["radiance", "irradiance_sh"]);
    let one = shot.take_world(&mut under(image(512, of), SkyShape::Equirectangular, NO_SCENE)?)?;
    let six = shot.take_world(&mut under(faces, SkyShape::Faces, NO_SCENE)?)?;
    for (name, image) in &one {
        // Measured: 0.0006 of the radiance, by the bends of bilinear filters.
        places(image)
            .try_for_each(|(x, y)| near(&format!("{name} at {x}, {y}"), texel(&six[name], x, y)[0], texel(image, x, y)[0], 0.003))?;
    }
    Ok(())
}
