//! Checks against a device's limits and the memory budget, before anything is created.

use std::cmp::Reverse;

use super::Allocation;
use super::model::Model;
use crate::bind::types::Bound;
use crate::device::DeviceFacts;
use crate::diagnostic::Diagnostic;
use crate::dump::units::bytes as human;
use crate::expand::types::{Dimension, Resource, Shape};
use crate::lifetime::Lifetimes;
use crate::plan::Usage;

/// How many resources a message about the budget lists.
const LISTED: usize = 8;

/// Extents of every resource in use.
pub(crate) fn resources(bound: &Bound, model: &Model, lifetimes: &Lifetimes, usages: &[Usage], device: &DeviceFacts) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for (index, resource) in bound.expanded.resources.iter().enumerate() {
        if lifetimes.ranges[index].is_empty() {
            continue;
        }
        match model.tight[index] {
            None => found.push(
                Diagnostic::error("allocate::too-large", format!("`{}` is larger than 64 bits can count", resource.name))
                    .at(resource.span, "declared here")
                    .hint("make it smaller"),
            ),
            Some(bytes) => extent(resource, bytes, usages[index], device, &mut found),
        }
    }
    found
}

fn extent(resource: &Resource, bytes: u64, usage: Usage, device: &DeviceFacts, found: &mut Vec<Diagnostic>) {
    let mut over = |code: &'static str, what: &str, has: u64, limit: u64, unit: &str| {
        if has > limit {
            let message = format!("`{}` has {has} {unit}{what}; {} allows {limit}", resource.name, device.name);
            found.push(Diagnostic::error(code, message).at(resource.span, "declared here").hint("make it smaller, or split it"));
        }
    };
    match &resource.shape {
        Shape::Texture(shape) => {
            let edge = u64::from(shape.width.max(shape.height).max(shape.depth));
            let (limit, what) = match shape.dimension {
                Dimension::D1 => (device.max_texture_1d, " along a 1D texture"),
                Dimension::D2 => (device.max_texture_2d, " along an edge"),
                Dimension::Cube => (device.max_texture_2d, " along an edge of a cube"),
                Dimension::D3 => (device.max_texture_3d, " along an edge of a volume"),
            };
            over("allocate::texture-too-large", what, edge, u64::from(limit), "texels");
            over("allocate::too-many-layers", "", u64::from(shape.layers), u64::from(device.max_layers), "layers");
        }
        Shape::Buffer { .. } => {
            over("allocate::buffer-too-large", "", bytes, device.max_buffer_bytes, "bytes");
            if usage.storage {
                over("allocate::binding-too-large", " bound as storage", bytes, device.max_storage_binding_bytes, "bytes");
            }
            if usage.uniform {
                over("allocate::binding-too-large", " bound as a uniform", bytes, device.max_uniform_binding_bytes, "bytes");
            }
        }
    }
}

/// The sum of all memories.
pub(crate) fn budget(bound: &Bound, allocation: &Allocation, device: &DeviceFacts) -> Option<Diagnostic> {
    let figures = &allocation.figures;
    let total = figures.reached.saturating_add(figures.retained);
    if total <= device.memory_budget {
        return None;
    }
    let mut largest: Vec<usize> = (0..allocation.bytes.len()).filter(|index| allocation.placements[*index].is_some()).collect();
    largest.sort_by_key(|index| (Reverse(allocation.bytes[*index]), *index));
    let mut diagnostic = Diagnostic::error(
        "allocate::over-budget",
        format!("the pipeline needs {} of memory; the budget is {}", human(total), human(device.memory_budget)),
    )
    .note(format!("{} for outputs, {} for everything else after sharing", human(figures.retained), human(figures.reached)));
    for (rank, index) in largest.iter().take(LISTED).enumerate() {
        let resource = &bound.expanded.resources[*index];
        let size = human(allocation.bytes[*index]);
        diagnostic = if rank == 0 {
            diagnostic.at(resource.span, format!("the largest: {size}"))
        } else {
            diagnostic.and(resource.span, size.clone())
        };
        diagnostic = diagnostic.note(format!("`{}`: {size} ({} bytes)", resource.name, allocation.bytes[*index]));
    }
    Some(diagnostic.hint("lower a size, use a smaller format, or raise the budget"))
}
