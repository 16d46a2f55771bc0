//! Copy passes.

use luminaire_graph::expand::types::ClearValue;
use luminaire_graph::plan::{BindingTarget, Stages, StepKind};
use luminaire_passes::Gpu;

use crate::support::{Builder, COPIED, assert_near, part, read, shape};

pub(crate) fn levels_and_layers(gpu: &Gpu) {
    let mut builder = Builder::new();
    let mut layered = shape("rgba8unorm");
    (layered.layers, layered.mips) = (3, 2);
    let source = builder.texture("source", layered, COPIED);
    let mut small = shape("rgba8unorm");
    (small.width, small.height) = (4, 4);
    let target = builder.texture("target", small, COPIED);
    builder.clear(part(source, 1, 2), ClearValue::Color([0.2, 0.4, 0.6, 0.8]));
    builder.step("copy", None, StepKind::Copy { source: part(source, 1, 2), target: part(target, 0, 0) }, Stages::default(), vec![]);
    let executor = builder.render(gpu);
    assert_near(read(&executor, "target").pixel(3, 3), [0.2, 0.4, 0.6, 0.8]);
}

pub(crate) fn bytes(gpu: &Gpu) {
    let mut builder = Builder::new();
    let source = builder.buffer("source", 16, 256);
    let target = builder.buffer("target", 16, 512);
    let shader = builder.shader(
        "numbers.wgsl",
        "var<storage, read_write> numbers: array<u32>;
        @compute @workgroup_size(4) fn main(@builtin(global_invocation_id) at: vec3<u32>) { numbers[at.x] = at.x + 5u; }",
    );
    let bound = BindingTarget::Buffer { resource: source, uniform: false, writable: true };
    builder.compute("count", shader, [1, 1, 1], vec![("numbers", bound)]);
    builder.step("copy", None, StepKind::Copy { source: part(source, 0, 0), target: part(target, 0, 0) }, Stages::default(), vec![]);
    builder.clear(part(source, 0, 0), ClearValue::Zero);
    let executor = builder.render(gpu);
    assert_eq!(executor.read_buffer("target").expect("bytes")[12..], 8u32.to_le_bytes());
    assert_eq!(executor.read_buffer("source").expect("bytes"), [0; 16]);
}
