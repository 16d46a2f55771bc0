//! The glTF loader over a folder of real, handmade and broken files, which lies beside the repository.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests")]

mod support;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::{Duration, Instant};

use glam::{Affine3A, Vec3};
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_scenes::asset::{AlphaMode, Asset, Interpolation, LightKind, Material, MipFilter, Projection, Property, TextureUse};
use luminaire_scenes::gltf::{Loaded, load, load_within};
use support::{AssetTest, messages};

/// No single file may take longer, debug builds on a busy machine included.
const LONGEST: Duration = Duration::from_secs(60);

/// Loads a file; those of the seed scenes have images in folders beside their own.
fn load_entry(assets: &Path, name: &str) -> Result<Loaded, Vec<Diagnostic>> {
    let path = assets.join(name);
    if name.contains("seed_scenes") { load_within(&path, assets) } else { load(&path) }
}

fn load_ok(assets: &Path, name: &str) -> Loaded {
    load_entry(assets, name).unwrap_or_else(|errors| panic!("{name}: {}", messages(&errors)))
}

fn scene_triangles(asset: &Asset) -> usize {
    asset.nodes.iter().flat_map(|node| &node.meshes).map(|mesh| asset.meshes[*mesh].indices.len() / 3).sum()
}

fn globals(asset: &Asset) -> Vec<Affine3A> {
    let mut globals: Vec<Affine3A> = Vec::new();
    for node in &asset.nodes {
        globals.push(node.parent.map_or(Affine3A::IDENTITY, |parent| globals[parent]) * node.local);
    }
    globals
}

/// Positions of all drawn vertices, in the scene's space.
fn world_positions(asset: &Asset) -> Vec<Vec3> {
    let globals = globals(asset);
    let drawn = asset.nodes.iter().zip(&globals).flat_map(|(node, global)| node.meshes.iter().map(move |mesh| (mesh, global)));
    drawn.flat_map(|(mesh, global)| asset.meshes[*mesh].vertices.iter().map(|v| global.transform_point3(Vec3::from(v.position)))).collect()
}

/// What the documentation of [`Asset`] promises.
fn check_guarantees(name: &str, asset: &Asset) {
    for (index, node) in asset.nodes.iter().enumerate() {
        assert!(node.parent.is_none_or(|parent| parent < index), "{name}: parent after child");
        assert!(node.local.is_finite(), "{name}: transform of {}", node.name);
        assert!(node.meshes.iter().all(|mesh| *mesh < asset.meshes.len()), "{name}");
        assert!(node.light.is_none_or(|light| light < asset.lights.len()), "{name}");
        assert!(node.camera.is_none_or(|camera| camera < asset.cameras.len()), "{name}");
    }
    for mesh in &asset.meshes {
        assert!(!mesh.vertices.is_empty() && !mesh.indices.is_empty() && mesh.indices.len().is_multiple_of(3), "{name}: {}", mesh.name);
        assert!(mesh.indices.iter().all(|index| (*index as usize) < mesh.vertices.len()), "{name}: {}", mesh.name);
        assert!(mesh.material < asset.materials.len(), "{name}: {}", mesh.name);
        for vertex in &mesh.vertices {
            let [x, y, z, w] = vertex.tangent;
            let mut floats = vertex.position.iter().chain(&vertex.uv0).chain(&vertex.uv1);
            assert!(floats.all(|value| value.is_finite()), "{name}: {vertex:?}");
            assert!(Vec3::from(vertex.normal).is_normalized(), "{name}: {vertex:?}");
            assert!(Vec3::new(x, y, z).is_normalized() && w.abs() == 1.0, "{name}: {vertex:?}");
        }
    }
    for material in &asset.materials {
        check_material(name, material, asset.images.len());
    }
    for image in &asset.images {
        assert!(image.width > 0 && image.height > 0, "{name}");
        assert_eq!(image.rgba.len(), image.width as usize * image.height as usize * 4, "{name}");
    }
    for light in &asset.lights {
        assert!(light.color.iter().all(|channel| channel.is_finite() && *channel >= 0.0), "{name}");
        assert!(light.intensity.is_finite() && light.intensity >= 0.0, "{name}");
        assert!(light.range.is_none_or(|range| range.is_finite() && range > 0.0), "{name}");
        if let LightKind::Spot { inner, outer } = light.kind {
            assert!(inner >= 0.0 && outer > inner && outer <= std::f32::consts::FRAC_PI_2, "{name}: {inner} {outer}");
        }
    }
    assert!(world_positions(asset).iter().all(|position| position.is_finite()), "{name}: world positions");
    check_animations(name, asset);
}

