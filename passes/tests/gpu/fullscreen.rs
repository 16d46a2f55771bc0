//! Fullscreen passes: orientation, outputs, blending, and the views that they read.

use luminaire_graph::expand::types::{ClearValue, Dimension};
use luminaire_graph::plan::{BindingTarget, BuiltinSampler, ColorTarget, Load, PartView, SampleType, StepKind};
use luminaire_graph::reflect::interface::ViewDimension;
use luminaire_graph::syntax::document::BlendDoc;
use luminaire_passes::Gpu;

use crate::support::{ATTACHED, Builder, SAMPLED, assert_near, format, part, read, sampled, shape, target};

const GRADIENT: &str = "
struct Out { @location(0) color: vec4<f32> }
@fragment fn shade(@builtin(position) at: vec4<f32>, @location(0) uv: vec2<f32>) -> Out {
    return Out(vec4<f32>(uv, floor(at.y) / 8.0, 1.0));
}";

pub(crate) fn gradient() -> Builder {
    let mut builder = Builder::new();
    let color = builder.texture("color", shape("rgba8unorm"), ATTACHED);
    let shader = builder.shader("gradient.wgsl", GRADIENT);
    builder.fullscreen("gradient", shader, vec![target(part(color, 0, 0), "rgba8unorm")], vec![]);
    builder
}

pub(crate) fn top_left_is_zero(gpu: &Gpu) {
    let executor = gradient().render(gpu);
    let image = read(&executor, "color");
    assert_eq!((image.width, image.height, image.layers), (8, 8, 1));
    assert_near(image.pixel(0, 0), [0.0625, 0.0625, 0.0, 1.0]);
    assert_near(image.pixel(7, 0), [0.9375, 0.0625, 0.0, 1.0]);
    assert_near(image.pixel(0, 7), [0.0625, 0.9375, 0.875, 1.0]);
    assert_eq!(image.pixel(8, 0), None);
    assert_eq!(image.rgba8().map(|bytes| bytes.len()), Some(256));
}

pub(crate) fn locations_may_go_nowhere(gpu: &Gpu) {
    let mut builder = Builder::new();
    let color = builder.texture("color", shape("rgba16float"), ATTACHED);
    let shader = builder.shader(
        "two.wgsl",
        "struct Out { @location(0) unused: vec4<f32>, @location(1) color: vec4<f32> }
        @fragment fn shade() -> Out { return Out(vec4<f32>(9.0), vec4<f32>(1.0, 2.0, -3.0, 4.0)); }",
    );
    builder.fullscreen("two", shader, vec![None, target(part(color, 0, 0), "rgba16float")], vec![]);
    let executor = builder.render(gpu);
    assert_near(read(&executor, "color").pixel(3, 3), [1.0, 2.0, -3.0, 4.0]);
}

pub(crate) fn blending(gpu: &Gpu) {
    let modes = [
        (BlendDoc::Alpha, [0.5, 0.25, 0.0, 0.75]),
        (BlendDoc::Premultiplied, [1.0, 0.25, 0.0, 0.75]),
        (BlendDoc::Add, [1.0, 0.5, 0.0, 1.0]),
        (BlendDoc::Multiply, [0.0, 0.0, 0.0, 0.25]),
        (BlendDoc::Min, [0.0, 0.0, 0.0, 0.5]),
        (BlendDoc::Max, [1.0, 0.5, 0.0, 0.5]),
    ];
    let mut builder = Builder::new();
    let shader = builder.shader(
        "half.wgsl",
        "struct Out { @location(0) color: vec4<f32> }
        @fragment fn shade() -> Out { return Out(vec4<f32>(1.0, 0.0, 0.0, 0.5)); }",
    );
    for (mode, _) in modes {
        let name = format!("{mode:?}");
        let color = builder.texture(&name, shape("rgba16float"), ATTACHED);
        let load = Load::Clear(ClearValue::Color([0.0, 0.5, 0.0, 0.5]));
        let view = part(color, 0, 0);
        let target = ColorTarget { view, format: format("rgba16float"), load, blend: Some(mode) };
        builder.fullscreen(&name, shader, vec![Some(target)], vec![]);
    }
    let executor = builder.render(gpu);
    for (mode, wanted) in modes {
        assert_near(read(&executor, &format!("{mode:?}")).pixel(0, 0), wanted);
    }
}

pub(crate) fn views_of_mips_and_layers(gpu: &Gpu) {
    let mut builder = Builder::new();
    let mut layered = shape("rgba8unorm");
    (layered.dimension, layered.layers, layered.mips) = (Dimension::Cube, 6, 2);
    let cube = builder.texture("cube", layered, SAMPLED);
    for face in 0..6 {
        builder.clear(part(cube, 0, face), ClearValue::Zero);
        builder.clear(part(cube, 1, face), ClearValue::Color([f64::from(face) / 5.0, 1.0, 0.0, 1.0]));
    }
    let color = builder.texture("color", shape("rgba8unorm"), ATTACHED);
    let shader = builder.shader(
        "views.wgsl",
        "var face: texture_2d<f32>; var faces: texture_2d_array<f32>; var cube: texture_cube<f32>;
        struct Out { @location(0) color: vec4<f32> }
        @fragment fn shade() -> Out {
            let size = vec2<f32>(textureDimensions(face)) / 8.0;
            let ok = select(0.0, 1.0, textureDimensions(cube).x == 4u);
            return Out(vec4<f32>(textureLoad(face, vec2<u32>(), 0).x, textureLoad(faces, vec2<u32>(), 4, 1).x, size.x, ok));
        }",
    );
    let all = |mips: std::ops::Range<u32>, dimension| PartView { resource: cube, mips, layers: 0..6, dimension };
    builder.fullscreen(
        "views",
        shader,
        vec![target(part(color, 0, 0), "rgba8unorm")],
        vec![
            ("face", sampled(part(cube, 1, 3))),
            ("faces", sampled(all(0..2, ViewDimension::D2Array))),
            ("cube", sampled(all(1..2, ViewDimension::Cube))),
        ],
    );
    let executor = builder.render(gpu);
    assert_near(read(&executor, "color").pixel(0, 0), [0.6, 0.8, 0.5, 1.0]);
    let faces = read(&executor, "cube");
    assert_eq!((faces.layers, faces.bytes.len()), (6, 8 * 8 * 4 * 6));
}

