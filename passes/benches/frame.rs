//! Time on the CPU of a frame in which everything runs, against the same calls of wgpu written by hand.
//!
//! Run with `cargo bench -p luminaire-passes`. Nothing is computed: the device is wgpu's noop one, so that what remains is wgpu's own
//! bookkeeping, and ours on top. By hand, the textures, views, bind groups and pipelines stand, and a frame is one encoder with the same
//! passes, submitted once. The ratio of both is printed at the end: the median over pairs that are measured one after the other;
//! `-- --ratio` prints nothing else. A chain comes in two kinds: what runs is decided once and kept, or decided anew in every frame,
//! since the last pass goes on gathering.

#![allow(clippy::expect_used, clippy::print_stdout, reason = "a bench stops where it can't go on, and says what it measured")]

use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput};
use luminaire_graph::compile::{CompileInput, compile};
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::plan::Plan;
use luminaire_graph::published::{PublishedScene, PublishedSchema, SceneCounts};
use luminaire_graph::source::{FileKind, MemoryFiles};
use luminaire_passes::{Executor, Gpu, GpuOptions};

const EDGE: u32 = 64;
const PAIRS: usize = 301;

const FULLSCREEN: &str = "
struct Targets { color: vec4<f32> }
var source: texture_2d<f32>;
@fragment fn shade(@builtin(position) at: vec4<f32>) -> Targets {
    return Targets(textureLoad(source, vec2<u32>(at.xy), 0));
}";

const COMPUTE: &str = "
var source: texture_2d<f32>;
var target_texture: texture_storage_2d<rgba16float, write>;
@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) at: vec3<u32>) {
    textureStore(target_texture, at.xy, textureLoad(source, at.xy, 0));
}";

/// Both shaders as wgpu takes them.
const BY_HAND: &str = "
@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var target_texture: texture_storage_2d<rgba16float, write>;
@vertex fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let uv = vec2<f32>(f32((index & 1u) * 2u), f32((index >> 1u) * 2u));
    return vec4<f32>(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0, 1.0);
}
@fragment fn shade(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(source, vec2<u32>(at.xy), 0);
}
@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) at: vec3<u32>) {
    textureStore(target_texture, at.xy, textureLoad(source, at.xy, 0));
}";

/// How a frame comes by what runs.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Decided {
    Once,
    Anew,
}

fn gpu() -> Gpu {
    let options = GpuOptions { noop: Some(DeviceFacts::webgpu_defaults()), ..GpuOptions::default() };
    Gpu::open(&options).expect("the noop device needs no driver")
}

