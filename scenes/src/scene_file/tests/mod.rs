//! Tests of scene files: what shipped ones hold, what wrong ones say, and where files may come from.

use std::path::Path;

use glam::{Vec3, Vec3A};
use luminaire_graph::diagnostic::{Diagnostic, render};
use luminaire_graph::source::SourceMap;
use luminaire_graph::syntax::read_document;

mod hostile;
mod nodes;
mod reference;
mod sky;

use super::SceneDoc;
use super::{load_scene, load_scene_text};
use crate::publish::counts;
use crate::world::{
    Camera, DirectionalLight, Exposure, GlobalTransform, Name, find_by_name, propagate_transforms, select_camera, set_time,
};

fn problems(text: &str) -> (Vec<Diagnostic>, String) {
    let mut sources = SourceMap::default();
    let problems = load_scene_text("test.ron", text, &mut sources).err().unwrap_or_default();
    let rendered = render(&problems, &sources, false);
    (problems, rendered)
}

fn codes(text: &str) -> Vec<&'static str> {
    problems(text).0.iter().map(|problem| problem.code).collect()
}

/// Every scene that comes with the program, by name.
fn shipped() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let scenes = paths.filter(|path| path.extension().is_some_and(|extension| extension == "ron"));
    let mut scenes: Vec<_> =
        scenes.map(|path| (path.file_name().unwrap().display().to_string(), std::fs::read_to_string(&path).unwrap())).collect();
    scenes.sort();
    scenes
}

#[test]
fn shipped_scenes_load() {
    let expected = [
        ("cornell.ron", [0, 1, 0, 1, 0, 0, 7, 0, 0]),
        ("materials.ron", [1, 2, 0, 2, 0, 0, 32, 0, 0]),
        ("probe_grid.ron", [1, 1, 0, 1, 0, 0, 4096, 0, 0]),
    ];
    let shipped = shipped();
    assert!(shipped.len() >= 10);
    for (name, text) in shipped {
        let mut sources = SourceMap::default();
        let mut scene =
            load_scene_text(&name, &text, &mut sources).unwrap_or_else(|problems| panic!("{}", render(&problems, &sources, false)));
        assert!(scene.warnings.is_empty());
        let counts: Vec<u32> = counts(&scene.world).into_values().collect();
        for (_, expected) in expected.iter().filter(|(scene, _)| *scene == name) {
            assert_eq!(counts, expected, "{name}");
        }
        for seconds in [1.0, 2.5, 30.0] {
            set_time(&mut scene.world, seconds).unwrap();
        }
    }
}

#[test]
fn shipped_scenes_mean_the_same_to_the_ron_crate() {
    use ron::extensions::Extensions;
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES);
    for (name, text) in shipped() {
        let file = SourceMap::default().add("shipped.ron", text.as_str());
        let document: SceneDoc = read_document(&text, file).unwrap();
        assert_eq!(document, options.from_str::<SceneDoc>(&text).unwrap(), "{name}");
    }
}

#[test]
fn cameras_and_lights_stand_and_look_as_written() {
    let text = r#"(
        cameras: { "a": (position: (1, 2, 3), target: (1, 2, -5), fov: 60, ev100: 3), "b": (position: (0, 5, 0), target: (0, 0, 0)) },
        lights: { "sun": Directional(lux: 10, direction: (0, -2, 0), color: (1, 0.5, 0.25)) },
    )"#;
    let mut world = load_scene_text("test.ron", text, &mut SourceMap::default()).unwrap().world;
    propagate_transforms(&mut world);
    let default = select_camera(&mut world, None).unwrap().unwrap();
    assert_eq!(world.get::<Name>(default).unwrap().as_str(), "a");
    assert_eq!(world.get::<Camera>(default).unwrap().exposure, Exposure::Ev100(3.0));
    let forward = |world: &crate::World, entity| world.get::<GlobalTransform>(entity).unwrap().0.transform_vector3(Vec3::NEG_Z);
    assert_eq!(forward(&world, default), Vec3::NEG_Z);
    assert_eq!(world.get::<GlobalTransform>(default).unwrap().0.translation, Vec3A::new(1.0, 2.0, 3.0));
    for name in ["b", "sun"] {
        let entity = find_by_name(&mut world, name).unwrap();
        assert!((forward(&world, entity) - Vec3::NEG_Y).length() < 1e-6, "{name}");
    }
    let sun = find_by_name(&mut world, "sun").unwrap();
    let light = world.get::<DirectionalLight>(sun).unwrap();
    assert_eq!((light.illuminance, light.color), (10.0, Vec3::new(1.0, 0.5, 0.25)));
}

