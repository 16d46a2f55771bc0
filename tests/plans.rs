//! Golden plans of every shipped pipeline: for a scene with one of everything, and for one with nothing.

#![allow(clippy::expect_used, reason = "a test stops where it can't go on")]

use std::path::{Path, PathBuf};
use std::sync::Arc;

use luminaire::files::{DiskFiles, embedded_pipelines};
use luminaire::graph::compile::{CompileInput, compile};
use luminaire::graph::device::DeviceFacts;
use luminaire::graph::diagnostic::render;
use luminaire::graph::dirty::Tracker;
use luminaire::graph::published::SceneCounts;
use luminaire::graph::{dump, execute};

fn plan_text(pipeline: &str, counts: &SceneCounts) -> String {
    let published = luminaire::scenes::publish::schema();
    let compilation = compile(&CompileInput {
        pipeline,
        files: &DiskFiles::default(),
        published: &published,
        counts,
        device: &DeviceFacts::webgpu_defaults(),
        output: [1280, 720],
        sets: &[],
        outputs: None,
    });
    let problems = render(&compilation.diagnostics, &compilation.sources, false);
    assert!(problems.is_empty(), "{pipeline}:\n{problems}");
    let plan = compilation.plan.expect("a plan where there are no problems");
    let mut recorder = execute::record::Recorder::default();
    let mut tracker = Tracker::new(Arc::new(plan.clone()));
    let frame = tracker.frame(&vec![0; plan.inputs.len()]);
    execute::prepare(&plan, &[], &mut recorder).expect("the recorder takes everything");
    execute::execute(&plan, &frame, &mut recorder).expect("the recorder takes everything");
    format!("{}\n== Verbs\n{}", dump::text(&plan, &compilation.sources), recorder.text())
}

fn check(name: &str, actual: &str) -> Option<String> {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/plans/{name}.txt"));
    if std::env::var_os("LUMINAIRE_ACCEPT").is_some() {
        std::fs::write(&path, actual).expect("the plan can be written");
        return None;
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    (expected != actual).then(|| format!("{} differs (LUMINAIRE_ACCEPT=1 accepts it):\n{actual}", path.display()))
}

#[test]
fn plans_of_shipped_pipelines() {
    let everything: SceneCounts = luminaire::scenes::publish::schema().counts.into_iter().map(|name| (name, 1)).collect();
    let mut failures = Vec::new();
    for pipeline in embedded_pipelines() {
        let name = pipeline.trim_start_matches("pipelines/").trim_end_matches(".ron").replace('/', "_");
        failures.extend(check(&name, &plan_text(&pipeline, &everything)));
        failures.extend(check(&format!("{name}.empty_scene"), &plan_text(&pipeline, &SceneCounts::new())));
    }
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}
