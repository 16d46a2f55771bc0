//! Images as sky: which direction shows which texel, what adds up, and what a change runs.

use std::f64::consts::PI;
use std::path::Path;

use glam::{DQuat, DVec3};
use libtest_mimic::Failed;
use luminaire::scenes::world::SkyImage;
use luminaire::session::load_scene;

use crate::Case;
use crate::support::picture::{Eye, Shot, places, settle, shown, texel};

pub const CASES: &[Case] = &[
    ("sky_image::directions show what the image has there", directions),
    ("sky_image::strength and the constant sky add up behind things alone", adds_up),
    ("sky_image::another turn runs the sky and no surface", changes),
];

/// Half of each direction and a half, in an equirectangular image.
fn write_directions(path: &Path) -> Result<(), Failed> {
    let (width, height) = (256, 128);
    let image = image::Rgb32FImage::from_fn(width, height, |x, y| {
        let (u, v) = ((f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height));
        let (around, down) = ((u - 0.5) * 2.0 * PI, v * PI);
        let direction = DVec3::new(down.sin() * around.cos(), down.cos(), down.sin() * around.sin());
        image::Rgb((direction * 0.5 + 0.5).as_vec3().to_array())
    });
    Ok(image.save(path)?)
}

/// The scene beside an image of directions.
fn scene(folder: &Path, text: &str) -> Result<luminaire::scenes::World, Failed> {
    write_directions(&folder.join("directions.exr"))?;
    std::fs::write(folder.join("scene.ron"), text)?;
    let loaded = load_scene(&folder.join("scene.ron").display().to_string(), None).map_err(shown)?;
    if loaded.diagnostics.is_empty() { Ok(loaded.world) } else { Err(format!("{:?}", loaded.diagnostics).into()) }
}

fn directions() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let mut worst = 0.0_f64;
    // The axes, the seam at -X among them, the horizon between, and both poles.
    let targets =
        [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [-1.0, 0.4, 0.05], [0.05, 1.0, 0.0], [0.0, -1.0, 0.05]];
    for (target, turn) in targets.into_iter().map(|target| (target, 0.0)).chain([([-1.0, 0.0, 0.0], 90.0), ([0.3, 0.2, 1.0], -30.0)]) {
        let eye = Eye::new([0.0; 3], target, 70.0);
        let text = format!("({} environment: (image: \"directions.exr\", rotation: {turn}))", eye.ron());
        let images = Shot::pbr(48, &["radiance"]).take_world(&mut scene(folder.path(), &text)?)?;
        let image = &images["radiance"];
        // The sky turns about +Y, counter-clockwise from above.
        let back = DQuat::from_rotation_y(-f64::to_radians(turn));
        for (x, y) in places(image) {
            let expected = back * eye.ray(image, x, y).normalize() * 0.5 + 0.5;
            let found = texel(image, x, y);
            let apart = (DVec3::new(found[0], found[1], found[2]) - expected).abs().max_element();
            worst = worst.max(apart);
            // The outermost rows end half a texel short of the poles: sin(pi / 256) / 2 = 0.0061. Half floats: 0.0005.
            if apart > 0.002 {
                return Err(format!("towards {target:?}, turned by {turn}: {found:?} at {x}, {y}, not {expected}").into());
            }
        }
    }
    println!("worst difference {worst:.5}");
    Ok(())
}

fn adds_up() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let eye = Eye::new([0.0, 0.0, 2.0], [0.0, 0.0, 0.0], 60.0);
    let text = format!(
        "({} objects: {{ \"ball\": (shape: Sphere(radius: 0.4), surface: (base_color: (1, 1, 1))) }},
        environment: (sky_radiance: (1, 2, 3), image: \"directions.exr\", strength: 4))",
        eye.ron()
    );
    let images = Shot::pbr(32, &["radiance"]).take_world(&mut scene(folder.path(), &text)?)?;
    let image = &images["radiance"];
    let ball = texel(image, 16, 16);
    let corner = texel(image, 0, 0);
    let expected = (eye.ray(image, 0, 0).normalize() * 0.5 + 0.5) * 4.0 + DVec3::new(1.0, 2.0, 3.0);
    let apart = (DVec3::new(corner[0], corner[1], corner[2]) / expected - 1.0).abs().max_element();
    if ball[..3] != [0.0; 3] || apart > 0.003 {
        return Err(format!("the ball {ball:?}, the corner {corner:?} and not {expected}").into());
    }
    Ok(())
}

fn changes() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let eye = Eye::new([0.0, 0.0, 2.0], [0.0, 0.0, 0.0], 60.0);
    let text = format!(
        "({} objects: {{ \"ball\": (shape: Sphere(radius: 0.4), surface: (base_color: (1, 1, 1))) }},
        environment: (image: \"directions.exr\"))",
        eye.ron()
    );
    let mut world = scene(folder.path(), &text)?;
    let mut session = Shot::pbr(16, &["color"]).session(&mut world)?;
    settle(&mut session)?;
    let mut run = |world: &mut luminaire::scenes::World| -> Result<Vec<String>, Failed> {
        session.update(world).map_err(shown)?;
        Ok(settle(&mut session)?.concat())
    };
    if let ran @ [_, ..] = &run(&mut world)?[..] {
        return Err(format!("nothing changed, and {ran:?} ran").into());
    }
    let turned = |world: &mut luminaire::scenes::World| world.resource_mut::<SkyImage>().rotation = 1.0;
    turned(&mut world);
    let expected = ["skybox.sky", "compose", "display.expose"];
    let others = ["gbuffer", "shadows"];
    for what in ["a turn", "another image"] {
        let ran = run(&mut world)?;
        if !expected.iter().all(|pass| ran.iter().any(|ran| ran == pass))
            || ran.iter().any(|pass| others.iter().any(|other| pass.contains(other)))
        {
            return Err(format!("{what} ran {ran:?}").into());
        }
        let mut image = (*world.resource::<SkyImage>().image).clone();
        image.texels.iter_mut().for_each(|texel| *texel = [0.25, 0.5, 0.75, 1.0]);
        world.resource_mut::<SkyImage>().image = image.into();
    }
    Ok(())
}
