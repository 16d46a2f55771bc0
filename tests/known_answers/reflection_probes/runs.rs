//! What runs after which change.

use std::collections::BTreeSet;

use bevy_ecs::component::{Component, Mutable};
use libtest_mimic::Failed;
use luminaire::scenes::world::{Camera, DirectionalLight, Environment, Exposure, LocalLight, World, find_by_name, set_translation};
use luminaire::session::Session;

use super::shot;
use crate::support::picture::{Eye, settle, shown, world};

/// A probe between things that stand eight metres away on each side. The lamp beside the probe reaches none of them.
fn scene() -> String {
    let sides = ["east", "west", "up", "down", "south", "north"];
    let places = ["8, 0, 0", "-8, 0, 0", "0, 8, 0", "0, -8, 0", "0, 0, 8", "0, 0, -8"];
    let objects: Vec<String> = sides
        .iter()
        .zip(places)
        .map(|(name, place)| format!("\"{name}\": (shape: Box(size: (2, 2, 2)), translation: ({place}), surface: (emissive: (1, 1, 1)))"))
        .collect();
    format!(
        "({} markers: {{ \"probe\": ReflectionProbe(position: (0, 0, 0), size: (20, 20, 20)) }},
        lights: {{ \"lamp\": Point(candela: 2, position: (1, 0, 0), range: 3) }},
        objects: {{ \"corner\": (shape: Box(size: (40, 0.1, 40)), translation: (0, -15, 0), surface: ()),
            \"pebble\": (shape: Box(size: (0.2, 0.2, 0.2)), translation: (1, 0, 1.5), surface: ()), {} }})",
        Eye::new([4.0, 4.0, 4.0], [0.0, 0.0, 0.0], 60.0).ron(),
        objects.join(",\n")
    )
}

/// The faces that ran in some frames.
fn faces(frames: &[Vec<String>]) -> BTreeSet<u32> {
    let face = |pass: &String| pass.strip_prefix("captured.faces[")?.split(']').next()?.parse().ok();
    frames.iter().flatten().filter_map(face).collect()
}

fn edit<C: Component<Mutability = Mutable>>(world: &mut World, name: &str, change: impl FnOnce(&mut C)) -> Result<(), Failed> {
    let entity = find_by_name(world, name).map_err(|problem| problem.message)?;
    change(&mut *world.get_mut::<C>(entity).ok_or("no such component")?);
    Ok(())
}

fn place(world: &mut World, name: &str, at: [f32; 3]) -> Result<(), Failed> {
    set_translation(world, name, at.into()).map_err(|problem| problem.message.into())
}

fn after(session: &mut Session, world: &mut World) -> Result<Vec<Vec<String>>, Failed> {
    session.update(world).map_err(shown)?;
    settle(session)
}

/// A change, and the faces that it runs.
type Change = (&'static str, fn(&mut World) -> Result<(), Failed>, &'static [u32]);

const OUTPUTS: &[&str] = &["radiance", "color"];

const ALL: &[u32] = &[0, 1, 2, 3, 4, 5];

const CHANGES: &[Change] = &[
    ("the camera", |world| place(world, "eye", [4.0, 3.0, 5.0]), &[]),
    ("the exposure", |world| edit(world, "eye", |camera: &mut Camera| camera.exposure = Exposure::Ev100(2.0)), &[]),
    ("a box in the east", |world| place(world, "east", [8.5, 0.5, 0.0]), &[0]),
    ("a box above that goes down in the south", |world| place(world, "up", [0.5, -1.0, 10.0]), &[2, 4]),
    ("a pebble in the light, which throws a shadow", |world| place(world, "pebble", [1.0, 0.0, 1.6]), ALL),
    ("a lamp that is dimmed", |world| edit(world, "lamp", |lamp: &mut LocalLight| lamp.intensity = 1.0), ALL),
    (
        "the sky",
        |world| {
            world.resource_mut::<Environment>().sky_radiance.x = 0.5;
            Ok(())
        },
        ALL,
    ),
    ("the probe", |world| place(world, "probe", [0.0, 0.1, 0.0]), ALL),
];

pub fn for_what_they_see() -> Result<(), Failed> {
    let mut world = world(&scene())?;
    let mut session = shot(32, 16, OUTPUTS).poisoned_session(&mut world)?;
    let first = faces(&settle(&mut session)?);
    if !first.iter().eq(ALL) {
        return Err(format!("at first {first:?}").into());
    }
    for (what, change, expected) in CHANGES {
        change(&mut world)?;
        let frames = after(&mut session, &mut world)?;
        let ran = faces(&frames);
        if !ran.iter().eq(*expected) || frames.is_empty() {
            return Err(format!("{what} ran the faces {ran:?}, not {expected:?}: {frames:?}").into());
        }
    }

    // The sun's shadows in cubes are not those of the camera's cascades.
    world.spawn((
        luminaire::scenes::world::Name::new("sun"),
        luminaire::scenes::world::Transform(glam::Affine3A::from_rotation_x(-1.0)),
        DirectionalLight { color: glam::Vec3::ONE, illuminance: 3.0 },
    ));
    session.follow(&mut world, &shot(32, 16, OUTPUTS).request()).map_err(shown)?;
    let sun_rises = settle(&mut session)?;
    place(&mut world, "eye", [3.0, 4.0, 5.0])?;
    let frames = after(&mut session, &mut world)?;
    let ran: Vec<&String> = frames.iter().flatten().collect();
    let captured = ran.iter().any(|pass| pass.starts_with("captured."));
    let cascades = ran.iter().any(|pass| pass.starts_with("sun_shadows."));
    if !faces(&sun_rises).iter().eq(ALL) || captured || !cascades {
        return Err(format!("below a sun a camera that moves ran {ran:?}").into());
    }
    is_fresh(&session, &mut world)
}

/// Whether the picture is, bit for bit, that of a session that starts with the world as it is.
fn is_fresh(session: &Session, world: &mut World) -> Result<(), Failed> {
    let mut fresh = shot(32, 16, OUTPUTS).session(world)?;
    settle(&mut fresh)?;
    for output in OUTPUTS {
        let image = |session: &Session| session.read_output(output).map_err(shown);
        if image(session)? != image(&fresh)? {
            return Err(format!("`{output}` is another picture in a fresh session").into());
        }
    }
    Ok(())
}

/// One face a frame, until all are new.
pub fn in_turns() -> Result<(), Failed> {
    let mut world = world(&scene())?;
    let mut session = shot(32, 16, OUTPUTS).set("faces_per_frame", 1).poisoned_session(&mut world)?;
    settle(&mut session)?;
    edit(&mut world, "lamp", |lamp: &mut LocalLight| lamp.intensity = 1.0)?;
    let frames = after(&mut session, &mut world)?;
    let each: Vec<BTreeSet<u32>> = frames.iter().map(|frame| faces(std::slice::from_ref(frame))).collect();
    if each.iter().any(|faces| faces.len() > 1) || !faces(&frames).iter().eq(ALL) {
        return Err(format!("frames ran the faces {each:?}").into());
    }
    is_fresh(&session, &mut world)
}
