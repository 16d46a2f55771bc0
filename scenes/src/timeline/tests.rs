//! The state of a scene is a function of time, known answers, and every way in which an event can be wrong.

use glam::{Affine3A, Vec3};
use luminaire_graph::diagnostic::{Diagnostic, render};
use luminaire_graph::source::SourceMap;
use proptest::prelude::*;

use crate::load_scene_text;
use crate::publish::counts;
use crate::world::{
    Camera, DirectionalLight, Environment, GlobalTransform, LocalLight, Materials, MeshInstance, Name, ObjectSlot, RectangleLight, Shown,
    Time, World, find_by_name, propagate_transforms, propagate_visibility, set_time,
};

/// Everything that a timeline can do, some of it at the same time and some of it interrupted.
const BUSY: &str = r#"(
    environment: (sky_radiance: (1, 2, 3)),
    materials: { "paint": (base_color: (1, 0, 0), roughness: 0.2), "other": () },
    groups: { "carousel": (translation: (1, 2, 3), rotation: (10, 20, 30), scale: (2, 2, 2)), "rest": (translation: (0, 5, 0)) },
    cameras: { "eye": (position: (0, 1, 5), target: (0, 1, 0), fov: 40, ev100: 10) },
    lights: {
        "lamp": Point(candela: 100, position: (0, 3, 0), parent: "carousel"),
        "sun": Directional(lux: 1000, direction: (0, -1, -1)),
        "window": Rectangle(luminance: 500, size: (2, 1), position: (0, 2, -4), direction: (0, 0, 1)),
    },
    objects: {
        "horse": (shape: Box(size: (1, 2, 3)), material: "paint", translation: (3, 0, 0), parent: "carousel"),
        "wall": (shape: Box(size: (9, 3, 0.2)), material: "other"),
        "grid": (shape: Sphere(radius: 0.1, sectors: 8, stacks: 4), repeat: (count: (2, 3, 2), spacing: (1, 1, 1), materials: ["paint", "other"])),
        "own": (shape: Torus(radius: 1, tube: 0.2), surface: (metallic: 1), parent: "grid"),
    },
    timeline: [
        (at: 0, do: Turn(node: "carousel", by: (0, 720, 0), during: 8)),
        (at: 1, do: Move(node: "horse", to: (3, 1, 0), during: 2, ease: Smooth)),
        (at: 2, do: Move(node: "horse", to: (3, -1, 0), during: 2, ease: In)),
        (at: 2.5, do: Scale(node: "carousel", to: (1, 3, 1), during: 1.5, ease: Out)),
        (at: 3, do: Reparent(node: "horse", parent: "rest")),
        (at: 3, do: Rotate(node: "horse", to: (0, 90, 0), during: 1)),
        (at: 3.5, do: Reparent(node: "lamp", parent: "horse", keep_place: false)),
        (at: 4, do: Remove(node: "wall")),
        (at: 4, do: Spawn(objects: { "wall": (shape: Box(size: (1, 1, 1)), material: "other", parent: "hole") }, groups: { "hole": () })),
        (at: 4.25, do: Remove(node: "grid")),
        (at: 4.5, do: Move(node: "wall", to: (0, 4, 0), during: 3, ease: Hold)),
        (at: 1.5, do: Light(light: "lamp", intensity: 900, color: (1, 0.5, 0.25), during: 4)),
        (at: 2, do: Light(light: "sun", intensity: 0, during: 3, ease: Smooth)),
        (at: 2, do: Light(light: "window", intensity: 50, during: 1)),
        (at: 3, do: Camera(camera: "eye", ev100: 4, fov: 60, during: 2)),
        (at: 1.5, do: Hide(node: "carousel")),
        (at: 2, do: Hide(node: "grid")),
        (at: 4.5, do: Show(node: "carousel")),
        (at: 6.05, do: Hide(node: "window")),
        (at: 0.5, do: Sky(radiance: (0, 0, 0.5), during: 5)),
        (at: 1, do: Material(material: "paint", base_color: (0, 1, 0), roughness: 1, during: 4)),
        (at: 6, do: Material(material: "own", emissive: (10, 0, 0))),
    ],
)"#;

fn load(text: &str) -> World {
    load_scene_text("test.ron", text, &mut SourceMap::default()).unwrap().world
}

fn problems(text: &str) -> (Vec<Diagnostic>, String) {
    let mut sources = SourceMap::default();
    let problems = load_scene_text("test.ron", text, &mut sources).err().unwrap_or_default();
    let rendered = render(&problems, &sources, false);
    (problems, rendered)
}

