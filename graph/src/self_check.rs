//! Recomputes what a plan claims, from the plan alone and in the simplest way.
//!
//! Nothing here is shared with the planner but the plan's types and the byte counts of formats: a fault of the planner must not
//! hide itself. Slow by intent, texel rectangles are walked mip by mip and layer by layer.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::allocate::extent::{ARENA_ALIGNMENT, texture_bytes};
use crate::expand::types::PassId;
use crate::place::{Alignment, HeapPlan};
use crate::plan::{Access, MemoryKind, Plan, PlannedShape, Role, Step, Use};

impl Plan {
    /// Every fault found, as a sentence; empty for a sound plan. Checks that indices are within their lists, lifetimes, that no two
    /// resources have a byte at the same time, that each fits and is allowed in its memory, the order of producers, modifiers
    /// and readers, and the figures.
    pub fn self_check(&self) -> Vec<String> {
        let mut faults = indices(self);
        // Without sound indices nothing else can be looked up.
        if faults.is_empty() {
            faults.extend(lifetimes(self));
            faults.extend(memory(self));
            faults.extend(access(self));
            faults.extend(order(self));
            faults.extend(figures(self));
        }
        faults
    }

    /// The same for a placement of this plan's resources: an order that keeps producers, modifiers and readers apart, no byte in use
    /// twice at a time, everything transient in the heap at its alignment, and the bound.
    pub fn check_placed(&self, placed: &HeapPlan, alignment: Alignment) -> Vec<String> {
        heap(self, placed, alignment)
    }
}

fn indices(plan: &Plan) -> Vec<String> {
    let mut faults = Vec::new();
    let resources = plan.resources.len();
    for step in &plan.steps {
        let named = step.uses.iter().map(|used| used.resource).chain(step.clears.iter().map(|(part, _)| part.resource));
        faults.extend(named.filter(|id| id.index() >= resources).map(|id| format!("`{}` uses resource {id:?}", step.name)));
        if step.shader.is_some_and(|shader| shader >= plan.shaders.len()) {
            faults.push(format!("`{}` has no such shader", step.name));
        }
    }
    for resource in &plan.resources {
        if resource.placement.is_some_and(|placement| placement.memory.index() >= plan.memories.len()) {
            faults.push(format!("`{}` lives in no memory", resource.name));
        }
    }
    let holders = plan.memories.iter().flat_map(|memory| &memory.holders);
    faults.extend(holders.filter(|id| id.index() >= resources).map(|id| format!("a memory holds resource {id:?}")));
    let outputs = plan.outputs.iter().filter(|output| output.view.resource.index() >= resources);
    faults.extend(outputs.map(|output| format!("output `{}` has no resource", output.name)));
    let mut passes: Vec<PassId> = plan.steps.iter().map(|step| step.pass).chain(plan.culled.iter().map(|culled| culled.pass)).collect();
    passes.sort_unstable();
    faults.extend(passes.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| format!("pass {:?} stands twice", pair[0])));
    faults
}

fn lifetimes(plan: &Plan) -> Vec<String> {
    let mut found: Vec<Range<usize>> = vec![0..0; plan.resources.len()];
    for (place, step) in plan.steps.iter().enumerate() {
        let named = step.uses.iter().map(|used| used.resource).chain(step.clears.iter().map(|(part, _)| part.resource));
        for id in named {
            let range = &mut found[id.index()];
            let start = if Range::is_empty(range) { place } else { range.start };
            *range = start..place + 1;
        }
    }
    let wrong = plan.resources.iter().zip(&found).filter(|(resource, found)| {
        // What outputs show without a pass is filled after the last step.
        if found.is_empty() && resource.retained.is_some() {
            return false;
        }
        let same = if found.is_empty() { resource.lifetime.is_empty() } else { resource.lifetime == **found };
        !same || resource.placement.is_some() == found.is_empty()
    });
    wrong.map(|(resource, found)| format!("`{}` is used in {found:?}, planned {:?}", resource.name, resource.lifetime)).collect()
}

fn bytes_of(shape: &PlannedShape) -> Option<u64> {
    match shape {
        PlannedShape::Texture(shape, format) => texture_bytes(shape, *format),
        PlannedShape::Buffer(bytes) => Some(*bytes),
    }
}

