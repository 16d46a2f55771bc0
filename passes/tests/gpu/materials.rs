//! The published scene: material textures and samplers, tables, and their updates.

use std::sync::Arc;

use luminaire_graph::plan::Cull;
use luminaire_graph::plan::{BindingTarget, Stages};
use luminaire_graph::published::{
    DrawBatch, MaterialBinding, PublishedMaterials, PublishedSampler, PublishedTexels, PublishedTexture, PublishedWrap, Table, TableKind,
    TableSchema, ViewKind, ViewRequest,
};
use luminaire_passes::Gpu;

use crate::draw::{batch, draw, draw_list, geometry};
use crate::support::{ATTACHED, Builder, assert_near, read, shape};

const TEXTURED: &str = "
var<storage, read> instance_slots: array<u32>;
var<uniform> view: vec4<f32>;
var material_color: texture_2d<f32>;
var material_sampler: sampler;
struct Out { @location(0) color: vec4<f32> }
struct Varyings { @builtin(position) at: vec4<f32>, @location(0) slot: f32 }
@vertex fn place(@location(0) position: vec3<f32>, @builtin(instance_index) instance: u32) -> Varyings {
    // Slot 0 is the left half, slot 1 the right.
    let slot = instance_slots[instance];
    let x = clamp(position.x, -1.0, 1.0) * 0.5 - 0.5 + f32(slot);
    return Varyings(vec4<f32>(x, position.y, 0.5, 1.0), f32(slot));
}
@fragment fn shade(in: Varyings) -> Out {
    return Out(textureSample(material_color, material_sampler, vec2<f32>(0.5)) * view);
}";

fn texture(color: [u8; 4], srgb: bool) -> Arc<PublishedTexture> {
    let mips = vec![color.repeat(4).into(), color.into()];
    let texels = if srgb { PublishedTexels::Srgb8 } else { PublishedTexels::Unorm8 };
    Arc::new(PublishedTexture { name: "color".to_owned(), texels, width: 2, height: 2, mips })
}

fn slots(rows: &[u32]) -> Table {
    Table::new(4, &rows.iter().flat_map(|slot| slot.to_le_bytes()).collect::<Vec<u8>>())
}

fn textured() -> Builder {
    let mut builder = Builder::new();
    geometry(&mut builder);
    let sampler = PublishedSampler {
        mag_linear: true,
        min_linear: true,
        mip_linear: true,
        no_mips: false,
        wrap_u: PublishedWrap::Repeat,
        wrap_v: PublishedWrap::ClampToEdge,
    };
    let table = |kind, stride| TableSchema { kind, doc: String::new(), members: Vec::new(), stride, per_draw: false };
    builder.schema.material_textures = vec!["material_color".to_owned()];
    builder.schema.material_samplers = vec!["material_sampler".to_owned()];
    builder.schema.tables.insert("instance_slots".to_owned(), table(TableKind::Storage, 4));
    builder.schema.tables.insert("view".to_owned(), table(TableKind::View, 16));
    builder.scene.tables.insert("instance_slots".to_owned(), slots(&[9, 1, 0]));
    builder.scene.views = vec![[1.0f32; 4].iter().flat_map(|value| value.to_le_bytes()).collect()];
    builder.scene.materials = Arc::new(PublishedMaterials {
        textures: vec![texture([255, 0, 0, 255], false), texture([0, 188, 0, 255], true)],
        samplers: vec![sampler],
        bindings: [0, 1].map(|texture| MaterialBinding { textures: vec![texture], samplers: vec![0] }).to_vec(),
    });
    builder.plan.views = vec![ViewRequest { kind: ViewKind::Camera, width: 8, height: 8 }];
    draw_list(
        &mut builder,
        vec![DrawBatch { material: 0, first_instance: 1, ..batch(0) }, DrawBatch { material: 1, first_instance: 2, ..batch(0) }],
    );
    let color = builder.texture("color", shape("rgba8unorm"), ATTACHED);
    let shader = builder.shader("textured.wgsl", TEXTURED);
    builder.step(
        "textured",
        Some(shader),
        draw(color, None, Cull::Back),
        Stages { vertex: true, fragment: true, compute: false },
        vec![
            ("instance_slots", BindingTarget::StorageTable("instance_slots".to_owned())),
            ("view", BindingTarget::View(0)),
            ("material_color", BindingTarget::MaterialTexture(0)),
            ("material_sampler", BindingTarget::MaterialSampler(0)),
        ],
    );
    builder
}

pub(crate) fn textures_follow_batches(gpu: &Gpu) {
    let executor = textured().render(gpu);
    let image = read(&executor, "color");
    // Row 7 is the lower edge, where the clamped triangle is widest.
    assert_near(image.pixel(4, 7), [1.0, 0.0, 0.0, 1.0]);
    assert_near(image.pixel(0, 7), [0.0, 0.5028, 0.0, 1.0]);
}

pub(crate) fn tables_are_updated(gpu: &Gpu) {
    let builder = textured();
    let mut scene = builder.scene.clone();
    let mut executor = builder.prepare(gpu);
    let first = executor.render_frame().expect("a frame");

    scene.views[0] = [0.0f32, 0.0, 0.0, 1.0].iter().flat_map(|value| value.to_le_bytes()).collect();
    executor.update_scene(Arc::new(scene.clone())).expect("an update");
    let second = executor.render_frame().expect("a frame");
    assert_near(read(&executor, "color").pixel(4, 7), [0.0, 0.0, 0.0, 1.0]);
    assert_eq!(first.bind_groups_created, second.bind_groups_created, "equal lengths are written in place");

    Arc::make_mut(&mut scene.draw_lists[0].batches).remove(0);
    executor.update_scene(Arc::new(scene.clone())).expect("an update");
    let third = executor.render_frame().expect("a frame");
    assert_eq!((third.counts.draw_calls, third.pipelines_created), (1, first.pipelines_created));
    assert_eq!(first.bind_groups_created, third.bind_groups_created, "no new material is shown");
    assert_near(read(&executor, "color").pixel(4, 7), [0.0; 4]);

    scene.views[0] = [1.0f32; 4].iter().flat_map(|value| value.to_le_bytes()).collect();
    Arc::make_mut(&mut scene.materials).textures[1] = texture([0, 0, 255, 255], false);
    scene.tables.insert("instance_slots".to_owned(), slots(&[7, 7, 1, 1]));
    executor.update_scene(Arc::new(scene.clone())).expect("an update");
    executor.render_frame().expect("a frame");
    assert_near(read(&executor, "color").pixel(4, 7), [0.0, 0.0, 1.0, 1.0]);

    scene.tables.clear();
    let problems = executor.update_scene(Arc::new(scene)).unwrap_err();
    assert_eq!(problems[0].code, "execute::missing-table");
    executor.render_frame().expect("the old scene still stands");
}
