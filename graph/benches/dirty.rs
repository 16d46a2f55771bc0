//! Time to decide what runs, in a plan of 10,000 passes of which one changed input reaches 0 to 10,000.
//!
//! Run with `cargo bench -p luminaire-graph --bench dirty`. The figure to look at is time per reached pass (criterion's throughput):
//! it should not depend on how many passes the plan has.

#![allow(clippy::panic)]

use std::sync::Arc;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use luminaire_graph::compile::{CompileInput, compile};
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::dirty::Tracker;
use luminaire_graph::published::{PublishedSchema, SceneCounts, TableKind, TableMember, TableSchema};
use luminaire_graph::source::{FileKind, MemoryFiles};

const COPY: &str = "\
struct Output { color: vec4f }
var before: texture_2d<f32>;
@fragment
fn copy(@builtin(position) at: vec4f) -> Output {
    return Output(textureLoad(before, vec2i(at.xy), 0));
}
";

const TINT: &str = "\
struct Output { color: vec4f }
struct Tint { color: vec4f }
var before: texture_2d<f32>;
var<uniform> tint: Tint;
var<uniform> shade: Tint;
@fragment
fn copy(@builtin(position) at: vec4f) -> Output {
    return Output(tint.color * shade.color * textureLoad(before, vec2i(at.xy), 0));
}
";

const PASSES: usize = 10_000;

/// A chain whose last `reached` passes depend on the tables `tint` and `shade`.
fn pipeline(reached: usize) -> String {
    let mut text = String::from("(\n    doc: \"Generated.\",\n    resources: {\n");
    for index in 0..=PASSES {
        text += &format!("        \"r{index}\": Texture(format: \"rgba8unorm\"),\n");
    }
    text.push_str("    },\n    passes: {\n        \"start\": Clear(write: \"r0\"),\n");
    for index in 1..=PASSES {
        let shader = if index + reached == PASSES + 1 { "tint.wgsl" } else { "copy.wgsl" };
        let before = index - 1;
        text += &format!(
            "        \"p{index}\": Fullscreen(shader: \"{shader}\", read: {{\"before\": \"r{before}\"}}, write: {{\"color\": \"r{index}\"}}),\n"
        );
    }
    text += &format!("    }},\n    outputs: {{ \"color\": \"r{PASSES}\" }},\n)\n");
    text
}

fn dirty_check(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("dirty_check_of_10000_passes");
    group.sample_size(20);
    let tint = TableSchema {
        kind: TableKind::Uniform,
        doc: String::new(),
        members: vec![TableMember { name: "color".to_owned(), wgsl: "vec4<f32>".to_owned(), offset: 0 }],
        stride: 16,
        per_draw: false,
    };
    let published = PublishedSchema {
        tables: [("tint".to_owned(), tint.clone()), ("shade".to_owned(), tint)].into_iter().collect(),
        ..PublishedSchema::default()
    };
    for reached in [0, 1, 10, 100, 1_000, PASSES] {
        let files = MemoryFiles::default()
            .with(FileKind::Pipeline, "p.ron", &pipeline(reached))
            .with(FileKind::Shader, "copy.wgsl", COPY)
            .with(FileKind::Shader, "tint.wgsl", TINT);
        let input = CompileInput {
            pipeline: "p.ron",
            files: &files,
            published: &published,
            counts: &SceneCounts::new(),
            device: &DeviceFacts { memory_budget: u64::MAX, ..DeviceFacts::webgpu_defaults() },
            output: [64, 64],
            sets: &[],
            outputs: None,
        };
        let Some(plan) = compile(&input).plan else { panic!("the generated pipeline is sound") };
        let mut tracker = Tracker::new(Arc::new(plan));
        let mut revisions = vec![0; tracker.inputs().len()];
        let first = tracker.frame(&revisions);
        tracker.commit(&first, &revisions);
        assert!(tracker.frame(&revisions).is_empty());
        let mut both = false;
        let mut run = || {
            // One table, both, and again, so that every frame is decided anew.
            both = !both;
            for revision in revisions.iter_mut().take(if both { 2 } else { 1 }) {
                *revision += 1;
            }
            let frame = tracker.frame(&revisions);
            tracker.commit(&frame, &revisions);
            frame.runs.len()
        };
        assert_eq!(run(), reached);
        group.throughput(Throughput::Elements(reached.max(1) as u64));
        group.bench_function(BenchmarkId::from_parameter(reached), |bencher| bencher.iter(&mut run));
    }
    group.finish();
}

criterion_group!(benches, dirty_check);
criterion_main!(benches);
