//! Memory: which texture or which bytes of an arena each resource gets, and what it all comes to.
//!
//! Textures are reused whole where their descriptors cover each other, buffers are sub-ranges of arenas, and outputs share with
//! nothing. Limits and the budget are checked here, so that whatever passes can be created. What the figures can't show is a
//! driver's own rounding of texture sizes: safe wgpu does not tell it.

pub(crate) mod arenas;
pub mod extent;
pub(crate) mod figures;
mod limits;
pub(crate) mod model;
mod refusals;
pub(crate) mod strip;
pub(crate) mod textures;

use crate::bind::types::Bound;
use crate::device::DeviceFacts;
use crate::diagnostic::Diagnostic;
use crate::expand::types::{Dimension, ResourceId, Shape};
use crate::lifetime::Lifetimes;
use crate::plan::{Alone, Memory, MemoryFigures, MemoryId, MemoryKind, PartView, Placement, Retained, StepKind, Usage};
use crate::schedule::Schedule;
use extent::format_of;
use model::Pool;

/// Where everything lives. All lists but `memories` are by resource id.
#[derive(Debug, Clone, PartialEq)]
pub struct Allocation {
    /// What is to be created: transient textures, then arenas, then the memories of retained resources.
    pub memories: Vec<Memory>,
    /// Where each resource lives; `None` if no step uses it.
    pub placements: Vec<Option<Placement>>,
    /// Tight bytes of each resource.
    pub bytes: Vec<u64>,
    /// All that is done to each resource.
    pub usages: Vec<Usage>,
    /// Why no other resource has its bytes at another time, if so.
    pub alone: Vec<Option<Alone>>,
    /// The sums.
    pub figures: MemoryFigures,
}

/// Assigns memory to every resource that a scheduled pass uses. Fails, with all reasons, where a limit or the budget is exceeded.
pub fn allocate(bound: &Bound, schedule: &Schedule, lifetimes: &Lifetimes, device: &DeviceFacts) -> Result<Allocation, Vec<Diagnostic>> {
    let usages = usages(bound, schedule, &lifetimes.retained);
    let problems = limits::resources(bound, &schedule.model, lifetimes, &usages, device);
    if !problems.is_empty() {
        return Err(problems);
    }
    let allocation = place(bound, schedule, lifetimes, usages, device);
    match limits::budget(bound, &allocation, device) {
        Some(problem) => Err(vec![problem]),
        None => Ok(allocation),
    }
}