fn check_animations(name: &str, asset: &Asset) {
    for animation in &asset.animations {
        assert!(animation.duration.is_finite() && animation.duration >= 0.0, "{name}: {}", animation.name);
        let mut moved = BTreeSet::new();
        for channel in &animation.channels {
            assert!(asset.nodes[channel.node].pose.is_some_and(|pose| pose.matrix() == asset.nodes[channel.node].local), "{name}");
            assert!(moved.insert((channel.node, channel.property)), "{name}: {channel:?}");
            assert!(!channel.times.is_empty() && channel.times.is_sorted() && channel.times.iter().all(|time| time.is_finite()), "{name}");
            let (is_spline, is_rotation) = (channel.interpolation == Interpolation::CubicSpline, channel.property == Property::Rotation);
            assert_eq!(channel.values.len(), channel.times.len() * if is_spline { 3 } else { 1 }, "{name}");
            for value in channel.values.iter() {
                assert!(value.is_finite() && (is_spline || !is_rotation || value.is_normalized()), "{name}: {value}");
            }
        }
    }
}

fn textures(material: &Material) -> [Option<TextureUse>; 7] {
    [
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.normal_texture,
        material.occlusion_texture,
        material.emissive_texture,
        material.specular_texture,
        material.specular_color_texture,
    ]
}

fn check_material(name: &str, material: &Material, images: usize) {
    let unit = [material.metallic, material.roughness, material.occlusion_strength, material.specular];
    assert!(unit.iter().chain(&material.base_color).all(|factor| (0.0..=1.0).contains(factor)), "{name}: {material:?}");
    let open = material.emissive.iter().chain(&material.specular_color).chain([&material.ior]);
    assert!(open.into_iter().all(|value| value.is_finite() && *value >= 0.0) && material.normal_scale.is_finite(), "{name}: {material:?}");
    for texture in textures(material).into_iter().flatten() {
        assert!(texture.image < images && texture.uv_set < 2, "{name}: {texture:?}");
        assert!(texture.transform.as_flattened().iter().all(|value| value.is_finite()), "{name}");
    }
}

/// Every glTF file of the manifest: its expectation, and its number of triangles.
fn manifest(assets: &Path) -> BTreeMap<String, (String, Option<usize>)> {
    let text = std::fs::read_to_string(assets.join("MANIFEST.json")).unwrap();
    let entries: serde_json::Map<String, serde_json::Value> = serde_json::from_str(&text).unwrap();
    let is_gltf = |name: &str| [".gltf", ".glb"].iter().any(|ending| name.ends_with(ending));
    let entry = |value: &serde_json::Value| {
        (value["expect"].as_str().unwrap().to_owned(), value["scene_triangles"].as_u64().map(|count| count as usize))
    };
    entries.iter().filter(|(name, _)| is_gltf(name)).map(|(name, value)| (name.clone(), entry(value))).collect()
}

