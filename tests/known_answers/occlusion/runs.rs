//! What runs when the camera, a light or a parameter changes.

use libtest_mimic::Failed;

use super::shot;
use crate::support::picture::{Eye, settle, shown, world};

fn scene(eye: f64, exposure: f64, lux: f64) -> String {
    let eye = Eye::new([eye, 2.0, 4.0], [0.0, 0.5, 0.0], 45.0).ron().replace("fov: 45", &format!("fov: 45, exposure: {exposure}"));
    format!(
        "({eye} lights: {{ \"sun\": Directional(lux: {lux}, direction: (-1, -2, -1)) }},
            objects: {{ \"floor\": (shape: Plane(size: (8, 8)), surface: ()),
                \"box\": (shape: Box(size: (1, 1, 1)), translation: (0, 0.5, 0), surface: ()) }})"
    )
}

pub fn what_reads_it() -> Result<(), Failed> {
    let all = ["gbuffer", "occlusion.search", "occlusion.resolve", "show", "encode"];
    let base = shot(32, &["color"]);
    let mut session = base.poisoned_session(&mut world(&scene(0.0, 1.0, 2.0))?)?;
    let first = settle(&mut session)?;
    if first != [all] {
        return Err(format!("at first: ran {first:?}").into());
    }
    let changes: [(&str, String, &[&str]); 4] = [
        ("the camera moves", scene(0.5, 1.0, 2.0), &all),
        ("the sun is brighter", scene(0.5, 1.0, 3.0), &[]),
        ("the camera exposes longer", scene(0.5, 2.0, 3.0), &[]),
        ("a box moves", scene(0.5, 2.0, 3.0).replace("(0, 0.5, 0)", "(0.2, 0.5, 0)"), &all),
    ];
    for (what, scene, expected) in changes {
        session.update(&mut world(&scene)?).map_err(shown)?;
        let ran = settle(&mut session)?.concat();
        if ran != expected {
            return Err(format!("{what}: ran {ran:?} and not {expected:?}").into());
        }
    }
    let mut moved = world(&scene(0.5, 2.0, 3.0).replace("(0, 0.5, 0)", "(0.2, 0.5, 0)"))?;
    session.reload(&mut moved, &base.set("occlusion.bent_normals", false).request()).map_err(shown)?;
    let ran = settle(&mut session)?.concat();
    if ran.iter().any(|pass| pass == "occlusion.resolve") { Ok(()) } else { Err(format!("without bent normals: ran {ran:?}").into()) }
}
