//! Hierarchy, repetition, files, rectangles, markers and orthographic cameras: known answers, and what wrong ones say.

use glam::{UVec3, Vec2};

use super::reference::load_beside_chair;
use super::*;
use crate::asset::Projection;
use crate::world::{Fly, Materials, MeshInstance, Meshes, Orbit, ProbeVolume, RectangleLight, ReflectionProbe, Volume};

fn load(text: &str) -> crate::World {
    let mut sources = SourceMap::default();
    let loaded = load_scene_text("test.ron", text, &mut sources);
    let mut world = loaded.unwrap_or_else(|problems| panic!("{}", render(&problems, &sources, false))).world;
    propagate_transforms(&mut world);
    world
}

fn place(world: &mut crate::World, name: &str) -> Vec3 {
    let entity = find_by_name(world, name).unwrap();
    world.get::<GlobalTransform>(entity).unwrap().0.translation.into()
}

#[test]
fn children_orbit_spread_and_inherit() {
    let mut world = load(
        r#"(
        lights: { "moonlight": Point(candela: 1, position: (1, 0, 0), parent: "moon") },
        objects: { "moon": (shape: Sphere(radius: 0.1), surface: (), translation: (2, 0, 0), rotation: (0, 90, 0), parent: "planet") },
        groups: { "planet": (translation: (10, 0, 0), parent: "star"), "star": (translation: (0, 5, 0), rotation: (0, 90, 0), scale: (2, 2, 2)) },
    )"#,
    );
    // A quarter turn takes +x to -z: the planet stands at 20 along -z, the moon 4 further, its light 2 to its own -z, turned twice.
    for (name, expected) in
        [("planet", Vec3::new(0.0, 5.0, -20.0)), ("moon", Vec3::new(0.0, 5.0, -24.0)), ("moonlight", Vec3::new(-2.0, 5.0, -24.0))]
    {
        let there = place(&mut world, name);
        assert!((there - expected).length() < 1e-5, "{name}: {there}");
    }
}

#[test]
fn wrong_parents_are_said_with_all_places() {
    let cases = [
        (
            r#"(groups: { "a": (parent: "b"), "b": (parent: "c"), "c": (parent: "a"), "d": (parent: "a") })"#,
            vec!["scene::cycle"],
            "`a` below `b` below `c` below the first",
        ),
        (r#"(groups: { "a": (parent: "a") })"#, vec!["scene::cycle"], "`a` is its own parent"),
        (r#"(groups: { "hub": (), "a": (parent: "hup") })"#, vec!["scene::unknown-node"], "did you mean `hub`?"),
        (
            r#"(groups: { "a": (parent: "hup"), "b": (parent: "b") }, markers: { "a": BoxVolume(center: (0, 0, 0), size: (1, 0, 1)) })"#,
            vec!["scene::bad-number", "scene::duplicate-name", "scene::unknown-node", "scene::cycle"],
            "the marker",
        ),
    ];
    for (text, expected, part) in cases {
        let (problems, rendered) = problems(text);
        assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), expected, "{rendered}");
        assert!(rendered.contains(part), "{rendered}");
    }
    let (cycle, _) = problems(r#"(groups: { "a": (parent: "b"), "b": (parent: "a") })"#);
    assert_eq!(cycle[0].secondary.len(), 1);
}

#[test]
fn copies_stand_on_a_grid_around_their_place() {
    let mut world = load(
        r#"(materials: { "a": (), "b": () }, objects: { "grid": (
            shape: Box(size: (1, 1, 1)), translation: (0, 10, 0), scale: (2, 1, 1),
            repeat: (count: (3, 2, 1), spacing: (1, 4, 9), materials: ["a", "b"]),
        ) })"#,
    );
    let mut copies: Vec<(Vec3, usize)> = world
        .query::<(&GlobalTransform, &MeshInstance)>()
        .iter(&world)
        .map(|(place, instance)| (Vec3::from(place.0.translation), instance.material))
        .collect();
    copies.sort_by(|(first, _), (second, _)| (first.y, first.x).partial_cmp(&(second.y, second.x)).unwrap());
    let expected = [(-2.0, 8.0, 0), (0.0, 8.0, 1), (2.0, 8.0, 0), (-2.0, 12.0, 1), (0.0, 12.0, 0), (2.0, 12.0, 1)];
    assert_eq!(copies, expected.map(|(x, y, material)| (Vec3::new(x, y, 0.0), material)));
    assert_eq!(world.resource::<Meshes>().0.len(), 1);
}