fn every_file_meets_its_expectation(assets: &Path) {
    let mut wrong = Vec::new();
    for (name, (expect, triangles)) in manifest(assets) {
        // Not every machine has the files that may not be passed on.
        if name.starts_with("restricted/") && !assets.join(&name).exists() {
            continue;
        }
        let start = Instant::now();
        let result = load_entry(assets, &name);
        let took = start.elapsed();
        assert!(took < LONGEST, "{name} took {took:?}");
        match &result {
            Ok(loaded) => check_guarantees(&name, &loaded.asset),
            Err(errors) => {
                assert!(errors.iter().any(Diagnostic::is_error), "{name}: refused without an error");
                assert!(errors.iter().all(|error| error.code.starts_with("gltf::") && error.message.contains(&name)), "{name}: {errors:?}");
            }
        }
        match (expect.as_str(), &result) {
            ("ok", Err(errors)) => wrong.push(format!("{name} was refused:\n{}", messages(errors))),
            ("error" | "clear_error", Ok(_)) => wrong.push(format!("{name} was loaded")),
            ("ok" | "ok_or_clear_error", Ok(loaded)) if Some(scene_triangles(&loaded.asset)) != triangles => {
                wrong.push(format!("{name} has {} triangles, expected {triangles:?}", scene_triangles(&loaded.asset)));
            }
            _ => {}
        }
    }
    assert!(wrong.is_empty(), "{} files:\n{}", wrong.len(), wrong.join("\n"));
}

fn refusals_name_their_reason(assets: &Path) {
    let cases = [
        ("unsupported/gltf-transform/BoxDraco.gltf", "KHR_draco_mesh_compression"),
        ("unsupported/gltf-transform/DracoSparseMesh.gltf", "KHR_draco_mesh_compression"),
        ("unsupported/gltf-transform/BoxMeshopt.glb", "EXT_meshopt_compression"),
        ("unsupported/texture_basisu_required.gltf", "KHR_texture_basisu"),
        ("unsupported/texture_webp_required.glb", "EXT_texture_webp"),
        ("unsupported/gltf1.gltf", "asset.version: is 1.0"),
        ("unsupported/min_version_2_1.gltf", "asset.minVersion: is 2.1"),
        ("malformed/node_cycle.glb", "nodes[0]: is its own ancestor"),
        ("malformed/index_out_of_range.glb", "meshes[0].primitives[0].indices: index 60000 is out of range"),
        ("malformed/image_http_uri.glb", "the scheme `http"),
        ("malformed/image_path_traversal.glb", "leaves the asset folder"),
        ("malformed/image_absolute_path.glb", "leaves the asset folder"),
        ("malformed/buffer_path_traversal.gltf", "buffers[0].uri"),
        ("malformed/png_60000x60000.glb", "60000x60000"),
        ("malformed/accessor_count_max.glb", "4294967295 elements"),
        ("malformed/nan_position.glb", "attributes.POSITION"),
        ("malformed/skin_joint_index_200_of_1.glb", "joint 200"),
    ];
    for (name, reason) in cases {
        let errors = load(&assets.join(name)).expect_err(name);
        assert!(messages(&errors).contains(reason), "{name}: {}", messages(&errors));
    }
}

fn transforms_and_scenes(assets: &Path) {
    let asset = load_ok(assets, "handmade/valid/node_matrix.glb").asset;
    let node = asset.nodes.iter().find(|node| !node.meshes.is_empty()).unwrap();
    let expected = Affine3A::from_translation(Vec3::new(1.0, 2.0, 3.0)) * Affine3A::from_rotation_y(0.7);
    assert!(node.local.abs_diff_eq(expected, 1e-5), "{:?}", node.local);

    let asset = load_ok(assets, "handmade/valid/node_depth_400.glb").asset;
    assert_eq!(asset.nodes.len(), 401);
    assert!((globals(&asset)[400].translation.x - 4.0).abs() < 1e-3);

    let asset = load_ok(assets, "handmade/valid/negative_scale_mirrors_winding.glb").asset;
    assert!(globals(&asset).iter().any(|global| global.matrix3.determinant() < 0.0));

    let asset = load_ok(assets, "handmade/valid/two_scenes_default_second.glb").asset;
    assert_eq!(scene_triangles(&asset), 24);

    let asset = load_ok(assets, "khronos/SimpleMeshes/SimpleMeshes.gltf").asset;
    assert_eq!((asset.meshes.len(), asset.nodes.len()), (1, 2), "two nodes share a mesh");

    let loaded = load_ok(assets, "handmade/valid/empty_scene.gltf");
    assert!(loaded.asset.nodes.is_empty() && !loaded.warnings.is_empty());
}

