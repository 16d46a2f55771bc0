//! `luminaire check`: every problem of the given files, with its place.

use std::path::Path;

use luminaire_graph::compile::{CompileInput, compile};
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::{Diagnostic, has_errors};
use luminaire_graph::expand::BLOCK_ALONE;
use luminaire_graph::published::SceneCounts;
use luminaire_graph::reflect::reflect;
use luminaire_graph::schedule::NOTHING_RUNS;
use luminaire_graph::source::{SourceMap, Span};

use super::arguments::CheckArguments;
use super::plan::one_of_everything;
use super::{print, report};
use crate::files::DiskFiles;
use crate::ron_kind::RonKind;
use crate::session::load_scene;

pub(super) fn run(arguments: &CheckArguments) -> bool {
    let mut fine = true;
    for path in &arguments.paths {
        let (diagnostics, sources) = check(path);
        fine &= report(&diagnostics, &sources);
        if !has_errors(&diagnostics) {
            fine &= print(&format!("{}: fine\n", path.display()));
        }
    }
    fine
}

fn check(path: &Path) -> (Vec<Diagnostic>, SourceMap) {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("wgsl") => shader(path),
        Some("gltf" | "glb") => scene(path),
        Some("ron") if is_scene(path) => scene(path),
        Some("ron") => pipeline(path),
        _ => {
            let message = format!("can't tell what `{}` is", path.display());
            let hint = "check takes pipelines and scenes (.ron), shaders (.wgsl) and models (.gltf, .glb)";
            (vec![Diagnostic::error("check::kind", message).hint(hint)], SourceMap::default())
        }
    }
}

/// Broken texts and paths that lead nowhere are read as what they look like: those below a folder `scenes` as scenes.
fn is_scene(path: &Path) -> bool {
    let kind = std::fs::read(path).ok().and_then(|bytes| RonKind::of(&String::from_utf8_lossy(&bytes)));
    kind.map_or_else(|| path.components().any(|part| part.as_os_str() == "scenes"), |kind| kind == RonKind::Scene)
}

fn scene(path: &Path) -> (Vec<Diagnostic>, SourceMap) {
    match load_scene(&path.display().to_string(), None) {
        Ok(loaded) => (loaded.diagnostics, loaded.sources),
        Err(problems) => problems,
    }
}

/// A pipeline is checked for a scene that has one of everything, and for one that has nothing: what is wrong with either is wrong.
fn pipeline(path: &Path) -> (Vec<Diagnostic>, SourceMap) {
    let published = luminaire_scenes::publish::schema();
    let name = path.display().to_string();
    let mut last = (Vec::new(), SourceMap::default());
    for counts in [one_of_everything(), SceneCounts::new()] {
        let mut compilation = compile(&CompileInput {
            pipeline: &name,
            files: &DiskFiles::for_pipeline(path),
            published: &published,
            counts: &counts,
            device: &DeviceFacts::webgpu_defaults(),
            output: [1280, 720],
            sets: &[],
            outputs: None,
        });
        // A block is given its inputs by others: alone, its names can be checked, and they have been.
        // And where a scene has nothing of what it draws, nothing runs.
        let fine = |code: &str| code == BLOCK_ALONE || code == NOTHING_RUNS && counts.is_empty();
        compilation.diagnostics.retain(|problem| !fine(problem.code));
        let problems = has_errors(&compilation.diagnostics);
        if problems || last.0.is_empty() {
            last = (compilation.diagnostics, compilation.sources);
        }
        if problems {
            break;
        }
    }
    last
}

fn shader(path: &Path) -> (Vec<Diagnostic>, SourceMap) {
    let mut sources = SourceMap::default();
    let published = luminaire_scenes::publish::schema();
    let inner = shader_name(path);
    let files = DiskFiles::for_shader(path, &inner);
    let diagnostics = reflect(&inner, Span::NOWHERE, &files, &published, &mut sources).err().unwrap_or_default();
    (diagnostics, sources)
}

/// The path below the nearest folder named `shaders`, or the file's name alone.
fn shader_name(path: &Path) -> String {
    let parts: Vec<String> = path.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    let start = parts.iter().rposition(|part| part == "shaders").map_or(parts.len().saturating_sub(1), |index| index + 1);
    parts.get(start..).unwrap_or_default().join("/")
}