/// Everything that can be seen, bit by bit: rows, places, lights, materials and the sky.
fn state(world: &mut World) -> String {
    propagate_transforms(world);
    propagate_visibility(world);
    let mut rows = Vec::new();
    let mut query = world.query::<(Option<&Name>, &GlobalTransform, Option<(&ObjectSlot, &MeshInstance)>)>();
    for (name, place, row) in query.iter(world) {
        let bits = place.0.to_cols_array().map(f32::to_bits);
        rows.push(format!("{name:?} {bits:?} {row:?}"));
    }
    let mut query = world.query::<(Option<&Name>, &Shown)>();
    rows.extend(query.iter(world).map(|(name, shown)| format!("{name:?} {shown:?}")));
    rows.extend(world.query::<&LocalLight>().iter(world).map(|light| format!("{light:?}")));
    rows.extend(world.query::<&DirectionalLight>().iter(world).map(|light| format!("{light:?}")));
    rows.extend(world.query::<&RectangleLight>().iter(world).map(|light| format!("{light:?}")));
    rows.extend(world.query::<&Camera>().iter(world).map(|camera| format!("{camera:?}")));
    rows.sort_unstable();
    format!("{rows:#?} {:?} {:?} {:?}", world.resource::<Environment>(), world.resource::<Materials>().0, counts(world))
}

fn place(world: &mut World, name: &str) -> Vec3 {
    propagate_transforms(world);
    let entity = find_by_name(world, name).unwrap();
    world.get::<GlobalTransform>(entity).unwrap().0.translation.into()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn whoever_goes_in_steps_and_whoever_jumps_see_the_same_bits(mut steps in prop::collection::vec(0.0_f64..9.0, 1..12), exact in 0_usize..12) {
        steps.sort_by(f64::total_cmp);
        // Sometimes a step ends exactly at an event.
        if let Some(step) = steps.get_mut(exact) {
            *step = (*step * 2.0).round() / 2.0;
            steps.sort_by(f64::total_cmp);
        }
        let (mut stepping, end) = (load(BUSY), *steps.last().unwrap());
        for step in &steps {
            set_time(&mut stepping, *step).unwrap();
        }
        let mut jumping = load(BUSY);
        set_time(&mut jumping, end).unwrap();
        prop_assert_eq!(state(&mut stepping), state(&mut jumping));
    }
}

#[test]
fn values_are_as_computed_by_hand() {
    let mut world = load(
        r#"(
        groups: { "hub": (translation: (10, 0, 0)) },
        lights: { "lamp": Point(candela: 100, position: (2, 0, 0), parent: "hub") },
        timeline: [
            (at: 1, do: Turn(node: "hub", by: (0, 90, 0), during: 2)),
            (at: 1, do: Light(light: "lamp", intensity: 300, during: 4)),
            (at: 6, do: Move(node: "hub", to: (0, 0, 0))),
            (at: 7, do: Reparent(node: "lamp")),
            (at: 8, do: Move(node: "hub", to: (50, 0, 0))),
        ],
    )"#,
    );
    let mut at = |seconds: f64| {
        set_time(&mut world, seconds).unwrap();
        let lamp = find_by_name(&mut world, "lamp").unwrap();
        (place(&mut world, "lamp"), world.get::<LocalLight>(lamp).unwrap().intensity)
    };
    let diagonal = 2.0 * 0.5_f32.sqrt();
    let expected = [
        (0.5, Vec3::new(12.0, 0.0, 0.0), 100.0),
        (2.0, Vec3::new(10.0 + diagonal, 0.0, -diagonal), 150.0),
        (3.0, Vec3::new(10.0, 0.0, -2.0), 200.0),
        (5.0, Vec3::new(10.0, 0.0, -2.0), 300.0),
        (6.0, Vec3::new(0.0, 0.0, -2.0), 300.0),
        // It has left the hub, and stays.
        (9.0, Vec3::new(0.0, 0.0, -2.0), 300.0),
    ];
    for (seconds, position, intensity) in expected {
        let (there, now) = at(seconds);
        assert!((there - position).length() < 1e-5, "{seconds} s: {there}");
        assert!((now - intensity).abs() < 1e-3, "{seconds} s: {now}");
    }
}

