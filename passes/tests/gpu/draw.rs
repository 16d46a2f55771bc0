//! Draw passes: winding, culling, depth.

use std::sync::Arc;

use luminaire_graph::expand::types::{ClearValue, ResourceId};
use luminaire_graph::plan::Cull;
use luminaire_graph::plan::{BindingTarget, DepthTarget, Load, SampleType, Stages, StepKind, Targets};
use luminaire_graph::published::{DrawBatch, DrawFilter, DrawList, VertexAttribute, VertexFormat, VertexSchema, ViewKind};
use luminaire_graph::syntax::document::CompareDoc;
use luminaire_passes::Gpu;

use crate::support::{ATTACHED, Builder, SAMPLED, assert_near, format, part, read, shape, target};

/// Writes the depth of a vertex as color.
const SURFACE: &str = "
struct Out { @location(0) color: vec4<f32> }
struct Varyings { @builtin(position) at: vec4<f32>, @location(0) depth: f32 }
@vertex fn place(@location(0) position: vec3<f32>) -> Varyings { return Varyings(vec4<f32>(position, 1.0), position.z); }
@fragment fn shade(in: Varyings) -> Out { return Out(vec4<f32>(1.0, in.depth, 0.0, 1.0)); }";

/// Two triangles over everything, counter-clockwise, at depths 0.25 and 0.75; indices 0..3 and 3..6.
pub(crate) fn geometry(builder: &mut Builder) {
    let attribute = VertexAttribute { format: VertexFormat::Float32x3, offset: 0 };
    builder.schema.vertex = VertexSchema { stride: 12, attributes: [("position".to_owned(), attribute)].into_iter().collect() };
    let geometry = Arc::make_mut(&mut builder.scene.geometry);
    for depth in [0.25f32, 0.75] {
        for [x, y] in [[-1.0f32, -1.0], [3.0, -1.0], [-1.0, 3.0]] {
            geometry.vertices.extend([x, y, depth].iter().flat_map(|value| value.to_le_bytes()));
        }
    }
    geometry.indices = (0..6).collect();
}

pub(crate) fn batch(first_index: u32) -> DrawBatch {
    DrawBatch {
        material: 0,
        first_index,
        index_count: 3,
        base_vertex: 0,
        first_instance: 0,
        instance_count: 1,
        mirrored: false,
        double_sided: false,
    }
}

pub(crate) fn draw_list(builder: &mut Builder, batches: Vec<DrawBatch>) {
    builder.plan.draw_lists = vec![(DrawFilter::All, ViewKind::Camera)];
    builder.scene.draw_lists = vec![DrawList { filter: DrawFilter::All, view: ViewKind::Camera, batches: batches.into() }];
}

pub(crate) fn draw(shader_color: ResourceId, depth: Option<DepthTarget>, cull: Cull) -> StepKind {
    let colors = vec![target(part(shader_color, 0, 0), "rgba8unorm")];
    StepKind::Draw {
        vertex: "place".to_owned(),
        fragment: Some("shade".to_owned()),
        list: 0,
        view: 0,
        cull,
        attributes: vec!["position".to_owned()],
        targets: Targets { colors, depth, extent: [8, 8], samples: 1 },
    }
}

const BOTH: Stages = Stages { vertex: true, fragment: true, compute: false };

pub(crate) fn winding(gpu: &Gpu) {
    // Whether the one triangle is seen, which is counter-clockwise as it stands.
    let cases = [
        (Cull::Back, false, false, true),
        (Cull::Front, false, false, false),
        (Cull::None, false, false, true),
        (Cull::Back, true, false, false),
        (Cull::Front, true, false, true),
        (Cull::Front, false, true, true),
        (Cull::Back, true, true, true),
    ];
    for (cull, mirrored, double_sided, seen) in cases {
        let mut builder = Builder::new();
        geometry(&mut builder);
        draw_list(&mut builder, vec![DrawBatch { mirrored, double_sided, ..batch(0) }]);
        let color = builder.texture("color", shape("rgba8unorm"), ATTACHED);
        let shader = builder.shader("surface.wgsl", SURFACE);
        builder.step("surface", Some(shader), draw(color, None, cull), BOTH, vec![]);
        let mut executor = builder.prepare(gpu);
        let stats = executor.render_frame().expect("a frame");
        assert_eq!((stats.counts.draw_calls, stats.counts.triangles), (1, 1));
        let red = read(&executor, "color").pixel(4, 4).expect("a texel")[0];
        assert_eq!(red == 1.0, seen, "{cull:?}, mirrored {mirrored}, double-sided {double_sided}");
    }
}