fn attributes(assets: &Path) {
    let first = |name: &str| load_ok(assets, name).asset.meshes.remove(0);
    let sparse = first("handmade/valid/sparse_over_base.glb");
    assert_eq!(sparse.vertices[0].position, [-0.75, -0.75, 0.75]);

    let coloured = first("handmade/valid/normalized_u8_color_u16_uv.glb");
    assert!(coloured.vertices.iter().all(|vertex| vertex.color == [255; 4]));
    assert!(coloured.vertices.iter().flat_map(|vertex| vertex.uv0).all(|coordinate| (0.0..=1.0).contains(&coordinate)));
    assert!(coloured.vertices.iter().any(|vertex| vertex.uv0 == [1.0, 1.0]));

    let rainbow = first("khronos/BoxVertexColors/BoxVertexColors.gltf");
    assert!(rainbow.vertices.iter().any(|vertex| vertex.color != [255; 4]), "colours are read");

    let flat = first("handmade/valid/no_normals.glb");
    assert_eq!(flat.vertices.len(), 36, "flat normals unshare vertices");
    for triangle in flat.vertices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|corner: usize| Vec3::from(triangle[corner].position));
        let normal = (b - a).cross(c - a).normalize();
        assert!(triangle.iter().all(|vertex| normal.abs_diff_eq(Vec3::from(vertex.normal), 1e-5)));
    }

    let morphed = load_ok(assets, "handmade/valid/morph_default_weight.glb").asset;
    let top = world_positions(&morphed).iter().map(|position| position.y).fold(f32::MIN, f32::max);
    assert!((top - 1.0).abs() < 1e-6, "{top}");

    let quantized = load_ok(assets, "handmade/valid/mesh_quantization_required.glb").asset;
    let extent = world_positions(&quantized).iter().fold(Vec3::ZERO, |extent, position| extent.max(position.abs()));
    assert!(extent.abs_diff_eq(Vec3::splat(0.5), 1e-2), "{extent}");

    let wide = first("handmade/valid/u32_indices_72k_vertices.glb");
    assert_eq!((wide.vertices.len(), wide.indices.len() / 3), (3 * 143_200, 143_200), "flat normals again");
}

fn skins_are_placed_in_the_pose_at_rest(assets: &Path) {
    let asset = load_ok(assets, "handmade/valid/skin_two_joints.glb").asset;
    let furthest = world_positions(&asset).iter().map(|position| position.x.abs()).fold(0.0, f32::max);
    assert!(furthest < 10.0, "the translation (100, 0, 0) of the mesh's node must not count, found {furthest}");
    let man = load_ok(assets, "khronos/CesiumMan/CesiumMan.gltf").asset;
    let positions = world_positions(&man);
    let height = positions.iter().map(|p| p.y).fold(f32::MIN, f32::max) - positions.iter().map(|p| p.y).fold(f32::MAX, f32::min);
    assert!((1.0..2.5).contains(&height), "a man of {height} m");
}