#[test]
fn what_is_removed_is_gone_with_all_below_and_its_slot_is_free() {
    let mut world = load(
        r#"(
        materials: { "m": () },
        objects: {
            "a": (shape: Box(size: (1, 1, 1)), material: "m"),
            "b": (shape: Box(size: (1, 1, 1)), material: "m", repeat: (count: (2, 1, 1), spacing: (1, 1, 1))),
            "c": (shape: Box(size: (1, 1, 1)), material: "m", parent: "b"),
            "d": (shape: Box(size: (1, 1, 1)), material: "m"),
        },
        timeline: [
            (at: 1, do: Remove(node: "b")),
            (at: 2, do: Spawn(objects: { "e": (shape: Cone(radius: 1, height: 1), material: "m", parent: "d", translation: (0, 1, 0)) })),
            (at: 2, do: Move(node: "d", to: (5, 0, 0))),
        ],
    )"#,
    );
    let slots = |world: &mut World| {
        let mut slots: Vec<u32> = world.query::<&ObjectSlot>().iter(world).map(|slot| slot.0).collect();
        slots.sort_unstable();
        slots
    };
    let slot = |world: &mut World, name: &str| {
        let entity = find_by_name(world, name).unwrap();
        world.get::<ObjectSlot>(entity).unwrap().0
    };
    assert_eq!(slots(&mut world), [0, 1, 2, 3, 4]);
    let of_d = slot(&mut world, "d");
    set_time(&mut world, 1.0).unwrap();
    assert_eq!(slots(&mut world).len(), 2);
    assert!(find_by_name(&mut world, "c").is_err());
    set_time(&mut world, 3.0).unwrap();
    assert_eq!(slot(&mut world, "d"), of_d, "a slot is for life");
    assert!(slot(&mut world, "e") < 4, "a free slot is taken");
    assert_eq!(place(&mut world, "e"), Vec3::new(5.0, 1.0, 0.0));
}

#[test]
fn time_goes_back_between_events_and_not_behind_them() {
    let mut world = load(BUSY);
    set_time(&mut world, 6.9).unwrap();
    let mut fresh = load(BUSY);
    set_time(&mut fresh, 6.1).unwrap();
    set_time(&mut world, 6.1).unwrap();
    assert_eq!(state(&mut world), state(&mut fresh));
    let refused = set_time(&mut world, 5.0).unwrap_err();
    assert_eq!(refused[0].code, "world::time-backwards");
    assert_eq!(state(&mut world), state(&mut fresh), "a refusal changes nothing");
    for wrong in [f64::NAN, f64::INFINITY] {
        assert_eq!(set_time(&mut world, wrong).unwrap_err()[0].code, "world::bad-time");
    }
    assert!(set_time(&mut load("()"), 5.0).is_ok());
}

#[test]
fn what_the_application_removed_is_said_or_left_alone() {
    let mut world = load(
        r#"(groups: { "a": (), "b": () }, timeline: [
            (at: 1, do: Move(node: "a", to: (1, 0, 0), during: 2)),
            (at: 2, do: Move(node: "b", to: (1, 0, 0))),
            (at: 2, do: Spawn(groups: { "c": (), "d": (parent: "b") })),
            (at: 2, do: Spawn(groups: { "e": (translation: (5, 0, 0)) })),
            (at: 3, do: Hide(node: "a")),
            (at: 3, do: Move(node: "e", to: (7, 0, 0))),
        ])"#,
    );
    set_time(&mut world, 1.5).unwrap();
    for name in ["a", "b"] {
        let entity = find_by_name(&mut world, name).unwrap();
        world.despawn(entity);
    }
    set_time(&mut world, 1.7).unwrap();
    let failed = set_time(&mut world, 2.0).unwrap_err();
    assert_eq!(failed.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["world::unknown-node"; 2]);
    assert!(failed.iter().all(|problem| problem.message.contains("`b`") && problem.notes == ["an event at 2 s"]), "{failed:?}");
    // All else has happened, and time goes on.
    assert_eq!((place(&mut world, "e"), world.get_resource::<Time>()), (Vec3::X * 5.0, Some(&Time(2.0))));
    assert!(find_by_name(&mut world, "c").is_err() && find_by_name(&mut world, "d").is_err());
    set_time(&mut world, 2.5).unwrap();
    assert_eq!(set_time(&mut world, 4.0).unwrap_err().len(), 1);
    assert_eq!(place(&mut world, "e"), Vec3::X * 7.0);
    set_time(&mut world, 5.0).unwrap();
}

