//! When passes run, on a device whose memory is poisoned: accumulation, turns, the past, indirect work, elements of the scene. What
//! each frame leaves is known from formulas, to the bit.

use libtest_mimic::Failed;
use luminaire::session::Session;

use crate::Case;
use crate::support::picture::{Shot, places, shown, texel, world};

pub const CASES: &[Case] = &[
    ("runs::what accumulates goes on, ends, and starts again", accumulates),
    ("runs::turns are taken, two rounds each", spreads),
    ("runs::the past goes through a resize", resizes),
    ("runs::a buffer says how much is done", indirect),
    ("runs::a light that moves runs its own iteration", elements),
    ("runs::what accumulates starts again on another device", accumulates_anew),
    ("runs::what is not kept is made again", not_kept),
];

fn shot(name: &str, size: [u32; 2], outputs: &[&str]) -> Shot {
    Shot::of(&format!("tests/fixtures/runs/{name}.ron"), size, outputs)
}

fn sky(radiance: u32) -> String {
    format!(
        "(cameras: {{ \"eye\": (position: (0, 0, 1), target: (0, 0, 0)) }},
        environment: (sky_radiance: ({radiance}, {radiance}, {radiance})))"
    )
}

/// Fails unless every texel of an output has these components.
fn expect(session: &Session, output: &str, when: &str, expected: [f64; 3]) -> Result<(), Failed> {
    expect_each(session, output, when, |_, _| expected)
}

fn expect_each(session: &Session, output: &str, when: &str, expected: impl Fn(u32, u32) -> [f64; 3]) -> Result<(), Failed> {
    let image = session.read_output(output).map_err(shown)?;
    for (x, y) in places(&image) {
        let found = texel(&image, x, y);
        if found[..3] != expected(x, y) {
            return Err(format!("`{output}` {when} at {x}, {y}: {found:?} and not {:?}", expected(x, y)).into());
        }
    }
    Ok(())
}

/// Of `gather`, three runs to a change: the sum of 1, 2, 3 times the sky, the count of all runs since ever, the run's number.
fn accumulates() -> Result<(), Failed> {
    let shot = shot("gather", [8, 8], &["sum", "tally"]);
    let mut session = shot.poisoned_session(&mut world(&sky(2))?)?;
    let mut ever = 100.0;
    // The run's number, and factors of the sums.
    let mut play = |session: &mut Session, light: f64, weight: f64, what: &str| -> Result<(), Failed> {
        for frame in 0..7u32 {
            let stats = session.render_frame().map_err(shown)?;
            let when = format!("{what}, frame {frame}");
            let runs = f64::from(frame.min(2) + 1);
            ever += if frame < 3 { 1.0 } else { 0.0 };
            let sum = runs * (runs + 1.0) / 2.0 * light * weight;
            expect(session, "sum", &when, [sum, ever, runs - 1.0])?;
            if weight == 1.0 {
                let blended = f64::from(frame.min(3) + 1);
                expect(session, "tally", &when, [0.5 + light * blended * (blended - 1.0) / 2.0, blended, 0.0])?;
            }
            // The past takes one frame more than what it is the past of.
            if stats.settled != (frame >= 4) && weight == 1.0 {
                return Err(format!("{when}: ran {:?}", session.ran()).into());
            }
        }
        Ok(())
    };
    play(&mut session, 2.0, 1.0, "at first")?;
    session.update(&mut world(&sky(5))?).map_err(shown)?;
    play(&mut session, 5.0, 1.0, "with another sky")?;
    session.reload(&mut world(&sky(5))?, &shot.set("weight", "3.0").request()).map_err(shown)?;
    play(&mut session, 5.0, 3.0, "with another parameter")?;
    // What blends takes no parameter: it has not started again.
    expect(&session, "tally", "in the end", [0.5 + 5.0 * 6.0, 4.0, 0.0])
}

/// Layers 0, 1, 2, and again: each round adds the layer's number, from 1, times the sky, to what the layer held.
fn spreads() -> Result<(), Failed> {
    let outputs = ["layer0", "layer1", "layer2"];
    let mut session = shot("spread", [8, 8], &outputs).poisoned_session(&mut world(&sky(2))?)?;
    let mut held = [0.0; 3];
    for (light, what) in [(2.0, "at first"), (3.0, "with another sky")] {
        for frame in 0..10usize {
            let stats = session.render_frame().map_err(shown)?;
            if frame < 6 {
                held[frame % 3] += (frame % 3 + 1) as f64 * light;
            }
            for (layer, output) in outputs.iter().enumerate() {
                let begun = what != "at first" || frame >= layer;
                let expected = if begun { [held[layer], 1.0, 0.0] } else { [-1.0, 0.0, 0.0] };
                expect(&session, output, &format!("{what}, frame {frame}"), expected)?;
            }
            if session.ran().contains(&"layers.add") != (frame < 6) || (stats.settled != (frame > 6)) {
                return Err(format!("{what}, frame {frame}: ran {:?}", session.ran()).into());
            }
        }
        session.update(&mut world(&sky(3))?).map_err(shown)?;
    }
    Ok(())
}

