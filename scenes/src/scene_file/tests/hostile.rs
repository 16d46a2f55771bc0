//! Scene files that ask for too much: they are refused with a reason, or loaded within reason.

use std::fmt::Write;

use luminaire_graph::published::{DrawFilter, ViewKind};

use super::*;
use crate::publish::{PublishRequest, Publisher};

fn chain(length: usize) -> String {
    let mut text = String::from("(groups: {");
    for index in 0..length {
        let parent = if index > 0 { format!("parent: \"g{}\"", index - 1) } else { String::new() };
        write!(text, "\"g{index}\": ({parent}),").unwrap();
    }
    text + "})"
}

#[test]
fn deep_hierarchies_are_refused_once() {
    assert!(codes(&chain(256)).is_empty());
    assert_eq!(codes(&chain(257)), ["scene::too-deep"]);
    assert_eq!(codes(&chain(20_000)), ["scene::too-deep"]);
}

#[test]
fn long_circles_are_found_once() {
    let mut text = chain(5_000);
    text = text.replacen("\"g0\": ()", "\"g0\": (parent: \"g4999\")", 1);
    let (problems, rendered) = problems(&text);
    assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["scene::cycle"]);
    assert!(rendered.contains("a circle of 5000"), "{rendered}");
}

#[test]
fn many_entries_load() {
    let mut text = String::from("(materials: { \"m\": () }, objects: {");
    for index in 0..20_000 {
        write!(text, "\"o{index}\": (shape: Box(size: (1, 1, {})), material: \"m\"),", 1 + index % 100).unwrap();
    }
    assert!(codes(&(text + "})")).is_empty());
}

#[test]
fn many_wrong_names_are_not_slow() {
    let groups = (0..20_000).fold(String::from("(groups: {"), |text, index| text + &format!("\"g{index}\": (parent: \"wrong {index}\"),"));
    let (problems, _) = problems(&(groups + "})"));
    assert_eq!(problems.len(), 20_000);
    assert!(problems.iter().all(|problem| problem.code == "scene::unknown-node"));
    assert_eq!(problems.iter().filter(|problem| !problem.notes.is_empty()).count(), 20);
}

#[test]
fn grids_and_triangles_are_limited() {
    let grid = |count: &str| {
        format!("(objects: {{ \"g\": (shape: Box(size: (1, 1, 1)), surface: (), repeat: (count: {count}, spacing: (1, 1, 1))) }})")
    };
    assert!(codes(&grid("(16, 16, 16)")).is_empty());
    assert_eq!(codes(&grid("(0, 1, 1)")), ["scene::bad-number"]);
    for count in ["(9, 1, 65536)", "(4294967295, 4294967295, 4294967295)"] {
        assert_eq!(codes(&grid(count)), ["scene::too-much"], "{count}");
    }
    let mut text = String::from("(objects: {");
    for index in 0..20 {
        write!(text, "\"s{index}\": (shape: Sphere(radius: {}, sectors: 512, stacks: 512), surface: ()),", index + 1).unwrap();
    }
    assert_eq!(codes(&(text + "})")), ["scene::too-much"]);
    // Together, some of it spawned.
    let many = |names: [&str; 2]| {
        names.iter().fold(String::from("objects: {"), |text, name| {
            text + &format!("\"{name}\": (shape: Box(size: (1, 1, 1)), surface: (), repeat: (count: (256, 256, 1), spacing: (1, 1, 1))),")
        }) + "}"
    };
    let (problems, rendered) = problems(&format!("({}, timeline: [(at: 9, do: Spawn({}))])", many(["a", "b"]), many(["c", "d"])));
    assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["scene::too-much"]);
    for part in ["196611, and 65537 of the object `d`", "at most 262144 are allowed", "a smaller `count`"] {
        assert!(rendered.contains(part), "{rendered}");
    }
    let probes = "(markers: { \"p\": ProbeVolume(center: (0, 0, 0), counts: (65536, 65536, 65536), spacing: (1, 1, 1)) })";
    assert_eq!(codes(probes), ["scene::too-much"]);
    assert_eq!(codes(&probes.replace("65536, 65536", "0, 1")), ["scene::bad-number"]);
    let half = "ProbeVolume(center: (0, 0, 0), counts: (1024, 512, 1), spacing: (1, 1, 1))";
    assert!(codes(&format!("(markers: {{ \"a\": {half}, \"b\": {half} }})")).is_empty());
    assert_eq!(codes(&format!("(markers: {{ \"a\": {half}, \"b\": {half}, \"c\": {half} }})")), ["scene::too-much"]);
}

