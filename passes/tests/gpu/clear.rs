//! Clears: through attachments, through copies, of buffers, of parts alone, and before steps.

use luminaire_graph::expand::types::{ClearValue, Dimension};
use luminaire_graph::plan::{BindingTarget, PartView, Usage};
use luminaire_graph::reflect::interface::{StorageAccess, ViewDimension};
use luminaire_passes::Gpu;

use crate::support::{Builder, assert_near, format, part, read, shape};

pub(crate) fn every_way(gpu: &Gpu) {
    let color = ClearValue::Color([0.25, 0.5, 1.0, 0.75]);
    let uint = ClearValue::Uint([7, 8, 9, 10]);
    let cases = [
        ("rgba8unorm", Dimension::D2, color, [0.25, 0.5, 1.0, 0.75]),
        ("rgba8unorm-srgb", Dimension::D2, color, [0.25, 0.5, 1.0, 0.75]),
        ("rgba8unorm-srgb", Dimension::D3, color, [0.25, 0.5, 1.0, 0.75]),
        ("rgba16float", Dimension::D3, color, [0.25, 0.5, 1.0, 0.75]),
        ("rg32float", Dimension::D3, color, [0.25, 0.5, 0.0, 1.0]),
        ("r32float", Dimension::D1, color, [0.25, 0.0, 0.0, 1.0]),
        ("rg11b10ufloat", Dimension::D2, color, [0.25, 0.5, 1.0, 1.0]),
        ("rgb9e5ufloat", Dimension::D2, color, [0.25, 0.5, 1.0, 1.0]),
        ("rgba8snorm", Dimension::D2, color, [0.25, 0.5, 1.0, 0.75]),
        ("rgba16uint", Dimension::D2, uint, [7.0, 8.0, 9.0, 10.0]),
        ("rgba32uint", Dimension::D3, uint, [7.0, 8.0, 9.0, 10.0]),
        ("r32sint", Dimension::D2, ClearValue::Uint([u32::MAX, 0, 0, 0]), [-1.0, 0.0, 0.0, 1.0]),
        ("depth32float", Dimension::D2, ClearValue::Depth(0.5), [0.5, 0.0, 0.0, 1.0]),
        ("depth16unorm", Dimension::D2, ClearValue::Depth(1.0), [1.0, 0.0, 0.0, 1.0]),
        ("depth32float", Dimension::Cube, ClearValue::Zero, [0.0, 0.0, 0.0, 1.0]),
    ];
    let mut builder = Builder::new();
    for (index, (format_name, dimension, value, _)) in cases.iter().enumerate() {
        let mut texture = shape(format_name);
        texture.dimension = *dimension;
        match dimension {
            Dimension::D1 => texture.height = 1,
            Dimension::D3 => texture.depth = 3,
            Dimension::Cube => texture.layers = 6,
            Dimension::D2 => {}
        }
        let layers = 0..texture.layers;
        let usage = Usage { sampled: true, ..Usage::default() };
        let resource = builder.texture(&index.to_string(), texture, usage);
        builder.clear(PartView { resource, mips: 0..1, layers, dimension: ViewDimension::D2 }, *value);
    }
    let executor = builder.render(gpu);
    for (index, (format_name, dimension, _, wanted)) in cases.iter().enumerate() {
        let image = read(&executor, &index.to_string());
        for texel in image.pixels.chunks(4) {
            let near = texel.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 0.01);
            assert!(near, "{format_name} {dimension:?}: {texel:?}, wanted {wanted:?}");
        }
    }
}

pub(crate) fn parts(gpu: &Gpu) {
    let mut builder = Builder::new();
    let mut layered = shape("rgba8unorm");
    layered.layers = 2;
    let color = builder.texture("color", layered, Usage { sampled: true, ..Usage::default() });
    let mut deep = shape("r32float");
    (deep.dimension, deep.depth, deep.mips) = (Dimension::D3, 8, 2);
    let volume = builder.texture("volume", deep, Usage { sampled: true, ..Usage::default() });
    builder.plan.outputs[1].view.mips = 1..2;
    let both = PartView { resource: color, mips: 0..1, layers: 0..2, dimension: ViewDimension::D2Array };
    builder.clear(both, ClearValue::Color([1.0; 4]));
    builder.clear(part(color, 0, 1), ClearValue::Zero);
    builder.clear(PartView { mips: 0..2, ..part(volume, 0, 0) }, ClearValue::Color([2.0, 0.0, 0.0, 0.0]));
    builder.clear(part(volume, 1, 0), ClearValue::Color([3.0, 0.0, 0.0, 0.0]));
    let executor = builder.render(gpu);
    let image = read(&executor, "color");
    assert_eq!((image.bytes[0], image.bytes[256]), (255, 0));
    let image = read(&executor, "volume");
    assert_eq!((image.width, image.layers), (4, 4));
    assert!(image.pixels.chunks(4).all(|texel| texel[0] == 3.0));
}

pub(crate) fn before_a_step(gpu: &Gpu) {
    let mut builder = Builder::new();
    let color = builder.texture("color", shape("rgba8unorm"), Usage { storage: true, ..Usage::default() });
    let shader = builder.shader(
        "dot.wgsl",
        "var color: texture_storage_2d<rgba8unorm, write>;
        @compute @workgroup_size(1) fn main() { textureStore(color, vec2<u32>(2u, 3u), vec4<f32>(1.0)); }",
    );
    let view = part(color, 0, 0);
    let bound = BindingTarget::StorageTexture { view: view.clone(), format: format("rgba8unorm"), access: StorageAccess::Write };
    builder.compute("dot", shader, [1, 1, 1], vec![("color", bound)]);
    builder.plan.steps[0].clears.push((view, ClearValue::Color([0.0, 0.0, 1.0, 1.0])));
    let executor = builder.render(gpu);
    let image = read(&executor, "color");
    assert_near(image.pixel(2, 3), [1.0; 4]);
    assert_near(image.pixel(3, 2), [0.0, 0.0, 1.0, 1.0]);
}