fn place(bound: &Bound, schedule: &Schedule, lifetimes: &Lifetimes, usages: Vec<Usage>, device: &DeviceFacts) -> Allocation {
    let model = &schedule.model;
    let resources = &bound.expanded.resources;
    let ranges = &lifetimes.ranges;
    let texture_kind = |index: usize| match (&resources[index].shape, format_of(bound, ResourceId(index as u32))) {
        (Shape::Texture(shape), Some(format)) => MemoryKind::Texture(shape.clone(), format),
        _ => MemoryKind::Arena,
    };
    let mut memories: Vec<Memory> = Vec::new();
    let mut placements: Vec<Option<Placement>> = vec![None; resources.len()];
    let timeline = textures::Timeline::new(model, ranges);
    for textures::Slot { usage, holders } in textures::assign(model, &timeline, &usages) {
        let Some(first) = holders.first().map(|resource| resource.index()) else { continue };
        let memory = MemoryId(memories.len() as u32);
        for holder in &holders {
            placements[holder.index()] = Some(Placement { memory, offset: 0 });
        }
        memories.push(Memory { kind: texture_kind(first), usage, bytes: model.charged[first], holders });
    }
    let buffers = (0..resources.len())
        .filter(|index| model.pools[*index] == Pool::Buffer && model.is_transient(*index) && !ranges[*index].is_empty());
    let buffers = buffers.map(|index| (index as u32, ranges[index].clone()));
    for mut arena in arenas::pack(model, buffers, arenas::ARENA_LIMIT.min(device.max_buffer_bytes)) {
        let memory = MemoryId(memories.len() as u32);
        arena.holders.sort_by_key(|(resource, offset)| (ranges[*resource as usize].start, *offset, *resource));
        let mut usage = Usage::default();
        for (resource, offset) in &arena.holders {
            usage = usage.union(usages[*resource as usize]);
            placements[*resource as usize] = Some(Placement { memory, offset: *offset });
        }
        let holders = arena.holders.iter().map(|(resource, _)| ResourceId(*resource)).collect();
        memories.push(Memory { kind: MemoryKind::Arena, usage, bytes: arena.bytes(), holders });
    }
    let transient_memories = memories.len();
    for index in (0..resources.len()).filter(|index| model.retained[*index] && !ranges[*index].is_empty()) {
        placements[index] = Some(Placement { memory: MemoryId(memories.len() as u32), offset: 0 });
        let holders = vec![ResourceId(index as u32)];
        memories.push(Memory { kind: texture_kind(index), usage: usages[index], bytes: model.charged[index], holders });
    }
    let sum = |memories: &[Memory]| memories.iter().fold(0u64, |sum, memory| sum.saturating_add(memory.bytes));
    let figures = MemoryFigures {
        without_sharing: figures::without_sharing(model, ranges),
        reached: sum(&memories[..transient_memories]),
        bound: figures::peak(model, ranges),
        retained: sum(&memories[transient_memories..]),
    };
    let alone = refusals::refusals(model, lifetimes, &timeline, &memories, &placements);
    // Resources in use were checked; others only show their size.
    let bytes = model.tight.iter().map(|bytes| bytes.unwrap_or(u64::MAX));
    Allocation { memories, placements, bytes: bytes.collect(), usages, alone, figures }
}

/// What the steps that run do to each resource, clears and the reading of outputs by the host included.
fn usages(bound: &Bound, schedule: &Schedule, retained: &[Option<Retained>]) -> Vec<Usage> {
    let mut usages = schedule.model.usages.clone();
    let mut add = |resource: ResourceId, usage: Usage| {
        if let Some(entry) = usages.get_mut(resource.index()) {
            *entry = entry.union(usage);
        }
    };
    let clear = |part: &PartView| clear_usage(bound, part.resource);
    // In the order of the file, in which steps lie in memory.
    for pass in &schedule.declared {
        let step = &bound.steps[pass.index()];
        match &step.kind {
            StepKind::Clear { target, .. } => add(target.resource, clear(target)),
            // Its first value.
            StepKind::Remember { target, .. } => add(target.resource, clear(target)),
            _ => {}
        }
        for (part, _) in &step.clears {
            add(part.resource, clear(part));
        }
    }
    for initial in &schedule.initial_clears {
        add(initial.part.resource, clear(&initial.part));
    }
    // What keeps its content keeps it under plans that ask for more, as long as its memory can do what they ask for.
    for (index, resource) in bound.expanded.resources.iter().enumerate().filter(|(index, _)| retained[*index].is_some()) {
        let texture = matches!(resource.shape, Shape::Texture(_));
        let usage = Usage { sampled: texture, copy_source: true, copy_target: !texture, ..Usage::default() };
        add(ResourceId(index as u32), usage);
    }
    for output in &bound.expanded.outputs {
        // The host reads outputs back, and a viewer samples them.
        let texture = bound.expanded.resources.get(output.part.resource.index()).is_some_and(|it| matches!(it.shape, Shape::Texture(_)));
        add(output.part.resource, Usage { copy_source: true, sampled: texture, ..Usage::default() });
    }
    usages
}

/// Attachments are cleared as such, everything else by a copy.
fn clear_usage(bound: &Bound, resource: ResourceId) -> Usage {
    let shape = bound.expanded.resources.get(resource.index()).map(|resource| &resource.shape);
    let attachment = match (shape, format_of(bound, resource)) {
        (Some(Shape::Texture(shape)), Some(format)) => shape.dimension != Dimension::D1 && (format.is_depth() || format.info().renderable),
        _ => false,
    };
    Usage { attachment, copy_target: !attachment, ..Usage::default() }
}
