//! Known answers of placing: what the best order and the tightest packing of a graph come to.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use luminaire_graph::place::{Alignment, HeapPlan};
use support::{Fixture, fixture};

const UNIT: u64 = 64 << 10;

fn placed(graph: &Fixture) -> HeapPlan {
    let plan = graph.plan();
    let placed = plan.placed();
    assert_eq!(plan.check_placed(&placed, Alignment::default()), Vec::<String>::new());
    placed
}

/// A frame with shadow cascades, a G-buffer, voxel cones, reflections, fog, depth of field, temporal filtering and bloom.
fn frame(width: u32, height: u32) -> Fixture {
    let size = |part: u32| format!("{}x{}", width / part, height / part);
    let (whole, half, quarter, eighth) = (size(1), size(2), size(4), size(8));
    fixture(&format!(
        "texture cascades depth32float 2048x2048 layers 4
         texture depth depth32float {whole}
         texture albedo rgba8unorm {whole}
         texture normal rgba16float {whole}
         texture surface rgba8unorm {whole}
         texture motion rg16float {whole}
         texture pyramid r16float {half} mips 8
         texture voxel_albedo rgba8unorm 128x128 depth 128
         texture voxel_normal rgba8unorm 128x128 depth 128
         texture voxel_light rgba16float 128x128 depth 128 mips 7
         texture occlusion_raw r8unorm {half}
         texture occlusion_half r8unorm {half}
         texture occlusion r8unorm {half}
         texture shadow r8unorm {whole}
         texture light rgba16float {whole}
         texture cones_diffuse rgba16float {half}
         texture cones_glossy rgba16float {half}
         texture indirect rgba16float {whole}
         texture mirror_raw rgba16float {half}
         texture mirror rgba16float {half}
         texture lit rgba16float {whole}
         texture fog rgba16float 160x90 layers 64
         texture focus r16float {whole}
         texture near rgba16float {half}
         texture far rgba16float {half}
         texture blurred rgba16float {whole}
         texture stable rgba16float {whole}
         texture glow0 rg11b10ufloat {half}
         texture glow1 rg11b10ufloat {quarter}
         texture glow2 rg11b10ufloat {eighth}
         texture mapped rgba8unorm {whole}
         texture smooth rgba8unorm {whole}
         texture screen rgba8unorm {whole}
         pass cast_shadows write cascades
         pass draw write depth write albedo write normal write surface write motion
         pass build_pyramid read depth write pyramid
         pass voxelize write voxel_albedo write voxel_normal
         pass fill_voxels modify voxel_albedo modify voxel_normal
         pass light_voxels read voxel_albedo read voxel_normal read cascades write voxel_light
         pass occlude read depth read normal read pyramid write occlusion_raw
         pass blur_across read occlusion_raw read depth write occlusion_half
         pass blur_down read occlusion_half read depth write occlusion
         pass resolve_shadows read cascades read depth read normal write shadow
         pass shade read albedo read normal read surface read depth read occlusion read shadow write light
         pass trace_diffuse read voxel_light read depth read normal write cones_diffuse
         pass trace_glossy read voxel_light read depth read normal read surface write cones_glossy
         pass gather read cones_diffuse read cones_glossy read depth read normal write indirect
         pass trace_mirror read pyramid read depth read normal read surface read light write mirror_raw
         pass filter_mirror read mirror_raw read normal read surface write mirror
         pass add read light read indirect read mirror write lit
         pass scatter_fog read depth write fog
         pass apply_fog read fog read depth modify lit
         pass measure_focus read depth write focus
         pass split read lit read focus read depth write near write far
         pass blur read near read far read focus write blurred
         pass sharpen read lit modify blurred
         pass streak read motion modify blurred
         pass stabilize read blurred read motion write stable
         pass glow_half read stable write glow0
         pass glow_quarter read glow0 write glow1
         pass glow_eighth read glow1 write glow2
         pass map_tones read stable read glow0 read glow1 read glow2 write mapped
         pass smooth_edges read mapped write smooth
         pass show read smooth write screen
         output color screen"
    ))
}

