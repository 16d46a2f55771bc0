//! Time from RON text to a plan, for generated pipelines of 10 to 10,000 passes.
//!
//! Run with `cargo bench -p luminaire-graph`. The figure to look at is time per pass (criterion's throughput): it should hardly
//! grow from 100 to 10,000 passes.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use luminaire_graph::compile::{CompileInput, compile};
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::published::{PublishedSchema, SceneCounts};
use luminaire_graph::source::{FileKind, MemoryFiles};

const SHADER: &str = "\
struct Output { color: vec4f }
var near: texture_2d<f32>;
var far: texture_2d<f32>;
var linear_clamp: sampler;
@fragment
fn mix_two(@location(0) uv: vec2f) -> Output {
    return Output(0.5 * (textureSample(near, linear_clamp, uv) + textureSample(far, linear_clamp, uv)));
}
";

/// A graph like a frame's: each pass reads its predecessor and one from some way back; sizes and formats vary.
fn pipeline(passes: usize) -> String {
    let mut text = String::from("(\n    doc: \"Generated.\",\n    resources: {\n");
    for index in 0..passes {
        let format = ["rgba16float", "rgba8unorm", "rg16float"][index % 3];
        let size = ["Output", "Scaled(0.5)", "Square(256)"][index % 3];
        text += &format!("        \"r{index}\": Texture(format: \"{format}\", size: {size}),\n");
    }
    text.push_str("    },\n    passes: {\n        \"p0\": Clear(write: \"r0\"),\n");
    for index in 1..passes {
        let (near, far) = (index - 1, index - index.min(1 + index * 7 % 13));
        text += &format!(
            "        \"p{index}\": Fullscreen(shader: \"mix.wgsl\", read: {{\"near\": \"r{near}\", \"far\": \"r{far}\"}}, write: {{\"color\": \"r{index}\"}}),\n"
        );
    }
    text += &format!("    }},\n    outputs: {{ \"color\": \"r{}\" }},\n)\n", passes - 1);
    text
}

fn parse_to_plan(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("parse_to_plan");
    group.sample_size(20);
    for passes in [10, 100, 1_000, 10_000] {
        let files = MemoryFiles::default().with(FileKind::Pipeline, "p.ron", &pipeline(passes)).with(FileKind::Shader, "mix.wgsl", SHADER);
        let (published, counts, device) = (PublishedSchema::default(), SceneCounts::new(), DeviceFacts::webgpu_defaults());
        let input = CompileInput {
            pipeline: "p.ron",
            files: &files,
            published: &published,
            counts: &counts,
            // The generated frame is larger than any real one: the budget must not be what stops it.
            device: &DeviceFacts { memory_budget: u64::MAX, ..device },
            output: [640, 360],
            sets: &[],
            outputs: None,
        };
        assert!(compile(&input).plan.is_some_and(|plan| plan.steps.len() == passes));
        group.throughput(Throughput::Elements(passes as u64));
        group.bench_function(BenchmarkId::from_parameter(passes), |bencher| bencher.iter(|| compile(&input)));
    }
    group.finish();
}

criterion_group!(benches, parse_to_plan);
criterion_main!(benches);
