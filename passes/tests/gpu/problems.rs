//! What goes wrong comes back as diagnostics that name the pass or the resource; and what a noop device can show.

use std::sync::Arc;

use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::expand::types::Dimension;
use luminaire_graph::plan::Cull;
use luminaire_graph::plan::{BindingTarget, Stages};
use luminaire_graph::source::{SourceMap, Span};
use luminaire_passes::facts::lavapipe;
use luminaire_passes::{Executor, Gpu, GpuOptions};

use crate::draw::{batch, draw, draw_list, geometry};
use crate::fullscreen::gradient;
use crate::support::{ATTACHED, Builder, COPIED, part, shape, target};

fn noop(facts: DeviceFacts) -> Gpu {
    Gpu::open(&GpuOptions { noop: Some(facts), ..GpuOptions::default() }).expect("a noop device")
}

fn problems(gpu: &Gpu, builder: Builder) -> Vec<Diagnostic> {
    match Executor::new(gpu, Arc::new(builder.plan), &builder.schema, Arc::new(builder.scene)) {
        Ok(_) => panic!("the plan was accepted"),
        Err(problems) => problems,
    }
}

/// A pass whose uniform is bound to a storage table's buffer, and one whose target has the wrong format.
fn broken() -> Builder {
    let mut builder = gradient();
    let color = builder.texture("other", shape("rgba8unorm"), ATTACHED);
    let file = SourceMap::default().add("test.ron", "broken");
    let shader = builder.shader(
        "broken.wgsl",
        "var<uniform> tint: vec4<f32>; struct Out { @location(0) color: vec4<f32> }
        @fragment fn shade() -> Out { return Out(tint); }",
    );
    builder.fullscreen(
        "wrong table",
        shader,
        vec![target(part(color, 0, 0), "rgba8unorm")],
        vec![("tint", BindingTarget::StorageTable("tints".to_owned()))],
    );
    builder.scene.tables.insert("tints".to_owned(), vec![0; 16].into());
    builder.plan.steps[1].span = Span::new(file, 0, 6);
    builder.fullscreen(
        "wrong format",
        shader,
        vec![target(part(color, 0, 0), "rgba16float")],
        vec![("tint", BindingTarget::Params { bytes: vec![0; 16], accumulated: None })],
    );
    builder
}

pub(crate) fn validation_names_the_pass(gpu: &Gpu) {
    let problems = problems(gpu, broken());
    assert_eq!(problems.len(), 2, "{problems:#?}");
    for (problem, pass) in problems.iter().zip(["`wrong table`", "`wrong format`"]) {
        assert_eq!(problem.code, "execute::validation");
        assert!(problem.message.contains(pass) && problem.message.contains("broken.wgsl"), "{}", problem.message);
    }
    assert!(problems[0].primary.is_some());
    // The device still works.
    gradient().render(gpu);
}

pub(crate) fn an_output_of_another_name(gpu: &Gpu) {
    let executor = gradient().render(gpu);
    let problems = executor.read_output("colour").unwrap_err();
    assert_eq!(problems[0].code, "execute::unknown-output");
    assert!(problems[0].hint.as_ref().is_some_and(|hint| hint.contains("`color`")));
}

pub(crate) fn noop_runs() {
    let gpu = noop(DeviceFacts::webgpu_defaults());
    let mut executor = gradient().prepare(&gpu);
    let stats = executor.render_frame().expect("a frame");
    assert_eq!((stats.counts.draw_calls, stats.times), (1, None));
    assert_eq!(executor.read_output("color").expect("an image").bytes.len(), 256);
    crate::fullscreen::samplers().render(&gpu);
    let gpu = noop(lavapipe());
    assert_eq!((gpu.facts().max_texture_2d, gpu.facts().name.as_str()), (16384, "lavapipe's limits"));
    assert!(gpu.facts().features.is_empty(), "only what was required");
    gradient().render(&gpu);
}

pub(crate) fn noop_limits() {
    let gpu = noop(DeviceFacts::webgpu_defaults());
    let mut builder = gradient();
    let mut wide = shape("rgba8unorm");
    wide.width = 8193;
    builder.texture("wide", wide, COPIED);
    let mut deep = shape("r8unorm");
    (deep.dimension, deep.depth) = (Dimension::D3, 4096);
    builder.texture("deep", deep, COPIED);
    builder.buffer("long", (256 << 20) + 4, 0);
    let found = problems(&gpu, builder);
    assert_eq!(found.len(), 3, "{found:#?}");
    for (problem, name) in found.iter().zip(["`wide`", "`deep`", "`long`"]) {
        assert_eq!(problem.code, "execute::too-large");
        assert!(problem.message.contains(name), "{}", problem.message);
    }
}

pub(crate) fn noop_budget() {
    let facts = DeviceFacts { memory_budget: 1000, ..DeviceFacts::webgpu_defaults() };
    let found = problems(&noop(facts), gradient());
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].code, "execute::over-budget");
    assert!(found[0].notes[0].contains("`color`"));
}

pub(crate) fn noop_scene() {
    let gpu = noop(DeviceFacts::webgpu_defaults());
    let mut builder = Builder::new();
    geometry(&mut builder);
    draw_list(&mut builder, vec![batch(4)]);
    let color = builder.texture("color", shape("rgba8unorm"), ATTACHED);
    let shader = builder.shader(
        "needs.wgsl",
        "var<uniform> camera: vec4<f32>; struct Out { @location(0) color: vec4<f32> }
        @vertex fn place(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> { return camera; }
        @fragment fn shade() -> Out { return Out(camera); }",
    );
    let stages = Stages { vertex: true, fragment: true, compute: false };
    let camera = BindingTarget::UniformTable("camera".to_owned());
    builder.step("needs", Some(shader), draw(color, None, Cull::Back), stages, vec![("camera", camera)]);
    builder.scene.tables.insert("camra".to_owned(), vec![0; 16].into());
    let found = problems(&gpu, builder);
    let codes: Vec<&str> = found.iter().map(|problem| problem.code).collect();
    assert_eq!(codes, ["execute::missing-table", "execute::draw-list"]);
    assert!(found[0].hint.as_ref().is_some_and(|hint| hint.contains("`camra`")));
}

pub(crate) fn noop_validation() {
    validation_names_the_pass(&noop(DeviceFacts::webgpu_defaults()));
}

/// The device that all tests share must stay, so this one opens another.
pub(crate) fn lost(_: &Gpu) {
    lose(&Gpu::open(&GpuOptions::default()).expect("another device"));
}

pub(crate) fn noop_lost() {
    lose(&noop(DeviceFacts::webgpu_defaults()));
}

fn lose(gpu: &Gpu) {
    let mut executor = gradient().prepare(gpu);
    gpu.device().destroy();
    let problems = executor.render_frame().unwrap_err();
    assert_eq!(problems[0].code, "execute::device-lost", "{problems:#?}");
    assert!(executor.read_output("color").is_err());
    assert!(Executor::new(gpu, Arc::new(gradient().plan), &Default::default(), Arc::default()).is_err());
}
