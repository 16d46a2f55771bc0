//! Named cases of memory: what shares, what does not and why, and what limits say.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use luminaire_graph::allocate::extent::texture_bytes;
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::render;
use luminaire_graph::expand::types::Shape;
use luminaire_graph::plan::{Alone, MemoryKind, Plan, PlannedResource, Retained};
use support::fixture;

fn named<'a>(plan: &'a Plan, name: &str) -> &'a PlannedResource {
    plan.resources.iter().find(|resource| resource.name == name).unwrap()
}

fn memory_of(plan: &Plan, name: &str) -> usize {
    named(plan, name).placement.unwrap().memory.index()
}

/// Passes that hand on a value through resources of these declarations, and an output.
fn chain(declarations: &[&str]) -> String {
    let mut text = "texture out rgba16float 8x8\n".to_owned();
    let mut passes = String::new();
    let mut before: Option<&str> = None;
    for declaration in declarations {
        let name = declaration.split_whitespace().nth(1).unwrap();
        text += &format!("{declaration}\n");
        let read = before.map_or_else(String::new, |before| format!(" read {before}"));
        passes += &format!("pass make_{name}{read} write {name}\n");
        before = Some(name);
    }
    format!("{text}{passes}pass last read {} write out\noutput color out", before.unwrap())
}

#[test]
fn bytes_are_tight() {
    for (declaration, bytes) in [
        ("texture x rgba8unorm 5x3", 60),
        ("texture x rgba8unorm 4x4 mips 3", (16 + 4 + 1) * 4),
        ("texture x rgba8unorm 8x2 mips 4", (16 + 4 + 2 + 1) * 4),
        ("texture x r32float 4x4 cube", 16 * 6 * 4),
        ("texture x rgba16float 4x4 depth 4 mips 3", (64 + 8 + 1) * 8),
        ("texture x r8unorm 4x4 samples 4", 64),
        ("texture x depth32float 4x4 layers 3", 16 * 3 * 4),
    ] {
        let fixture = fixture(&format!("{declaration}\npass a write x\noutput color x"));
        let Shape::Texture(shape) = &fixture.bound.expanded.resources[0].shape else { panic!() };
        assert_eq!(texture_bytes(shape, shape.formats[0]), Some(bytes), "{declaration}");
    }
}

#[test]
fn bytes_that_do_not_fit_are_an_error_and_no_panic() {
    let edge = u32::MAX;
    let graph = fixture(&format!("texture x rgba32float {edge}x{edge} depth {edge}\npass a write x\noutput color x"));
    let problems = graph.planned_on(&DeviceFacts::webgpu_defaults()).err().unwrap();
    assert_eq!(problems[0].code, "allocate::too-large");
    let graph = fixture("texture x rgba32float 4x4 mips 4000000000\npass a write x\noutput color x");
    assert_eq!(graph.planned_on(&DeviceFacts::webgpu_defaults()).err().unwrap()[0].code, "allocate::too-large");
}

#[test]
fn chain_of_equal_textures_needs_two() {
    let plan =
        fixture(&chain(&["texture a r32float 8x8", "texture b r32float 8x8", "texture c r32float 8x8", "texture d r32float 8x8"])).plan();
    assert_eq!(memory_of(&plan, "a"), memory_of(&plan, "c"));
    assert_eq!(memory_of(&plan, "b"), memory_of(&plan, "d"));
    assert_eq!(plan.figures.reached, 2 * 256);
    assert_eq!(plan.figures.reached, plan.figures.bound);
}

#[test]
fn every_field_of_the_descriptor_counts() {
    for other in [
        "texture c rgba8unorm 8x8",
        "texture c r32float 8x4",
        "texture c r32float 8x8 mips 2",
        "texture c r32float 8x8 layers 2",
        "texture c r32float 8x8 depth 2",
        "texture c r32float 8x8 samples 4",
        "texture c r32float 8x8 cube",
    ] {
        let plan = fixture(&chain(&["texture a r32float 8x8", "texture b r32float 8x8", other])).plan();
        assert_ne!(memory_of(&plan, "a"), memory_of(&plan, "c"), "{other}");
        assert_eq!(named(&plan, "c").alone, Some(Alone::OnlyOfItsDescriptor), "{other}");
    }
}

#[test]
fn usage_is_the_union() {
    let plan = fixture(
        "texture a rgba8unorm 8x8\ntexture b r32float 8x8\ntexture c rgba8unorm 8x8\ntexture out rgba16float 8x8\n\
         pass pa write a\npass pb read a write b\npass pc copy out2 to c read b\ntexture out2 rgba8unorm 8x8 clear\n\
         pass last read c write out\noutput color out",
    )
    .plan();
    let memory = &plan.memories[memory_of(&plan, "a")];
    assert_eq!(memory_of(&plan, "a"), memory_of(&plan, "c"));
    assert!(memory.usage.storage && memory.usage.sampled && memory.usage.copy_target);
    assert!(!named(&plan, "a").usage.copy_target);
}

