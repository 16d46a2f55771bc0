//! Scene files that ask for too much: they are refused with a reason, or loaded within reason.

use std::fmt::Write;

use super::*;

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
    for count in ["(0, 1, 1)", "(1025, 1024, 1)", "(4294967295, 4294967295, 4294967295)"] {
        assert_eq!(codes(&grid(count)), ["scene::bad-number"], "{count}");
    }
    let mut text = String::from("(objects: {");
    for index in 0..20 {
        write!(text, "\"s{index}\": (shape: Sphere(radius: {}, sectors: 512, stacks: 512), surface: ()),", index + 1).unwrap();
    }
    assert_eq!(codes(&(text + "})")), ["scene::too-much"]);
    let many = (0..3).fold(String::from("(objects: {"), |text, index| {
        text + &format!("\"g{index}\": (shape: Box(size: (1, 1, 1)), surface: (), repeat: (count: (1024, 512, 1), spacing: (1, 1, 1))),")
    });
    assert_eq!(codes(&(many + "})")), ["scene::too-much"]);
    let probes = "(markers: { \"p\": ProbeVolume(center: (0, 0, 0), counts: (65536, 65536, 65536), spacing: (1, 1, 1)) })";
    assert_eq!(codes(probes), ["scene::bad-number"]);
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
