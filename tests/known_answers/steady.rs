//! The same again: frames that follow each other, outputs in every combination, and scenes without lights.

use libtest_mimic::Failed;

use crate::Case;
use crate::support::picture::{Eye, Shot, places, shown, texel, world};

pub const CASES: &[Case] = &[
    ("steady::frames are equal and create nothing", frames_are_equal),
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
    let read = |session: &luminaire::session::Session| OUTPUTS.map(|name| session.read_output(name).map_err(shown));
    let before = read(&session);
    if first.pipelines_created == 0 || first.bind_groups_created == 0 || first.counts.draw_calls < 10 {
        return Err(format!("the first frame did nothing: {first:?}").into());
    }
    for _ in 0..4 {
        let next = session.render_frame().map_err(shown)?;
        if next != first {
            return Err(format!("{next:?} after {first:?}").into());
        }
        for (name, (a, b)) in OUTPUTS.iter().zip(before.iter().zip(&read(&session))) {
            match (a, b) {
                (Ok(a), Ok(b)) if a.texels.iter().flatten().map(|x| x.to_bits()).eq(b.texels.iter().flatten().map(|x| x.to_bits())) => {}
                _ => return Err(format!("`{name}` changes from frame to frame").into()),
            }
        }
    }
    Ok(())
}

/// Textures are shared among resources, differently for each choice of outputs; what one leaves behind must reach no other.
fn outputs_do_not_interfere() -> Result<(), Failed> {
    let scene = busy();
    let mut world = world(&scene)?;
    let all = Shot::pbr(32, &OUTPUTS).take_world(&mut world)?;
    for choice in 1..1u32 << OUTPUTS.len() {
        let outputs: Vec<&str> = (0..OUTPUTS.len()).filter(|bit| choice >> bit & 1 == 1).map(|bit| OUTPUTS[bit]).collect();
        for (name, image) in Shot::pbr(32, &outputs).take_world(&mut world)? {
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