pub(crate) fn samplers() -> Builder {
    let mut builder = Builder::new();
    let color = builder.texture("color", shape("rgba8unorm"), ATTACHED);
    let mut left = shape("r8unorm");
    left.width = 2;
    left.height = 1;
    let ramp = builder.texture("ramp", left, SAMPLED);
    let depth = builder.texture("depth", shape("depth32float"), SAMPLED);
    builder.clear(part(depth, 0, 0), ClearValue::Depth(0.5));
    let fill = builder.shader(
        "ramp.wgsl",
        "struct Out { @location(0) color: vec4<f32> }
        @fragment fn shade(@builtin(position) at: vec4<f32>) -> Out { return Out(vec4<f32>(floor(at.x))); }",
    );
    builder.fullscreen("ramp", fill, vec![target(part(ramp, 0, 0), "r8unorm")], vec![]);
    let shader = builder.shader(
        "samplers.wgsl",
        "var ramp: texture_2d<f32>; var stored: texture_depth_2d;
        var linear_clamp: sampler; var linear_repeat: sampler; var nearest_clamp: sampler; var nearest_repeat: sampler;
        var compare_less: sampler_comparison; var compare_greater: sampler_comparison;
        struct Out { @location(0) color: vec4<f32> }
        @fragment fn shade() -> Out {
            let linear = textureSample(ramp, linear_clamp, vec2<f32>(1.0, 0.5)).x - textureSample(ramp, linear_repeat, vec2<f32>(1.0, 0.5)).x;
            let nearest = textureSample(ramp, nearest_clamp, vec2<f32>(1.1, 0.5)).x - textureSample(ramp, nearest_repeat, vec2<f32>(1.1, 0.5)).x;
            let less = textureSampleCompareLevel(stored, compare_less, vec2<f32>(0.5), 0.25);
            let greater = textureSampleCompareLevel(stored, compare_greater, vec2<f32>(0.5), 0.25);
            return Out(vec4<f32>(linear, nearest, less, greater));
        }",
    );
    let depth_view = BindingTarget::Texture { view: part(depth, 0, 0), sample: SampleType::Depth, multisampled: false };
    let ramp_view = BindingTarget::Texture { view: part(ramp, 0, 0), sample: SampleType::FilterableFloat, multisampled: false };
    let samplers = BuiltinSampler::ALL.map(|sampler| (sampler.name(), BindingTarget::Sampler(sampler)));
    let bound = [("ramp", ramp_view), ("stored", depth_view)].into_iter().chain(samplers).collect();
    builder.fullscreen("samplers", shader, vec![target(part(color, 0, 0), "rgba8unorm")], bound);
    builder
}

pub(crate) fn built_in_samplers(gpu: &Gpu) {
    let executor = samplers().render(gpu);
    assert_near(read(&executor, "color").pixel(0, 0), [0.5, 1.0, 1.0, 0.0]);
}

pub(crate) fn four_samples(gpu: &Gpu) {
    let mut builder = Builder::new();
    let mut fine = shape("rgba8unorm");
    fine.samples = 4;
    let samples = builder.texture("samples", fine, SAMPLED);
    builder.plan.outputs.clear();
    let color = builder.texture("color", shape("rgba8unorm"), ATTACHED);
    let edge = builder.shader(
        "edge.wgsl",
        "struct Out { @location(0) color: vec4<f32> }
        @fragment fn shade(@builtin(sample_index) index: u32) -> Out { return Out(vec4<f32>(f32(index) / 3.0, 0.0, 0.0, 1.0)); }",
    );
    builder.fullscreen("edge", edge, vec![target(part(samples, 0, 0), "rgba8unorm")], vec![]);
    if let StepKind::Fullscreen { targets, .. } = &mut builder.plan.steps[0].kind {
        targets.samples = 4;
    }
    let mean = builder.shader(
        "mean.wgsl",
        "var samples: texture_multisampled_2d<f32>;
        struct Out { @location(0) color: vec4<f32> }
        @fragment fn shade() -> Out {
            return Out((textureLoad(samples, vec2<u32>(), 0) + textureLoad(samples, vec2<u32>(), 3)) / 2.0);
        }",
    );
    let view = BindingTarget::Texture { view: part(samples, 0, 0), sample: SampleType::FilterableFloat, multisampled: true };
    builder.fullscreen("mean", mean, vec![target(part(color, 0, 0), "rgba8unorm")], vec![("samples", view)]);
    let executor = builder.render(gpu);
    assert_near(read(&executor, "color").pixel(0, 0), [0.5, 0.0, 0.0, 1.0]);
}