fn depth_target(resource: ResourceId, load: Load, write: bool, compare: CompareDoc) -> DepthTarget {
    DepthTarget { view: part(resource, 0, 0), format: format("depth32float"), load, write, compare, bias: 0, slope_bias: 0.0 }
}

pub(crate) fn depth_compare(gpu: &Gpu) {
    // Reversed: the nearer one has the greater depth, whichever is drawn first.
    for order in [[0, 3], [3, 0]] {
        let mut builder = Builder::new();
        geometry(&mut builder);
        draw_list(&mut builder, order.map(batch).to_vec());
        let color = builder.texture("color", shape("rgba8unorm"), ATTACHED);
        let depth = builder.texture("depth", shape("depth32float"), ATTACHED);
        let shader = builder.shader("surface.wgsl", SURFACE);
        let target = depth_target(depth, Load::Clear(ClearValue::Zero), true, CompareDoc::Greater);
        builder.step("surface", Some(shader), draw(color, Some(target), Cull::Back), BOTH, vec![]);
        let executor = builder.render(gpu);
        assert_near(read(&executor, "color").pixel(1, 6), [1.0, 0.75, 0.0, 1.0]);
        assert_near(read(&executor, "depth").pixel(1, 6), [0.75, 0.0, 0.0, 1.0]);
    }
}

pub(crate) fn read_only_depth_is_sampled(gpu: &Gpu) {
    let mut builder = Builder::new();
    geometry(&mut builder);
    draw_list(&mut builder, vec![batch(0), batch(3)]);
    let color = builder.texture("color", shape("rgba8unorm"), ATTACHED);
    let depth = builder.texture("depth", shape("depth32float"), SAMPLED);
    let shader = builder.shader(
        "sampled.wgsl",
        "var stored: texture_depth_2d;
        struct Out { @location(0) color: vec4<f32> }
        @vertex fn place(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> { return vec4<f32>(position, 1.0); }
        @fragment fn shade(@builtin(position) at: vec4<f32>) -> Out {
            return Out(vec4<f32>(textureLoad(stored, vec2<u32>(at.xy), 0), at.z, 0.0, 1.0));
        }",
    );
    builder.clear(part(depth, 0, 0), ClearValue::Depth(0.5));
    let target = depth_target(depth, Load::Keep, false, CompareDoc::Greater);
    let stored = BindingTarget::Texture { view: part(depth, 0, 0), sample: SampleType::Depth, multisampled: false };
    let fragment = Stages { fragment: true, ..Stages::default() };
    builder.step("sampled", Some(shader), draw(color, Some(target), Cull::Back), fragment, vec![("stored", stored)]);
    let executor = builder.render(gpu);
    assert_near(read(&executor, "color").pixel(4, 4), [0.5, 0.75, 0.0, 1.0]);
}

pub(crate) fn nothing_still_clears(gpu: &Gpu) {
    let mut builder = Builder::new();
    geometry(&mut builder);
    builder.scene.geometry = Arc::default();
    draw_list(&mut builder, Vec::new());
    let color = builder.texture("color", shape("rgba8unorm"), ATTACHED);
    let shader = builder.shader("surface.wgsl", SURFACE);
    builder.step("surface", Some(shader), draw(color, None, Cull::Back), BOTH, vec![]);
    let mut executor = builder.prepare(gpu);
    assert_eq!(executor.render_frame().expect("a frame").counts.draw_calls, 0);
    assert_near(read(&executor, "color").pixel(0, 0), [0.0; 4]);
}
