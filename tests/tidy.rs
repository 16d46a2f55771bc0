//! The rules of ARCHITECTURE.md that a program can check.

#![allow(clippy::unwrap_used, reason = "a test stops where it can't go on")]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn files(folder: &Path, extension: &str, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            files(&path, extension, found);
        } else if path.extension().is_some_and(|found| found == extension) {
            found.push(path);
        }
    }
    found.sort();
}

fn all(extension: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    files(&root(), extension, &mut found);
    let name = |path: &Path| path.strip_prefix(root()).unwrap().display().to_string();
    found.iter().map(|path| (name(path), std::fs::read_to_string(path).unwrap())).collect()
}

/// Every crate below `luminaire-graph` in the lock file.
#[test]
fn the_graph_depends_on_no_gpu_crate() {
    let lock = std::fs::read_to_string(root().join("Cargo.lock")).unwrap();
    let mut packages: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut name = String::new();
    for line in lock.lines() {
        if let Some(value) = line.strip_prefix("name = ") {
            name = value.trim_matches('"').to_owned();
        } else if let Some(dependency) = line.strip_prefix(" \"") {
            let dependency = dependency.split(['"', ' ']).next().unwrap_or_default().to_owned();
            packages.entry(name.clone()).or_default().push(dependency);
        }
    }
    // Development dependencies stand in the lock file too; none of them is a GPU crate either.
    let mut reached = BTreeSet::new();
    let mut pending = vec!["luminaire-graph".to_owned()];
    while let Some(package) = pending.pop() {
        if reached.insert(package.clone()) {
            pending.extend(packages.get(&package).into_iter().flatten().cloned());
        }
    }
    assert!(reached.contains("naga"), "the lock file was not understood");
    for gpu in ["wgpu", "wgpu-core", "wgpu-hal", "ash", "winit"] {
        assert!(!reached.contains(gpu), "luminaire-graph depends on {gpu}");
    }
}

#[test]
fn dependencies_point_one_way() {
    let allowed = [("graph", vec![]), ("passes", vec!["luminaire-graph"]), ("scenes", vec!["luminaire-graph"])];
    for (folder, allowed) in allowed {
        let manifest = std::fs::read_to_string(root().join(folder).join("Cargo.toml")).unwrap();
        let dependencies = manifest.split("[dependencies]").nth(1).unwrap().split("\n[").next().unwrap();
        for line in dependencies.lines().filter(|line| line.starts_with("luminaire-")) {
            let name = line.split(['.', ' ', '=']).next().unwrap();
            assert!(allowed.contains(&name), "{folder} depends on {name}");
        }
    }
}

#[test]
fn files_have_headers_and_are_not_long() {
    let mut problems = Vec::new();
    for (name, text) in all("rs") {
        if !text.starts_with("//!") {
            problems.push(format!("{name} does not begin with its purpose"));
        }
        let lines = text.lines().count();
        let header: String = text.lines().take_while(|line| line.starts_with("//!")).collect();
        if lines > 500 && !header.contains("long") {
            problems.push(format!("{name} has {lines} lines, and its header gives no reason"));
        }
    }
    for extension in ["wgsl", "ron"] {
        for (name, text) in all(extension) {
            if !name.contains("fixtures") && !text.starts_with("//") {
                problems.push(format!("{name} does not begin with its purpose"));
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn the_core_names_no_technique() {
    for (name, text) in all("rs") {
        let core = (name.starts_with("graph/src") || name.starts_with("passes/src") || name.starts_with("src")) && !name.contains("test");
        let code: String = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n").to_lowercase();
        for technique in ["cone_trac", "voxel", "irradiance", "prefilter", "tonemap", "tone_map", "gbuffer", "g_buffer"] {
            assert!(!core || !code.contains(technique), "{name} names the technique `{technique}`");
        }
    }
}

#[test]
fn shipped_scenes_are_in_the_program() {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(root().join("scenes")).unwrap().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.ends_with(".ron") {
            found.push(format!("scenes/{name}"));
        }
    }
    found.sort();
    assert_eq!(found, luminaire::files::embedded_scenes());
}

#[test]
fn every_pipeline_has_a_golden_plan() {
    for pipeline in luminaire::files::embedded_pipelines() {
        let name = pipeline.trim_start_matches("pipelines/").trim_end_matches(".ron").replace('/', "_");
        assert!(root().join(format!("tests/plans/{name}.txt")).exists(), "{pipeline} has no golden plan in tests/plans");
    }
}
