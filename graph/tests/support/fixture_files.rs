//! Shared by the tests: a small published schema, files from the fixtures folder, and comparison with expected text.

#![allow(clippy::expect_used, reason = "a broken fixture folder should stop the test")]

use std::path::{Path, PathBuf};

use luminaire_graph::compile::{Compilation, CompileInput, compile};
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::published::{
    Collection, PublishedSchema, SceneCounts, TableKind, TableMember, TableSchema, VertexAttribute, VertexFormat, VertexSchema,
};
use luminaire_graph::source::{FileError, FileKind, Files, LoadedFile, LoadedImage};

pub fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures")
}

/// Pipelines by path, shaders from `fixtures/shaders`.
pub struct FixtureFiles;

impl Files for FixtureFiles {
    fn read(&self, kind: FileKind, path: &str) -> Result<LoadedFile, FileError> {
        let (folder, shown) = match kind {
            FileKind::Pipeline | FileKind::Block => (fixtures(), path.to_owned()),
            FileKind::Shader | FileKind::Image => (fixtures().join("shaders"), format!("shaders/{path}")),
        };
        match std::fs::read_to_string(folder.join(path)) {
            Ok(text) => Ok(LoadedFile { name: shown, text }),
            Err(_) => Err(FileError::NotFound { searched: vec!["shaders".to_owned()] }),
        }
    }

    /// One image there is, and one that is no image.
    fn image(&self, path: &str) -> Result<LoadedImage, FileError> {
        match path {
            "ramp.exr" => Ok(LoadedImage { name: "shaders/ramp.exr".to_owned(), width: 4, height: 2, texels: vec![[0.5; 4]; 8] }),
            "noise.exr" => Err(FileError::Unreadable("the file ends in the middle of its texels".to_owned())),
            _ => Err(FileError::NotFound { searched: vec!["shaders".to_owned()] }),
        }
    }

    fn known(&self, kind: FileKind) -> Vec<String> {
        let folder = match kind {
            FileKind::Image => return vec!["ramp.exr".to_owned(), "noise.exr".to_owned()],
            FileKind::Shader => "shaders",
            FileKind::Block => "blocks",
            FileKind::Pipeline => "plans",
        };
        let mut names: Vec<String> = std::fs::read_dir(fixtures().join(folder))
            .map(|entries| entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect())
            .unwrap_or_default();
        names.sort();
        names
    }
}

/// One uniform table, three vertex attributes, two counts.
pub fn schema() -> PublishedSchema {
    let camera = TableSchema {
        kind: TableKind::Uniform,
        doc: "The camera.".to_owned(),
        members: vec![TableMember { name: "projection_from_world".to_owned(), wgsl: "mat4x4<f32>".to_owned(), offset: 0 }],
        stride: 64,
        per_draw: false,
    };
    let attribute = |format, offset| VertexAttribute { format, offset };
    let member = |name: &str, wgsl: &str, offset| TableMember { name: name.to_owned(), wgsl: wgsl.to_owned(), offset };
    let lights = TableSchema {
        kind: TableKind::Storage,
        doc: "Point lights.".to_owned(),
        members: vec![member("position", "vec3<f32>", 0), member("range", "f32", 12)],
        stride: 16,
        per_draw: false,
    };
    PublishedSchema {
        tables: [("camera".to_owned(), camera), ("point_lights".to_owned(), lights)].into_iter().collect(),
        textures: Vec::new(),
        material_textures: vec!["base_color_texture".to_owned()],
        material_samplers: vec!["base_color_sampler".to_owned()],
        vertex: VertexSchema {
            stride: 32,
            attributes: [
                ("position".to_owned(), attribute(VertexFormat::Float32x3, 0)),
                ("normal".to_owned(), attribute(VertexFormat::Float32x3, 12)),
                ("uv0".to_owned(), attribute(VertexFormat::Float32x2, 24)),
            ]
            .into_iter()
            .collect(),
        },
        counts: vec!["point_lights".to_owned(), "directional_lights".to_owned()],
        collections: [("point_lights".to_owned(), Collection { table: "point_lights".to_owned(), element: "point_light".to_owned() })]
            .into_iter()
            .collect(),
    }
}

/// Compiles a fixture at 256x128 in a scene with one point light.
pub fn compile_fixture(path: &str) -> Compilation {
    let counts: SceneCounts = [("point_lights".to_owned(), 1), ("directional_lights".to_owned(), 0)].into_iter().collect();
    compile(&CompileInput {
        pipeline: path,
        files: &FixtureFiles,
        published: &schema(),
        counts: &counts,
        device: &DeviceFacts::webgpu_defaults(),
        output: [256, 128],
        sets: &[],
        outputs: None,
    })
}

/// Every fixture of a folder, by name.
pub fn fixtures_in(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(fixtures().join(folder)).expect("the fixtures folder");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .filter_map(|name| name.strip_suffix(".ron").map(str::to_owned))
        .collect();
    names.sort();
    names
}

/// Compares with the expected text beside a fixture. `LUMINAIRE_ACCEPT=1` writes what came out instead.
pub fn check_text(path: &Path, actual: &str) -> Result<(), String> {
    if std::env::var_os("LUMINAIRE_ACCEPT").is_some() {
        return std::fs::write(path, actual).map_err(|error| error.to_string());
    }
    let expected = std::fs::read_to_string(path).unwrap_or_default();
    if expected == actual {
        return Ok(());
    }
    Err(format!("{} differs (LUMINAIRE_ACCEPT=1 accepts it).\n--- expected\n{expected}\n--- actual\n{actual}", path.display()))
}
