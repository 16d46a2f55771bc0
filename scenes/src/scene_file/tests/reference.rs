//! The reference of the scene language is true: its examples load, and it mentions everything that can be written.

use std::path::Path;

use super::*;

/// A chair with the node `seat`, the material `Wood`, and the clip `Rise`, in which the seat goes from 1 m to 3 m within 2 s.
pub(super) const CHAIR: &str = r#"{
    "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }],
    "nodes": [{ "name": "legs", "children": [1] }, { "name": "seat", "mesh": 0, "translation": [0, 1, 0] }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }],
    "materials": [{ "name": "Wood", "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 0.125, 1], "roughnessFactor": 0.75, "metallicFactor": 0 } }],
    "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
        { "bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2] }, { "bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3" }],
    "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 8 }, { "buffer": 0, "byteOffset": 44, "byteLength": 24 }],
    "animations": [{ "name": "Rise", "channels": [{ "sampler": 0, "target": { "node": 1, "path": "translation" } }], "samplers": [{ "input": 1, "output": 2 }] }],
    "buffers": [{ "byteLength": 68, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAEAAAAAAAACAPwAAAAAAAAAAAABAQAAAAAA=" }]
}"#;

/// Loads a scene beside the chair.
pub(super) fn load_beside_chair(text: &str) -> (Result<crate::LoadedScene, Vec<Diagnostic>>, SourceMap) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("chair.gltf"), CHAIR).unwrap();
    let path = folder.path().join("scene.ron");
    std::fs::write(&path, text).unwrap();
    let mut sources = SourceMap::default();
    let loaded = load_scene(&path, None, &mut sources);
    (loaded, sources)
}

fn page() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).unwrap()
}

#[test]
fn examples_load() {
    let page = page();
    let examples: Vec<&str> = page.split("```ron\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert!(examples.len() >= 8);
    for example in examples {
        let (loaded, sources) = load_beside_chair(example);
        let mut loaded = loaded.unwrap_or_else(|problems| panic!("{example}\n{}", render(&problems, &sources, false)));
        assert!(loaded.warnings.is_empty(), "{}", render(&loaded.warnings, &sources, false));
        for seconds in [0.5, 2.0, 20.0] {
            set_time(&mut loaded.world, seconds).unwrap();
        }
    }
}

#[test]
fn everything_that_can_be_written_is_mentioned() {
    let page = page();
    let sources = [
        include_str!("../document/mod.rs"),
        include_str!("../document/motion.rs"),
        include_str!("../document/nodes.rs"),
        include_str!("../document/timeline.rs"),
    ];
    let mut named = 0;
    for line in sources.iter().flat_map(|source| source.lines()) {
        let line = line.trim();
        let field = line.strip_prefix("pub ").unwrap_or(line).split_once(": ").map(|(field, _)| field);
        let variant = line.strip_suffix(" {").or_else(|| line.strip_suffix(','));
        let is_name = |name: &&str| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        let Some(name) = field.or(variant).filter(is_name).filter(|_| !line.starts_with("//")) else { continue };
        // The event's action is written `do`.
        let name = if name == "action" { "do" } else { name };
        assert!(page.contains(&format!("`{name}`")), "the reference does not mention `{name}`");
        named += 1;
    }
    assert!(named > 100, "the documents were not understood");
}
