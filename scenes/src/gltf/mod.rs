//! glTF 2.0: from a `.gltf` or `.glb` file to an [`Asset`].
//!
//! Guarantees: a file from a stranger can't make this panic, hang, overflow the stack, read outside of its folder or allocate
//! much more than the file's own size; every problem of a stage is reported at once, with its JSON path; what comes out is
//! finite and in range throughout.
//!
//! ```text
//! container -> version -> buffers -> accessors -> textures, materials, meshes, skins, nodes, ... -> build
//! ```
//!
//! Everything up to `build` reads structure: references, types, counts. `build` reads vertices, images and keys, and only those
//! that the default scene uses.
//!
//! The JSON is read with `serde_json` and checked here, member by member. The types of the `gltf` crate stop at the first wrong
//! member without its path, its validation refuses a valid empty scene, and its accessor readers trust what the file says.
//!
//! Downsides: the whole file is in memory while it is read; skins and morph targets are applied once, and an animation of them
//! is not played, which is a warning.

mod accessor;
mod animation;
mod buffer;
mod build;
mod camera;
mod container;
mod element;
mod geometry;
pub(crate) mod image;
mod json;
mod keys;
mod light;
mod material;
mod mesh;
mod node;
mod report;
mod skin;
mod tangents;
#[cfg(test)]
mod tests;
mod texture;
mod topology;
mod uri;
mod version;

use std::path::Path;

use luminaire_graph::diagnostic::Diagnostic;

use crate::asset::{Asset, Camera, Light};
use animation::AnimationSource;
use image::ImageSource;
use json::Json;
use material::MaterialSource;
use mesh::MeshSource;
use node::{Counts, NodeSource};
use report::Report;
use skin::SkinSource;
use uri::Folder;

/// A file that was read, and what was odd about it.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The default scene (the one that the file names, or the first).
    pub asset: Asset,
    /// What was left out or mended.
    pub warnings: Vec<Diagnostic>,
}

/// Loads a file whose buffers and images lie in its own folder or below.
///
/// # Errors
///
/// All problems found, errors first, each with the code `gltf::...`. After 50 errors the rest is only counted.
pub fn load(path: &Path) -> Result<Loaded, Vec<Diagnostic>> {
    load_from(path, None)
}

/// Like [`load`], for a file whose buffers and images may lie anywhere in `root`, a folder around it.
///
/// # Errors
///
/// As [`load`].
pub fn load_within(path: &Path, root: &Path) -> Result<Loaded, Vec<Diagnostic>> {
    load_from(path, Some(root))
}

/// Loads a file that is already in memory, `.gltf` or `.glb`. It can name no files, only data URIs. `name` is for messages.
///
/// # Errors
///
/// As [`load`].
pub fn load_bytes(name: &str, bytes: &[u8]) -> Result<Loaded, Vec<Diagnostic>> {
    let report = Report::new(name.to_owned());
    let asset = container::parse(bytes, &report).and_then(|container| read(container, &Folder::Nowhere, &report));
    finish(asset, report)
}

fn load_from(path: &Path, root: Option<&Path>) -> Result<Loaded, Vec<Diagnostic>> {
    let report = Report::new(path.display().to_string());
    let asset = match Folder::of(path, root) {
        Ok(folder) => container::read(path, &report).and_then(|container| read(container, &folder, &report)),
        Err(problem) => {
            report.error("gltf::unreadable", "", problem, "");
            None
        }
    };
    finish(asset, report)
}

fn finish(asset: Option<Asset>, report: Report) -> Result<Loaded, Vec<Diagnostic>> {
    let warnings = report.finish()?;
    Ok(Loaded { asset: asset.unwrap_or_default(), warnings })
}

/// Everything in the file, checked, before vertices and images are read. Indices are the file's.
struct Parts<'a> {
    images: Vec<Option<ImageSource<'a>>>,
    materials: Vec<MaterialSource>,
    meshes: Vec<MeshSource<'a>>,
    skins: Vec<SkinSource<'a>>,
    lights: Vec<Option<Light>>,
    cameras: Vec<Option<Camera>>,
    nodes: Vec<NodeSource>,
    animations: Vec<AnimationSource<'a>>,
    /// Roots of the default scene.
    scene: Vec<usize>,
}

/// The stages, in order. `None` means that the report has errors.
fn read(container: container::Container, folder: &Folder, report: &Report) -> Option<Asset> {
    let root = Json::root(&container.json, report);
    version::check(&root);
    if report.has_errors() {
        return None;
    }
    let buffers = buffer::read_buffers(&root, container.binary, folder);
    let views = buffer::read_views(&root, &buffers);
    let accessors = accessor::read_accessors(&root, &views, buffer::total(&buffers));
    let images = image::read_images(&root, &views);
    let textures = texture::read_textures(&root, images.len());
    let materials = material::read_materials(&root, &textures);
    let meshes = mesh::read_meshes(&root, &accessors, materials.len());
    let lights = light::read_lights(&root);
    let cameras = camera::read_cameras(&root);
    let skins = skin::read_skins(&root, &accessors, root.list("nodes").len());
    let counts = Counts { meshes: meshes.len(), skins: skins.len(), cameras: cameras.len(), lights: lights.len() };
    let nodes = node::read_nodes(&root, counts);
    let scene = node::default_scene(&root, &nodes);
    let animations = animation::read_animations(&root, &accessors, &nodes, &meshes);
    if report.has_errors() {
        return None;
    }
    let scene = scene.unwrap_or_default();
    if scene.is_empty() {
        report.warning("gltf::empty-scene", "scenes", "the file has no scene, or its default scene has no nodes; nothing is drawn", "");
    }
    let asset = build::build(&Parts { images, materials, meshes, skins, lights, cameras, nodes, animations, scene }, folder, report);
    (!report.has_errors()).then_some(asset)
}
