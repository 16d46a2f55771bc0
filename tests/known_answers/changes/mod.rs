//! What a change of the scene changes of what is published, and what that runs, for `pbr`.
//!
//! Each table makes changes of one world, one after the other; the text beside it tells for every one the published parts that are
//! other than before, and the passes that ran. `LUMINAIRE_ACCEPT=1` writes these texts anew: read every line before you keep it.

mod eight_lamps;
mod kinds;
mod parts;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use bevy_ecs::component::{Component, Mutable};
use libtest_mimic::Failed;
use luminaire::scenes::world::{World, find_by_name, set_translation};

use crate::Case;
use crate::support::picture::{Shot, shown, world};
use parts::changed_parts;

pub const CASES: &[Case] = &[
    ("changes::each kind of change runs what it reaches", kinds::run_what_they_reach),
    ("changes::one of eight lamps", eight_lamps::are_each_for_themselves),
];

/// A change, and what it does.
type Change = (&'static str, fn(&mut World) -> Result<(), Failed>);

/// Makes the changes of a scene's world, renders after each, and compares what happened with the text of that name.
fn check(name: &str, scene: &str, prepare: fn(&mut World), changes: &[Change]) -> Result<(), Failed> {
    let mut world = world(scene)?;
    prepare(&mut world);
    let shot = Shot::pbr(48, &["color"]).set("shadowed_point_lights", 8).set("local_shadow_texels", 32).set("sun_shadow_texels", 64);
    let mut session = shot.poisoned_session(&mut world)?;
    while !session.render_frame().map_err(shown)?.settled {}
    let mut text = String::new();
    for (what, change) in changes {
        let before = session.scene();
        change(&mut world)?;
        session.follow(&mut world, &shot.request()).map_err(shown)?;
        session.render_frame().map_err(shown)?;
        let parts = changed_parts(session.plan(), &before, &session.scene());
        let list = |items: Vec<String>| if items.is_empty() { "nothing".to_owned() } else { items.join(", ") };
        let _ = writeln!(text, "{what}\n    changes {}\n    runs {}\n", list(parts), list(passes(&session.ran())));
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/known_answers/changes").join(name);
    if std::env::var_os("LUMINAIRE_ACCEPT").is_some() {
        std::fs::write(&path, &text).map_err(|error| error.to_string())?;
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    if text == expected { Ok(()) } else { Err(format!("{} differs (LUMINAIRE_ACCEPT=1 accepts it):\n{text}", path.display()).into()) }
}

/// Names of passes; the maps of a light together: `shadows of lamp 1 (0 1 2 3 4 5)` are the faces of its cube, `shadows of sun 0 (0 1 2)`
/// its cascades.
fn passes(ran: &[&str]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let mut maps: BTreeMap<(&str, u32), BTreeSet<u32>> = BTreeMap::new();
    for pass in ran {
        let numbers: Vec<u32> = pass.split(['[', ']']).filter_map(|part| part.parse().ok()).collect();
        let map = match (pass.split('.').next(), numbers.as_slice()) {
            (Some("point_shadows"), [face]) => Some((("lamp", face / 6), face % 6)),
            (Some("spot_shadows"), [spot]) => Some((("spot", *spot), 0)),
            (Some("rectangle_shadows"), [face]) => Some((("rectangle", face / 6), face % 6)),
            (Some("sun_shadows"), [sun, cascade]) => Some((("sun", *sun), *cascade)),
            _ => None,
        };
        match map {
            None => names.push((*pass).to_owned()),
            Some((light, map)) => _ = maps.entry(light).or_default().insert(map),
        }
    }
    let of_light = |((kind, light), maps): ((&str, u32), BTreeSet<u32>)| {
        format!("shadows of {kind} {light} ({})", maps.iter().map(u32::to_string).collect::<Vec<_>>().join(" "))
    };
    maps.into_iter().map(of_light).chain(names).collect()
}

fn place(world: &mut World, name: &str, at: [f32; 3]) -> Result<(), Failed> {
    set_translation(world, name, at.into()).map_err(|problem| problem.message.into())
}

/// Changes a component of what has this name.
fn edit<C: Component<Mutability = Mutable>>(world: &mut World, name: &str, change: impl FnOnce(&mut C)) -> Result<(), Failed> {
    let entity = find_by_name(world, name).map_err(|problem| problem.message)?;
    let mut component = world.get_mut::<C>(entity).ok_or("no such component")?;
    change(&mut component);
    Ok(())
}

fn take_away(world: &mut World, name: &str) -> Result<(), Failed> {
    let entity = find_by_name(world, name).map_err(|problem| problem.message)?;
    world.despawn(entity);
    Ok(())
}

fn go_to(world: &mut World, seconds: f64) -> Result<(), Failed> {
    luminaire::scenes::world::set_time(world, seconds)
        .map_err(|problems| problems.into_iter().map(|problem| problem.message).collect::<Vec<_>>().join("\n").into())
}