#[test]
fn everything_wrong_is_reported_at_once_with_its_place() {
    let text = r#"(
    materials: { "white": (roughness: 1.5) },
    lights: { "lamp": Point(candela: -1, position: (0, 0, 0)), "spot": Spot(candela: 1, position: (0, 0, 0), direction: (0, 0, 0), inner: 50, outer: 40) },
    cameras: { "lamp": (position: (1, 1, 1), target: (1, 1, 1), fov: 200) },
    objects: {
        "a": (shape: Box(size: (1, 0, 1)), material: "whit"),
        "b": (shape: Sphere(radius: 1, sectors: 2), material: "white", surface: ()),
        "c": (shape: Plane(size: (-1, 1))),
    },
    files: { "chair": (path: "chair.gltf") },
)"#;
    let (problems, rendered) = problems(text);
    let codes: Vec<&str> = problems.iter().map(|problem| problem.code).collect();
    let expected = [
        "scene::bad-number",
        "scene::no-direction",
        "scene::bad-number",
        "scene::bad-number",
        "scene::no-direction",
        "scene::bad-cone",
        "scene::unknown-material",
        "scene::bad-number",
        "scene::which-material",
        "scene::bad-number",
        "scene::which-material",
        "scene::bad-number",
        "scene::no-folder",
        "scene::duplicate-name",
    ];
    assert_eq!(codes, expected, "{rendered}");
    assert!(problems.iter().all(|problem| problem.primary.as_ref().is_some_and(|label| label.span.is_somewhere())), "{rendered}");
    assert!(rendered.contains("did you mean `white`?"), "{rendered}");
}

#[test]
fn unknown_fields_and_broken_text_are_refused() {
    for text in ["(colour: 1)", "(lights: { \"a\": Point(candela: 1, position: (0, 0, 0), colour: (1, 1, 1)) })", "(", "", "(doc: 1)"] {
        assert!(!codes(text).is_empty(), "{text}");
    }
    assert!(codes("()").is_empty(), "an empty scene is a scene");
}

#[test]
fn numbers_at_the_edge_are_refused_or_finite() {
    for number in ["1e39", "1e30", "NaN", "inf", "-inf", "1e-30"] {
        let text = format!("(objects: {{ \"a\": (shape: Sphere(radius: {number}), surface: ()) }})");
        assert!(!codes(&text).is_empty(), "{number}");
    }
}

#[test]
fn files_come_from_the_scenes_folder() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    let gltf = r#"{ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "name": "door", "translation": [1, 0, 0] }] }"#;
    std::fs::write(folder.path().join("outer.gltf"), gltf).unwrap();
    std::fs::write(inner.join("room.gltf"), gltf).unwrap();
    let scene = |name: &str, text: &str| {
        let path = inner.join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let load = |path: &Path, root: Option<&Path>| load_scene(path, root, &mut SourceMap::default());

    let good = scene("good.ron", r#"(files: { "room": (path: "room.gltf", translation: (0, 2, 0), scale: (2, 2, 2)) })"#);
    let mut world = load(&good, None).unwrap().world;
    propagate_transforms(&mut world);
    let door = find_by_name(&mut world, "door").unwrap();
    assert_eq!(world.get::<GlobalTransform>(door).unwrap().0.translation, Vec3A::new(2.0, 2.0, 0.0));

    let outside = scene("outside.ron", r#"(files: { "room": (path: "../outer.gltf") })"#);
    assert_eq!(load(&outside, None).unwrap_err()[0].code, "scene::outside-root");
    assert!(load(&outside, Some(folder.path())).is_ok());
    let missing = scene("missing.ron", r#"(files: { "a": (path: "rom.gltf"), "b": (path: "room.obj") })"#);
    let missing: Vec<&str> = load(&missing, None).unwrap_err().iter().map(|problem| problem.code).collect();
    assert_eq!(missing, ["scene::no-such-file", "scene::unknown-kind"]);
    assert!(load(&inner.join("room.gltf"), None).is_ok());
    assert_eq!(load(&inner.join("none.ron"), None).unwrap_err()[0].code, "scene::unreadable");
    assert_eq!(load(&inner.join("none.obj"), None).unwrap_err()[0].code, "scene::unknown-kind");
}
