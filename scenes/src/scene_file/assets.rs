//! The files that a scene names: found, loaded once each, and given the materials that the scene changes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bevy_ecs::prelude::World;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::syntax::document::Text;

use super::check::{FileUse, Play, material, motion};
use super::checks::Problems;
use super::load::{extension, load_gltf};
use crate::asset::Asset;
use crate::world::{Materials, Repeat, StoredAsset, store_asset};

/// Most levels of a file's nodes: each event inside of it walks up once.
const MAX_LEVELS: usize = 1024;
/// Most materials, where entries change those of their files.
const MAX_MATERIALS: usize = 1 << 18;
/// Where a scene's files may lie.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    /// The scene file's folder.
    pub(super) folder: &'a Path,
    /// The folder that nothing may lie outside of; the scene file's own if not given.
    pub(super) root: Option<&'a Path>,
}

/// A file as an entry uses it.
#[derive(Debug, Clone)]
pub(crate) struct UsedFile {
    pub(crate) asset: Arc<StoredAsset>,
    /// How it plays, if its entry says so.
    pub(crate) play: Option<Play>,
}

/// Loads every file and stores it in the world; `None` where that failed, which is among the problems then.
pub(super) fn load_files(world: &mut World, uses: &[FileUse], place: Option<Place<'_>>, problems: &mut Problems) -> Vec<Option<UsedFile>> {
    let mut known: BTreeMap<PathBuf, Option<Arc<StoredAsset>>> = BTreeMap::new();
    uses.iter()
        .map(|used| {
            let path = resolve(&used.path, place).map_err(|problem| problems.add(problem)).ok()?;
            let asset = known.entry(path).or_insert_with_key(|path| load(world, path, used, place, problems)).clone()?;
            let asset = if used.materials.is_empty() { asset } else { Arc::new(with_changes(world, &asset, used, problems)) };
            let of = format!("file `{}`", used.name);
            let entry = used.animation.as_ref();
            let play = entry.and_then(|entry| motion::play(&asset, &of, used.path.span, entry, used.appears, problems));
            // A file that comes later plays from its beginning, and not from where it would be by then.
            let later = || Play { clip: 0, speed: 1.0, start: used.appears, repeat: Repeat::Loop };
            let play = play.or_else(|| (used.appears > 0.0 && !asset.animations().is_empty()).then(later));
            Some(UsedFile { asset, play })
        })
        .collect()
}

fn load(world: &mut World, path: &Path, used: &FileUse, place: Option<Place<'_>>, problems: &mut Problems) -> Option<Arc<StoredAsset>> {
    match load_gltf(path, place.and_then(|place| place.root)) {
        Ok(loaded) => {
            problems.0.extend(loaded.warnings);
            if depth(&loaded.asset) > MAX_LEVELS {
                problems.add(
                    Diagnostic::error(
                        "scene::too-deep",
                        format!("nodes of `{}` stand more than {MAX_LEVELS} levels deep", used.path.value),
                    )
                    .at(used.path.span, "this file")
                    .hint("give its nodes parents nearer to the root"),
                );
                return None;
            }
            Some(Arc::new(store_asset(world, loaded.asset)))
        }
        Err(errors) => {
            problems.0.extend(errors.into_iter().map(|error| named_at(error, &used.path)));
            None
        }
    }
}

/// How many nodes stand above one another. Parents come before their children.
fn depth(asset: &Asset) -> usize {
    let mut depths: Vec<usize> = Vec::with_capacity(asset.nodes.len());
    for node in &asset.nodes {
        depths.push(1 + node.parent.and_then(|parent| depths.get(parent)).copied().unwrap_or(0));
    }
    depths.into_iter().max().unwrap_or(0)
}

/// The file with the materials that the scene changes. Errors: a name that no material of the file has.
fn with_changes(world: &mut World, asset: &StoredAsset, used: &FileUse, problems: &mut Problems) -> StoredAsset {
    let all = world.get_resource::<Materials>().and_then(|materials| materials.0.get(asset.materials()));
    let names: Vec<String> = all.unwrap_or_default().iter().map(|material| material.name.clone()).collect();
    for name in used.materials.keys().filter(|name| !names.contains(&name.value)) {
        let known = || names.iter().map(String::as_str);
        problems.add_unknown(
            Diagnostic::error("scene::unknown-material", format!("the file `{}` has no material `{}`", used.name, name.value))
                .at(name.span, "no such material"),
            "materials of the file",
            Some(&name.value),
            known,
        );
    }
    let stored = world.get_resource::<Materials>().map_or(0, |materials| materials.0.len());
    if stored + names.len() > MAX_MATERIALS {
        problems.add(
            Diagnostic::error("scene::too-much", format!("with those of the file `{}` the scene has too many materials", used.name))
                .at(used.path.span, format!("at most {MAX_MATERIALS} are allowed; each entry that changes some has all of its file again"))
                .hint("change materials of fewer entries"),
        );
        return asset.clone();
    }
    // Several materials of one name change together; what is wrong with a value is said once.
    let mut said = Problems::default();
    let changed = asset.with_materials(world, |old| {
        let entry = used.materials.get(old.name.as_str())?;
        let of = format!("material `{}` of file `{}`", old.name, used.name);
        Some(material::changed(old.clone(), &of, entry, &mut said))
    });
    for problem in said.0 {
        if !problems.0.contains(&problem) {
            problems.add(problem);
        }
    }
    changed
}

/// Where a file that the scene names lies on disk.
fn resolve(path: &Text, place: Option<Place<'_>>) -> Result<PathBuf, Diagnostic> {
    let kind = extension(Path::new(&path.value));
    if place.is_some() && kind != "gltf" && kind != "glb" {
        let message = format!("`{}` is no glTF file: its name ends neither in .gltf nor in .glb", path.value);
        return Err(Diagnostic::error("scene::unknown-kind", message).at(path.span, "this file"));
    }
    locate(path, place)
}

/// The path of a file of any kind, which must lie where the scene's files may.
pub(super) fn locate(path: &Text, place: Option<Place<'_>>) -> Result<PathBuf, Diagnostic> {
    let error = |code, message, hint: &str| Err(Diagnostic::error(code, message).at(path.span, "this file").hint(hint));
    let Some(Place { folder, root }) = place else {
        let message = format!("the scene has no folder, so it can't name the file `{}`", path.value);
        return error("scene::no-folder", message, "load it from a file");
    };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(resolved) = folder.join(&path.value).canonicalize() else {
        let message = format!("there is no file `{}` beside the scene file", path.value);
        return error("scene::no-such-file", message, "paths start at the folder of the scene file");
    };
    let root = root.unwrap_or(folder);
    if !root.canonicalize().is_ok_and(|root| resolved.starts_with(root)) {
        let message = format!("`{}` lies outside of the folder that files may come from, `{}`", path.value, root.display());
        return error("scene::outside-root", message, "a folder around both can be given as the asset root");
    }
    Ok(resolved)
}

/// A problem of a glTF file, with the place that names the file.
fn named_at(mut problem: Diagnostic, path: &Text) -> Diagnostic {
    if problem.primary.is_none() {
        problem = problem.at(path.span, "in this file");
    }
    problem
}