#[test]
fn frame_reaches_the_best_of_all_orders() {
    for (width, height, best) in [(1920, 1080, 0.896), (3840, 2160, 0.934)] {
        let heap = placed(&frame(width, height));
        let of_declared = |bytes: u64| bytes as f64 / heap.declared_bound as f64;
        assert!((of_declared(heap.bound) - best).abs() < 5e-4, "{height}: {}", of_declared(heap.bound));
        assert!(of_declared(heap.bytes) < best + 0.004, "{height}: {}", of_declared(heap.bytes));
    }
}

#[test]
fn chain_takes_two() {
    let mut text = "texture x0 rgba16float 256x256\npass p0 write x0\n".to_owned();
    for index in 1..200 {
        text += &format!("texture x{index} rgba16float 256x256\npass p{index} read x{} write x{index}\n", index - 1);
    }
    let heap = placed(&fixture(&format!("{text}texture end r8unorm 8x8\npass last read x199 write end\noutput color end")));
    assert_eq!((heap.bytes, heap.bound, heap.declared_bound), (16 * UNIT, 16 * UNIT, 16 * UNIT));
}

/// More passes than a search over sets of them takes.
#[test]
fn branches_are_placed_one_after_the_other() {
    const BRANCHES: u64 = 50;
    let mut levels = ["first", "second"].map(|_| String::new());
    let mut text = "texture source rgba16float 256x256\ntexture end r8unorm 8x8\npass source write source\n".to_owned();
    let mut gather = "pass gather write end".to_owned();
    for branch in 0..BRANCHES {
        text += &format!("texture a{branch} rgba16float 256x256\ntexture b{branch} rgba8unorm 128x128\n");
        levels[0] += &format!("pass a{branch} read source write a{branch}\n");
        levels[1] += &format!("pass b{branch} read a{branch} write b{branch}\n");
        gather += &format!(" read b{branch}");
    }
    let heap = placed(&fixture(&format!("{text}{}{gather}\noutput color end", levels.concat())));
    // The worst step is the first of the last branch: the source, a large texture, and the small ones of all other branches.
    assert_eq!(heap.declared_bound, (BRANCHES + 1) * 8 * UNIT);
    assert_eq!(heap.bound, (8 + 8 + BRANCHES - 1) * UNIT);
    assert_eq!(heap.bytes, heap.bound);
}

#[test]
fn chains_that_nothing_needs_take_nothing() {
    let graph = fixture(
        "texture a rgba16float 256x256\ntexture b rgba16float 256x256\ntexture c rgba16float 256x256\ntexture d rgba16float 256x256\n\
         texture end r8unorm 8x8\npass pa write a\npass pb read a write b\npass pc read b write c\npass pd read c write d\n\
         pass last read a write end\noutput color end",
    );
    assert_eq!(graph.order(), ["pa", "last"]);
    let heap = placed(&graph);
    assert_eq!(heap.bytes, 8 * UNIT);
    assert_eq!(heap.offsets.len(), 1);
    assert_eq!(graph.plan().figures.without_sharing, 8 * UNIT);
}

#[test]
fn buffers_and_textures_keep_their_alignments() {
    let graph = fixture(
        "buffer a 1000\nbuffer b 300\ntexture c rgba8unorm 64x64\ntexture d rgba8unorm 130x130\ntexture end r8unorm 8x8\n\
         pass make write a write b write c write d\npass last read a read b read c read d write end\noutput color end",
    );
    let heap = placed(&graph);
    assert_eq!(heap.bound, 1024 + 512 + UNIT + 2 * UNIT);
}

#[test]
fn nothing_transient_takes_nothing() {
    let heap = placed(&fixture("texture a r8unorm 8x8\npass pa write a\noutput color a"));
    assert_eq!((heap.bytes, heap.bound, heap.offsets.len(), heap.order.len()), (0, 0, 0, 1));
}
