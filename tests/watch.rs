//! Files that change on disk: told once, by name, whichever way they were written.
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use luminaire::watch::{QUIET, Watch};

/// What is told within a while; nothing if nothing is.
fn told(watch: &mut Watch, most: Duration) -> Vec<PathBuf> {
    let start = Instant::now();
    while start.elapsed() < most {
        let changed = watch.changed();
        if !changed.is_empty() {
            return changed;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    Vec::new()
}

const SOON: Duration = Duration::from_secs(10);

fn write(path: &Path, text: &str) {
    std::fs::write(path, text).unwrap();
}

#[test]
fn changes_are_told_once_however_they_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let [pipeline, shader, other] = ["a.ron", "b.wgsl", "c.txt"].map(|name| folder.path().join(name));
    for path in [&pipeline, &shader, &other] {
        write(path, "before");
    }
    let missing = folder.path().join("missing.wgsl");
    let mut watch = Watch::files([pipeline.clone(), shader.clone(), missing]).unwrap();
    assert_eq!(watch.changed(), Vec::<PathBuf>::new());
    // Several writes, one report.
    for text in ["a", "b", "c"] {
        write(&pipeline, text);
        assert_eq!(watch.changed(), Vec::<PathBuf>::new(), "changes still come in");
    }
    assert_eq!(told(&mut watch, SOON), [&*pipeline]);
    assert_eq!(told(&mut watch, 3 * QUIET), Vec::<PathBuf>::new());
    // As editors do it, and both at once.
    let new = folder.path().join("b.wgsl.new");
    write(&new, "after");
    std::fs::rename(&new, &shader).unwrap();
    write(&pipeline, "d");
    assert_eq!(told(&mut watch, SOON), [pipeline.clone(), shader.clone()]);
    // What is not watched is nobody's business, until it is.
    write(&other, "after");
    assert_eq!(told(&mut watch, 3 * QUIET), Vec::<PathBuf>::new());
    watch.turn_to([other.clone()]).unwrap();
    write(&pipeline, "e");
    write(&other, "later");
    assert_eq!(told(&mut watch, SOON), [other]);
}

#[test]
fn a_compilation_names_all_its_files() {
    use luminaire::files::DiskFiles;
    use luminaire::graph::compile::{CompileInput, compile};
    use luminaire::graph::device::DeviceFacts;
    use luminaire::graph::published::SceneCounts;
    use luminaire::scenes::publish::schema;

    let folder = tempfile::tempdir().unwrap();
    let [pipeline, shader, import, ramp] = ["p.ron", "s.wgsl", "i.wgsl", "r.exr"].map(|name| folder.path().join(name));
    write(
        &pipeline,
        r#"(doc: "One pass.", resources: {"a": Texture(format: "rgba8unorm"), "ramp": Image(file: "r.exr", format: "r32float")},
            passes: {"p": Fullscreen(shader: "s.wgsl", write: {"color": "a"})}, outputs: {"color": "a"})"#,
    );
    write(&shader, "#import \"i.wgsl\"\nstruct Out { color: vec4<f32> }\n@fragment fn shade() -> Out { return Out(vec4<f32>(value())); }");
    image::Rgb32FImage::new(2, 2).save(&ramp).unwrap();
    write(&import, "fn value() -> f32 { return 1.0; }");
    let compilation = compile(&CompileInput {
        pipeline: &pipeline.display().to_string(),
        files: &DiskFiles::for_pipeline(&pipeline),
        published: &schema(),
        counts: &SceneCounts::new(),
        device: &DeviceFacts::webgpu_defaults(),
        output: [8, 8],
        sets: &[],
        outputs: None,
    });
    assert!(compilation.plan.is_some(), "{:?}", compilation.diagnostics);
    let mut watch = Watch::sources(&compilation.sources).unwrap();
    for file in [&pipeline, &shader, &import, &ramp] {
        write(file, "changed");
        let changed = told(&mut watch, SOON);
        assert_eq!(changed.len(), 1, "{changed:?}");
        assert_eq!(changed[0].canonicalize().unwrap(), file.canonicalize().unwrap());
    }
}