fn materials_and_textures(assets: &Path) {
    let asset = load_ok(assets, "handmade/valid/no_indices_no_material.glb").asset;
    let standard = &asset.materials[asset.meshes[0].material];
    assert_eq!((standard.base_color, standard.metallic, standard.roughness), ([1.0; 4], 1.0, 1.0));

    let asset = load_ok(assets, "handmade/valid/material_extensions.glb").asset;
    let any = |test: &dyn Fn(&Material) -> bool| asset.materials.iter().any(test);
    assert!(any(&|material| material.emissive.contains(&50.0)), "emissive strength");
    assert!(any(&|material| material.specular == 0.0), "specular");
    assert!(any(&|material| matches!(material.alpha_mode, AlphaMode::Mask { .. })), "mask");
    assert!(any(&|material| material.alpha_mode == AlphaMode::Blend), "blend");
    assert!(any(&|material| material.unlit), "unlit");
    assert!(any(&|material| material.ior == 1.0), "ior");

    let asset = load_ok(assets, "handmade/valid/texture_formats.glb").asset;
    assert_eq!(asset.images.len(), 10);
    let sizes: Vec<(u32, u32)> = asset.images.iter().map(|image| (image.width, image.height)).collect();
    assert!(sizes.contains(&(13, 7)) && sizes.contains(&(1, 1)), "{sizes:?}");

    let asset = load_ok(assets, "khronos/TextureTransformTest/TextureTransformTest.gltf").asset;
    let moved = asset.materials.iter().filter_map(|material| material.base_color_texture);
    assert!(moved.filter(|texture| texture.transform != [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]).count() >= 5);
    let asset = load_ok(assets, "khronos/MultiUVTest/MultiUVTest.gltf").asset;
    let sets: Vec<u32> = asset.materials.iter().flat_map(textures).flatten().map(|texture| texture.uv_set).collect();
    assert!(sets.contains(&0) && sets.contains(&1), "{sets:?}");
    let asset = load_ok(assets, "khronos/TextureSettingsTest/TextureSettingsTest.gltf").asset;
    let samplers: Vec<_> =
        asset.materials.iter().filter_map(|material| material.base_color_texture).map(|texture| texture.sampler).collect();
    assert!(samplers.iter().any(|sampler| sampler.wrap_u != sampler.wrap_v), "{samplers:?}");
    assert!(samplers.iter().all(|sampler| sampler.mip != MipFilter::Nearest));
    assert!(asset.materials.iter().any(|material| material.double_sided) && asset.materials.iter().any(|material| !material.double_sided));
}

fn lights_and_cameras(assets: &Path) {
    let asset = load_ok(assets, "handmade/valid/lights_all_types.glb").asset;
    let globals = globals(&asset);
    let find = |test: &dyn Fn(&LightKind, f32) -> bool| {
        let mut lit = asset.nodes.iter().zip(&globals).filter_map(|(node, global)| Some((&asset.lights[node.light?], global)));
        lit.find(|(light, _)| test(&light.kind, light.intensity)).expect("the light")
    };
    find(&|kind, intensity| *kind == LightKind::Point && intensity == 40.0);
    let (_, spot) = find(&|kind, intensity| matches!(kind, LightKind::Spot { .. }) && intensity == 100.0);
    assert!(spot.transform_vector3(Vec3::NEG_Z).normalize().abs_diff_eq(Vec3::NEG_Y, 1e-4));
    let (_, sun) = find(&|kind, intensity| *kind == LightKind::Directional && intensity == 3.0);
    let expected = Vec3::new(0.0, -1.0, -1.0).normalize();
    assert!(sun.transform_vector3(Vec3::NEG_Z).normalize().abs_diff_eq(expected, 1e-4));
    let default = LightKind::Spot { inner: 0.0, outer: std::f32::consts::FRAC_PI_4 };
    let (light, _) = find(&|kind, intensity| *kind == default && intensity == 1.0);
    assert_eq!((light.color, light.range), ([1.0; 3], None));

    let asset = load_ok(assets, "handmade/valid/cameras_infinite_aspect_ortho.glb").asset;
    let any = |test: &dyn Fn(&Projection) -> bool| asset.cameras.iter().any(|camera| test(&camera.projection));
    assert!(any(&|projection| matches!(projection, Projection::Perspective { far: None, .. })));
    assert!(any(&|projection| matches!(projection, Projection::Orthographic { .. })));
}