/// In the middle of its change `flat` has no height, which no file says.
const FAILING: &str = r#"(
    groups: { "a": (translation: (1, 1, 1)), "b": (translation: (2, 0, 0)), "flat": () },
    timeline: [
        (at: 0, do: Scale(node: "flat", to: (1, -1, 1), during: 4)),
        (at: 1, do: Move(node: "b", to: (2, 4, 0), during: 4)),
        (at: 2, do: Reparent(node: "a", parent: "flat")),
        (at: 2, do: Hide(node: "b")),
        (at: 2, do: Reparent(node: "b", parent: "flat")),
        (at: 2, do: Turn(node: "a", by: (0, 90, 0), during: 2)),
        (at: 3, do: Reparent(node: "a", parent: "flat")),
        (at: 5, do: Show(node: "b")),
    ],
)"#;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn events_that_fail_keep_nothing_from_happening(mut steps in prop::collection::vec(0_u8..14, 1..10)) {
        steps.sort_unstable();
        let end = f64::from(*steps.last().unwrap()) * 0.5;
        let (mut stepping, mut jumping, mut failed) = (load(FAILING), load(FAILING), Vec::new());
        for step in steps {
            failed.extend(set_time(&mut stepping, f64::from(step) * 0.5).err().unwrap_or_default());
        }
        prop_assert_eq!(&failed, &set_time(&mut jumping, end).err().unwrap_or_default());
        prop_assert_eq!(failed.len(), if end < 2.0 { 0 } else { 2 });
        prop_assert!(failed.iter().all(|problem| problem.code == "world::flat-parent"));
        prop_assert_eq!(state(&mut stepping), state(&mut jumping));
    }
}

#[test]
fn what_is_hidden_comes_back_with_all_below() {
    let mut world = load(
        r#"(
        materials: { "m": () },
        groups: { "room": (), "desk": (parent: "room") },
        lights: { "lamp": Point(candela: 1, position: (0, 1, 0), parent: "desk") },
        objects: { "cup": (shape: Box(size: (1, 1, 1)), material: "m", parent: "desk") },
        timeline: [
            (at: 0, do: Hide(node: "desk")),
            (at: 1, do: Hide(node: "room")),
            (at: 2, do: Show(node: "desk")),
            (at: 2, do: Spawn(objects: { "pen": (shape: Box(size: (1, 1, 1)), material: "m", parent: "desk") })),
            (at: 3, do: Reparent(node: "cup")),
            (at: 4, do: Show(node: "room")),
            (at: 5, do: Hide(node: "lamp")),
        ],
    )"#,
    );
    let names = ["lamp", "cup", "pen"];
    let mut shown = |seconds: f64| {
        set_time(&mut world, seconds).unwrap();
        propagate_visibility(&mut world);
        names.map(|name| find_by_name(&mut world, name).is_ok_and(|entity| world.get::<Shown>(entity).unwrap().0))
    };
    let expected = [
        (0.0, [false; 3]),
        (1.0, [false; 3]),
        (2.0, [false; 3]),
        (3.0, [false, true, false]),
        (4.0, [true, true, true]),
        (5.0, [false, true, true]),
    ];
    for (seconds, expected) in expected {
        assert_eq!(shown(seconds), expected, "{seconds} s");
    }
}

#[test]
fn a_place_can_not_be_kept_below_what_has_no_extent() {
    let mut world = load(
        r#"(groups: { "a": (translation: (1, 1, 1)), "flat": () }, timeline: [
            (at: 0, do: Scale(node: "flat", to: (1, -1, 1), during: 2)), (at: 1, do: Reparent(node: "a", parent: "flat"))])"#,
    );
    assert_eq!(set_time(&mut world, 2.0).unwrap_err()[0].code, "world::flat-parent");
    let entity = find_by_name(&mut world, "a").unwrap();
    assert_eq!(world.get::<crate::world::Transform>(entity).unwrap().0, Affine3A::from_translation(Vec3::ONE));
}

