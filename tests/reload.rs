//! What happens to a session when its files change: on wgpu's device that runs nothing, so that no driver is needed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

use std::path::{Path, PathBuf};

use luminaire::graph::device::{DeviceFacts, Feature};
use luminaire::passes::Adapter;
use luminaire::session::{RenderRequest, Session, load_scene};

const PIPELINE: &str = r#"(
    doc: "Two passes, and a block with a third.",
    params: {"gain": (default: 0.5)},
    blocks: {"last": (file: "last.ron", params: {"gain": "2 * gain"}, inputs: {"light": "sum"})},
    resources: {
        "light": Texture(format: "rgba16float", size: Square(8)),
        "sum": Texture(format: "rgba16float", size: Square(8), clear: Zero),
    },
    passes: {
        "light": Compute(shader: "fill.wgsl", cover: "light", write: {"texels": "light"}),
        "sum": Fullscreen(shader: "add.wgsl", read: {"light": "light"}, modify: {"color": "sum"}, blend: {"color": Add}),
    },
    outputs: {"color": "last.color"},
)"#;
const BLOCK: &str = r#"(
    doc: "Copies what it is given.",
    params: {"gain": (default: 1.0)},
    inputs: {"light": Texture()},
    resources: {"color": Texture(format: "rgba16float", size: Square(8))},
    passes: {"copy": Fullscreen(shader: "show.wgsl", read: {"light": "light"}, write: {"color": "color"})},
    outputs: {"color": "color"},
)"#;
const FILL: &str = "
var texels: texture_storage_2d<rgba16float, write>;
@compute @workgroup_size(8, 8) fn fill(@builtin(global_invocation_id) id: vec3<u32>) { textureStore(texels, id.xy, vec4<f32>(0.25)); }
";
const ADD: &str = "
var light: texture_2d<f32>;
struct Targets { color: vec4<f32> }
@fragment fn add(@builtin(position) place: vec4<f32>) -> Targets { return Targets(textureLoad(light, vec2<i32>(place.xy), 0)); }
";
const SHOW: &str = "
var light: texture_2d<f32>;
struct Params { gain: f32 }
var<uniform> params: Params;
struct Targets { color: vec4<f32> }
@fragment fn show(@builtin(position) place: vec4<f32>) -> Targets { return Targets(params.gain * textureLoad(light, vec2<i32>(place.xy), 0)); }
";

struct Files(tempfile::TempDir);

impl Files {
    fn new() -> Files {
        let files = Files(tempfile::tempdir().unwrap());
        for (name, text) in [("it.ron", PIPELINE), ("last.ron", BLOCK), ("fill.wgsl", FILL), ("add.wgsl", ADD), ("show.wgsl", SHOW)] {
            files.write(name, text);
        }
        files
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }
}

fn request(pipeline: &Path) -> RenderRequest<'_> {
    let pipeline = pipeline.to_str().unwrap();
    RenderRequest { pipeline, size: [16, 16], camera: None, sets: &[], outputs: None, timing: false, memory_budget: None }
}

fn edited(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "`{from}` stands once");
    text.replace(from, to)
}

#[test]
fn an_edit_runs_what_it_reaches_and_builds_what_changed() {
    let (files, adapter) = (Files::new(), Adapter::noop(&DeviceFacts::webgpu_defaults()).unwrap());
    let path = files.path("it.ron");
    let mut world = load_scene("scenes/cornell.ron", None).unwrap().world;
    let mut session = Session::on(&adapter, &mut world, &request(&path)).unwrap();
    let first = session.render_frame().unwrap();
    assert_eq!(session.ran(), ["light", "sum", "last.copy"]);
    assert!(session.render_frame().unwrap().settled);

    // What is edited, what runs then, and how many pipelines are built.
    let edits: [(&str, String, &[&str], u64); 5] = [
        ("show.wgsl", edited(SHOW, "params.gain *", "2.0 * params.gain *"), &["last.copy"], 1),
        ("last.ron", edited(BLOCK, "\"rgba16float\"", "\"rgba8unorm\""), &["last.copy"], 1),
        ("it.ron", edited(PIPELINE, "(default: 0.5)", "(default: 0.75)"), &["last.copy"], 0),
        ("add.wgsl", edited(ADD, "place.xy)", "place.yx)"), &["sum", "last.copy"], 1),
        ("fill.wgsl", edited(FILL, "0.25", "0.5"), &["light", "sum", "last.copy"], 1),
    ];
    let mut built = first.pipelines_created;
    for (name, text, ran, pipelines) in edits {
        files.write(name, &text);
        session.reload(&mut world, &request(&path)).unwrap();
        let stats = session.render_frame().unwrap();
        assert_eq!(session.ran(), ran, "{name}");
        assert_eq!(stats.pipelines_created - built, pipelines, "{name}");
        built = stats.pipelines_created;
    }
}

