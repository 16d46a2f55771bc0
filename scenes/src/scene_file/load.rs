//! From a path to a world.

use std::path::{Path, PathBuf};

use bevy_ecs::prelude::World;
use luminaire_graph::diagnostic::{Diagnostic, has_errors};
use luminaire_graph::source::SourceMap;
use luminaire_graph::syntax::read_document;

use super::assets::{Place, load_files};
use super::check::{Checked, check};
use super::checks::Problems;
use super::document::SceneDoc;
use super::events::events;
use super::names::Names;
use super::size::check_size;
use super::sky::load_sky;
use super::{default_light, spawn};
use crate::gltf;
use crate::timeline::{self, Timeline};
use crate::world::{Environment, Materials, Meshes, new_world, spawn_stored, store_asset};

/// Longest scene file, bytes.
const MAX_TEXT_BYTES: u64 = 64 << 20;

/// A scene with its warnings.
#[derive(Debug)]
pub struct LoadedScene {
    /// Ready to be published.
    pub world: World,
    /// What was left out or mended; places point into the sources that were handed in.
    pub warnings: Vec<Diagnostic>,
}

/// Loads a `.gltf`, `.glb` or `.ron` file. `asset_root` is the folder that the files which it names may come from; its own
/// folder if not given. Texts are added to `sources`, for messages. A glTF file without lights gets some, with the warning
/// `scene::default-light`.
/// Errors: everything that is wrong, `scene::...` for the scene file and `gltf::...` for what it names.
pub fn load_scene(path: &Path, asset_root: Option<&Path>, sources: &mut SourceMap) -> Result<LoadedScene, Vec<Diagnostic>> {
    match extension(path).as_str() {
        "gltf" | "glb" => {
            let gltf::Loaded { asset, mut warnings } = load_gltf(path, asset_root)?;
            let mut world = new_world();
            let is_dark = default_light::is_missing(&asset);
            let stored = store_asset(&mut world, asset);
            spawn_stored(&mut world, &stored, None);
            if is_dark {
                warnings.push(default_light::add(&mut world, &path.display().to_string()));
            }
            Ok(LoadedScene { world, warnings })
        }
        "ron" => {
            let text = read(path).map_err(|problem| vec![problem])?;
            let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
            load(&path.display().to_string(), &text, Some(Place { folder: &folder, root: asset_root }), sources)
        }
        _ => Err(vec![
            Diagnostic::error("scene::unknown-kind", format!("`{}` is no scene", path.display()))
                .hint("scenes are .gltf, .glb and .ron files"),
        ]),
    }
}

/// Loads a scene file that is already in memory. It can name no glTF files. `name` is for messages.
/// Errors: as [`load_scene`].
pub fn load_scene_text(name: &str, text: &str, sources: &mut SourceMap) -> Result<LoadedScene, Vec<Diagnostic>> {
    load(name, text, None, sources)
}

/// The steps from text to world.
fn load(name: &str, text: &str, place: Option<Place<'_>>, sources: &mut SourceMap) -> Result<LoadedScene, Vec<Diagnostic>> {
    let file = sources.add(name, text);
    let document: SceneDoc = read_document(text, file)?;
    let mut problems = Problems::default();
    let Checked { sky_radiance, sky_image, least_illuminance, materials, primitives, declarations, initial, spawned: batches, files } =
        check(&document, &mut problems);
    let mut world = new_world();
    world.insert_resource(Environment { sky_radiance, least_illuminance });
    // First of all, so that their rows are those that were counted.
    world.insert_resource(Materials(materials));
    world.insert_resource(Meshes(primitives.meshes));
    if let Some(sky) = sky_image.and_then(|sky| load_sky(&sky, place, &mut problems)) {
        world.insert_resource(sky);
    }
    let files = load_files(&mut world, &files, place, &mut problems);
    check_size(&declarations, &files, &world, &mut problems);
    let mut names = Names::new(&declarations, &files, &document.timeline);
    names.declare(initial.clone(), 0.0, &mut problems);
    let events = events(&document, &batches, &mut names, &world, &mut problems);
    let parents = names.declared;
    if has_errors(&problems.0) {
        return Err(problems.0);
    }
    let files: Vec<_> = files.into_iter().flatten().collect();
    let mut spawned = Vec::new();
    spawned.resize_with(declarations.len(), || None);
    spawn(&mut world, &declarations, initial, &parents, &files, &mut spawned);
    if !events.is_empty() {
        world.insert_resource(Timeline::new(events, declarations, parents, files, spawned));
        let failed = timeline::advance(&mut world, 0.0, |_, _| {}).map_err(|refused| vec![refused])?;
        if !failed.is_empty() {
            return Err(failed);
        }
    }
    Ok(LoadedScene { world, warnings: problems.0 })
}

pub(super) fn load_gltf(path: &Path, root: Option<&Path>) -> Result<gltf::Loaded, Vec<Diagnostic>> {
    match root {
        Some(root) => gltf::load_within(path, root),
        None => gltf::load(path),
    }
}

fn read(path: &Path) -> Result<String, Diagnostic> {
    let unreadable = |reason: String| Diagnostic::error("scene::unreadable", format!("`{}` can't be read: {reason}", path.display()));
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
    if metadata.len() > MAX_TEXT_BYTES {
        return Err(unreadable(format!("it is larger than {} MiB", MAX_TEXT_BYTES >> 20)));
    }
    let bytes = std::fs::read(path).map_err(|error| unreadable(error.to_string()))?;
    String::from_utf8(bytes).map_err(|error| unreadable(format!("it is not UTF-8 at byte {}", error.utf8_error().valid_up_to())))
}

pub(super) fn extension(path: &Path) -> String {
    path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default()
}
