//! Images of linear light from a folder of real, handmade and broken files, which lies beside the repository.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod support;

use std::path::Path;

use luminaire_graph::source::SourceMap;
use luminaire_scenes::linear_image::decode_linear;
use luminaire_scenes::load_scene;
use support::{AssetTest, messages};

/// Whether one file may be read is told by the manifest; that each is told from the others quickly, and without a panic, is tested.
fn broken_files_are_refused(assets: &Path) {
    let folder = assets.join("malformed/hdr");
    let mut refused = 0;
    for entry in std::fs::read_dir(&folder).unwrap().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let read = decode_linear(&std::fs::read(entry.path()).unwrap());
        // A square image is no equirectangular one, and can be read.
        assert_eq!(read.is_err(), name != "not_2_to_1.hdr", "{name}: {:?}", read.map(|image| (image.width, image.height)));
        refused += usize::from(name != "not_2_to_1.hdr");
    }
    assert!(refused >= 11);
}

/// A texel at 2^k in each channel is read exactly.
fn directions_are_read(assets: &Path) {
    let image = decode_linear(&std::fs::read(assets.join("hdr/direction_code_128.hdr")).unwrap()).unwrap();
    assert_eq!((image.width, image.height), (128, 64));
    // Right of the middle, at the horizon: +X.
    let [r, g, b, a] = image.texels[32 * 128 + 64];
    assert!((r - 1.0).abs() < 0.01 && (g - 0.5).abs() < 0.02 && (b - 0.5).abs() < 0.02 && a == 1.0, "{r} {g} {b} {a}");
    // The top row is +Y.
    assert!(image.texels[..128].iter().all(|texel| texel[1] > 0.99));
}

fn odd_shapes_and_broken_files_are_told(assets: &Path) {
    let folder = tempfile::tempdir().unwrap();
    let load = |source: &str| {
        std::fs::copy(assets.join(source), folder.path().join("sky.hdr")).unwrap();
        let path = folder.path().join("scene.ron");
        std::fs::write(&path, "(cameras: {\"eye\": (position: (0, 0, 1), target: (0, 0, 0))}, environment: (image: \"sky.hdr\"))").unwrap();
        let loaded = load_scene(&path, None, &mut SourceMap::default());
        match loaded {
            Ok(loaded) => loaded.warnings.iter().map(|warning| warning.code).collect::<Vec<_>>(),
            Err(problems) => {
                let told = problems.iter().all(|problem| problem.hint.is_some() && problem.message.contains("sky.hdr"));
                assert!(told, "{}", messages(&problems));
                problems.iter().map(|problem| problem.code).collect()
            }
        }
    };
    assert_eq!(load("hdr/royal_esplanade_1k.hdr"), Vec::<&str>::new());
    // Brighter than any half float.
    assert_eq!(load("hdr/over_f16_max.hdr"), Vec::<&str>::new());
    assert_eq!(load("malformed/hdr/not_2_to_1.hdr"), ["scene::sky-shape"]);
    for entry in std::fs::read_dir(assets.join("malformed/hdr")).unwrap().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name != "not_2_to_1.hdr" {
            assert_eq!(load(&format!("malformed/hdr/{name}")), ["scene::sky-image"], "{name}");
        }
    }
}

const TESTS: &[(&str, AssetTest)] = &[
    ("broken files are refused", broken_files_are_refused),
    ("directions are read", directions_are_read),
    ("odd shapes and broken files are told", odd_shapes_and_broken_files_are_told),
];

fn main() {
    support::run(TESTS);
}
