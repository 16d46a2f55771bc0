//! What runs when the sky, its turn, its strength or the camera changes, and what a day runs.

use std::collections::BTreeSet;
use std::sync::Arc;

use libtest_mimic::Failed;
use luminaire::scenes::world::{SkyImage, SkyShape};
use luminaire::session::Session;

use super::{IBL, image, under};
use crate::support::picture::{Eye, Shot, settle, shown, world};

const BALL: &str = "objects: { \"ball\": (shape: Sphere(radius: 0.5), surface: (roughness: 0.4)) }";
/// What puts indirect light and direct light together, and makes a picture of both.
const FOLLOWS: [&str; 3] = ["no_indirect", "compose", "display"];
/// The sky is seen behind things, too, where it is drawn over direct light.
const BEHIND: [&str; 2] = ["light", "skybox"];

/// The blocks and passes that run until nothing changes any more, by the first word of their names.
fn ran(session: &mut Session) -> Result<BTreeSet<String>, Failed> {
    let first_word = |pass: &String| pass.split(['.', '[']).next().unwrap_or_default().to_owned();
    Ok(settle(session)?.concat().iter().map(first_word).collect())
}

fn check(what: &str, found: &BTreeSet<String>, expected: &[&[&str]]) -> Result<(), Failed> {
    let expected: BTreeSet<String> = expected.concat().into_iter().map(str::to_owned).collect();
    if *found == expected { Ok(()) } else { Err(format!("{what} ran {found:?} and not {expected:?}").into()) }
}

pub fn changes() -> Result<(), Failed> {
    let eye = |x: f64| Eye::new([x, 0.0, 3.0], [0.0, 0.0, 0.0], 40.0);
    let scene = |eye: &Eye| format!("({} {BALL})", eye.ron());
    let sky = image(64, |direction| 1.0 + direction.y as f32);
    let mut world = under(sky.clone(), SkyShape::Equirectangular, &scene(&eye(0.0)))?;
    let shot = Shot::of(IBL, [32, 32], &["color"]).set("environment_texels", 16).set("occlusion", "none");
    let mut session = shot.session(&mut world)?;
    let first = ran(&mut session)?;
    for part in ["environment", "irradiance", "prefilter", "brdf_lut", "ibl_resolve", "gbuffer", "light"] {
        if !first.contains(part) {
            return Err(format!("at first: {part} is not among {first:?}").into());
        }
    }
    world.resource_mut::<SkyImage>().rotation = 1.0;
    session.update(&mut world).map_err(shown)?;
    check("a turn", &ran(&mut session)?, &[&["ibl_resolve"], &BEHIND, &FOLLOWS])?;
    world.resource_mut::<SkyImage>().strength = 2.0;
    session.update(&mut world).map_err(shown)?;
    check("another strength", &ran(&mut session)?, &[&["ibl_resolve"], &BEHIND, &FOLLOWS])?;
    let mut other = sky;
    other.texels.iter_mut().for_each(|texel| texel[0] *= 0.5);
    world.resource_mut::<SkyImage>().image = Arc::new(other);
    session.update(&mut world).map_err(shown)?;
    check("another image", &ran(&mut session)?, &[&["environment", "irradiance", "prefilter", "ibl_resolve"], &BEHIND, &FOLLOWS])?;
    let sky = world.remove_resource::<SkyImage>().ok_or("no sky")?;
    let mut moved = under((*sky.image).clone(), sky.shape, &scene(&eye(0.2)))?;
    moved.insert_resource(sky);
    session.update(&mut moved).map_err(shown)?;
    check("another camera", &ran(&mut session)?, &[&["gbuffer", "ibl_resolve"], &BEHIND, &FOLLOWS])?;
    // Nothing else was in the way of the pictures: they are those of a session that starts there.
    let kept = session.read_output("color").map_err(shown)?;
    let fresh = shot.take_world(&mut moved)?;
    if kept == fresh["color"] { Ok(()) } else { Err("the picture is not that of a new session".into()) }
}

/// The physical sky at several heights of the sun: a change runs the sky, what it lights and the sun's own light. Spread over frames it ends
/// with the same picture.
pub fn day() -> Result<(), Failed> {
    let scene = |height: f64| {
        let (sine, cosine) = height.to_radians().sin_cos();
        let eye = Eye::new([0.0, 0.5, 3.0], [0.0, 0.0, 0.0], 40.0).ron();
        world(&format!("({eye} lights: {{ \"sun\": Directional(lux: 100000, direction: ({}, {}, 0)) }}, {BALL})", -cosine, -sine))
    };
    let at_once = Shot::of(IBL, [32, 32], &["color"])
        .set("sky", "physical")
        .set("environment_texels", 16)
        .set("occlusion", "none")
        .set("sun_shadow_texels", 64);
    let spread = at_once.clone().set("environment_faces_per_frame", 1).set("lobes_per_frame", 8);
    let (mut whole, mut parts) = (at_once.session(&mut scene(50.0)?)?, spread.session(&mut scene(50.0)?)?);
    settle(&mut whole)?;
    settle(&mut parts)?;
    for height in [49.0, 10.0, -2.0] {
        whole.update(&mut scene(height)?).map_err(shown)?;
        let sun = ["air", "physical_sky", "light", "sun_shadows"];
        check(
            &format!("the sun at {height}"),
            &ran(&mut whole)?,
            &[&sun, &["environment", "irradiance", "prefilter", "ibl_resolve"], &FOLLOWS],
        )?;
        parts.update(&mut scene(height)?).map_err(shown)?;
        let frames = settle(&mut parts)?;
        let most = |part: &str| frames.iter().map(|ran| ran.iter().filter(|pass| pass.starts_with(part)).count()).max();
        // A face of the environment is one pass and one for each of its four other levels.
        if most("environment.faces") != Some(5) || most("prefilter.lobes") != Some(8) {
            return Err(format!("in a frame ran {:?} and {:?}", most("environment.faces"), most("prefilter.lobes")).into());
        }
        let [at_once, spread] = [&whole, &parts].map(|session| session.read_output("color").map_err(shown));
        if at_once? != spread? {
            return Err(format!("with the sun at {height} what is spread over frames is another picture").into());
        }
    }
    Ok(())
}
