//! A plan as text for people, stable to the byte: a changed pipeline shows its effect as a difference of this text.

use super::units::bytes as human;
use super::{describe, steps};
use crate::plan::{MemoryKind, Plan, PlannedResource};
use crate::source::SourceMap;

/// The whole plan: what is rendered, every step with what it touches, where each resource lives, what does not run, and what it
/// all costs.
pub fn text(plan: &Plan, sources: &SourceMap) -> String {
    let mut out = Writer(String::new());
    out.line(0, &format!("pipeline {}, output {} x {}", plan.name, plan.extent[0], plan.extent[1]));
    for line in plan.doc.lines().map(str::trim).filter(|line| !line.is_empty()) {
        out.line(1, line);
    }
    out.section("parameters", plan.params.len());
    for param in &plan.params {
        out.line(1, &format!("{} = {}", param.name, describe::value(&param.value)));
    }
    out.section("outputs", plan.outputs.len());
    for output in &plan.outputs {
        let view = &output.view;
        let content = describe::content(plan, view.resource, &view.mips);
        out.line(1, &format!("{} = {}, {content}", output.name, steps::part_name(plan, view)));
    }
    out.section("steps", plan.steps.len());
    for (place, step) in plan.steps.iter().enumerate() {
        let lines = steps::step(plan, place, step, sources);
        for (index, line) in lines.iter().enumerate() {
            out.line(if index == 0 { 0 } else { 4 }, line);
        }
    }
    resources(plan, sources, &mut out);
    memories(plan, &mut out);
    inputs(plan, &mut out);
    out.section("passes that do not run", plan.culled.len());
    for culled in &plan.culled {
        out.line(1, &format!("{} ({}): {}", culled.name, culled.kind, describe::culled(plan, &culled.reason)));
    }
    figures(plan, &mut out);
    out.section("device features needed", plan.requirements.len());
    for requirement in &plan.requirements {
        out.line(1, &format!("{}, by `{}` {}", requirement.feature.name(), requirement.pass, requirement.why));
    }
    out.0
}

struct Writer(String);

impl Writer {
    fn line(&mut self, indent: usize, text: &str) {
        for _ in 0..indent {
            self.0.push_str("  ");
        }
        self.0.push_str(text);
        self.0.push('\n');
    }

    fn section(&mut self, title: &str, count: usize) {
        self.0.push('\n');
        self.line(0, &if count == 0 { format!("{title}: none") } else { format!("{title} ({count})") });
    }
}

fn resources(plan: &Plan, sources: &SourceMap, out: &mut Writer) {
    out.section("resources", plan.resources.len());
    for (index, resource) in plan.resources.iter().enumerate() {
        let place = describe::place(sources, resource.span).map_or_else(String::new, |place| format!("  [{place}]"));
        let size = format!("{} ({} bytes)", human(resource.bytes), resource.bytes);
        out.line(1, &format!("{}: {}, {size}{place}", resource.name, describe::shape(resource)));
        if resource.lifetime.is_empty() {
            out.line(3, "no step uses it");
            continue;
        }
        let (first, last) = (resource.lifetime.start, resource.lifetime.end - 1);
        out.line(3, &if first == last { format!("in use in step {first}") } else { format!("in use from step {first} to {last}") });
        out.line(3, &format!("used as {}", describe::usages(resource.usage).join(", ")));
        out.line(3, &home(plan, index as u32, resource));
    }
}

fn home(plan: &Plan, index: u32, resource: &PlannedResource) -> String {
    let Some(placement) = resource.placement else { return "lives nowhere".to_owned() };
    let memory = placement.memory.0;
    let arena = plan.memories.get(memory as usize).is_some_and(|memory| memory.kind == MemoryKind::Arena);
    let at = if arena { format!(" at byte {}", placement.offset) } else { String::new() };
    let sharers = describe::sharers(plan, crate::expand::types::ResourceId(index));
    let how = match resource.alone {
        Some(alone) => describe::alone(plan, alone),
        None => {
            let names = crate::diagnostic::list_names(sharers.iter().map(|id| describe::resource(plan, *id)));
            format!("shares it with {names}")
        }
    };
    format!("lives in memory {memory}{at}; {how}")
}

fn memories(plan: &Plan, out: &mut Writer) {
    out.section("memories", plan.memories.len());
    for (index, memory) in plan.memories.iter().enumerate() {
        let kind = if memory.kind == MemoryKind::Arena { "arena" } else { "texture" };
        let names = crate::diagnostic::list_names(memory.holders.iter().map(|id| describe::resource(plan, *id)));
        let usages = describe::usages(memory.usage).join(", ");
        out.line(1, &format!("{index}: {kind}, {} ({} bytes), {usages}; holds {names}", human(memory.bytes), memory.bytes));
    }
}

fn inputs(plan: &Plan, out: &mut Writer) {
    let costs = super::explain::costs(plan);
    out.section("inputs from outside, and what is retained so that each can change alone", costs.len());
    for (input, bytes) in costs {
        out.line(1, &format!("{input}: {}", human(bytes)));
    }
}

fn figures(plan: &Plan, out: &mut Writer) {
    let figures = &plan.figures;
    let placed = plan.placed();
    out.0.push('\n');
    out.line(0, "memory");
    for (what, bytes, meaning) in [
        ("without sharing", figures.without_sharing, "every transient resource in memory of its own"),
        ("reached", figures.reached, "what this plan allocates for transients"),
        ("bound", figures.bound, "the most bytes in use at once: no plan with this order takes less"),
        ("declared bound", plan.declared_bound(), "the same for the order of the file"),
        ("placed", placed.bytes, "if resources could be placed by byte, in an order for that, textures in units of 64 KiB"),
        ("placed bound", placed.bound, "the most bytes in use at once in that order"),
        ("retained", figures.retained, "outputs and what can be read without being made again: shares with nothing"),
        ("total", figures.reached.saturating_add(figures.retained), "reached and retained"),
    ] {
        out.line(1, &format!("{what:<16} {:>12} {bytes:>16} bytes  {meaning}", human(bytes)));
    }
}