fn memory(plan: &Plan) -> Vec<String> {
    let mut faults = Vec::new();
    for (index, memory) in plan.memories.iter().enumerate() {
        // By first use, so that only those still in use need to be compared.
        let mut placed = Vec::new();
        for id in &memory.holders {
            let resource = &plan.resources[id.index()];
            let name = &resource.name;
            let Some(placement) = resource.placement.filter(|placement| placement.memory.index() == index) else {
                faults.push(format!("memory {index} holds `{name}`, which lives elsewhere"));
                continue;
            };
            if bytes_of(&resource.shape) != Some(resource.bytes) {
                faults.push(format!("`{name}` does not have {} bytes", resource.bytes));
            }
            let end = placement.offset.saturating_add(resource.bytes);
            let fits = match (&resource.shape, &memory.kind) {
                (PlannedShape::Texture(a, format), MemoryKind::Texture(b, held)) => {
                    let same_edges = (a.width, a.height, a.depth, a.dimension) == (b.width, b.height, b.depth, b.dimension);
                    format == held && same_edges && (a.layers, a.mips, a.samples) == (b.layers, b.mips, b.samples) && end == memory.bytes
                }
                (PlannedShape::Buffer(_), MemoryKind::Arena) => placement.offset % ARENA_ALIGNMENT == 0 && end <= memory.bytes,
                _ => false,
            };
            if !fits || memory.usage.union(resource.usage) != memory.usage {
                faults.push(format!("`{name}` does not fit in memory {index}"));
            }
            if resource.retained.is_some() && memory.holders.len() > 1 {
                faults.push(format!("`{name}` is retained and shares memory {index}"));
            }
            placed.push((resource.lifetime.clone(), placement.offset..end, name));
        }
        placed.sort_by_key(|(steps, bytes, _)| (steps.start, bytes.start));
        let mut active: Vec<&(Range<usize>, Range<u64>, &String)> = Vec::new();
        for entry in &placed {
            active.retain(|other| other.0.end > entry.0.start);
            let clashes = active.iter().filter(|other| other.1.start < entry.1.end && entry.1.start < other.1.end);
            faults.extend(clashes.map(|other| format!("`{}` and `{}` have the same bytes at once", other.2, entry.2)));
            active.push(entry);
        }
    }
    let held: usize = plan.memories.iter().map(|memory| memory.holders.len()).sum();
    if held != plan.resources.iter().filter(|resource| resource.placement.is_some()).count() {
        faults.push("a resource that lives in a memory is not among its holders".to_owned());
    }
    faults
}

/// Two buffers in one arena that a step uses with different access.
fn access(plan: &Plan) -> Vec<String> {
    let mut faults = Vec::new();
    let kind = |access: Access| match access {
        Access::StorageReadWrite => Access::StorageWrite,
        Access::Clear => Access::CopyTarget,
        other => other,
    };
    for step in &plan.steps {
        let mut seen: BTreeMap<usize, &Use> = BTreeMap::new();
        for used in &step.uses {
            let Some(placement) = plan.resources[used.resource.index()].placement else { continue };
            if plan.is_texture(placement.memory.index()) {
                continue;
            }
            let first = seen.entry(placement.memory.index()).or_insert(used);
            if first.resource != used.resource && kind(first.access) != kind(used.access) {
                faults.push(format!("`{}` uses one arena as {:?} and {:?}", step.name, first.access, used.access));
            }
        }
    }
    faults
}

fn texels(used: &Use) -> impl Iterator<Item = (u32, u32)> + use<> {
    let layers = used.layers.clone();
    used.mips.clone().flat_map(move |mip| layers.clone().map(move |layer| (mip, layer)))
}

/// What has happened to a mip level of a layer.
#[derive(Default)]
struct Content {
    filled: bool,
    produced: bool,
    last: Option<PassId>,
    last_modifier: Option<PassId>,
    /// Somebody saw it as the final value.
    final_seen: bool,
}