#[test]
fn rectangles_glow_and_face_where_they_are_directed() {
    let mut world = load(
        r#"(lights: { "window": Rectangle(luminance: 300, size: (2, 1), position: (0, 2, 0), direction: (1, 0, 0), color: (1, 0.5, 0), two_sided: true) })"#,
    );
    let entity = find_by_name(&mut world, "window").unwrap();
    let light = *world.get::<RectangleLight>(entity).unwrap();
    assert_eq!(light, RectangleLight { color: Vec3::new(1.0, 0.5, 0.0), luminance: 300.0, size: Vec2::new(2.0, 1.0), two_sided: true });
    let instance = *world.get::<MeshInstance>(entity).unwrap();
    let material = &world.resource::<Materials>().0[instance.material];
    assert_eq!((material.emissive, material.double_sided), ([300.0, 150.0, 0.0], true));
    let place = world.get::<GlobalTransform>(entity).unwrap().0;
    let mesh = &world.resource::<Meshes>().0[instance.mesh];
    for vertex in &mesh.vertices {
        assert!((place.transform_vector3(vertex.normal.into()) - Vec3::X).length() < 1e-6);
        let corner = place.transform_point3(vertex.position.into());
        assert!(corner.x.abs() < 1e-6 && ((corner.y - 2.0).abs() - 0.5).abs() < 1e-6 && (corner.z.abs() - 1.0).abs() < 1e-6, "{corner}");
    }
}

#[test]
fn markers_are_spawned_and_probes_stand_where_they_should() {
    let mut world = load(
        r#"(markers: {
            "probes": ProbeVolume(center: (0, 1, 0), counts: (4, 2, 4), spacing: (5, 5, 5)),
            "mirror": ReflectionProbe(position: (1, 1, 1), size: (3, 2, 3), parent: "probes"),
            "room": BoxVolume(center: (0, 0, 0), size: (1, 2, 3)),
        })"#,
    );
    let [probes, mirror, room] = ["probes", "mirror", "room"].map(|name| find_by_name(&mut world, name).unwrap());
    let volume = *world.get::<ProbeVolume>(probes).unwrap();
    assert_eq!(volume.counts, UVec3::new(4, 2, 4));
    assert_eq!(
        (volume.position(UVec3::ZERO), volume.position(UVec3::new(3, 1, 2))),
        (Vec3::new(-7.5, -2.5, -7.5), Vec3::new(7.5, 2.5, 2.5))
    );
    assert_eq!(*world.get::<ReflectionProbe>(mirror).unwrap(), ReflectionProbe { size: Vec3::new(3.0, 2.0, 3.0), near: 0.1, far: 100.0 });
    assert_eq!(place(&mut world, "mirror"), Vec3::new(1.0, 2.0, 1.0));
    assert_eq!(*world.get::<Volume>(room).unwrap(), Volume { size: Vec3::new(1.0, 2.0, 3.0) });
}

#[test]
fn cameras_can_be_orthographic_or_end_somewhere() {
    let mut world = load(
        r#"(cameras: {
            "plan": (position: (0, 9, 0), target: (0, 0, 0), ortho: 4),
            "near": (position: (0, 0, 9), target: (0, 0, 0), fov: 90, near: 1, far: 50),
        })"#,
    );
    let mut projection = |name: &str| {
        let entity = find_by_name(&mut world, name).unwrap();
        world.get::<Camera>(entity).unwrap().projection
    };
    assert_eq!(projection("plan"), Projection::Orthographic { ymag: 2.0, xmag: 2.0, near: 0.01, far: 1000.0 });
    assert_eq!(projection("near"), Projection::Perspective { yfov: std::f32::consts::FRAC_PI_2, near: 1.0, far: Some(50.0) });
    let both = codes(r#"(cameras: { "c": (position: (0, 9, 0), target: (0, 0, 0), ortho: 4, fov: 40, near: 3, far: 2) })"#);
    assert_eq!(both, ["scene::which-projection", "scene::bad-number"]);
}

