//! Small files in memory, one for each rule that the loader follows.

use base64::Engine;
use glam::{Vec3, Vec4};
use serde_json::{Value, json};

use super::*;
use crate::asset::{Interpolation, LightKind, Mesh, Property};

/// A file under construction.
struct File {
    json: Value,
    bytes: Vec<u8>,
}

impl File {
    fn new() -> File {
        let json = json!({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {}}]}], "accessors": [], "bufferViews": [],
        });
        File { json, bytes: Vec::new() }
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend_from_slice(bytes);
        views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        let accessors = self.json["accessors"].as_array_mut().unwrap();
        accessors.push(accessor);
        accessors.len() - 1
    }

    fn floats(&mut self, kind: &str, floats: &[f32]) -> usize {
        let view = self.view(bytemuck::cast_slice(floats));
        let components = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        self.accessor(json!({"bufferView": view, "componentType": 5126, "type": kind, "count": floats.len() / components}))
    }

    fn attribute(mut self, name: &str, kind: &str, floats: &[f32]) -> File {
        let accessor = self.floats(kind, floats);
        self.json["meshes"][0]["primitives"][0]["attributes"][name] = accessor.into();
        self
    }

    fn indices(mut self, indices: &[u8]) -> File {
        let view = self.view(indices);
        let accessor = self.accessor(json!({"bufferView": view, "componentType": 5121, "type": "SCALAR", "count": indices.len()}));
        self.json["meshes"][0]["primitives"][0]["indices"] = accessor.into();
        self
    }

    fn set(mut self, pointer: &str, value: Value) -> File {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        match self.json.pointer_mut(parent).unwrap() {
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = value,
            other => other[key] = value,
        }
        self
    }

    fn load(mut self) -> Result<Loaded, Vec<Diagnostic>> {
        if !self.bytes.is_empty() {
            let data = base64::prelude::BASE64_STANDARD.encode(&self.bytes);
            let uri = format!("data:application/octet-stream;base64,{data}");
            self.json["buffers"] = json!([{"uri": uri, "byteLength": self.bytes.len()}]);
        }
        load_text(self.json.to_string().as_bytes())
    }

    fn mesh(self) -> Mesh {
        let mut loaded = self.load().unwrap_or_else(|errors| panic!("{errors:?}"));
        loaded.asset.meshes.remove(0)
    }

    fn errors(self) -> Vec<String> {
        let errors = self.load().expect_err("the file is broken");
        errors.into_iter().map(|error| format!("{} {}", error.code, error.message)).collect()
    }

    fn warnings(self) -> Vec<&'static str> {
        self.load().unwrap_or_else(|errors| panic!("{errors:?}")).warnings.iter().map(|warning| warning.code).collect()
    }
}

fn load_text(text: &[u8]) -> Result<Loaded, Vec<Diagnostic>> {
    load_bytes("test.gltf", text)
}

/// Four corners of a square in the plane z = 0.
const SQUARE: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
const SQUARE_NORMALS: [f32; 12] = [0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 0.0, 0.0, 2.0];
const SQUARE_UVS: [f32; 8] = [0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0];

fn square() -> File {
    File::new().attribute("POSITION", "VEC3", &SQUARE).attribute("NORMAL", "VEC3", &SQUARE_NORMALS)
}

#[test]
fn strips_and_fans_become_lists() {
    let strip = square().set("/meshes/0/primitives/0/mode", 5.into()).indices(&[0, 1, 3, 2]).mesh();
    assert_eq!(strip.indices, [0, 1, 3, 1, 2, 3]);
    let fan = square().set("/meshes/0/primitives/0/mode", 6.into()).mesh();
    assert_eq!(fan.indices, [1, 2, 0, 2, 3, 0]);
    for mesh in [strip, fan] {
        assert!(mesh.vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]), "normals get unit length");
    }
}

#[test]
fn missing_normals_are_flat() {
    let mesh = File::new().attribute("POSITION", "VEC3", &SQUARE).indices(&[0, 1, 2, 0, 2, 3]).mesh();
    assert_eq!(mesh.vertices.len(), 6);
    assert_eq!(mesh.indices, [0, 1, 2, 3, 4, 5]);
    assert!(mesh.vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]));
    let degenerate = File::new().attribute("POSITION", "VEC3", &SQUARE).indices(&[1, 1, 1]).mesh();
    assert!(degenerate.vertices.iter().all(|vertex| Vec3::from(vertex.normal).is_normalized()));
    let tiny = SQUARE.map(|coordinate| coordinate * 1e-40);
    let tiny = File::new().attribute("POSITION", "VEC3", &tiny).indices(&[0, 1, 2]).mesh();
    assert!(tiny.vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]), "denormal triangles have a direction too");
}