/// Texels say where they are and how wide the image was: what both extents have is that of the frame before, the rest the first value.
fn resizes() -> Result<(), Failed> {
    let outputs = ["cropped", "renewed"];
    let scene = sky(1);
    let mut before = [5, 4];
    let mut session = shot("resize", before, &outputs).poisoned_session(&mut world(&scene)?)?;
    session.render_frame().map_err(shown)?;
    expect(&session, "cropped", "at first", [7.0, 0.0, 0.0])?;
    expect(&session, "renewed", "at first", [8.0, 0.0, 0.0])?;
    let place = |width: u32, x: u32, y: u32| [f64::from(10_000 * width + 100 * y + x), 0.0, 0.0];
    for size in [[7, 3], [2, 9], [6, 6]] {
        session.render_frame().map_err(shown)?;
        for output in outputs {
            expect_each(&session, output, &format!("a frame later, {before:?}"), |x, y| place(before[0], x, y))?;
        }
        session.reload(&mut world(&scene)?, &shot("resize", size, &outputs).request()).map_err(shown)?;
        session.render_frame().map_err(shown)?;
        expect_each(&session, "cropped", &format!("from {before:?} to {size:?}"), |x, y| {
            if x < before[0] && y < before[1] { place(before[0], x, y) } else { [7.0, 0.0, 0.0] }
        })?;
        expect(&session, "renewed", &format!("from {before:?} to {size:?}"), [8.0, 0.0, 0.0])?;
        before = size;
    }
    Ok(())
}

/// As many workgroups as the buffer says, behind its first word; all else keeps the declared value.
fn indirect() -> Result<(), Failed> {
    let shot = shot("indirect", [8, 8], &["reached"]);
    let mut session = shot.poisoned_session(&mut world(&sky(1))?)?;
    for wide in [3, 5, 1] {
        session.reload(&mut world(&sky(1))?, &shot.clone().set("wide", wide).request()).map_err(shown)?;
        session.render_frame().map_err(shown)?;
        if session.ran() != ["say", "work"] {
            return Err(format!("{wide} wide: ran {:?}", session.ran()).into());
        }
        let image = session.read_output("reached").map_err(shown)?;
        for (x, y) in places(&image) {
            let expected = if x < wide && y < 2 { [1.0, f64::from(wide), 2.0, 1.0] } else { [0.25, 0.0, 0.0, 0.0] };
            if texel(&image, x, y) != expected {
                return Err(format!("{wide} wide, at {x}, {y}: {:?} and not {expected:?}", texel(&image, x, y)).into());
            }
        }
    }
    Ok(())
}

/// Three lights of 1, 2 and 3 candela at 10, 20 and 30 metres; then one of them moves, and another one is brighter.
fn elements() -> Result<(), Failed> {
    let scene = |candela: [u32; 3], at: [u32; 3]| {
        let light = |index: usize| format!("\"lamp{index}\": Point(candela: {}, position: ({}, 0, 0))", candela[index], at[index]);
        format!(
            "(cameras: {{ \"eye\": (position: (0, 0, 1), target: (0, 0, 0)) }}, lights: {{ {}, {}, {} }})",
            light(0),
            light(1),
            light(2)
        )
    };
    let states = [
        ([1, 2, 3], [10, 20, 30], vec!["lights[0].measure", "lights[1].measure", "lights[2].measure", "add"]),
        ([1, 2, 3], [10, 25, 30], vec!["lights[1].measure", "add"]),
        ([1, 2, 7], [10, 25, 30], vec!["lights[2].measure", "add"]),
        ([1, 2, 7], [10, 25, 30], vec![]),
    ];
    let mut session = shot("elements", [8, 8], &["shown"]).poisoned_session(&mut world(&scene([1, 2, 3], [10, 20, 30]))?)?;
    for (candela, at, ran) in states {
        session.update(&mut world(&scene(candela, at))?).map_err(shown)?;
        session.render_frame().map_err(shown)?;
        if session.ran() != ran {
            return Err(format!("{candela:?} at {at:?}: ran {:?} and not {ran:?}", session.ran()).into());
        }
        let expected = [candela[0] + 100 * candela[1] + 10_000 * candela[2], at.iter().sum(), 3].map(f64::from);
        expect(&session, "shown", &format!("{candela:?} at {at:?}"), expected)?;
    }
    Ok(())
}

/// Lost after two runs of three: all is as if the program had just begun.
fn accumulates_anew() -> Result<(), Failed> {
    let mut session = shot("gather", [8, 8], &["sum", "tally"]).poisoned_session(&mut world(&sky(2))?)?;
    for _ in 0..2 {
        session.render_frame().map_err(shown)?;
    }
    expect(&session, "sum", "before", [6.0, 102.0, 1.0])?;
    session.gpu().device().destroy();
    for (sum, tally) in [([2.0, 101.0, 0.0], [0.5, 1.0, 0.0]), ([6.0, 102.0, 1.0], [2.5, 2.0, 0.0]), ([12.0, 103.0, 2.0], [6.5, 3.0, 0.0])]
    {
        session.render_frame().map_err(shown)?;
        expect(&session, "sum", "after", sum)?;
        expect(&session, "tally", "after", tally)?;
    }
    Ok(())
}

/// Twice the sum of the sky and 100 times the camera's place. A camera that moves finds the sky's texture in other hands.
fn not_kept() -> Result<(), Failed> {
    let scene = |z: u32| sky(3).replace("position: (0, 0, 1)", &format!("position: (0, 0, {z})"));
    let mut session = shot("shared", [8, 8], &["shown"]).poisoned_session(&mut world(&scene(1))?)?;
    let memory = |name: &str| session.plan.resources.iter().find(|resource| resource.name == name).and_then(|found| found.placement);
    if memory("first").is_none() || memory("first") != memory("third") {
        return Err("`first` and `third` share nothing".into());
    }
    for z in [1, 2, 5, 5] {
        session.update(&mut world(&scene(z))?).map_err(shown)?;
        let settled = session.render_frame().map_err(shown)?.settled;
        expect(&session, "shown", &format!("from {z}"), [f64::from(2 * (3 + 100 * z)); 3])?;
        if !settled && session.ran() != ["sky", "camera", "twice", "show"] {
            return Err(format!("from {z}: ran {:?}", session.ran()).into());
        }
    }
    Ok(())
}
