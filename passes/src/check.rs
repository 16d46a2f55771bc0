//! A plan against the device's limits and the memory budget, before anything is created.
//!
//! The planner has checked the same from the adapter's facts; this is the last line before wgpu, and it also counts what the
//! scene takes. Every problem names the resource.

use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::expand::types::{Dimension, TextureShape};
use luminaire_graph::plan::{Memory, MemoryKind, Plan};
use luminaire_graph::published::{PublishedScene, Table};

use crate::textures::holder_names;

/// Everything in the plan that this device can't hold.
pub(crate) fn check(plan: &Plan, scene: &PublishedScene, facts: &DeviceFacts) -> Vec<Diagnostic> {
    let mut problems: Vec<Diagnostic> = plan.memories.iter().filter_map(|memory| check_memory(plan, memory, facts)).collect();
    let scene_bytes = scene_bytes(scene);
    let total = plan.memories.iter().fold(scene_bytes, |sum, memory| sum.saturating_add(memory.bytes));
    if total > facts.memory_budget {
        let largest = plan.memories.iter().max_by_key(|memory| memory.bytes);
        let message =
            format!("`{}` takes {total} bytes ({scene_bytes} of them for the scene); the budget is {}", plan.name, facts.memory_budget);
        let mut problem = Diagnostic::error("execute::over-budget", message)
            .hint("render at a smaller size, lower the parameters that size its resources, or raise the budget");
        if let Some(largest) = largest {
            let names = holder_names(plan, largest);
            problem = problem.note(format!("the largest memory has {} bytes and holds {names}", largest.bytes));
        }
        problems.push(problem);
    }
    problems
}

fn check_memory(plan: &Plan, memory: &Memory, facts: &DeviceFacts) -> Option<Diagnostic> {
    let (what, size, limit) = match &memory.kind {
        MemoryKind::Arena => ("bytes", memory.bytes, facts.max_buffer_bytes),
        MemoryKind::Texture(shape, _) => largest_excess(shape, facts)?,
    };
    if size <= limit {
        return None;
    }
    let message = format!("resource {} has {size} {what}; `{}` takes {limit}", holder_names(plan, memory), facts.name);
    let mut problem = Diagnostic::error("execute::too-large", message);
    if let Some(holder) = memory.holders.first() {
        problem = problem.at(plan.resources[holder.index()].span, "too large for this device");
    }
    Some(problem)
}

/// What a texture has more of than the device takes.
fn largest_excess(shape: &TextureShape, facts: &DeviceFacts) -> Option<(&'static str, u64, u64)> {
    let edge = match shape.dimension {
        Dimension::D1 => facts.max_texture_1d,
        Dimension::D2 | Dimension::Cube => facts.max_texture_2d,
        Dimension::D3 => facts.max_texture_3d,
    };
    let longest = shape.width.max(shape.height).max(shape.depth);
    let sizes = [("texels along an edge", longest, edge), ("layers", shape.layers, facts.max_layers)];
    sizes.into_iter().find(|(_, size, limit)| size > limit).map(|(what, size, limit)| (what, u64::from(size), u64::from(limit)))
}

/// What the published scene takes on the device, near enough.
fn scene_bytes(scene: &PublishedScene) -> u64 {
    let tables = scene.tables.values().map(Table::len).chain(scene.views.iter().map(Vec::len));
    let textures = scene.materials.textures.iter().flat_map(|texture| texture.mips.iter().map(|mip| mip.len()));
    let rest = [scene.geometry.vertices.len(), scene.geometry.indices.len().saturating_mul(4)];
    tables.chain(textures).chain(rest).fold(0, |sum, bytes| sum.saturating_add(bytes as u64))
}