#[test]
fn files_have_materials_of_their_own_and_nodes_that_can_be_parents() {
    let text = r#"(
        files: {
            "chair": (path: "chair.gltf", translation: (5, 0, 0)),
            "dark": (path: "chair.gltf", materials: { "Wood": (roughness: 0.25, emissive: (1, 2, 3)) }),
        },
        groups: { "cat": (translation: (0, 0.5, 0), parent: "chair/seat") },
        timeline: [
            (at: 1, do: Move(node: "dark/legs", to: (0, 3, 0))),
            (at: 2, do: Reparent(node: "chair/legs")),
            (at: 3, do: Remove(node: "chair")),
            (at: 3, do: Material(material: "dark/Wood", roughness: 1)),
            (at: 4, do: Spawn(files: { "chair": (path: "chair.gltf", translation: (0, 0, 7)) })),
        ],
    )"#;
    let (loaded, sources) = load_beside_chair(text);
    let mut world = loaded.unwrap_or_else(|problems| panic!("{}", render(&problems, &sources, false))).world;
    propagate_transforms(&mut world);
    assert_eq!(place(&mut world, "cat"), Vec3::new(5.0, 1.5, 0.0));
    let looks = |world: &crate::World| {
        let materials = &world.resource::<Materials>().0;
        materials.iter().map(|material| (material.base_color[0], material.roughness, material.emissive[1])).collect::<Vec<_>>()
    };
    assert_eq!(looks(&world), [(0.5, 0.75, 0.0), (0.5, 0.25, 2.0)]);
    set_time(&mut world, 3.5).unwrap();
    propagate_transforms(&mut world);
    assert_eq!(place(&mut world, "cat"), Vec3::new(5.0, 2.5, 0.0), "it left the chair with legs and seat");
    assert!(find_by_name(&mut world, "chair").is_err());
    assert_eq!(looks(&world)[1], (0.5, 1.0, 2.0));
    set_time(&mut world, 4.0).unwrap();
    propagate_transforms(&mut world);
    assert_eq!(place(&mut world, "chair"), Vec3::new(0.0, 0.0, 7.0));

    let wrong = [
        (
            r#"(files: { "chair": (path: "chair.gltf", materials: { "Wod": (), "Wood": (roughness: 2) }) })"#,
            vec!["scene::unknown-material", "scene::bad-number"],
        ),
        (r#"(files: { "chair": (path: "chair.gltf") }, groups: { "cat": (parent: "chair/seet") })"#, vec!["scene::unknown-node"]),
        (
            r#"(files: { "chair": (path: "chair.gltf") }, timeline: [(at: 1, do: Remove(node: "chair")), (at: 2, do: Move(node: "chair/seat", to: (0, 0, 0)))])"#,
            vec!["scene::removed-node"],
        ),
        (
            r#"(files: { "chair": (path: "chair.gltf") }, timeline: [(at: 1, do: Material(material: "chair/Wod", roughness: 1))])"#,
            vec!["scene::unknown-material"],
        ),
        (
            r#"(files: { "chair": (path: "chair.gltf") }, timeline: [(at: 1, do: Reparent(node: "chair/legs", parent: "chair/seat"))])"#,
            vec!["scene::cycle"],
        ),
    ];
    for (text, expected) in wrong {
        let (loaded, sources) = load_beside_chair(text);
        let problems = loaded.unwrap_err();
        let rendered = render(&problems, &sources, false);
        assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), expected, "{rendered}");
        assert!(!rendered.contains("Wod") || rendered.contains("did you mean `Wood`?"), "{rendered}");
    }
}

#[test]
fn clips_play_as_written() {
    let text = r#"(
        files: {
            "first": (path: "chair.gltf"),
            "slow": (path: "chair.gltf", animation: (clip: "Rise", speed: 0.5, start: 1, again: Once)),
        },
        groups: { "a": (parent: "first/seat"), "b": (parent: "slow/seat") },
        timeline: [
            (at: 4.5, do: Animate(file: "first", clip: "0", speed: 2, again: PingPong)),
            (at: 6, do: Spawn(files: { "late": (path: "chair.gltf") }, groups: { "c": (parent: "late/seat") })),
        ],
    )"#;
    let (loaded, sources) = load_beside_chair(text);
    let mut world = loaded.unwrap_or_else(|problems| panic!("{}", render(&problems, &sources, false))).world;
    let expected = [("a", 0.5, 1.5), ("a", 2.5, 1.5), ("b", 2.5, 1.75), ("b", 5.5, 3.0), ("a", 5.75, 2.5), ("c", 6.5, 1.5)];
    for (name, seconds, height) in expected {
        set_time(&mut world, seconds).unwrap();
        propagate_transforms(&mut world);
        assert!((place(&mut world, name).y - height).abs() < 1e-5, "{name} at {seconds} s: {}", place(&mut world, name));
    }
    let shown = crate::describe::text(&crate::describe::describe(&mut world));
    assert!(shown.contains("plays `Rise` of 2 s at speed 0.5 from 1 s once"), "{shown}");
    let wrong = [
        (
            r#"(files: { "a": (path: "chair.gltf", animation: (clip: "Rize", speed: 1e9)) })"#,
            vec!["scene::bad-number", "scene::unknown-clip"],
        ),
        (r#"(files: { "a": (path: "chair.gltf") }, timeline: [(at: 1, do: Animate(file: "a", clip: "7"))])"#, vec!["scene::unknown-clip"]),
        (r#"(groups: { "a": () }, timeline: [(at: 1, do: Animate(file: "a"))])"#, vec!["scene::wrong-kind"]),
    ];
    for (text, expected) in wrong {
        let (loaded, sources) = load_beside_chair(text);
        let problems = loaded.unwrap_err();
        let rendered = render(&problems, &sources, false);
        assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), expected, "{rendered}");
        assert!(!rendered.contains("Rize") || rendered.contains("did you mean `Rise`?"), "{rendered}");
    }
}

