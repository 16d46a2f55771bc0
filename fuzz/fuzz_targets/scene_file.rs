//! Any text as a scene file: it loads, or is refused with messages that can be shown.

#![no_main]

use libfuzzer_sys::fuzz_target;
use luminaire_graph::diagnostic::{has_errors, render};
use luminaire_graph::source::SourceMap;
use luminaire_scenes::load_scene_text;

fuzz_target!(|text: &str| {
    let mut sources = SourceMap::default();
    match load_scene_text("fuzz.ron", text, &mut sources) {
        Ok(mut loaded) => {
            assert!(!has_errors(&loaded.warnings), "loaded with errors");
            luminaire_scenes::world::propagate_transforms(&mut loaded.world);
        }
        Err(problems) => {
            assert!(has_errors(&problems), "refused without an error");
            assert!(!render(&problems, &sources, false).is_empty());
        }
    }
});
