//! Eight lamps in a row, twenty metres apart, which reach three metres. A box (slots 0 to 7) stands below each of them, and a floor (8)
//! far below all.

use libtest_mimic::Failed;

use super::{Change, check, place, take_away};

const CHANGES: &[Change] = &[
    ("lamp 5 moves", |world| place(world, "lamp 5", [100.0, 2.2, 0.0])),
    ("box 5 leaves the reach of lamp 5", |world| place(world, "box 5", [100.0, 0.0, -8.0])),
    ("box 5 comes to lamp 2", |world| place(world, "box 5", [40.0, 0.0, 1.2])),
    ("lamp 5 goes to lamp 6", |world| place(world, "lamp 5", [119.0, 2.0, 0.0])),
    ("lamp 3 is removed", |world| take_away(world, "lamp 3")),
    ("box 3, which no lamp reaches now, moves", |world| place(world, "box 3", [60.0, 0.5, 0.0])),
    ("box 7 is removed", |world| take_away(world, "box 7")),
];

pub fn are_each_for_themselves() -> Result<(), Failed> {
    let lamp = |index: usize| format!("\"lamp {index}\": Point(candela: 20, position: ({}, 2, 0), range: 3)", 20 * index);
    let object =
        |index: usize| format!("\"box {index}\": (shape: Box(size: (1, 1, 1)), material: \"grey\", translation: ({}, 0, 0))", 20 * index);
    let list = |of: &dyn Fn(usize) -> String| (0..8).map(of).collect::<Vec<_>>().join(",\n");
    let scene = format!(
        "(
            materials: {{ \"grey\": (base_color: (0.5, 0.5, 0.5)) }},
            cameras: {{ \"eye\": (position: (70, 20, 90), target: (70, 0, 0)) }},
            lights: {{ {} }},
            objects: {{ {}, \"floor\": (shape: Plane(size: (400, 400)), material: \"grey\", translation: (70, -20, 0)) }},
        )",
        list(&lamp),
        list(&object)
    );
    check("eight_lamps.txt", &scene, |_| {}, CHANGES)
}
