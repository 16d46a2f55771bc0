//! A backend that writes each verb down as a line of text and touches no GPU.
//!
//! The lines name resources and passes, never indices alone, so that a test reads like the plan that it checks.

use std::convert::Infallible;

use super::Backend;
use crate::expand::types::{ClearValue, ResourceId};
use crate::plan::{Memory, MemoryId, MemoryKind, PartView, Plan, StepKind};

/// What a plan made a backend do.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Recorder {
    /// One verb each, in order.
    pub lines: Vec<String>,
}

impl Recorder {
    /// All lines as one text.
    pub fn text(&self) -> String {
        self.lines.iter().flat_map(|line| [line.as_str(), "\n"]).collect()
    }
}

impl Backend for Recorder {
    type Error = Infallible;

    fn create_memory(&mut self, plan: &Plan, memory: MemoryId) -> Result<(), Infallible> {
        let held = &plan.memories[memory.index()];
        self.lines.push(format!("create memory {}: {} for {}", memory.0, describe(held), names(plan, held)));
        Ok(())
    }

    fn prepare_step(&mut self, plan: &Plan, step: usize) -> Result<(), Infallible> {
        self.lines.push(format!("prepare {}", plan.steps[step].name));
        Ok(())
    }

    fn clear_part(&mut self, plan: &Plan, step: usize, clear: usize) -> Result<(), Infallible> {
        let (view, value) = &plan.steps[step].clears[clear];
        self.lines.push(format!("clear {} to {} for {}", part(plan, view), value_text(value), plan.steps[step].name));
        Ok(())
    }

    fn run_step(&mut self, plan: &Plan, step: usize) -> Result<(), Infallible> {
        let step = &plan.steps[step];
        let what = match &step.kind {
            StepKind::Draw { .. } => "draw".to_owned(),
            StepKind::Fullscreen { .. } => "fullscreen".to_owned(),
            StepKind::Compute { groups: [x, y, z], .. } => format!("compute {x}x{y}x{z}"),
            StepKind::Copy { source, target } => format!("copy {} to {}", part(plan, source), part(plan, target)),
            StepKind::Clear { target, value } => format!("clear {} to {}", part(plan, target), value_text(value)),
        };
        self.lines.push(format!("run {}: {what}", step.name));
        Ok(())
    }

    fn submit(&mut self, _plan: &Plan) -> Result<(), Infallible> {
        self.lines.push("submit".to_owned());
        Ok(())
    }

    fn abandon(&mut self) {
        self.lines.push("abandon".to_owned());
    }
}

fn describe(memory: &Memory) -> String {
    match &memory.kind {
        MemoryKind::Texture(shape, format) => format!(
            "texture {:?} {format} {}x{}x{}, {} layers, {} mips, {} samples",
            shape.dimension, shape.width, shape.height, shape.depth, shape.layers, shape.mips, shape.samples
        ),
        MemoryKind::Arena => format!("arena of {} bytes", memory.bytes),
    }
}

fn names(plan: &Plan, memory: &Memory) -> String {
    let names: Vec<&str> = memory.holders.iter().map(|holder| name(plan, *holder)).collect();
    names.join(", ")
}

fn name(plan: &Plan, resource: ResourceId) -> &str {
    &plan.resources[resource.index()].name
}

fn part(plan: &Plan, view: &PartView) -> String {
    let range = |range: &std::ops::Range<u32>| {
        if range.end == range.start + 1 { range.start.to_string() } else { format!("{}..{}", range.start, range.end) }
    };
    format!("{}.mip({}).layer({})", name(plan, view.resource), range(&view.mips), range(&view.layers))
}

fn value_text(value: &ClearValue) -> String {
    match value {
        ClearValue::Zero => "zero".to_owned(),
        ClearValue::Color([r, g, b, a]) => format!("({r}, {g}, {b}, {a})"),
        ClearValue::Depth(depth) => format!("depth {depth}"),
        ClearValue::Uint([r, g, b, a]) => format!("uint ({r}, {g}, {b}, {a})"),
    }
}
