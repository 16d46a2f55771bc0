//! The checker of plans finds what is broken on purpose.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use luminaire_graph::place::{Alignment, HeapPlan};
use luminaire_graph::plan::Plan;
use support::fixture;

fn plan() -> Plan {
    fixture(
        "texture a r32float 8x8\ntexture b r32float 8x8\ntexture c r32float 8x8\nbuffer d 1000\nbuffer e 600\ntexture out r32float 4x4\n\
         pass pa write a write d write e\npass pb read a write b\npass pm modify b\npass pc read b read d read e write c\n\
         pass po read c write out\noutput color out",
    )
    .plan()
}

fn breaks(what: &str, change: impl Fn(&mut Plan)) {
    let mut broken = plan();
    change(&mut broken);
    assert!(!broken.self_check().is_empty(), "{what} is not found");
}

#[test]
fn sound_plan_has_no_fault() {
    assert_eq!(plan().self_check(), Vec::<String>::new());
}

#[test]
fn every_break_is_found() {
    for place in 0..4 {
        breaks("a changed order", |plan| plan.steps.swap(place, place + 1));
        breaks("a step that is left out", |plan| drop(plan.steps.remove(place)));
        breaks("a step that stands twice", |plan| plan.steps.push(plan.steps[place].clone()));
    }
    let index = |plan: &Plan, name: &str| plan.resources.iter().position(|resource| resource.name == name).unwrap();
    breaks("a lifetime that is too short", |plan| plan.resources[0].lifetime.end -= 1);
    breaks("bytes that are wrong", |plan| plan.resources[0].bytes += 4);
    breaks("a memory that is too small", |plan| plan.memories.iter_mut().for_each(|memory| memory.bytes /= 2));
    breaks("an offset that is not aligned", |plan| {
        let d = index(plan, "d");
        plan.resources[d].placement.as_mut().unwrap().offset += 4;
    });
    breaks("two buffers in the same bytes", |plan| {
        let (d, e) = (index(plan, "d"), index(plan, "e"));
        plan.resources[e].placement = plan.resources[d].placement;
    });
    breaks("two textures in the same memory at once", |plan| {
        let (a, b) = (index(plan, "a"), index(plan, "b"));
        let (from, to) = (plan.resources[b].placement.unwrap().memory, plan.resources[a].placement.unwrap().memory);
        let moved = std::mem::take(&mut plan.memories[from.index()].holders);
        plan.memories[to.index()].holders.extend(&moved);
        for holder in moved {
            plan.resources[holder.index()].placement.as_mut().unwrap().memory = to;
        }
    });
    breaks("a usage that the memory lacks", |plan| plan.memories[0].usage.sampled = false);
    breaks("a figure", |plan| plan.figures.reached += 1);
    breaks("a resource that does not exist", |plan| plan.steps[0].uses[0].resource.0 = 1000);
}

#[test]
fn every_broken_placement_is_found() {
    let plan = plan();
    let sound = plan.placed();
    assert_eq!(plan.check_placed(&sound, Alignment::default()), Vec::<String>::new());
    let breaks = |what: &str, change: &dyn Fn(&mut HeapPlan)| {
        let mut broken = sound.clone();
        change(&mut broken);
        assert!(!plan.check_placed(&broken, Alignment::default()).is_empty(), "{what} is not found");
    };
    breaks("a changed order", &|heap| heap.order.swap(0, 1));
    breaks("a pass that is left out", &|heap| heap.order.truncate(1));
    breaks("a pass that stands twice", &|heap| heap.order[0] = heap.order[1]);
    breaks("a heap that is too small", &|heap| heap.bytes -= 1);
    breaks("a bound", &|heap| heap.bound -= 1);
    breaks("an offset that is not aligned", &|heap| heap.offsets[0].1 += 4);
    breaks("a resource that is left out", &|heap| heap.offsets.truncate(1));
    breaks("two resources in the same bytes", &|heap| heap.offsets.iter_mut().for_each(|(_, offset)| *offset = 0));
}