#[test]
fn a_failed_reload_keeps_the_last_good_plan() {
    let (files, adapter) = (Files::new(), Adapter::noop(&DeviceFacts::webgpu_defaults()).unwrap());
    let path = files.path("it.ron");
    let mut world = load_scene("scenes/cornell.ron", None).unwrap().world;
    let mut session = Session::on(&adapter, &mut world, &request(&path)).unwrap();
    session.render_frame().unwrap();
    for (name, good, wrong, code) in [
        ("it.ron", PIPELINE, edited(PIPELINE, "\"2 * gain\"", "\"2 * gian\""), "validate::unknown-name"),
        ("last.ron", BLOCK, edited(BLOCK, "passes:", "pases:"), "syntax::unknown-field"),
        ("show.wgsl", SHOW, edited(SHOW, "var light", "vra light"), "reflect::wgsl-syntax"),
    ] {
        files.write(name, &wrong);
        let (problems, sources) = session.reload(&mut world, &request(&path)).unwrap_err();
        let shown = luminaire::graph::diagnostic::render(&problems, &sources, false);
        assert!(shown.contains(name) && shown.contains(code), "{code}: {shown}");
        assert!(session.render_frame().unwrap().settled, "{name}: the old plan holds what it held");
        files.write(name, good);
        session.reload(&mut world, &request(&path)).unwrap();
        assert!(session.render_frame().unwrap().settled, "{name}: as it was");
    }
}

#[test]
fn an_image_is_filled_once_and_again_when_its_file_changes() {
    let (files, adapter) = (Files::new(), Adapter::noop(&DeviceFacts::webgpu_defaults()).unwrap());
    let path = files.path("it.ron");
    let resources = r#"resources: {"ramp": Image(file: "ramp.exr", format: "rgba16float"),"#;
    let text = edited(PIPELINE, "resources: {\n        \"light\"", &format!("{resources}\n        \"light\""));
    files.write("it.ron", &edited(&text, "read: {\"light\": \"light\"}", "read: {\"light\": \"ramp\"}"));
    let save = |value: f32| image::Rgb32FImage::from_pixel(8, 8, image::Rgb([value; 3])).save(files.path("ramp.exr")).unwrap();
    save(1.0);
    let mut world = load_scene("scenes/cornell.ron", None).unwrap().world;
    let mut session = Session::on(&adapter, &mut world, &request(&path)).unwrap();
    session.render_frame().unwrap();
    assert_eq!(session.ran(), ["image(ramp)", "sum", "last.copy"]);
    // The same texels are no change; others are.
    for (value, ran) in [(1.0, vec![]), (2.0, vec!["image(ramp)", "sum", "last.copy"])] {
        save(value);
        session.reload(&mut world, &request(&path)).unwrap();
        session.render_frame().unwrap();
        assert_eq!(session.ran(), ran, "{value}");
        assert!(session.render_frame().unwrap().settled);
    }
    // One that can't be read leaves the last good plan.
    for (bytes, code) in [(&b"no image"[..], "load::bad-image"), (&b"\x76\x2f\x31\x01"[..], "load::bad-image")] {
        std::fs::write(files.path("ramp.exr"), bytes).unwrap();
        let (problems, _) = session.reload(&mut world, &request(&path)).unwrap_err();
        assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), [code]);
        assert!(session.render_frame().unwrap().settled);
    }
    std::fs::remove_file(files.path("ramp.exr")).unwrap();
    let (problems, _) = session.reload(&mut world, &request(&path)).unwrap_err();
    assert_eq!(problems[0].code, "load::missing-image");
}

#[test]
fn a_plan_that_needs_another_feature_gets_another_device() {
    let facts = DeviceFacts { features: [Feature::Float32Blendable].into_iter().collect(), ..DeviceFacts::webgpu_defaults() };
    let (files, adapter) = (Files::new(), Adapter::noop(&facts).unwrap());
    let path = files.path("it.ron");
    let mut world = load_scene("scenes/cornell.ron", None).unwrap().world;
    let mut session = Session::on(&adapter, &mut world, &request(&path)).unwrap();
    session.render_frame().unwrap();
    files.write("it.ron", &edited(PIPELINE, "\"sum\": Texture(format: \"rgba16float\"", "\"sum\": Texture(format: \"rgba32float\""));
    session.reload(&mut world, &request(&path)).unwrap();
    session.render_frame().unwrap();
    assert_eq!(session.ran(), ["light", "sum", "last.copy"], "nothing is left of the other device");
    assert!(session.render_frame().unwrap().settled);
}