#[test]
fn normals_without_direction_are_mended() {
    let broken = || File::new().attribute("POSITION", "VEC3", &SQUARE).attribute("NORMAL", "VEC3", &[0.0; 12]).indices(&[0, 1, 2, 0, 2, 3]);
    assert!(broken().mesh().vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]));
    assert_eq!(broken().warnings(), ["gltf::normal"]);
}

#[test]
fn unused_vertices_are_dropped() {
    let mesh = square().indices(&[3, 1, 2]).mesh();
    assert_eq!(mesh.indices, [2, 0, 1]);
    assert_eq!(mesh.vertices[0].position, [1.0, 0.0, 0.0]);
}

#[test]
fn sparse_accessors_replace_elements() {
    let mut file = square();
    let indices = file.view(&[2]);
    let values = file.view(bytemuck::cast_slice(&[5.0_f32, 6.0, 7.0]));
    let sparse = json!({"count": 1, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    let mesh = file.set("/accessors/0/sparse", sparse.clone()).indices(&[0, 1, 2]).mesh();
    assert_eq!(mesh.vertices[1].position, [1.0, 0.0, 0.0]);
    assert_eq!(mesh.vertices[2].position, [5.0, 6.0, 7.0]);

    let mut file = square();
    let (indices, values) = (file.view(&[4]), file.view(&[0; 12]));
    let sparse = json!({"count": 1, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    let errors = file.set("/accessors/0/sparse", sparse).errors();
    assert!(errors[0].contains("accessors[0].sparse.indices"), "{errors:?}");
}

#[test]
fn colours_and_alpha() {
    let three = square().attribute("COLOR_0", "VEC3", &[0.5; 12]).indices(&[0, 1, 2]).mesh();
    assert_eq!(three.vertices[0].color, [128, 128, 128, 255]);
    let four = square().attribute("COLOR_0", "VEC4", &[2.0, -1.0, f32::NAN, 0.0].repeat(4)).indices(&[0, 1, 2]).mesh();
    assert_eq!(four.vertices[0].color, [255, 0, 0, 0]);
}

/// A square with one material, whose texture is one pixel.
fn textured(material: &Value) -> File {
    let mut png = Vec::new();
    let pixel = ::image::RgbaImage::from_pixel(1, 1, ::image::Rgba([128, 128, 255, 255]));
    pixel.write_to(&mut std::io::Cursor::new(&mut png), ::image::ImageFormat::Png).unwrap();
    let mut file = square().indices(&[0, 1, 2, 0, 2, 3]);
    let view = file.view(&png);
    file.set("/images", json!([{"bufferView": view, "mimeType": "image/png"}]))
        .set("/textures", json!([{"source": 0}]))
        .set("/materials", json!([material.clone()]))
        .set("/meshes/0/primitives/0/material", 0.into())
}

#[test]
fn tangents_follow_the_texture_coordinates() {
    let normal_mapped = || textured(&json!({"normalTexture": {"index": 0}}));
    let mesh = normal_mapped().attribute("TEXCOORD_0", "VEC2", &SQUARE_UVS).mesh();
    assert_eq!(mesh.vertices.len(), 4);
    for vertex in &mesh.vertices {
        assert_eq!(vertex.tangent, [1.0, 0.0, 0.0, 1.0], "u grows along x, and up in the image is y");
    }
    let mirrored: Vec<f32> = SQUARE_UVS.chunks(2).flat_map(|uv| [1.0 - uv[0], uv[1]]).collect();
    let mesh = normal_mapped().attribute("TEXCOORD_0", "VEC2", &mirrored).mesh();
    assert!(mesh.vertices.iter().all(|vertex| vertex.tangent == [-1.0, 0.0, 0.0, -1.0]));
    let constant = normal_mapped().attribute("TEXCOORD_0", "VEC2", &[0.0; 8]).mesh();
    assert!(constant.vertices.iter().all(|vertex| Vec3::from_slice(&vertex.tangent).is_normalized()));
    assert_eq!(normal_mapped().warnings(), ["gltf::no-texcoord"]);
}

#[test]
fn too_many_triangles_around_a_vertex_cost_no_stack() {
    let around = 60_000_u32;
    let mut positions = vec![0.0, 0.0, 0.0];
    for step in 0..around {
        let (sin, cos) = (step as f32 * 1e-4).sin_cos();
        positions.extend([cos, sin, 0.0]);
    }
    let count = positions.len() / 3;
    let uvs: Vec<f32> = positions.chunks(3).flat_map(|p| [p[0], p[1]]).collect();
    let mut file = textured(&json!({"normalTexture": {"index": 0}})).set("/meshes/0/primitives/0/mode", 6.into());
    let indices: Vec<u32> = (0..=around).collect();
    let view = file.view(bytemuck::cast_slice(&indices));
    let accessor = file.accessor(json!({"bufferView": view, "componentType": 5125, "type": "SCALAR", "count": count}));
    let file = file
        .set("/meshes/0/primitives/0/indices", accessor.into())
        .attribute("POSITION", "VEC3", &positions)
        .attribute("NORMAL", "VEC3", &[0.0, 0.0, 1.0].repeat(count))
        .attribute("TEXCOORD_0", "VEC2", &uvs);
    assert_eq!(file.warnings(), ["gltf::tangents"]);
}

#[test]
fn any_two_sets_of_texture_coordinates_are_kept() {
    let material =
        json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 3}}, "emissiveTexture": {"index": 0, "texCoord": 1}});
    let file = textured(&material).attribute("TEXCOORD_1", "VEC2", &[0.1; 8]).attribute("TEXCOORD_3", "VEC2", &[0.3; 8]);
    let asset = file.load().unwrap().asset;
    let set = |texture: Option<crate::asset::TextureUse>| texture.unwrap().uv_set;
    assert_eq!((set(asset.materials[0].base_color_texture), set(asset.materials[0].emissive_texture)), (1, 0));
    assert_eq!((asset.meshes[0].vertices[0].uv0, asset.meshes[0].vertices[0].uv1), ([0.1; 2], [0.3; 2]));
    assert_eq!((asset.images.len(), asset.images[0].rgba.as_ref()), (1, [128, 128, 255, 255].as_slice()));
}