#[test]
fn a_wrong_timeline_is_refused_with_both_places() {
    let head = r#"cameras: { "bare": (position: (0, 0, 1), target: (0, 0, 0)), "flat": (position: (0, 0, 1), target: (0, 0, 0), ortho: 2) },
        groups: { "a": (), "b": (parent: "a") }, lights: { "lamp": Point(candela: 1, position: (0, 0, 0)) }, materials: { "m": () },"#;
    let cases = [
        ("(at: -1, do: Remove(node: \"a\"))", "scene::bad-time", "`at` of an event is -1"),
        ("(at: NaN, do: Remove(node: \"a\"))", "scene::bad-time", "must lie between 0 and 1000000 seconds"),
        ("(at: 1, do: Move(node: \"a\", to: (0, 0, 0), during: -2))", "scene::bad-time", "`during`"),
        ("(at: 1, do: Move(node: \"a\", to: (0, inf, 0)))", "scene::bad-number", "`to` of the move of `a`"),
        ("(at: 1, do: Move(node: \"aa\", to: (0, 0, 0)))", "scene::unknown-node", "did you mean `a`?"),
        ("(at: 1, do: Remove(node: \"a\")), (at: 2, do: Remove(node: \"b\"))", "scene::removed-node", "removed here"),
        ("(at: 2, do: Remove(node: \"a\")), (at: 1, do: Remove(node: \"b\"))", "", ""),
        ("(at: 1, do: Remove(node: \"c\")), (at: 2, do: Spawn(groups: { \"c\": () }))", "scene::later-node", "spawned here"),
        ("(at: 1, do: Spawn(groups: { \"a\": () }))", "scene::duplicate-name", "`a` is the name of a group and of a group"),
        ("(at: 1, do: Reparent(node: \"a\", parent: \"b\"))", "scene::cycle", "`a` would stand below itself"),
        ("(at: 1, do: Spawn(groups: { \"x\": (parent: \"y\"), \"y\": (parent: \"x\") }))", "scene::cycle", "`x` below `y` below the first"),
        ("(at: 1, do: Hide(node: \"aa\"))", "scene::unknown-node", "did you mean `a`?"),
        ("(at: 1, do: Remove(node: \"a\")), (at: 2, do: Show(node: \"b\"))", "scene::removed-node", "removed here"),
        (
            "(at: 1, do: Scale(node: \"b\", to: (0, 1, 1))), (at: 1, do: Reparent(node: \"lamp\", parent: \"b\"))",
            "scene::flat-parent",
            "keep_place",
        ),
        (
            "(at: 1, do: Spawn(groups: { \"x\": (scale: (0, 1, 1)), \"y\": (parent: \"x\") })), (at: 1, do: Reparent(node: \"a\", parent: \"y\"))",
            "scene::flat-parent",
            "`a` can't keep",
        ),
        (
            "(at: 1, do: Scale(node: \"b\", to: (0, 1, 1))), (at: 2, do: Scale(node: \"b\", to: (1, 1, 1))), (at: 3, do: Reparent(node: \"lamp\", parent: \"b\"))",
            "",
            "",
        ),
        ("(at: 1, do: Scale(node: \"b\", to: (0, 1, 1))), (at: 3, do: Reparent(node: \"lamp\", parent: \"b\", keep_place: false))", "", ""),
        ("(at: 1, do: Light(light: \"a\", intensity: 1))", "scene::wrong-kind", "`a` is no light"),
        ("(at: 1, do: Light(light: \"lamp\"))", "scene::no-change", "`intensity` or `color`"),
        ("(at: 1, do: Light(light: \"lamp\", intensity: -1))", "scene::bad-number", "`intensity`"),
        ("(at: 1, do: Camera(camera: \"bare\", ev100: 1))", "scene::wrong-kind", "needs an exposure `ev100`"),
        ("(at: 1, do: Camera(camera: \"flat\", fov: 50))", "scene::wrong-kind", "being orthographic"),
        ("(at: 1, do: Camera(camera: \"lamp\", fov: 50))", "scene::wrong-kind", "no camera"),
        ("(at: 1, do: Material(material: \"n\", roughness: 1))", "scene::unknown-material", "did you mean `m`?"),
        ("(at: 1, do: Material(material: \"m\"))", "scene::no-change", "changes nothing"),
        ("(at: 1, do: Material(material: \"m\", roughness: 2))", "scene::bad-number", "`roughness`"),
        ("(at: 1, do: Explode(node: \"a\"))", "deserialize", "Explode"),
    ];
    for (events, code, text) in cases {
        let (problems, rendered) = problems(&format!("({head} timeline: [{events}])"));
        match code {
            "" => assert!(problems.is_empty(), "{rendered}"),
            "deserialize" => assert!(!problems.is_empty() && rendered.contains(text), "{rendered}"),
            _ => {
                assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), [code], "{events}\n{rendered}");
                assert!(rendered.contains(text), "{rendered}");
                assert!(problems[0].primary.as_ref().is_some_and(|label| label.span.is_somewhere()));
            }
        }
    }
}

#[test]
fn too_many_events_are_refused_and_many_are_not_slow() {
    let event = "(at: 1, do: Move(node: \"a\", to: (0, 0, 0))),";
    let text = |count: usize| format!("(groups: {{ \"a\": () }}, timeline: [{}])", event.repeat(count));
    let (problems, rendered) = problems(&text(100_001));
    assert_eq!(problems[0].code, "scene::too-much", "{rendered}");
    set_time(&mut load(&text(20_000)), 2.0).unwrap();
}
