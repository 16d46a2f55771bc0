//! Animations and cameras of real glTF files, against a reader of its own that knows nothing of the loader: JSON, raw floats, and
//! the formulas of glTF 2.0, appendix C, in 64 bits.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests")]

mod support;

use std::collections::BTreeMap;
use std::path::Path;

use bevy_ecs::prelude::Entity;
use glam::{Affine3A, DMat4, DQuat, DVec3, DVec4};
use luminaire_scenes::asset::Asset;
use luminaire_scenes::gltf;
use luminaire_scenes::publish::{CameraTable, PublishRequest, Publisher};
use luminaire_scenes::world::{
    AnimationPlayer, GlobalTransform, Transform, World, new_world, propagate_transforms, select_camera, set_time, spawn_asset,
};
use serde_json::Value;
use support::{AssetTest, messages};

/// A file, read again.
struct File {
    json: Value,
    buffers: Vec<Vec<u8>>,
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn index(value: &Value) -> usize {
    value.as_u64().unwrap() as usize
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

impl File {
    fn read(path: &Path) -> File {
        let json: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
        let buffer = |buffer: &Value| std::fs::read(path.with_file_name(buffer["uri"].as_str().unwrap())).unwrap();
        let buffers = list(&json["buffers"]).iter().map(buffer).collect();
        File { json, buffers }
    }

    /// The elements of an accessor of floats, with zeros up to four components.
    fn floats(&self, accessor: &Value) -> Vec<DVec4> {
        let accessor = &self.json["accessors"][index(accessor)];
        assert_eq!(accessor["componentType"], 5126);
        let components = match accessor["type"].as_str().unwrap() {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            other => panic!("{other} in an animation"),
        };
        let view = &self.json["bufferViews"][index(&accessor["bufferView"])];
        assert!(view["byteStride"].is_null());
        let start = view["byteOffset"].as_u64().unwrap_or(0) + accessor["byteOffset"].as_u64().unwrap_or(0);
        let bytes = &self.buffers[index(&view["buffer"])][start as usize..];
        let element = |bytes: &[u8]| {
            let mut element = DVec4::ZERO;
            for (slot, bytes) in bytes.chunks_exact(4).enumerate() {
                element[slot] = f64::from(f32::from_le_bytes(bytes.try_into().unwrap()));
            }
            element
        };
        bytes.chunks_exact(4 * components).take(index(&accessor["count"])).map(element).collect()
    }

    /// The value of an animation's sampler.
    fn sample(&self, sampler: &Value, time: f64, is_rotation: bool) -> DVec4 {
        let keys: Vec<f64> = self.floats(&sampler["input"]).iter().map(|key| key.x).collect();
        let values = self.floats(&sampler["output"]);
        let kind = sampler["interpolation"].as_str().unwrap_or("LINEAR");
        let value = |key: usize| if kind == "CUBICSPLINE" { values[3 * key + 1] } else { values[key] };
        let last = keys.len() - 1;
        if time <= keys[0] || last == 0 {
            return value(0);
        }
        if time >= keys[last] {
            return value(last);
        }
        let k = (0..last).find(|k| keys[*k] <= time && time < keys[k + 1]).unwrap();
        let interval = keys[k + 1] - keys[k];
        let t = (time - keys[k]) / interval;
        let (a, b) = (value(k), value(k + 1));
        match kind {
            "STEP" => a,
            "CUBICSPLINE" => {
                let (t2, t3) = (t * t, t * t * t);
                let (leaving, arriving) = (values[3 * k + 2], values[3 * (k + 1)]);
                let cubic = a * (2.0 * t3 - 3.0 * t2 + 1.0)
                    + leaving * (interval * (t3 - 2.0 * t2 + t))
                    + b * (-2.0 * t3 + 3.0 * t2)
                    + arriving * (interval * (t3 - t2));
                if is_rotation { cubic.normalize() } else { cubic }
            }
            "LINEAR" if is_rotation => {
                let (a, b) = (a.normalize(), b.normalize());
                let cosine = a.dot(b);
                let angle = cosine.abs().min(1.0).acos();
                if angle < 1e-5 {
                    return a;
                }
                a * ((angle * (1.0 - t)).sin() / angle.sin()) + b * (cosine.signum() * (angle * t).sin() / angle.sin())
            }
            "LINEAR" => a * (1.0 - t) + b * t,
            other => panic!("{other}"),
        }
    }

    /// Local transforms of all nodes, with all animations playing in a loop; at rest without a time. Keys are the nodes that move.
    fn locals(&self, time: Option<f64>) -> (Vec<DMat4>, Vec<usize>) {
        let nodes = list(&self.json["nodes"]);
        let read = |node: &Value, key: &str, default: DVec4| match list(&node[key]) {
            [] => default,
            values => DVec4::from_array(std::array::from_fn(|slot| values.get(slot).map_or(0.0, number))),
        };
        let mut parts: Vec<[DVec4; 3]> = nodes
            .iter()
            .map(|node| [read(node, "translation", DVec4::ZERO), read(node, "rotation", DVec4::W), read(node, "scale", DVec4::ONE)])
            .collect();
        let mut moving = Vec::new();
        for animation in list(&self.json["animations"]) {
            let samplers = list(&animation["samplers"]);
            let channels = list(&animation["channels"]);
            let ends = channels.iter().flat_map(|channel| self.floats(&samplers[index(&channel["sampler"])]["input"]));
            let end = ends.fold(0.0, |end: f64, key| end.max(key.x));
            for channel in channels {
                let node = index(&channel["target"]["node"]);
                let part = match channel["target"]["path"].as_str().unwrap() {
                    "translation" => 0,
                    "rotation" => 1,
                    "scale" => 2,
                    _ => continue,
                };
                moving.push(node);
                if let Some(time) = time {
                    parts[node][part] = self.sample(&samplers[index(&channel["sampler"])], time % end, part == 1);
                }
            }
        }
        let local = |(node, [translation, rotation, scale]): (&Value, [DVec4; 3])| match list(&node["matrix"]) {
            [] => {
                let rotation = DQuat::from_vec4(rotation.normalize());
                DMat4::from_scale_rotation_translation(scale.truncate(), rotation, translation.truncate())
            }
            matrix => DMat4::from_cols_array(&std::array::from_fn(|entry| number(&matrix[entry]))),
        };
        moving.sort_unstable();
        moving.dedup();
        (nodes.iter().zip(parts).map(local).collect(), moving)
    }

    /// Transforms of all nodes to the scene's space.
    fn globals(&self, time: Option<f64>) -> Vec<DMat4> {
        let (locals, _) = self.locals(time);
        let nodes = list(&self.json["nodes"]);
        let parents: BTreeMap<usize, usize> = nodes
            .iter()
            .enumerate()
            .flat_map(|(parent, node)| list(&node["children"]).iter().map(move |child| (index(child), parent)))
            .collect();
        let global = |node: usize| {
            let above = std::iter::successors(parents.get(&node), |parent| parents.get(parent));
            above.fold(locals[node], |global, parent| locals[*parent] * global)
        };
        (0..nodes.len()).map(global).collect()
    }

    fn name(&self, node: usize) -> String {
        self.json["nodes"][node]["name"].as_str().map_or_else(|| format!("node {node}"), str::to_owned)
    }
}

/// A new world of a file, in which all clips play.
struct Played {
    world: World,
    by_name: BTreeMap<String, Entity>,
}

fn load(path: &Path) -> Asset {
    gltf::load(path).unwrap_or_else(|errors| panic!("{}: {}", path.display(), messages(&errors))).asset
}

fn play(asset: &Asset) -> Played {
    let mut world = new_world();
    let entities = spawn_asset(&mut world, asset, Affine3A::IDENTITY);
    let by_name: BTreeMap<String, Entity> = asset.nodes.iter().map(|node| node.name.clone()).zip(entities).collect();
    assert_eq!(by_name.len(), asset.nodes.len(), "the test needs names of their own");
    for mut player in world.query::<&mut AnimationPlayer>().iter_mut(&mut world) {
        player.playing = (0..player.clips().len()).collect();
    }
    Played { world, by_name }
}

fn close(found: &GlobalTransform, expected: DMat4) -> bool {
    let found = DMat4::from(found.0.as_daffine3()).to_cols_array();
    found.iter().zip(expected.to_cols_array()).all(|(found, expected)| (found - expected).abs() <= 1e-5 * (1.0 + expected.abs()))
}

/// Compares every node of a file at these times, and at rest before any is set. Returns how many animated nodes leave their rest
/// at one of the times, and how many do not: those show nothing.
fn compare(path: &Path, times: [f64; 3]) -> (usize, usize) {
    let file = File::read(path);
    let Played { mut world, by_name } = play(&load(path));
    let (_, moving) = file.locals(None);
    let rest = file.globals(None);
    let mut moved = vec![false; rest.len()];
    for time in [None, Some(times[0]), Some(times[1]), Some(times[2])] {
        if let Some(time) = time {
            set_time(&mut world, time).unwrap();
        }
        propagate_transforms(&mut world);
        for (node, expected) in file.globals(time).into_iter().enumerate() {
            let found = world.get::<GlobalTransform>(by_name[&file.name(node)]).unwrap();
            assert!(close(found, expected), "{}: {} at {time:?}: {found:?}, not {expected}", path.display(), file.name(node));
            moved[node] |= !expected.abs_diff_eq(rest[node], 1e-3);
        }
    }
    let leaving = moving.iter().filter(|node| moved[**node]).count();
    (leaving, moving.len() - leaving)
}

fn every_interpolation_of_every_property(assets: &Path) {
    let path = assets.join("khronos/InterpolationTest/InterpolationTest.gltf");
    let kinds: std::collections::BTreeSet<(String, String)> = list(&File::read(&path).json["animations"])
        .iter()
        .flat_map(|animation| {
            list(&animation["channels"]).iter().map(|channel| {
                let sampler = &animation["samplers"][index(&channel["sampler"])];
                let text = |value: &Value| value.as_str().unwrap().to_owned();
                (text(&sampler["interpolation"]), text(&channel["target"]["path"]))
            })
        })
        .collect();
    assert_eq!(kinds.len(), 9, "three interpolations of three properties: {kinds:?}");
    assert_eq!(compare(&path, [0.21, 0.6, 2.77]), (9, 0));
}

fn animated_boxes_and_triangles(assets: &Path) {
    assert_eq!(compare(&assets.join("khronos/BoxAnimated/BoxAnimated.gltf"), [0.4, 1.7, 9.1]), (2, 0));
    assert_eq!(compare(&assets.join("khronos/AnimatedTriangle/AnimatedTriangle.gltf"), [0.1, 0.6, 3.8]), (1, 0));
}

/// The pictures of this file say nothing about motion, so any will do.
fn an_animated_cube(assets: &Path) {
    let folder = tempfile::tempdir().unwrap();
    for entry in std::fs::read_dir(assets.join("khronos/AnimatedCube")).unwrap() {
        let entry = entry.unwrap();
        let copy = folder.path().join(entry.file_name());
        match entry.path().extension() {
            Some(extension) if extension == "png" => image::RgbImage::new(2, 2).save(copy).unwrap(),
            _ => drop(std::fs::copy(entry.path(), copy).unwrap()),
        }
    }
    assert_eq!(compare(&folder.path().join("AnimatedCube.gltf"), [0.3, 1.9, 7.5]), (1, 0));
}

/// Joints below nodes with a matrix. Some have channels that hold their rest.
fn joints_of_skins(assets: &Path) {
    let (leaving, _) = compare(&assets.join("khronos/RiggedSimple/RiggedSimple.gltf"), [0.3, 1.2, 5.0]);
    assert!(leaving > 0);
    let (leaving, _) = compare(&assets.join("khronos/CesiumMan/CesiumMan.gltf"), [0.3, 1.2, 5.0]);
    assert!(leaving > 10);
    let loaded = gltf::load(&assets.join("khronos/CesiumMan/CesiumMan.gltf")).unwrap();
    assert!(loaded.warnings.iter().any(|warning| warning.code == "gltf::animated-skin"), "{}", messages(&loaded.warnings));
}

/// Random times in a random order give what fresh worlds give, bit for bit.
fn time_has_no_memory(assets: &Path) {
    let mut state = 7_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    for name in ["InterpolationTest/InterpolationTest.gltf", "CesiumMan/CesiumMan.gltf", "BoxAnimated/BoxAnimated.gltf"] {
        let path = assets.join("khronos").join(name);
        let bits = |played: &Played| -> Vec<[u32; 12]> {
            let local = |entity: &Entity| played.world.get::<Transform>(*entity).unwrap().0.to_cols_array().map(f32::to_bits);
            played.by_name.values().map(local).collect()
        };
        let asset = load(&path);
        let mut wandering = play(&asset);
        for _ in 0..12 {
            let time = random() * 20.0 - 2.0;
            set_time(&mut wandering.world, time).unwrap();
            let mut fresh = play(&asset);
            set_time(&mut fresh.world, time).unwrap();
            assert_eq!(bits(&wandering), bits(&fresh), "{name} at {time}");
        }
    }
}

/// A camera's matrix takes points to where its definition in the file does: reversed depth, and without a far plane in perspective.
fn both_kinds_of_cameras(assets: &Path) {
    let path = assets.join("khronos/Cameras/Cameras.gltf");
    let file = File::read(&path);
    let mut world = play(&load(&path)).world;
    let aspect = 1.5;
    let mut seen = Vec::new();
    for (node, global) in file.globals(None).into_iter().enumerate() {
        let Some(camera) = file.json["nodes"][node].get("camera").map(index) else { continue };
        let name = format!("camera {camera}");
        let request = PublishRequest { camera: Some(&name), extent: [96, 64], views: &[], draw_lists: &[], max_texture_2d: 64 };
        let published = Publisher::default().publish(&mut world, &request).unwrap_or_else(|problems| panic!("{}", messages(&problems)));
        let table: CameraTable = bytemuck::pod_read_unaligned(&published.scene.tables["camera"].bytes());
        let matrix = DMat4::from_cols_array_2d(&table.projection_from_world.map(|column| column.map(f64::from)));
        let definition = &file.json["cameras"][camera];
        let kind = definition["type"].as_str().unwrap();
        let field = |key: &str| number(&definition[kind][key]);
        for local in [DVec3::new(0.3, -0.2, -1.0), DVec3::new(-1.0, 2.0, -40.0), DVec3::new(0.0, 0.0, -90.0)] {
            let distance = -local.z;
            let expected = match kind {
                "perspective" => {
                    let half = (field("yfov") / 2.0).tan() * distance;
                    DVec3::new(local.x / (half * aspect), local.y / half, field("znear") / distance)
                }
                _ => {
                    let (near, far) = (field("znear"), field("zfar"));
                    DVec3::new(local.x / (field("ymag") * aspect), local.y / field("ymag"), (far - distance) / (far - near))
                }
            };
            let clip = matrix * global.transform_point3(local).extend(1.0);
            let found = clip.truncate() / clip.w;
            assert!((found - expected).abs().max_element() < 1e-5, "{name}, {local}: {found}, not {expected}");
        }
        seen.push(kind.to_owned());
        assert_eq!(select_camera(&mut world, None).unwrap(), select_camera(&mut world, Some("camera 0")).unwrap());
    }
    assert_eq!(seen, ["perspective", "orthographic"]);
}

/// The tests, by name.
const TESTS: &[(&str, AssetTest)] = &[
    ("every_interpolation_of_every_property", every_interpolation_of_every_property),
    ("animated_boxes_and_triangles", animated_boxes_and_triangles),
    ("an_animated_cube", an_animated_cube),
    ("joints_of_skins", joints_of_skins),
    ("time_has_no_memory", time_has_no_memory),
    ("both_kinds_of_cameras", both_kinds_of_cameras),
];

fn main() {
    support::run(TESTS)
}
