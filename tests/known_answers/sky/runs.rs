//! What runs when the sun or the camera turns, and when the light or the air changes.

use libtest_mimic::Failed;

use crate::support::picture::{Shot, shown, world};

/// A scene, and a parameter that is set or not.
type State = (&'static str, [f64; 2], f64, Option<(&'static str, &'static str)>, &'static [&'static str]);

const STATES: &[State] = &[
    ("the camera turns", [0.5, 30.0], 128_000.0, None, &["draw", "display.expose"]),
    ("the sun turns", [0.5, 10.0], 128_000.0, None, &["sky.look", "sky.gather", "draw", "display.expose"]),
    ("the sun sets", [0.5, -5.0], 128_000.0, None, &["sky.look", "sky.gather", "draw", "display.expose"]),
    // In the same unit of light: nothing but the sky's own pass knows of it.
    ("the sun gets weaker", [0.5, -5.0], 127_000.0, None, &["draw", "display.expose"]),
    ("the eye rises", [0.5, -5.0], 127_000.0, Some(("altitude", "300.0")), &["sky.look", "sky.gather", "draw", "display.expose"]),
    (
        "the air gets hazy",
        [0.5, -5.0],
        127_000.0,
        Some(("mie_scale", "3.0")),
        &["sky.scatter", "sky.look", "sky.gather", "draw", "display.expose"],
    ),
    ("nothing", [0.5, -5.0], 127_000.0, Some(("mie_scale", "3.0")), &[]),
];

pub fn what_reads_it() -> Result<(), Failed> {
    let scene = |[camera, sun]: [f64; 2], lux: f64| {
        let (sine, cosine) = sun.to_radians().sin_cos();
        format!(
            "(cameras: {{ \"eye\": (position: (0, 2, 0), target: (1, 2, {camera})) }},
                lights: {{ \"sun\": Directional(lux: {lux}, direction: ({}, {}, 0)) }})",
            -cosine, -sine
        )
    };
    let base = Shot::of("pipelines/sky.ron", [32, 32], &["color"]);
    let mut session = base.poisoned_session(&mut world(&scene([0.0, 30.0], 128_000.0))?)?;
    session.render_frame().map_err(shown)?;
    let mut ran = session.ran();
    ran.sort_unstable();
    if ran != ["display.expose", "draw", "sky.gather", "sky.look", "sky.scatter", "sky.transmit"] {
        return Err(format!("at first: ran {ran:?}").into());
    }
    for (what, places, lux, set, expected) in STATES {
        let shot = set.iter().fold(base.clone(), |shot, (name, value)| shot.set(name, value));
        let mut world = world(&scene(*places, *lux))?;
        if set.is_some() {
            session.reload(&mut world, &shot.request()).map_err(shown)?;
        } else {
            session.update(&mut world).map_err(shown)?;
        }
        session.render_frame().map_err(shown)?;
        if session.ran() != *expected {
            return Err(format!("{what}: ran {:?} and not {expected:?}", session.ran()).into());
        }
    }
    Ok(())
}
