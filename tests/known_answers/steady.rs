//! The same again: frames that follow each other, outputs in every combination, and scenes without lights.

use std::collections::BTreeSet;

use libtest_mimic::Failed;

use luminaire::image_file::LinearImage;
use luminaire::session::Session;

use crate::Case;
use crate::support::picture::{ALBEDO, Eye, Series, Shot, places, settle, shown, texel, world};

pub const CASES: &[Case] = &[
    ("steady::frames are equal and create nothing", frames_are_equal),
    ("steady::incremental is full", incremental_is_full),
    ("steady::incremental is full for samples", incremental_is_full_for_samples),
    ("steady::incremental is full for base colours", incremental_is_full_for_albedo),
    ("steady::poison is seen", poison_is_seen),
    ("steady::a lost device is replaced", lost_devices_are_replaced),
    ("steady::any other outputs leave the picture as it is", outputs_do_not_interfere),
    ("steady::the sky is seen and lights nothing", sky_lights_nothing),
];

const OUTPUTS: [&str; 7] = ["color", "radiance", "direct", "indirect", "albedo", "normal", "depth"];

/// Something of everything: both kinds of shadows, emission, a blended surface, the sky.
fn busy() -> String {
    let eye = Eye::new([0.0, 2.0, 5.0], [0.0, 0.3, 0.0], 45.0);
    format!(
        "({} environment: (sky_radiance: (0.1, 0.2, 0.4)),
        lights: {{ \"sun\": Directional(lux: 2, direction: (-1, -2, -1)), \"lamp\": Point(candela: 3, position: (1, 1.5, 1)) }},
        objects: {{
            \"floor\": (shape: Plane(size: (8, 8)), surface: (roughness: 0.6)),
            \"ball\": (shape: Sphere(radius: 0.6), translation: (-0.8, 0.6, 0), surface: (metallic: 1, roughness: 0.3)),
            \"glow\": (shape: Box(size: (0.4, 0.4, 0.4)), translation: (0.9, 0.2, -0.5), surface: (emissive: (1, 0.5, 0.2))),
            \"glass\": (shape: Plane(size: (1, 1)), rotation: (90, 0, 0), translation: (0.3, 0.6, 1), surface: (alpha: 0.4)) }})",
        eye.ron()
    )
}

fn frames_are_equal() -> Result<(), Failed> {
    let mut session = Shot::pbr(64, &OUTPUTS).session(&mut world(&busy())?)?;
    let first = session.render_frame().map_err(shown)?;
    if first.pipelines_created == 0 || first.bind_groups_created == 0 || first.counts.draw_calls < 10 || first.settled {
        return Err(format!("the first frame did nothing: {first:?}").into());
    }
    let before = images(&session, &OUTPUTS)?;
    for _ in 0..4 {
        let next = session.render_frame().map_err(shown)?;
        if !next.settled || (next.counts.steps, next.counts.submissions, next.created) != (0, 0, first.created) {
            return Err(format!("nothing changed, and yet {next:?}").into());
        }
    }
    same_images(&before, &images(&session, &OUTPUTS)?, "from frame to frame")
}

fn images<'a>(session: &Session, outputs: &[&'a str]) -> Result<Vec<(&'a str, LinearImage)>, Failed> {
    outputs.iter().map(|name| Ok((*name, session.read_output(name).map_err(shown)?))).collect()
}

/// Bit for bit.
fn same_images(a: &[(&str, LinearImage)], b: &[(&str, LinearImage)], when: &str) -> Result<(), Failed> {
    for ((name, a), (_, b)) in a.iter().zip(b) {
        let bits = |image: &LinearImage| -> Vec<u32> { image.texels.iter().flatten().map(|x| x.to_bits()).collect() };
        if (a.width, a.height) != (b.width, b.height) {
            return Err(format!("`{name}` has another size {when}").into());
        }
        let differ = bits(a).chunks(4).zip(bits(b).chunks(4)).filter(|(a, b)| a != b).count();
        if differ > 0 {
            return Err(format!("`{name}` differs {when} in {differ} of {} texels", a.texels.len()).into());
        }
    }
    Ok(())
}

/// What is replaced in the scene, and a pass of `pbr` that must not run for it.
const CHANGES: [(&str, &str, &str, &str); 7] = [
    ("the camera moves", "(0.0, 2.0, 5.0)", "(0.3, 2.2, 4.8)", "point_shadows.faces[0].opaque"),
    ("the lamp moves", "position: (1, 1.5, 1)", "position: (0.7, 1.6, 1.2)", "gbuffer"),
    ("the lamp is brighter", "candela: 3", "candela: 5", "point_shadows.faces[0].opaque"),
    ("the sun is dimmer", "lux: 2", "lux: 1", "sun_shadows.light[0].cascade[0].opaque"),
    ("a ball moves", "translation: (-0.8, 0.6, 0)", "translation: (-0.7, 0.7, 0.1)", "nothing"),
    ("a surface gets rougher", "roughness: 0.3", "roughness: 0.5", "sun_shadows.light[0].cascade[0].opaque"),
    ("the sky turns", "sky_radiance: (0.1, 0.2, 0.4)", "sky_radiance: (0.3, 0.2, 0.1)", "gbuffer"),
];

/// What changed is drawn, what did not is not, and the picture is that of a session that starts with the change. The former lives in
/// poisoned memory: what it drew on something that is no more there would differ.
fn incremental_is_full() -> Result<(), Failed> {
    let shot = Shot::pbr(48, &OUTPUTS);
    let reloads = [("exposure", shot.clone().set("exposure", 1.5)), ("size", Shot { size: [40, 56], ..shot.clone() })];
    replay(&shot, &OUTPUTS, &reloads, |what, ran, idle| match ran.is_empty() || ran.iter().any(|pass| pass == idle) {
        true => Err(format!("{what}: ran {ran:?}").into()),
        false => Ok(()),
    })
}

/// The samples of a picture that did not gather all of its own before the change are not in the mean.
fn incremental_is_full_for_samples() -> Result<(), Failed> {
    let shot = Shot::pbr(48, &["radiance", "color"]).set("samples", 3);
    let reloads = [
        ("samples", shot.clone().set("samples", 5)),
        ("exposure", shot.clone().set("samples", 5).set("exposure", 1.5)),
        ("size", Shot { size: [40, 56], ..shot.clone() }),
    ];
    replay(&shot, &["radiance", "color"], &reloads, |what, ran, idle| {
        match ran.is_empty() || ran.iter().any(|pass| pass == idle && idle != "gbuffer") {
            true => Err(format!("{what}: ran {ran:?}").into()),
            false => Ok(()),
        }
    })
}

fn incremental_is_full_for_albedo() -> Result<(), Failed> {
    let shot = Shot::of(ALBEDO, [48, 48], &["color"]);
    // Light is nothing to it, and neither is roughness.
    let seen = ["the camera moves", "a ball moves", "size"];
    replay(&shot, &["color"], &[("size", Shot { size: [40, 56], ..shot.clone() })], |what, ran, _| {
        if ran.is_empty() == seen.contains(&what) { Err(format!("{what}: ran {ran:?}").into()) } else { Ok(()) }
    })
}

/// What stands in the scene's text: a bare place is the camera's.
fn place(text: &str) -> String {
    if !text.starts_with('(') {
        return text.to_owned();
    }
    let numbers: Vec<f64> = text.trim_matches(['(', ')']).split(',').filter_map(|number| number.trim().parse().ok()).collect();
    Eye::new([numbers[0], numbers[1], numbers[2]], [0.0, 0.3, 0.0], 45.0).ron()
}

/// Change by change, and then reload by reload. `check` gets what changed, what ran, and what must not have.
fn replay(
    shot: &Shot,
    outputs: &[&str],
    reloads: &[(&'static str, Shot)],
    check: impl Fn(&str, &[String], &str) -> Result<(), Failed>,
) -> Result<(), Failed> {
    let mut scene = busy();
    let mut session = shot.poisoned_session(&mut world(&scene)?)?;
    settle(&mut session)?;
    for (what, from, to, idle) in CHANGES {
        let changed = scene.replace(&place(from), &place(to));
        if changed == scene {
            return Err(format!("{what}: the scene stayed as it was").into());
        }
        scene = changed;
        session.update(&mut world(&scene)?).map_err(shown)?;
        check(what, &ran(settle(&mut session)?), idle)?;
        let mut fresh = shot.session(&mut world(&scene)?)?;
        settle(&mut fresh)?;
        same_images(&images(&session, outputs)?, &images(&fresh, outputs)?, &format!("after {what}"))?;
    }
    for (what, next) in reloads {
        let mut world = world(&scene)?;
        session.reload(&mut world, &next.request()).map_err(shown)?;
        let ran = ran(settle(&mut session)?);
        // Another shape of the image is another frustum, to which cascades are fitted; no other map knows of it.
        if ran.iter().any(|name| name.contains("shadow") && !(*what == "size" && name.starts_with("sun_shadows."))) {
            return Err(format!("{what}: ran {ran:?}").into());
        }
        check(what, &ran, "nothing")?;
        let mut fresh = next.session(&mut world)?;
        settle(&mut fresh)?;
        same_images(&images(&session, outputs)?, &images(&fresh, outputs)?, &format!("after a change of {what}"))?;
    }
    Ok(())
}

/// Of some frames all passes, each once.
fn ran(frames: Vec<Vec<String>>) -> Vec<String> {
    let all: BTreeSet<String> = frames.into_iter().flatten().collect();
    all.into_iter().collect()
}

/// Whatever is asked for first after the loss: a frame though nothing changed, a change of the scene, or another size.
fn lost_devices_are_replaced() -> Result<(), Failed> {
    let (mut scene, mut shot) = (busy(), Shot::pbr(48, &OUTPUTS));
    let mut session = shot.session(&mut world(&scene)?)?;
    let first = session.render_frame().map_err(shown)?;
    for (recoveries, what) in (1..).zip(["nothing", "the lamp moves", "size"]) {
        if what == "nothing" {
            // Where nothing is submitted a loss is noticed when the last work has ended.
            images(&session, &OUTPUTS)?;
        }
        session.gpu().device().destroy();
        match what {
            "the lamp moves" => {
                scene = scene.replace("position: (1, 1.5, 1)", "position: (0.7, 1.6, 1.2)");
                session.update(&mut world(&scene)?).map_err(shown)?;
            }
            "size" => {
                shot.size = [40, 56];
                session.reload(&mut world(&scene)?, &shot.request()).map_err(shown)?;
            }
            _ => {}
        }
        let stats = session.render_frame().map_err(shown)?;
        if (session.recoveries(), stats.counts.steps) != (recoveries, first.counts.steps) {
            return Err(format!("{what}: {} recoveries, {stats:?}", session.recoveries()).into());
        }
        let mut fresh = shot.session(&mut world(&scene)?)?;
        fresh.render_frame().map_err(shown)?;
        same_images(&images(&session, &OUTPUTS)?, &images(&fresh, &OUTPUTS)?, &format!("after a loss and {what}"))?;
        if !session.render_frame().map_err(shown)?.settled {
            return Err(format!("{what}: it does not settle").into());
        }
    }
    Ok(())
}

/// A pass that leaves texels out although it promised not to shows what is below: poison, and not zero.
fn poison_is_seen() -> Result<(), Failed> {
    let outputs = ["float", "half", "color", "number"];
    let shot = Shot::of("tests/fixtures/gpu/poison.ron", [8, 8], &outputs);
    let mut world = world("(cameras: { \"eye\": (position: (0, 0, 1), target: (0, 0, 0)) })")?;
    let mut session = shot.poisoned_session(&mut world)?;
    session.render_frame().map_err(shown)?;
    let below = |name: &str| -> Result<[f32; 4], Failed> { Ok(session.read_output(name).map_err(shown)?.texels[63]) };
    let all_nan = below("float")?.iter().chain(&below("half")?).all(|component| component.is_nan());
    if !all_nan || below("color")? != [1.0, 0.0, 1.0, 1.0] || below("number")?[0] != u32::MAX as f32 {
        return Err(format!("{:?}", outputs.map(below)).into());
    }
    // And the rest is what was written.
    match session.read_output("float").map_err(shown)?.texels[0] {
        [0.5, 0.5, 0.5, 0.5] => Ok(()),
        other => Err(format!("{other:?}").into()),
    }
}

/// Textures are shared among resources, differently for each choice of outputs; what one leaves behind must reach no other. Nothing of
/// what the choice before shows is left in the next: camera, lights and a surface differ.
fn outputs_do_not_interfere() -> Result<(), Failed> {
    let first = busy();
    let second = CHANGES.iter().fold(first.clone(), |scene, (_, from, to, _)| scene.replace(&place(from), &place(to)));
    let scenes = [(&first, Shot::pbr(32, &OUTPUTS).take(&first)?), (&second, Shot::pbr(32, &OUTPUTS).take(&second)?)];
    let mut series = Series::default();
    for choice in 1..1u32 << OUTPUTS.len() {
        // Those that need much compiled come last, one after the other.
        let outputs: Vec<&str> =
            OUTPUTS.iter().rev().enumerate().filter(|(bit, _)| choice >> bit & 1 == 1).map(|(_, name)| *name).collect();
        let (scene, all) = &scenes[choice as usize % 2];
        for (name, image) in series.take(&Shot::pbr(32, &outputs), scene)? {
            if image != all[&name] {
                return Err(format!("`{name}` is another picture when the outputs are {outputs:?}").into());
            }
        }
    }
    Ok(())
}

fn sky_lights_nothing() -> Result<(), Failed> {
    let scene = "(cameras: { \"eye\": (position: (0, 0, 4), target: (0, 0, 0)) },
        environment: (sky_radiance: (0.25, 0.5, 3)),
        objects: { \"ball\": (shape: Sphere(radius: 1), surface: (base_color: (1, 1, 1))) })";
    let images = Shot::pbr(64, &["radiance", "direct", "indirect", "normal"]).take(scene)?;
    let mut seen = [0, 0];
    for (x, y) in places(&images["radiance"]) {
        let drawn = texel(&images["normal"], x, y)[3] == 1.0;
        let expected = if drawn { [0.0; 3] } else { [0.25, 0.5, 3.0] };
        seen[usize::from(drawn)] += 1;
        let [radiance, direct, indirect] = ["radiance", "direct", "indirect"].map(|name| texel(&images[name], x, y));
        if radiance[..3] != expected || direct[..3] != expected || indirect[..3] != [0.0; 3] {
            return Err(format!("{radiance:?} = {direct:?} + {indirect:?} at {x}, {y}, not {expected:?}").into());
        }
    }
    if seen[0] > 500 && seen[1] > 500 { Ok(()) } else { Err(format!("sky and ball cover {seen:?} pixels").into()) }
}
