//! What a change of the scene runs, for `pbr`: a table of changes of one world, made one after the other.
//!
//! Two lamps stand twenty metres apart and reach three metres. A box stands below each and is seen by the face that looks down (3),
//! another one between them out of reach, and a blended one below the first lamp.

use std::collections::BTreeSet;

use glam::Vec3;
use libtest_mimic::Failed;
use luminaire::scenes::world::{LocalLight, World, find_by_name, set_translation};

use crate::Case;
use crate::support::picture::{Shot, shown, world};

pub const CASES: &[Case] = &[("changes::run what they reach", run_what_they_reach)];

const SCENE: &str = "(
    environment: (sky_radiance: (0.5, 0.5, 0.5)),
    materials: { \"grey\": (base_color: (0.5, 0.5, 0.5)), \"glass\": (alpha: 0.5) },
    cameras: { \"eye\": (position: (0, 1, 14), target: (0, 0, 0)) },
    lights: {
        \"first\": Point(candela: 20, position: (-10, 2, 0), range: 3),
        \"second\": Point(candela: 20, position: (10, 2, 0), range: 3),
    },
    objects: {
        \"below first\": (shape: Box(size: (1, 1, 1)), material: \"grey\", translation: (-10, 0, 0)),
        \"below second\": (shape: Box(size: (1, 1, 1)), material: \"grey\", translation: (10, 0, 0)),
        \"between\": (shape: Box(size: (1, 1, 1)), material: \"grey\"),
        \"pane\": (shape: Box(size: (0.5, 0.1, 0.5)), material: \"glass\", translation: (-10, 0.9, 0)),
    },
)";

/// What is changed, how, the faces whose maps are drawn again (six to a lamp), and whether the camera's surfaces are.
type Change = (&'static str, fn(&mut World) -> Result<(), Failed>, &'static [u32], bool);

const CHANGES: &[Change] = &[
    ("nothing", |_| Ok(()), &[], false),
    ("the same place once more", |world| place(world, "between", Vec3::ZERO), &[], false),
    ("a box that a lamp reaches", |world| place(world, "below first", Vec3::new(-10.1, 0.0, 0.0)), &[3], true),
    ("a box that no lamp reaches", |world| place(world, "between", Vec3::X), &[], true),
    ("something that throws no shadow", |world| place(world, "pane", Vec3::new(-10.1, 0.9, 0.0)), &[], false),
    ("the camera", |world| place(world, "eye", Vec3::new(0.0, 1.0, 13.0)), &[], true),
    ("the strength of a lamp", |world| brighten(world, "second"), &[], false),
    ("a lamp", |world| place(world, "second", Vec3::new(10.0, 2.1, 0.0)), &[6, 7, 8, 9, 10, 11], false),
    ("a box out of a lamp's reach", |world| place(world, "below second", Vec3::new(10.0, 0.0, -9.0)), &[9], true),
    ("a box into another one's", |world| place(world, "below second", Vec3::new(-10.0, 0.0, 0.8)), &[3], true),
    ("a lamp that is taken away", |world| take_away(world, "first"), &[0, 1, 2, 3, 4, 5], false),
    ("a box that is taken away", |world| take_away(world, "between"), &[], true),
];

fn place(world: &mut World, name: &str, at: Vec3) -> Result<(), Failed> {
    set_translation(world, name, at).map_err(|problem| problem.message.into())
}

fn brighten(world: &mut World, name: &str) -> Result<(), Failed> {
    let entity = find_by_name(world, name).map_err(|problem| problem.message)?;
    world.get_mut::<LocalLight>(entity).ok_or("no lamp")?.intensity *= 2.0;
    Ok(())
}

fn take_away(world: &mut World, name: &str) -> Result<(), Failed> {
    let entity = find_by_name(world, name).map_err(|problem| problem.message)?;
    world.despawn(entity);
    Ok(())
}

fn run_what_they_reach() -> Result<(), Failed> {
    let mut world = world(SCENE)?;
    let mut session = Shot::pbr(48, &["color"]).poisoned_session(&mut world)?;
    while !session.render_frame().map_err(shown)?.settled {}
    for (what, change, faces, surfaces) in CHANGES {
        change(&mut world)?;
        session.update(&mut world).map_err(shown)?;
        session.render_frame().map_err(shown)?;
        let ran = session.ran();
        let face = |pass: &&str| pass.strip_prefix("shadows.local[")?.split_once(']')?.0.parse::<u32>().ok();
        let drawn: BTreeSet<u32> = ran.iter().filter_map(face).collect();
        if drawn != faces.iter().copied().collect() || ran.contains(&"gbuffer") != *surfaces {
            return Err(format!("{what}: ran {ran:?}; expected the faces {faces:?}, and the surfaces: {surfaces}").into());
        }
        if ran.is_empty() != matches!(*what, "nothing" | "the same place once more") {
            return Err(format!("{what}: ran {ran:?}").into());
        }
    }
    Ok(())
}