/// The tangents derived for a mesh agree with those that its author exported.
fn derived_tangents_agree_with_exported_ones(assets: &Path) {
    let folder = assets.join("khronos/NormalTangentMirrorTest");
    let text = std::fs::read_to_string(folder.join("NormalTangentMirrorTest.gltf")).unwrap();
    let temporary = tempfile::tempdir().unwrap();
    for entry in std::fs::read_dir(&folder).unwrap() {
        let entry = entry.unwrap();
        std::fs::copy(entry.path(), temporary.path().join(entry.file_name())).unwrap();
    }
    let without = temporary.path().join("without.gltf");
    assert!(text.contains("\"TANGENT\""));
    std::fs::write(&without, text.replace("\"TANGENT\"", "\"_TANGENT\"")).unwrap();
    let exported = load(&folder.join("NormalTangentMirrorTest.gltf")).unwrap().asset;
    let derived = load(&without).unwrap().asset;
    let (mut close, mut all) = (0, 0);
    for (a, b) in exported.meshes.iter().zip(&derived.meshes) {
        assert_eq!(a.indices.len(), b.indices.len());
        for (i, j) in a.indices.iter().zip(&b.indices) {
            let (a, b) = (a.vertices[*i as usize], b.vertices[*j as usize]);
            assert_eq!(a.position, b.position);
            let dot = Vec3::from_slice(&a.tangent).dot(Vec3::from_slice(&b.tangent));
            all += 1;
            close += usize::from(dot > 0.95 && a.tangent[3] == b.tangent[3]);
        }
    }
    assert!(close * 100 >= all * 97, "{close} of {all} corners agree");
}

fn percent_encoded_and_unicode_names(assets: &Path) {
    assert_eq!(scene_triangles(&load_ok(assets, "handmade/valid/percent_encoded_uri.gltf").asset), 12);
    assert_eq!(scene_triangles(&load_ok(assets, "gltf-transform/EncodingTest/Unicode ❤♻ Test.gltf").asset), 2);
}

/// Damages handmade files in many places, always in the same way.
fn damaged_files_never_panic(assets: &Path) {
    let names =
        ["sparse_over_base", "skin_two_joints", "morph_default_weight", "lights_all_types", "anim_step_cubic", "interleaved_stride32"];
    let folder = tempfile::tempdir().unwrap();
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut loaded = 0;
    for name in names {
        let original = std::fs::read(assets.join(format!("handmade/valid/{name}.glb"))).unwrap();
        for round in 0..400 {
            let mut bytes = original.clone();
            for _ in 0..=random(3) {
                let at = 12 + random(bytes.len() - 12);
                // Digits for digits keep most of the JSON valid, so that numbers are tried more than syntax.
                bytes[at] = if bytes[at].is_ascii_digit() { b'0' + random(10) as u8 } else { random(256) as u8 };
            }
            let path = folder.path().join("damaged.glb");
            std::fs::write(&path, &bytes).unwrap();
            if let Ok(file) = load(&path) {
                check_guarantees(&format!("{name}, round {round}"), &file.asset);
                loaded += 1;
            }
        }
    }
    assert!(loaded > 100, "{loaded} of the damaged files load: the damage is too coarse to test anything");
}

/// The tests, by name.
const TESTS: &[(&str, AssetTest)] = &[
    ("every_file_meets_its_expectation", every_file_meets_its_expectation),
    ("refusals_name_their_reason", refusals_name_their_reason),
    ("transforms_and_scenes", transforms_and_scenes),
    ("attributes", attributes),
    ("skins_are_placed_in_the_pose_at_rest", skins_are_placed_in_the_pose_at_rest),
    ("materials_and_textures", materials_and_textures),
    ("lights_and_cameras", lights_and_cameras),
    ("derived_tangents_agree_with_exported_ones", derived_tangents_agree_with_exported_ones),
    ("percent_encoded_and_unicode_names", percent_encoded_and_unicode_names),
    ("damaged_files_never_panic", damaged_files_never_panic),
];

fn main() {
    support::run(TESTS)
}