#[test]
fn cameras_travel_obey_and_are_exposed() {
    let mut world = load(
        r#"(cameras: {
            "train": (position: (0, 0, 5), target: (0, 0, 0), path: (keys: [
                (at: 0, position: (0, 0, 5), target: (0, 0, 0), fov: 40), (at: 2, position: (4, 0, 5), target: (4, 0, 0), fov: 60),
            ], straight: true, again: Once)),
            "bird": (position: (0, 0, 5), target: (0, 0, 0), exposure: 0.5, controller: Fly(speed: 6)),
            "moon": (position: (0, 0, 5), target: (0, 0, 1), controller: Orbit(turn: 90, nearest: 1, farthest: 20)),
        }, timeline: [(at: 1, do: Camera(camera: "bird", exposure: 2))])"#,
    );
    set_time(&mut world, 1.0).unwrap();
    propagate_transforms(&mut world);
    assert!((place(&mut world, "train") - Vec3::new(2.0, 0.0, 5.0)).length() < 1e-5);
    let [train, bird, moon] = ["train", "bird", "moon"].map(|name| find_by_name(&mut world, name).unwrap());
    let Projection::Perspective { yfov, .. } = world.get::<Camera>(train).unwrap().projection else { panic!("no perspective") };
    assert!((yfov.to_degrees() - 50.0).abs() < 1e-3);
    assert_eq!(world.get::<Camera>(bird).unwrap().exposure, Exposure::Factor(2.0));
    assert_eq!(world.get::<Fly>(bird).unwrap().speed, 6.0);
    let orbit = world.get::<Orbit>(moon).unwrap();
    assert_eq!((orbit.distance(), orbit.nearest, orbit.farthest), (4.0, 1.0, 20.0));
    let head = "position: (0, 0, 5), target: (0, 0, 0)";
    let wrong = [
        ("ev100: 3, exposure: 1", vec!["scene::which-exposure"]),
        ("path: (keys: [])", vec!["scene::camera-path"]),
        (
            "path: (keys: [(at: 1, position: (0, 0, 1), target: (0, 0, 0)), (at: 1, position: (0, 0, 2), target: (0, 0, 0))])",
            vec!["scene::camera-path"],
        ),
        (
            "path: (keys: [(at: -1, position: (0, 0, 1), target: (0, 0, 0))]), controller: Fly()",
            vec!["scene::bad-time", "scene::which-motion"],
        ),
        ("controller: Orbit(nearest: 5, farthest: 4)", vec!["scene::bad-number"]),
    ];
    for (fields, expected) in wrong {
        assert_eq!(codes(&format!("(cameras: {{ \"c\": ({head}, {fields}) }})")), expected, "{fields}");
    }
}

#[test]
fn animated_nodes_that_change_parents_are_functions_of_time_too() {
    let text = r#"(
        files: { "chair": (path: "chair.gltf", rotation: (0, 0, 30)), "other": (path: "chair.gltf", animation: (speed: 0.3)) },
        groups: { "cat": (parent: "chair/seat"), "wheel": () },
        timeline: [
            (at: 0.5, do: Turn(node: "wheel", by: (0, 900, 0), during: 5)),
            (at: 1.3, do: Reparent(node: "cat", parent: "other/seat")),
            (at: 2.1, do: Reparent(node: "chair/legs", parent: "wheel")),
            (at: 2.4, do: Animate(file: "other", speed: -1)),
            (at: 2.9, do: Move(node: "chair/legs", to: (0, 0, 9), during: 2)),
            (at: 3.7, do: Reparent(node: "cat", parent: "wheel")),
        ],
    )"#;
    let at = |steps: &[f64]| {
        let mut world = load_beside_chair(text).0.unwrap().world;
        for step in steps {
            set_time(&mut world, *step).unwrap();
        }
        propagate_transforms(&mut world);
        let bits = |place: &GlobalTransform| place.0.to_cols_array().map(f32::to_bits);
        let mut places: Vec<_> = world.query::<&GlobalTransform>().iter(&world).map(bits).collect();
        places.sort_unstable();
        places
    };
    for end in [1.3, 2.0, 3.0, 3.7, 4.44, 7.0] {
        let steps: Vec<f64> = (1..30).map(|step| f64::from(step) * 0.17).filter(|step| *step < end).chain([end]).collect();
        assert_eq!(at(&steps), at(&[end]), "{end}");
    }
}