#[test]
fn outputs_share_with_nothing() {
    let plan = fixture(
        "texture a r32float 8x8\ntexture b r32float 8x8\ntexture c r32float 8x8\n\
         pass pa write a\npass pb read a write b\npass pc read b write c\noutput one a\noutput two c",
    )
    .plan();
    assert_eq!(named(&plan, "a").alone, Some(Alone::Retained(Retained::Output)));
    assert_eq!(plan.figures.retained, 512);
    assert_eq!(plan.figures.reached, 256);
    assert!(named(&plan, "a").usage.copy_source && named(&plan, "a").usage.sampled);
}

#[test]
fn textures_in_use_together_say_so() {
    let plan = fixture(
        "texture a r32float 8x8\ntexture b r32float 8x8\ntexture out r32float 4x4\n\
         pass pa write a\npass pb write b\npass pc read a read b write out\noutput color out",
    )
    .plan();
    assert_eq!(named(&plan, "a").alone, Some(Alone::InUseTogether { count: 2, step: 1 }));
}

#[test]
fn buffers_are_ranges_of_arenas_at_multiples_of_256() {
    // One pass writes all three and another reads them, each with one access, so that one arena holds them.
    let plan = fixture(
        "buffer a 300\nbuffer b 10\nbuffer c 1000\ntexture out r32float 4x4\n\
         pass make write a write b write c\npass use read a read b read c write out\noutput color out",
    )
    .plan();
    let arenas: Vec<_> = plan.memories.iter().filter(|memory| memory.kind == MemoryKind::Arena).collect();
    assert_eq!(arenas.len(), 1);
    assert_eq!(arenas[0].bytes, 1024 + 512 + 256);
    assert_eq!(named(&plan, "b").bytes, 12);
    assert!(plan.resources.iter().filter_map(|resource| resource.placement).all(|placement| placement.offset % 256 == 0));
    assert_eq!(named(&plan, "a").alone, Some(Alone::BuffersInUse));
}

#[test]
fn buffers_reuse_bytes_over_time() {
    let plan =
        fixture(&chain(&["buffer a 4096", "texture b r32float 8x8", "buffer c 1024", "texture d r32float 8x8", "buffer e 3072"])).plan();
    assert_eq!(memory_of(&plan, "a"), memory_of(&plan, "c"));
    assert_eq!(memory_of(&plan, "a"), memory_of(&plan, "e"));
    assert_eq!(plan.memories[memory_of(&plan, "a")].bytes, 4096);
    assert_eq!(named(&plan, "c").alone, None);
}

#[test]
fn different_access_in_one_pass_keeps_buffers_apart() {
    let plan = fixture(&chain(&["buffer a 4096", "buffer b 4096", "buffer c 4096"])).plan();
    // Each pass reads one and writes the next.
    assert_ne!(memory_of(&plan, "a"), memory_of(&plan, "b"));
    assert_ne!(memory_of(&plan, "b"), memory_of(&plan, "c"));
    assert_eq!(memory_of(&plan, "a"), memory_of(&plan, "c"));
    let copied = fixture(
        "buffer a 4096\nbuffer b 4096\ntexture out r32float 4x4\n\
         pass make write a\npass move copy a to b\npass use read b write out\noutput color out",
    )
    .plan();
    assert_ne!(memory_of(&copied, "a"), memory_of(&copied, "b"));
    let uniform = fixture(
        "buffer a 4096\nbuffer b 4096\ntexture out r32float 4x4\n\
         pass make write a write b\npass use read a uniform b write out\noutput color out",
    )
    .plan();
    assert_ne!(memory_of(&uniform, "a"), memory_of(&uniform, "b"));
}

#[test]
fn limits_name_resource_value_and_limit() {
    for (declaration, code) in [
        ("texture x r32float 9000x8", "allocate::texture-too-large"),
        ("texture x r32float 8x8 depth 4000", "allocate::texture-too-large"),
        ("texture x r32float 8x8 layers 300", "allocate::too-many-layers"),
        ("buffer x 300000000", "allocate::buffer-too-large"),
        ("buffer x 200000000", "allocate::binding-too-large"),
    ] {
        let graph = fixture(&format!("{declaration}\npass a write x\noutput color x"));
        let problems = graph.planned_on(&DeviceFacts::webgpu_defaults()).err().unwrap();
        assert_eq!(problems[0].code, code, "{declaration}");
        let text = render(&problems, &graph.sources, false);
        assert!(text.contains("`x` has") && text.contains("WebGPU's default limits allows"), "{text}");
    }
}

#[test]
fn budget_lists_the_largest() {
    let graph = fixture(
        "texture big rgba32float 4096x4096\ntexture small rgba8unorm 8x8\n\
         pass a write big\npass b read big write small\noutput color small",
    );
    let device = DeviceFacts { memory_budget: 100 << 20, ..DeviceFacts::webgpu_defaults() };
    let text = render(&graph.planned_on(&device).err().unwrap(), &graph.sources, false);
    for part in [
        "allocate::over-budget",
        "the pipeline needs 256 MiB of memory; the budget is 100 MiB",
        "the largest: 256 MiB",
        "`big`: 256 MiB (268435456 bytes)",
    ] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
}

#[test]
fn what_is_culled_takes_no_memory() {
    let plan = fixture("texture a r32float 8x8\ntexture b r32float 20000x20000\npass pa write a\npass pb write b\noutput color a").plan();
    assert_eq!(named(&plan, "b").placement, None);
    assert!(named(&plan, "b").lifetime.is_empty());
}