/// Parts that nothing makes hold the declared value, which is set whenever it is not held.
fn declared(plan: &Plan) -> BTreeMap<(u32, u32, u32), Content> {
    let uses = || plan.steps.iter().flat_map(|step| &step.uses);
    let made: BTreeSet<(u32, u32, u32)> = uses()
        .filter(|used| used.role == Role::Produce)
        .flat_map(|used| texels(used).map(|(mip, layer)| (used.resource.0, mip, layer)))
        .collect();
    let shown = plan.outputs.iter().map(|output| (output.view.resource, output.view.mips.clone(), output.view.layers.clone()));
    let named = uses().map(|used| (used.resource, used.mips.clone(), used.layers.clone())).chain(shown);
    let mut contents = BTreeMap::new();
    for (resource, mips, layers) in named.filter(|(resource, ..)| plan.resources[resource.index()].clear.is_some()) {
        for cell in mips.flat_map(|mip| layers.clone().map(move |layer| (resource.0, mip, layer))).filter(|cell| !made.contains(cell)) {
            contents.insert(cell, Content { filled: true, ..Content::default() });
        }
    }
    contents
}

fn order(plan: &Plan) -> Vec<String> {
    let mut faults = Vec::new();
    let mut contents: BTreeMap<(u32, u32, u32), Content> = declared(plan);
    for step in &plan.steps {
        for (part, _) in &step.clears {
            for mip in part.mips.clone() {
                for layer in part.layers.clone() {
                    contents.entry((part.resource.0, mip, layer)).or_default().filled = true;
                }
            }
        }
        for read in step.uses.iter().filter(|used| used.role == Role::Read) {
            for (mip, layer) in texels(read) {
                let content = contents.entry((read.resource.0, mip, layer)).or_default();
                if !content.filled || read.version.is_some_and(|version| content.last != Some(version)) {
                    faults.push(fault(plan, step, read, "reads what is not there"));
                }
                content.final_seen |= read.version.is_none();
            }
        }
        for write in step.uses.iter().filter(|used| crate::schedule::writes(used.role)) {
            for (mip, layer) in texels(write) {
                let content = contents.entry((write.resource.0, mip, layer)).or_default();
                let modifies = write.role == Role::Modify;
                let early = modifies && !content.filled;
                let late = !modifies && (content.produced || content.last.is_some());
                let unordered = modifies && content.last_modifier > Some(step.pass);
                if early || late || unordered || content.final_seen {
                    faults.push(fault(plan, step, write, "writes at the wrong time"));
                }
                content.filled = true;
                content.produced |= !modifies;
                content.last = Some(step.pass);
                content.last_modifier = if modifies { content.last } else { content.last_modifier };
            }
        }
    }
    for output in &plan.outputs {
        let view = &output.view;
        let mut texels = view.mips.clone().flat_map(|mip| view.layers.clone().map(move |layer| (mip, layer)));
        if !texels.all(|(mip, layer)| contents.get(&(view.resource.0, mip, layer)).is_some_and(|content| content.filled)) {
            faults.push(format!("output `{}` is not filled", output.name));
        }
    }
    faults
}

fn fault(plan: &Plan, step: &Step, used: &Use, what: &str) -> String {
    format!("`{}` {what}: `{}` mips {:?} layers {:?}", step.name, plan.resources[used.resource.index()].name, used.mips, used.layers)
}

fn figures(plan: &Plan) -> Vec<String> {
    let mut faults = Vec::new();
    let mut without_sharing = 0u64;
    let mut live = vec![0u64; plan.steps.len()];
    let (mut reached, mut retained) = (0u64, 0u64);
    for memory in &plan.memories {
        let is_retained = memory.holders.iter().any(|id| plan.resources[id.index()].retained.is_some());
        let sum = if is_retained { &mut retained } else { &mut reached };
        *sum = sum.saturating_add(memory.bytes);
    }
    for resource in plan.resources.iter().filter(|resource| resource.placement.is_some() && resource.retained.is_none()) {
        let bytes = match resource.shape {
            PlannedShape::Texture(..) => resource.bytes,
            PlannedShape::Buffer(bytes) => bytes.div_ceil(ARENA_ALIGNMENT) * ARENA_ALIGNMENT,
        };
        without_sharing = without_sharing.saturating_add(bytes);
        for step in live.get_mut(resource.lifetime.clone()).into_iter().flatten() {
            *step = step.saturating_add(bytes);
        }
    }
    let bound = live.into_iter().max().unwrap_or(0);
    let found = [without_sharing, reached, bound, retained];
    let claimed = [plan.figures.without_sharing, plan.figures.reached, plan.figures.bound, plan.figures.retained];
    if found != claimed {
        faults.push(format!("figures are {found:?}, claimed {claimed:?}"));
    }
    let figures = &plan.figures;
    if figures.bound > figures.reached || figures.reached > figures.without_sharing {
        faults.push(format!("figures contradict each other: {figures:?}"));
    }
    faults
}