#[test]
fn places_that_overflow_publish_nothing_and_do_not_panic() {
    let mut text = String::from("(groups: {");
    for index in 0..40 {
        let parent = if index > 0 { format!("parent: \"g{}\",", index - 1) } else { String::new() };
        write!(text, "\"g{index}\": (scale: (1000000, 1000000, 1000000), translation: (1000000, 0, 0), {parent}),").unwrap();
    }
    let text = text
        + "}, objects: { \"o\": (shape: Box(size: (1, 1, 1)), surface: (), parent: \"g39\") }, timeline: [(at: 1, do: Reparent(node: \"o\", parent: \"g3\"))])";
    let mut world = load_scene_text("test.ron", &text, &mut SourceMap::default()).unwrap().world;
    assert_eq!(set_time(&mut world, 1.0).unwrap_err()[0].code, "world::flat-parent");
    let shown = crate::describe::text(&crate::describe::describe(&mut world));
    assert!(shown.contains("bounds     none"), "{shown}");
}

#[test]
fn a_file_that_stands_too_often_is_too_much() {
    // A chair has two nodes and a mesh.
    let chairs = (0..65_600).fold(String::from("(files: {"), |text, index| text + &format!("\"{index}\": (path: \"chair.gltf\"),"));
    let (loaded, _) = reference::load_beside_chair(&(chairs + "})"));
    let problems = loaded.map(|_| ()).unwrap_err();
    assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["scene::too-much"]);
    assert!(problems[0].message.contains("262144, and 4 of the file `65536`"), "{}", problems[0].message);
}

#[test]
fn as_many_as_are_allowed_load_and_publish() {
    // Each step over them takes a second or less; what took the square of their number would never end.
    let text = r#"(materials: { "a": (), "b": () }, objects: {
        "g": (shape: Sphere(radius: 0.5), repeat: (count: (64, 64, 16), spacing: (2, 2, 2), materials: ["a", "b"])),
        "h": (shape: Box(size: (1, 1, 1)), repeat: (count: (64, 64, 47), spacing: (2, 2, 2), materials: ["a", "b"])),
    })"#;
    let mut world = load_scene_text("test.ron", text, &mut SourceMap::default()).unwrap().world;
    assert_eq!(crate::describe::describe(&mut world).nodes.len(), 2 + 63 * 64 * 64);
    let lists = [(DrawFilter::All, ViewKind::Camera)];
    let request = PublishRequest { camera: None, extent: [64, 64], views: &[], draw_lists: &lists, max_texture_2d: 64 };
    let published = Publisher::default().publish(&mut world, &request).unwrap();
    assert_eq!(published.scene.draw_lists[0].batches.len(), 4);
    // As many copies, of a shape with many triangles.
    let heavy = text.replace("Sphere(radius: 0.5)", "Sphere(radius: 0.5, sectors: 512, stacks: 256)");
    let (problems, rendered) = problems(&heavy);
    assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["scene::too-much"]);
    assert!(rendered.contains("too many triangles") && rendered.contains("at most 268435456"), "{rendered}");
}

#[test]
fn long_names_are_not_compared_letter_by_letter() {
    let long = |letter: &str, index: usize| format!("{}{index}", letter.repeat(300_000));
    let groups =
        (0..12).fold(String::new(), |text, index| text + &format!("\"{}\": (parent: \"{}\"),", long("x", index), long("y", index)));
    let (problems, rendered) = problems(&format!("(groups: {{ {groups} }})"));
    assert_eq!(problems.len(), 12);
    assert!(problems.iter().all(|problem| problem.code == "scene::unknown-node"));
    assert!(rendered.len() < 100_000, "{} bytes", rendered.len());
}

