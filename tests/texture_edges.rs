//! Textures at the edges of triangles. The mip level comes from differences between neighbours, some of which lie outside of the
//! triangle; what such a neighbour reads from storage is nothing to rely on.

#![allow(clippy::unwrap_used, reason = "a test stops where it can't go on")]

#[path = "support/mod.rs"]
mod support;

use std::path::Path;

use libtest_mimic::{Arguments, Failed, Trial};
use luminaire::image_file::{LinearImage, write_image};
use luminaire::passes::Adapter;
use luminaire::session::{RenderRequest, Session, load_scene};
use support::trial;

const TEXELS: u32 = 64;

/// A square of two triangles with a board of 4 x 4 black and white fields, looked up without interpolation.
fn write_board(folder: &Path) {
    std::fs::create_dir_all(folder).unwrap();
    let white = |x: u32, y: u32| f32::from(u8::from((x / 16 + y / 16).is_multiple_of(2)));
    let texels = (0..TEXELS * TEXELS).map(|i| white(i % TEXELS, i / TEXELS)).map(|value| [value, value, value, 1.0]).collect();
    write_image(&folder.join("board.png"), &LinearImage { width: TEXELS, height: TEXELS, texels, components: 4 }).unwrap();
    let positions = [[-1.0_f32, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let uvs = [[0.0_f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let floats = positions.iter().flatten().chain(uvs.iter().flatten());
    let mut bytes: Vec<u8> = floats.flat_map(|value| value.to_le_bytes()).collect();
    bytes.extend([0, 1, 2, 0, 2, 3]);
    std::fs::write(folder.join("board.bin"), &bytes).unwrap();
    let text = r#"{
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "buffers": [{"uri": "board.bin", "byteLength": 86}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 32},
            {"buffer": 0, "byteOffset": 80, "byteLength": 6}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR"}],
        "images": [{"uri": "board.png"}], "samplers": [{"magFilter": 9728, "minFilter": 9984}], "textures": [{"source": 0, "sampler": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}]
    }"#;
    std::fs::write(folder.join("board.gltf"), text).unwrap();
}

/// Large fields are black or white up to the edges, never the grey of a small mip level.
fn no_grey_along_the_diagonal() -> Result<(), Failed> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("texture_edges");
    write_board(&folder);
    let shown = |(problems, sources): luminaire::session::Problems| luminaire::graph::diagnostic::render(&problems, &sources, false);
    let mut loaded = load_scene(&folder.join("board.gltf").display().to_string(), None).map_err(shown)?;
    let outputs = ["albedo".to_owned()];
    let request = RenderRequest {
        pipeline: "pipelines/pbr.ron",
        size: [400, 400],
        camera: None,
        sets: &[],
        outputs: Some(&outputs),
        timing: false,
        memory_budget: None,
    };
    let mut session = Session::new(&mut loaded.world, &request).map_err(shown)?;
    session.render_frame().map_err(shown)?;
    let image = session.read_output("albedo").map_err(shown)?;
    let count = |test: fn(f32) -> bool| image.texels.iter().filter(|texel| test(texel[0])).count();
    let (white, grey) = (count(|value| value > 0.99), count(|value| (0.01..=0.99).contains(&value)));
    if white > 5000 && grey == 0 { Ok(()) } else { Err(format!("{white} white texels and {grey} grey ones").into()) }
}

fn main() {
    let missing = Adapter::choose(None).is_err().then_some("a Vulkan adapter");
    let trials: Vec<Trial> = vec![trial("no grey along the diagonal", missing, no_grey_along_the_diagonal)];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