/// Every fault of a placement, from the plan's steps and shapes alone.
fn heap(plan: &Plan, heap: &HeapPlan, alignment: Alignment) -> Vec<String> {
    let place = |pass: &PassId| heap.order.iter().position(|other| other == pass);
    let mut places: Vec<Option<usize>> = plan.steps.iter().map(|step| place(&step.pass)).collect();
    places.sort_unstable();
    if heap.order.len() != plan.steps.len() || places.iter().enumerate().any(|(index, place)| *place != Some(index)) {
        return vec!["the placed order is not one of the steps".to_owned()];
    }
    let mut reordered = plan.clone();
    reordered.steps.sort_by_key(|step| place(&step.pass));
    // What is cleared is cleared by whatever step comes first.
    let clears: Vec<_> = reordered.steps.iter_mut().flat_map(|step| std::mem::take(&mut step.clears)).collect();
    for clear in clears {
        let names = |step: &&mut Step| step.uses.iter().any(|used| used.resource == clear.0.resource);
        let first = reordered.steps.iter_mut().find(names);
        match first {
            Some(step) => step.clears.push(clear),
            None => reordered.steps.iter_mut().take(1).for_each(|step| step.clears.push(clear.clone())),
        }
    }
    let mut faults = order(&reordered);

    let mut spans: BTreeMap<u32, Range<usize>> = BTreeMap::new();
    for (place, step) in reordered.steps.iter().enumerate() {
        for used in step.uses.iter().filter(|used| plan.resources[used.resource.index()].retained.is_none()) {
            spans.entry(used.resource.0).or_insert(place..place).end = place + 1;
        }
    }
    let offsets: BTreeMap<u32, u64> = heap.offsets.iter().map(|(resource, offset)| (resource.0, *offset)).collect();
    if offsets.len() != heap.offsets.len() || !offsets.keys().eq(spans.keys()) {
        faults.push("what is placed is not what is transient".to_owned());
        return faults;
    }
    let mut live = vec![0u64; plan.steps.len()];
    let mut placed: Vec<(Range<usize>, Range<u64>)> = Vec::new();
    for ((resource, span), offset) in spans.into_iter().zip(offsets.into_values()) {
        let resource = &plan.resources[resource as usize];
        let unit = if matches!(resource.shape, PlannedShape::Buffer(_)) { alignment.buffer } else { alignment.texture };
        let bytes = resource.bytes.div_ceil(unit).saturating_mul(unit);
        if offset % unit != 0 || offset.saturating_add(bytes) > heap.bytes {
            faults.push(format!("`{}` does not fit at byte {offset} of {}", resource.name, heap.bytes));
        }
        live[span.clone()].iter_mut().for_each(|live| *live = live.saturating_add(bytes));
        placed.push((span, offset..offset.saturating_add(bytes)));
    }
    for (index, (span, bytes)) in placed.iter().enumerate() {
        let met = |other: &&(Range<usize>, Range<u64>)| {
            other.0.start < span.end && span.start < other.0.end && other.1.start < bytes.end && bytes.start < other.1.end
        };
        faults.extend(placed[..index].iter().find(met).map(|other| format!("bytes {bytes:?} are in use twice: {span:?} and {other:?}")));
    }
    let bound = live.into_iter().max().unwrap_or(0);
    if bound != heap.bound || bound > heap.bytes {
        faults.push(format!("the bound is {bound}, claimed {} of {} bytes", heap.bound, heap.bytes));
    }
    faults
}