/// A chain: each pass reads what the one before wrote; every other one is a Compute.
fn plan(passes: usize, decided: Decided) -> Plan {
    let mut text = String::from("(doc: \"A chain.\", resources: {");
    for index in 0..=passes {
        text += &format!("\"r{index}\": Texture(format: \"rgba16float\", size: Square({EDGE}), clear: Zero),");
    }
    text.push_str("}, passes: {");
    for index in 0..passes {
        let (source, target) = (format!("r{index}"), format!("r{}", index + 1));
        // It never has enough, and what it reads does not change.
        let counts = decided == Decided::Anew && index + 1 == passes;
        let (run, source) = if counts { ("Accumulate(1000000000)", "r0".to_owned()) } else { ("EveryFrame", source) };
        text += &if index % 2 == 0 {
            format!(
                "\"p{index}\": Compute(shader: \"c.wgsl\", run: {run}, cover: \"{target}\", read: {{\"source\": \"{source}\"}},
                write: {{\"target_texture\": \"{target}\"}}),"
            )
        } else {
            format!(
                "\"p{index}\": Fullscreen(shader: \"f.wgsl\", run: {run}, read: {{\"source\": \"{source}\"}},
                write: {{\"color\": \"{target}\"}}),"
            )
        };
    }
    text += &format!("}}, outputs: {{\"color\": \"r{passes}\", \"before\": \"r{}\"}})", passes - 1);
    let files = MemoryFiles::default().with(FileKind::Pipeline, "chain.ron", &text).with(FileKind::Shader, "c.wgsl", COMPUTE).with(
        FileKind::Shader,
        "f.wgsl",
        FULLSCREEN,
    );
    let compilation = compile(&CompileInput {
        pipeline: "chain.ron",
        files: &files,
        published: &PublishedSchema::default(),
        counts: &SceneCounts::new(),
        device: &DeviceFacts::webgpu_defaults(),
        output: [EDGE, EDGE],
        sets: &[],
        outputs: None,
    });
    let plan = compilation.plan.expect("a plan");
    assert_eq!(plan.steps.len(), passes);
    plan
}

fn executor(passes: usize, decided: Decided) -> Executor {
    let plan = Arc::new(plan(passes, decided));
    let mut executor = Executor::new(&gpu(), plan, &PublishedSchema::default(), Arc::new(PublishedScene::default())).expect("an executor");
    for _ in 0..3 {
        let stats = executor.render_frame().expect("a frame");
        assert_eq!((stats.counts.steps, stats.counts.submissions), (passes as u64, 1));
    }
    executor
}

/// What the executor does for the chain, without it.
struct ByHand {
    gpu: Gpu,
    decided: Decided,
    names: Vec<String>,
    views: Vec<wgpu::TextureView>,
    compute: (wgpu::ComputePipeline, Vec<wgpu::BindGroup>),
    fullscreen: (wgpu::RenderPipeline, Vec<wgpu::BindGroup>),
}

impl ByHand {
    fn new(passes: usize, decided: Decided) -> ByHand {
        let gpu = gpu();
        let device = gpu.device();
        let module =
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source: wgpu::ShaderSource::Wgsl(BY_HAND.into()) });
        // As many textures as the plan has memories.
        let views: Vec<wgpu::TextureView> = (0..plan(passes, decided).memories.len())
            .map(|_| {
                let texture = device.create_texture(&wgpu::TextureDescriptor {
                    label: None,
                    size: wgpu::Extent3d { width: EDGE, height: EDGE, depth_or_array_layers: 1 },
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format: wgpu::TextureFormat::Rgba16Float,
                    usage: wgpu::TextureUsages::TEXTURE_BINDING
                        | wgpu::TextureUsages::STORAGE_BINDING
                        | wgpu::TextureUsages::RENDER_ATTACHMENT,
                    view_formats: &[],
                });
                texture.create_view(&wgpu::TextureViewDescriptor::default())
            })
            .collect();
        let compute = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let fullscreen = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("shade"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::TextureFormat::Rgba16Float.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let group = |layout: &wgpu::BindGroupLayout, index: usize, writes: bool| {
            let view = |index: usize| wgpu::BindingResource::TextureView(&views[index % views.len()]);
            let mut entries = vec![wgpu::BindGroupEntry { binding: 0, resource: view(index) }];
            if writes {
                entries.push(wgpu::BindGroupEntry { binding: 1, resource: view(index + 1) });
            }
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
        };
        let layouts = (compute.get_bind_group_layout(0), fullscreen.get_bind_group_layout(0));
        let compute_groups = (0..passes).step_by(2).map(|index| group(&layouts.0, index, true)).collect();
        let fullscreen_groups = (1..passes).step_by(2).map(|index| group(&layouts.1, index, false)).collect();
        let mut by_hand = ByHand {
            decided,
            names: (0..passes).map(|index| format!("p{index}")).collect(),
            views,
            compute: (compute, compute_groups),
            fullscreen: (fullscreen, fullscreen_groups),
            gpu,
        };
        for _ in 0..3 {
            by_hand.frame();
        }
        by_hand
    }

    fn frame(&mut self) {
        let mut encoder = self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
        if self.decided == Decided::Once {
            // What the first pass reads is the declared value, and others have had its bytes since.
            drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("clear"),
                color_attachments: &[Some(cleared(&self.views[0]))],
                ..wgpu::RenderPassDescriptor::default()
            }));
        }
        for (index, name) in self.names.iter().enumerate() {
            if index % 2 == 0 {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(name), timestamp_writes: None });
                pass.set_pipeline(&self.compute.0);
                pass.set_bind_group(0, &self.compute.1[index / 2], &[]);
                pass.dispatch_workgroups(EDGE / 8, EDGE / 8, 1);
                continue;
            }
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(name),
                color_attachments: &[Some(cleared(&self.views[(index + 1) % self.views.len()]))],
                ..wgpu::RenderPassDescriptor::default()
            });
            pass.set_pipeline(&self.fullscreen.0);
            pass.set_bind_group(0, &self.fullscreen.1[index / 2], &[]);
            pass.draw(0..3, 0..1);
        }
        self.gpu.queue().submit([encoder.finish()]);
    }
}

fn cleared(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
    }
}

/// The medians of both, and of their ratio, over pairs of frames (of several, where frames are short).
fn ratio(passes: usize, decided: Decided) -> (Duration, Duration, f64) {
    let (mut executor, mut by_hand) = (executor(passes, decided), ByHand::new(passes, decided));
    let frames = (1_000 / passes).max(1) as u32;
    let mut pairs: Vec<(f64, Duration, Duration)> = Vec::with_capacity(PAIRS);
    for _ in 0..PAIRS {
        let start = Instant::now();
        for _ in 0..frames {
            by_hand.frame();
        }
        let middle = Instant::now();
        for _ in 0..frames {
            let _ = black_box(executor.render_frame());
        }
        let (hand, ours) = (middle - start, middle.elapsed());
        pairs.push((ours.as_secs_f64() / hand.as_secs_f64(), ours / frames, hand / frames));
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ratio = pairs[PAIRS / 2].0;
    let median = |mut times: Vec<Duration>| {
        times.sort_unstable();
        times[PAIRS / 2]
    };
    (median(pairs.iter().map(|pair| pair.1).collect()), median(pairs.iter().map(|pair| pair.2).collect()), ratio)
}

fn frame(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frame");
    group.sample_size(20).measurement_time(Duration::from_secs(2)).warm_up_time(Duration::from_millis(500));
    for passes in [10, 100, 1_000] {
        group.throughput(Throughput::Elements(passes as u64));
        for (name, decided) in [("executor", Decided::Once), ("executor, decided anew", Decided::Anew)] {
            let mut executor = executor(passes, decided);
            group.bench_function(BenchmarkId::new(name, passes), |bencher| bencher.iter(|| executor.render_frame()));
        }
        let mut by_hand = ByHand::new(passes, Decided::Once);
        group.bench_function(BenchmarkId::new("by hand", passes), |bencher| bencher.iter(|| by_hand.frame()));
    }
    group.finish();
}

fn main() {
    if !std::env::args().any(|argument| argument == "--ratio") {
        let mut criterion = Criterion::default().configure_from_args();
        frame(&mut criterion);
        criterion.final_summary();
    }
    for decided in [Decided::Once, Decided::Anew] {
        for passes in [10, 100, 1_000] {
            let (executor, by_hand, ratio) = ratio(passes, decided);
            println!("{passes} passes, decided {decided:?}: {executor:?} by the executor, {by_hand:?} by hand, ratio {ratio:.3}");
        }
    }
}
