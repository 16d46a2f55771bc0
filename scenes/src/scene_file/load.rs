//! From a path to a world.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use bevy_ecs::prelude::World;
use luminaire_graph::diagnostic::{Diagnostic, has_errors};
use luminaire_graph::source::SourceMap;
use luminaire_graph::syntax::read_document;
use luminaire_graph::syntax::spanned::Spanned;

use super::checked::check;
use super::checks::Problems;
use super::document::SceneDoc;
use super::{default_light, spawn};
use crate::gltf;
use crate::world::{new_world, spawn_stored, store_asset};

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
            load(&path.display().to_string(), &text, Some((&folder, asset_root)), sources)
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

/// The steps from text to world. `place` is the scene file's folder and the folder that files may come from.
fn load(name: &str, text: &str, place: Option<(&Path, Option<&Path>)>, sources: &mut SourceMap) -> Result<LoadedScene, Vec<Diagnostic>> {
    let file = sources.add(name, text);
    let document: SceneDoc = read_document(text, file)?;
    let mut problems = Problems::default();
    let checked = check(&document, &mut problems);
    let mut world = new_world();
    let mut assets = BTreeMap::new();
    let mut files = Vec::new();
    for (name, path, transform) in &checked.files {
        match resolve(path, place) {
            Ok(resolved) => {
                if !assets.contains_key(&resolved) {
                    match load_gltf(&resolved, place.and_then(|(_, root)| root)) {
                        Ok(loaded) => {
                            problems.0.extend(loaded.warnings);
                            assets.insert(resolved.clone(), Some(store_asset(&mut world, loaded.asset)));
                        }
                        Err(errors) => {
                            problems.0.extend(errors.into_iter().map(|error| named_at(error, path)));
                            assets.insert(resolved.clone(), None);
                        }
                    }
                }
                files.push((name.as_str(), resolved, *transform));
            }
            Err(problem) => problems.add(problem),
        }
    }
    if has_errors(&problems.0) {
        return Err(problems.0);
    }
    spawn::spawn(&mut world, &checked);
    for (name, path, transform) in files {
        if let Some(Some(asset)) = assets.get(&path) {
            let root = spawn::group(&mut world, name, transform);
            spawn_stored(&mut world, asset, Some(root));
        }
    }
    Ok(LoadedScene { world, warnings: problems.0 })
}

/// Where a file that the scene names lies on disk.
fn resolve(path: &Spanned<String>, place: Option<(&Path, Option<&Path>)>) -> Result<PathBuf, Diagnostic> {
    let error = |code, message| Err(Diagnostic::error(code, message).at(path.span, "this file"));
    let Some((folder, root)) = place else {
        return error("scene::no-folder", format!("the scene has no folder, so it can't name the file `{}`", path.value));
    };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let kind = extension(Path::new(&path.value));
    if kind != "gltf" && kind != "glb" {
        return error("scene::unknown-kind", format!("`{}` is no glTF file: its name ends neither in .gltf nor in .glb", path.value));
    }
    let Ok(resolved) = folder.join(&path.value).canonicalize() else {
        return error("scene::no-such-file", format!("there is no file `{}` beside the scene file", path.value));
    };
    let root = root.unwrap_or(folder);
    if !root.canonicalize().is_ok_and(|root| resolved.starts_with(root)) {
        let message = format!("`{}` lies outside of the folder that files may come from, `{}`", path.value, root.display());
        return error("scene::outside-root", message)
            .map_err(|problem| problem.hint("a folder around both can be given as the asset root"));
    }
    Ok(resolved)
}

fn load_gltf(path: &Path, root: Option<&Path>) -> Result<gltf::Loaded, Vec<Diagnostic>> {
    match root {
        Some(root) => gltf::load_within(path, root),
        None => gltf::load(path),
    }
}

/// A problem of a glTF file, with the place that names the file.
fn named_at(mut problem: Diagnostic, path: &Spanned<String>) -> Diagnostic {
    if problem.primary.is_none() {
        problem = problem.at(path.span, "in this file");
    }
    problem
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

fn extension(path: &Path) -> String {
    path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default()
}
