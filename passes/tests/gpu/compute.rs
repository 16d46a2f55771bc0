//! Compute passes: storage textures, params, overrides, buffers in arenas, counts.

use luminaire_graph::expand::types::Dimension;
use luminaire_graph::plan::{BindingTarget, PartView, Usage};
use luminaire_graph::reflect::interface::{StorageAccess, ViewDimension};
use luminaire_passes::Gpu;

use crate::support::{Builder, assert_near, format, read, shape};

const VOLUME: &str = "
override blue: f32;
struct Params { red: f32, green: f32 }
var<uniform> params: Params;
var voxels: texture_storage_3d<rgba16float, write>;
@compute @workgroup_size(4, 4, 4) fn main(@builtin(global_invocation_id) at: vec3<u32>) {
    textureStore(voxels, at, vec4<f32>(params.red, params.green, blue, f32(at.z)));
}";

fn volume() -> Builder {
    let mut builder = Builder::new();
    let mut cube = shape("rgba16float");
    (cube.dimension, cube.depth) = (Dimension::D3, 8);
    let voxels = builder.texture("voxels", cube, Usage { storage: true, ..Usage::default() });
    let shader = builder.shader("volume.wgsl", VOLUME);
    let view = PartView { resource: voxels, mips: 0..1, layers: 0..1, dimension: ViewDimension::D3 };
    let params = [0.25f32, 0.5].iter().flat_map(|value| value.to_le_bytes()).collect();
    builder.compute(
        "fill",
        shader,
        [2, 2, 2],
        vec![
            ("params", BindingTarget::Params { bytes: params, accumulated: None }),
            ("voxels", BindingTarget::StorageTexture { view, format: format("rgba16float"), access: StorageAccess::Write }),
        ],
    );
    builder.plan.steps[0].constants.push(("blue".to_owned(), 0.75));
    builder
}

pub(crate) fn fills_a_volume(gpu: &Gpu) {
    let executor = volume().render(gpu);
    let image = read(&executor, "voxels");
    assert_eq!((image.width, image.height, image.layers), (8, 8, 8));
    assert_near(image.pixel(7, 7), [0.25, 0.5, 0.75, 0.0]);
    assert_eq!(image.pixels.last(), Some(&7.0));
}

pub(crate) fn buffers_live_in_arenas(gpu: &Gpu) {
    let mut builder = Builder::new();
    let numbers = builder.buffer("numbers", 64, 256);
    let shader = builder.shader(
        "numbers.wgsl",
        "var<storage, read_write> numbers: array<u32>;
        @compute @workgroup_size(16) fn main(@builtin(global_invocation_id) at: vec3<u32>) {
            numbers[at.x] = at.x + 100u * arrayLength(&numbers);
        }",
    );
    let target = BindingTarget::Buffer { resource: numbers, uniform: false, writable: true };
    builder.compute("count", shader, [1, 1, 1], vec![("numbers", target)]);
    let executor = builder.render(gpu);
    let bytes = executor.read_buffer("numbers").expect("bytes");
    assert_eq!(bytes.len(), 64);
    assert_eq!(bytes[60..], 1615u32.to_le_bytes());
    assert_eq!(executor.read_output("numbers").unwrap_err()[0].code, "execute::unreadable-output");
}

pub(crate) fn frames_are_equal_and_counted(gpu: &Gpu) {
    let mut executor = volume().prepare(gpu);
    let first = executor.render_frame().expect("a frame");
    let before = read(&executor, "voxels");
    let second = executor.render_frame().expect("a frame");
    assert_eq!(before, read(&executor, "voxels"));
    assert_eq!((first.counts.dispatches, first.counts.steps, first.counts.draw_calls), (1, 1, 0));
    assert_eq!((first.pipelines_created, first.bind_groups_created), (1, 1));
    // Nothing changed: nothing ran, nothing was submitted, nothing was created.
    assert_eq!((second.counts.steps, second.counts.submissions, second.created), (0, 0, first.created));
    assert!(second.settled);
    if let Some(times) = first.times {
        assert_eq!(times.len(), 1);
        assert_eq!(&*times[0].name, "fill");
        assert!(times[0].milliseconds >= 0.0);
    }
}