#[test]
fn texture_transforms_scale_then_rotate_then_move() {
    let transform = json!({"offset": [0.5, 0.25], "scale": [2.0, 4.0], "rotation": std::f32::consts::FRAC_PI_2, "texCoord": 1});
    let info = json!({"index": 0, "extensions": {"KHR_texture_transform": transform}});
    let file = textured(&json!({"pbrMetallicRoughness": {"baseColorTexture": info}})).attribute("TEXCOORD_1", "VEC2", &SQUARE_UVS);
    let texture = file.load().unwrap().asset.materials[0].base_color_texture.unwrap();
    assert_eq!(texture.uv_set, 1);
    assert!(texture.transformed(glam::Vec2::new(1.0, 0.0)).abs_diff_eq(glam::Vec2::new(0.5, -1.75), 1e-6));
    assert!(texture.transformed(glam::Vec2::new(0.0, 1.0)).abs_diff_eq(glam::Vec2::new(4.5, 0.25), 1e-6));
}

#[test]
fn every_problem_is_reported_at_once() {
    let errors = square()
        .set("/nodes", json!([{"mesh": 7}, {"children": [9]}]))
        .set("/accessors/1/count", 5.into())
        .set("/materials", json!([{"alphaMode": "GLASS", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1]}}]))
        .errors();
    let expected = [
        "accessors[1]: 5 elements of 12 bytes",
        "materials[0].pbrMetallicRoughness.baseColorFactor: expected 4 numbers, found 3",
        "materials[0].alphaMode: expected OPAQUE, MASK or BLEND, found `GLASS`",
        "nodes[0].mesh: refers to meshes[7], but the file has 1 meshes",
        "nodes[1].children[0]: refers to nodes[9], but the file has 2 nodes",
    ];
    assert_eq!(errors.len(), expected.len(), "{errors:?}");
    for (error, expected) in errors.iter().zip(expected) {
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn deep_and_broken_json_is_an_error() {
    let deep = [b"[".repeat(1_000_000), b"]".repeat(1_000_000)].concat();
    for text in [deep.as_slice(), b"", b"null", b"{", b"glTF", b"\xFF\xFE", b"{\"asset\": {}}", b"{}"] {
        assert!(load_text(text).is_err(), "{:?}", &text[..text.len().min(20)]);
    }
    assert!(load_text(br#"{"asset": {"version": "2.0"}}"#).unwrap().asset.nodes.is_empty());
}

#[test]
fn a_chain_of_a_hundred_thousand_nodes_costs_no_stack() {
    let count = 100_000;
    let nodes: Vec<Value> =
        (0..count).map(|node| if node + 1 < count { json!({"children": [node + 1]}) } else { json!({"mesh": 0}) }).collect();
    let loaded = square().indices(&[0, 1, 2]).set("/nodes", nodes.into()).load().unwrap();
    assert_eq!(loaded.asset.nodes.len(), count);
}

#[test]
fn hierarchies_must_be_forests() {
    let twice = square().set("/nodes", json!([{"children": [1, 1]}, {}])).errors();
    assert!(twice[0].starts_with("gltf::node-two-parents"), "{twice:?}");
    let cycle = square().set("/nodes", json!([{}, {"children": [2]}, {"children": [1]}])).errors();
    assert!(cycle[0].starts_with("gltf::node-cycle"), "{cycle:?}");
    let child = square().set("/nodes", json!([{}, {"children": [0]}])).errors();
    assert!(child[0].starts_with("gltf::scene-root"), "{child:?}");
}

#[test]
fn promises_without_bytes_are_refused() {
    let large = square().set("/accessors/0", json!({"componentType": 5126, "type": "VEC3", "count": 4_000_000_000_u64})).errors();
    assert!(large[0].starts_with("gltf::accessor-too-large"), "{large:?}");
    let many = square().set("/accessors/0/count", 1e18.into()).errors();
    assert!(many[0].contains("accessors[0].count"), "{many:?}");
    let late = square().set("/bufferViews/0/byteOffset", u64::MAX.into()).errors();
    assert!(late[0].starts_with("gltf::view-out-of-range"), "{late:?}");
}

#[test]
fn odd_lights_are_mended() {
    let lights = json!({"lights": [
        {"type": "point", "intensity": -3, "range": 0},
        {"type": "spot", "spot": {"innerConeAngle": 1.0, "outerConeAngle": 0.5}},
    ]});
    let nodes = json!([
        {"extensions": {"KHR_lights_punctual": {"light": 0}}, "children": [1]},
        {"extensions": {"KHR_lights_punctual": {"light": 1}}},
    ]);
    let loaded = square().set("/extensions", json!({"KHR_lights_punctual": lights})).set("/nodes", nodes).load().unwrap();
    let [point, spot] = loaded.asset.lights.as_slice() else { panic!("two lights") };
    assert_eq!((point.intensity, point.range), (0.0, None));
    assert!(matches!(spot.kind, LightKind::Spot { inner, outer } if inner < outer && outer == 0.5));
    assert_eq!(loaded.warnings.len(), 3);
}

#[test]
fn nodes_may_morph_one_mesh_differently() {
    let mut file = square().indices(&[0, 1, 2]);
    let delta = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(4));
    let asset = file
        .set("/meshes/0/primitives/0/targets", json!([{"POSITION": delta}]))
        .set("/meshes/0/weights", json!([0.25]))
        .set("/nodes", json!([{"mesh": 0}, {"mesh": 0, "weights": [0.5]}, {"mesh": 0}]))
        .set("/scenes", json!([{"nodes": [0, 1, 2]}]))
        .load()
        .unwrap()
        .asset;
    let heights: Vec<f32> = asset.nodes.iter().map(|node| asset.meshes[node.meshes[0]].vertices[0].position[2]).collect();
    assert_eq!((heights, asset.meshes.len()), (vec![0.25, 0.5, 0.25], 2));
}

/// Node, path, interpolation, times and values.
type ChannelOf<'a> = (usize, &'a str, &'a str, &'a [f32], &'a [f32]);

/// Nodes with an animation of these channels: the first two are in the scene, and the second has a matrix.
fn animated(channels: &[ChannelOf<'_>]) -> File {
    let mut file = square().indices(&[0, 1, 2]).set("/nodes", json!([{"mesh": 0}, {"matrix": glam::Mat4::IDENTITY.to_cols_array()}, {}]));
    let (mut samplers, mut list) = (Vec::new(), Vec::new());
    for (node, path, interpolation, times, values) in channels {
        let kind = if *path == "rotation" { "VEC4" } else { "VEC3" };
        let (input, output) = (file.floats("SCALAR", times), file.floats(kind, values));
        list.push(json!({"sampler": samplers.len(), "target": {"node": node, "path": path}}));
        samplers.push(json!({"input": input, "output": output, "interpolation": interpolation}));
    }
    file.json["animations"] = json!([{"channels": list, "samplers": samplers}]);
    file.set("/scenes", json!([{"nodes": [0, 1]}]))
}

#[test]
fn animations_are_kept_for_the_nodes_of_the_scene() {
    let turn = [0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 3.0, 3.0];
    let loaded = animated(&[
        (0, "rotation", "LINEAR", &[0.5, 2.5], &turn),
        (0, "scale", "CUBICSPLINE", &[1.0], &[0.0, 0.0, 0.0, 4.0, 5.0, 6.0, 1.0, 1.0, 1.0]),
        (2, "translation", "STEP", &[9.0], &[1.0; 3]),
    ]);
    let Loaded { asset, warnings } = loaded.load().unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    let [animation] = asset.animations.as_slice() else { panic!("one animation") };
    assert_eq!((animation.name.as_str(), animation.duration), ("animation 0", 9.0), "as long as the file has it");
    let [rotation, scale] = animation.channels.as_slice() else { panic!("node 2 is not in the scene") };
    assert_eq!((rotation.node, rotation.property, rotation.interpolation), (0, Property::Rotation, Interpolation::Linear));
    assert_eq!((rotation.times.as_ref(), rotation.values[0]), ([0.5, 2.5].as_slice(), Vec4::W));
    assert!(rotation.values[1].abs_diff_eq(Vec4::new(0.0, 0.0, 0.5_f32.sqrt(), 0.5_f32.sqrt()), 1e-6), "unit length");
    assert_eq!((scale.interpolation, scale.values[1]), (Interpolation::CubicSpline, Vec4::new(4.0, 5.0, 6.0, 0.0)));
}

#[test]
fn channels_that_cannot_be_played_are_warnings() {
    let still = [0.0; 6];
    let of = |channel: ChannelOf<'_>| {
        let loaded = animated(&[channel]).load().unwrap();
        let codes: Vec<_> = loaded.warnings.iter().map(|warning| warning.code).collect();
        (codes, loaded.asset.animations.into_iter().next().unwrap())
    };
    let (codes, animation) = of((1, "translation", "LINEAR", &[0.0, 3.0], &still));
    assert_eq!((codes.as_slice(), animation.channels.len(), animation.duration), (["gltf::animated-matrix"].as_slice(), 0, 3.0));
    let (codes, animation) = of((0, "scale", "STEP", &[0.0, 1.0], &[0.0, f32::NAN, 0.0, 0.0, 0.0, 0.0]));
    assert_eq!((codes.as_slice(), animation.channels.len()), (["gltf::animation-values"].as_slice(), 0));
    let (codes, animation) = of((0, "scale", "STEP", &[f32::NAN, f32::INFINITY], &still));
    assert_eq!((codes.as_slice(), animation.channels.len()), (["gltf::animation-times", "gltf::animation-values"].as_slice(), 0));
    let keys = [1.0, 0.5, 1.0, f32::NAN, 4.0];
    let (codes, animation) = of((0, "scale", "STEP", &keys, &[[1.0; 3], [2.0; 3], [3.0; 3], [4.0; 3], [5.0; 3]].concat()));
    assert_eq!((codes.as_slice(), animation.duration), (["gltf::animation-times"].as_slice(), 4.0));
    assert_eq!(animation.channels[0].times.as_ref(), [1.0, 1.0, 4.0]);
    assert_eq!(animation.channels[0].values.iter().map(|value| value.x).collect::<Vec<_>>(), [1.0, 3.0, 5.0]);
    let (codes, animation) = of((0, "rotation", "LINEAR", &[0.0], &[0.0; 4]));
    assert_eq!((codes.as_slice(), animation.channels[0].values[0]), (["gltf::rotation"].as_slice(), Vec4::W));
    let twice = animated(&[(0, "scale", "STEP", &[0.0], &[1.0; 3]), (0, "scale", "STEP", &[0.0], &[2.0; 3])]).load().unwrap();
    assert_eq!((twice.warnings[0].code, twice.asset.animations[0].channels[0].values[0].x), ("gltf::animated-twice", 1.0));
}