#[test]
fn many_events_that_spawn_and_remove_are_not_slow() {
    let mut text = String::from("(materials: { \"m\": () }, timeline: [");
    for index in 0..10_000 {
        write!(text, "(at: {index}, do: Spawn(objects: {{ \"o{index}\": (shape: Box(size: (1, 1, 1)), material: \"m\") }})),").unwrap();
        write!(text, "(at: {index}, do: Move(node: \"o{index}\", to: (1, 0, 0), during: 0.5)),").unwrap();
    }
    for index in 0..10_000 {
        write!(text, "(at: 40000, do: Remove(node: \"o{index}\")),").unwrap();
    }
    let mut world = load_scene_text("test.ron", &(text + "])"), &mut SourceMap::default()).unwrap().world;
    set_time(&mut world, 35_000.0).unwrap();
    assert_eq!(counts(&world)["opaque"], 10_000);
    set_time(&mut world, 50_000.0).unwrap();
    assert_eq!(counts(&world)["opaque"], 0);
}

#[test]
fn times_that_are_no_times_are_refused() {
    let events = |at: &str, during: &str| {
        format!("(groups: {{ \"a\": () }}, timeline: [(at: {at}, do: Move(node: \"a\", to: (1, 0, 0), during: {during}))])")
    };
    assert!(codes(&events("1000000", "1000000")).is_empty());
    for (at, during) in
        [("1e300", "1"), ("inf", "1"), ("-inf", "1"), ("NaN", "1"), ("-1e-9", "1"), ("1", "1e300"), ("1", "NaN"), ("1", "-inf")]
    {
        assert_eq!(codes(&events(at, during)), ["scene::bad-time"], "{at} {during}");
    }
    let mut world = load_scene_text("test.ron", &events("0", "1"), &mut SourceMap::default()).unwrap().world;
    for time in [1e300, f64::MAX, 1e-300] {
        set_time(&mut world, time).unwrap();
    }
    for time in [f64::NAN, f64::INFINITY, -1e300] {
        assert!(set_time(&mut world, time).is_err());
    }
}

/// A chain of nodes, the last of which moves.
fn deep_file(levels: usize) -> String {
    let nodes = (0..levels).map(|index| format!("{{ \"name\": \"n{index}\", \"children\": [{}] }},", index + 1)).collect::<String>();
    format!(
        "{{ \"asset\": {{ \"version\": \"2.0\" }}, \"scenes\": [{{ \"nodes\": [0] }}], \"nodes\": [{nodes} {{ \"name\": \"last\" }}] }}"
    )
}

#[test]
fn deep_files_are_refused_and_many_events_inside_of_one_are_not_slow() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("deep.gltf"), deep_file(1024)).unwrap();
    std::fs::write(folder.path().join("deep.ron"), "(files: { \"f\": (path: \"deep.gltf\") })").unwrap();
    let refused = load_scene(&folder.path().join("deep.ron"), None, &mut SourceMap::default()).map(|_| ()).unwrap_err();
    assert_eq!(refused.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["scene::too-deep"]);
    std::fs::write(folder.path().join("deep.gltf"), deep_file(1023)).unwrap();
    let event = "(at: 1, do: Turn(node: \"f/last\", by: (0, 1, 0))),";
    let text =
        format!("(files: {{ \"f\": (path: \"deep.gltf\") }}, timeline: [{} (at: 2, do: Hide(node: \"f/n500\"))])", event.repeat(20_000));
    std::fs::write(folder.path().join("deep.ron"), text).unwrap();
    let mut world = load_scene(&folder.path().join("deep.ron"), None, &mut SourceMap::default()).unwrap().world;
    set_time(&mut world, 3.0).unwrap();
    assert_eq!(crate::describe::describe(&mut world).nodes.len(), 1025);
}
