//! Any bytes as a glTF file: it loads and can be spawned, or is refused with messages that can be shown.

#![no_main]

use libfuzzer_sys::fuzz_target;
use luminaire_graph::diagnostic::{has_errors, render};
use luminaire_graph::source::SourceMap;
use luminaire_scenes::gltf::{Loaded, load_bytes};
use luminaire_scenes::world::{new_world, propagate_transforms, scene_bounds, spawn_stored, store_asset, update_bounds};

fuzz_target!(|bytes: &[u8]| {
    match load_bytes("fuzz.glb", bytes) {
        Ok(Loaded { asset, warnings }) => {
            assert!(!has_errors(&warnings), "loaded with errors");
            let mut world = new_world();
            let stored = store_asset(&mut world, asset);
            spawn_stored(&mut world, &stored, None);
            propagate_transforms(&mut world);
            update_bounds(&mut world);
            scene_bounds(&mut world);
        }
        Err(problems) => {
            assert!(has_errors(&problems), "refused without an error");
            assert!(!render(&problems, &SourceMap::default(), false).is_empty());
        }
    }
});
