//! From one plan to the next: what stays held.
//!
//! A memory is taken over where it holds content of a resource that has the same name, place and shape in the new plan, and the new
//! plan asks for nothing that it can't do. A pass that is the same in both plans and reads what the same passes make keeps what it
//! last ran on; everything else is new.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use super::Remembered;
use super::flow::Flow;
use super::maker::{Names, input_places};
use super::tracker::{Tracker, Turn};
use crate::expand::types::{OnResize, ResourceId, Run};
use crate::plan::{MemoryId, MemoryKind, Plan, PlannedShape};

/// What a new plan takes over.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Adoption {
    /// By memory of the new plan: the memory of the old plan that it is.
    pub memories: Vec<Option<MemoryId>>,
    /// Content of the frame before that is remembered, and whose memory is not taken over.
    pub carried: Vec<Carry>,
}

/// Content that a backend keeps until a frame is submitted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Carry {
    /// The resource's name.
    pub name: String,
    /// The resource in the old plan; `None` where the backend carries it already.
    pub from: Option<ResourceId>,
}

/// A node that means the same in all plans: its step's name, and its place in a batch.
type Key = (u32, Option<u32>);

/// What a node reads and modifies, by who made it.
type Signature = Vec<Vec<Key>>;

impl Tracker {
    /// Turns to another plan. The backend moves the memories as it is told.
    pub fn adopt(&mut self, plan: Arc<Plan>) -> Adoption {
        let mut new = Tracker { frames: self.frames, ..Tracker::new(plan) };
        let resources = self.resources_in(&new);
        let memories = self.memories_in(&mut new, &resources);
        let (named, nodes) = self.nodes_in(&new);
        self.find_remade(&mut new, &resources);
        self.keep_pieces(&mut new, &resources, &memories, &named);
        self.keep_states(&mut new, &named, &nodes);
        let carried = self.keep_past(&mut new, &resources, &memories);
        new.find_unheld();
        new.start_unheld_anew();
        *self = new;
        Adoption { memories, carried }
    }

    /// By resource of the new plan: the one of the same name in the old.
    fn resources_in(&self, new: &Tracker) -> Vec<Option<ResourceId>> {
        let by_name: HashMap<&str, usize> =
            self.plan.resources.iter().enumerate().map(|(index, resource)| (resource.name.as_str(), index)).collect();
        let old = new.plan.resources.iter().map(|resource| by_name.get(resource.name.as_str()).map(|index| ResourceId(*index as u32)));
        old.collect()
    }

    /// Memories that are taken over, and who resides in them.
    fn memories_in(&self, new: &mut Tracker, resources: &[Option<ResourceId>]) -> Vec<Option<MemoryId>> {
        let mut taken = vec![None; new.plan.memories.len()];
        let mut used = vec![false; self.plan.memories.len()];
        for (index, entry) in taken.iter_mut().enumerate() {
            let memory = &new.plan.memories[index];
            let stays = |id: &ResourceId| -> Option<MemoryId> {
                let old = resources[id.index()]?;
                let (before, after) = (&self.plan.resources[old.index()], &new.plan.resources[id.index()]);
                let (from, to) = (before.placement?, after.placement?);
                let resides = self.held.residents[from.memory.index()].contains(&old);
                (resides && from.offset == to.offset && same_shape(&before.shape, &after.shape)).then_some(from.memory)
            };
            let fits = |old: &MemoryId| {
                let before = &self.plan.memories[old.index()];
                let same = match (&before.kind, &memory.kind) {
                    (MemoryKind::Arena, MemoryKind::Arena) => before.bytes == memory.bytes,
                    // The residents have the same shape.
                    (MemoryKind::Texture(..), MemoryKind::Texture(..)) => true,
                    _ => false,
                };
                same && before.usage.union(memory.usage) == before.usage && !used[old.index()]
            };
            *entry = memory.holders.iter().filter_map(stays).find(fits);
            let Some(old) = *entry else { continue };
            used[old.index()] = true;
            new.held.residents[index] = memory.holders.iter().copied().filter(|id| stays(id) == Some(old)).collect();
        }
        taken
    }

    /// By node of the new plan: the old one of its name, and the same if it is made and reads the same.
    fn nodes_in(&self, new: &Tracker) -> (Vec<Option<u32>>, Vec<Option<u32>>) {
        let names = &mut Names::default();
        let (old_resources, new_resources) = (names.resources(&self.plan), names.resources(&new.plan));
        let old_keys: Vec<Key> = keys(&self.flow, &self.plan, names);
        let new_keys: Vec<Key> = keys(&new.flow, &new.plan, names);
        let by_key: HashMap<Key, u32> = (0u32..).zip(&old_keys).map(|(node, key)| (*key, node)).collect();
        let mut same_step: HashMap<(usize, usize), bool> = HashMap::new();
        let named: Vec<Option<u32>> = new_keys.iter().map(|key| by_key.get(key).copied()).collect();
        let mut found = Vec::with_capacity(named.len());
        for (node, old) in named.iter().enumerate() {
            let counterpart = old.filter(|old| {
                let steps = (self.flow.nodes[*old as usize].step as usize, new.flow.nodes[node].step as usize);
                let same = *same_step
                    .entry(steps)
                    .or_insert_with(|| names.maker(&self.plan, &old_resources, steps.0) == names.maker(&new.plan, &new_resources, steps.1));
                same && signature(&self.flow, &old_keys, *old) == signature(&new.flow, &new_keys, node as u32)
            });
            found.push(counterpart);
        }
        (named, found)
    }

    /// Remembered resources whose last values others leave than before: they change without anybody being due.
    fn find_remade(&self, new: &mut Tracker, resources: &[Option<ResourceId>]) {
        let keys = |tracker: &Tracker, source: u32| {
            let source = &tracker.flow.sources[source as usize];
            let name = |node: &u32| {
                let node = tracker.flow.nodes[*node as usize];
                (tracker.plan.steps[node.step as usize].name.clone(), node.iteration)
            };
            let mut makers: Vec<_> = source.makers.iter().map(name).collect();
            makers.sort_unstable();
            (makers, source.unmade)
        };
        for (resource, source) in &new.flow.recalled {
            let old = resources.get(*resource as usize).copied().flatten();
            let before = old.and_then(|old| Some((old, *self.flow.recalled.get(&old.0)?)));
            let remade = before.is_some_and(|(old, before)| self.remade.contains(&old) || keys(self, before) != keys(new, *source));
            if remade {
                new.remade.insert(ResourceId(*resource));
            }
        }
    }

    /// Pieces that are still what the same nodes left.
    fn keep_pieces(&self, new: &mut Tracker, resources: &[Option<ResourceId>], memories: &[Option<MemoryId>], named: &[Option<u32>]) {
        let stays = |new: &Tracker, resource: ResourceId| -> Option<ResourceId> {
            let placement = new.plan.resources[resource.index()].placement?;
            memories[placement.memory.index()]?;
            new.held.residents[placement.memory.index()].contains(&resource).then(|| resources[resource.index()]).flatten()
        };
        for piece in 0..new.flow.pieces.len() {
            let (piece_unit, piece_resource) = (new.flow.pieces[piece].unit, new.flow.pieces[piece].resource);
            // A changed pass runs again anyway; what matters is who wrote, whether or not in the same way.
            let writers: Vec<u32> =
                new.flow.units.of(piece_unit as usize).iter().copied().filter(|node| new.writes(*node, piece_resource)).collect();
            let old_unit = |node: &u32| named[*node as usize].map(|old| self.flow.unit_of[old as usize]);
            let Some(unit) = writers.first().and_then(old_unit) else { continue };
            let lost = self
                .flow
                .unit_pieces
                .of(unit as usize)
                .iter()
                .find(|old| resources[piece_resource.index()] == Some(self.flow.pieces[**old as usize].resource));
            if lost.is_some_and(|old| self.flow.is_amortised(unit) && !self.held.unseen.contains(old)) {
                new.held.unseen.remove(&(piece as u32));
            }
            let Some(old_resource) = stays(new, piece_resource) else { continue };
            let all_same = writers.iter().all(|node| old_unit(node) == Some(unit));
            let old = self.flow.unit_pieces.of(unit as usize).iter().find(|old| self.flow.pieces[**old as usize].resource == old_resource);
            let held = old.is_some_and(|old| {
                let count = |tracker: &Tracker, unit: u32, resource| {
                    tracker.flow.units.of(unit as usize).iter().filter(|node| tracker.writes(**node, resource)).count()
                };
                self.held.pieces[*old as usize]
                    && self.flow.pieces[*old as usize].rects == new.flow.pieces[piece].rects
                    && count(self, unit, old_resource) == count(new, piece_unit, piece_resource)
            });
            new.held.pieces[piece] = all_same && held;
        }
        for index in 0..new.plan.resources.len() {
            let Some(old) = stays(new, ResourceId(index as u32)) else { continue };
            new.held.declared[index] = self.held.declared[old.index()]
                && self.flow.unmade[old.index()] == new.flow.unmade[index]
                && self.plan.resources[old.index()].clear == new.plan.resources[index].clear;
        }
    }

    /// What nodes last ran on, and whose turn it is.
    fn keep_states(&self, new: &mut Tracker, named: &[Option<u32>], nodes: &[Option<u32>]) {
        let known = input_places(&self.plan.inputs);
        for (place, input) in new.plan.inputs.iter().enumerate() {
            new.seen[place] = known.get(input).and_then(|old| self.seen[*old]);
        }
        // Whoever waits goes on waiting, even for something else.
        let mut turns: BTreeMap<u32, Turn> = BTreeMap::new();
        for (node, old) in (0u32..).zip(named) {
            let before = old.and_then(|old| self.turns.get(&self.flow.unit_of[old as usize]));
            if let (Run::Spread { .. }, Some(turn)) = (new.flow.nodes[node as usize].run, before) {
                turns.insert(new.flow.unit_of[node as usize], *turn);
            }
        }
        for (node, old) in (0u32..).zip(nodes) {
            let Some(old) = old.filter(|old| !self.fresh.contains(old)) else { continue };
            new.fresh.remove(&node);
            if self.recalling.contains(&old) {
                new.recalling.insert(node);
            }
            if let Run::Accumulate(_) = new.flow.nodes[node as usize].run {
                new.gathered.insert(node, self.gathered.get(&old).copied().unwrap_or(0));
            }
        }
        for (unit, turn) in turns {
            new.turns.insert(unit, turn);
            if turn.remaining > 0 {
                new.waiting.insert(unit);
            }
        }
    }

    /// Where the values of the frame before are, for histories.
    fn keep_past(&self, new: &mut Tracker, resources: &[Option<ResourceId>], memories: &[Option<MemoryId>]) -> Vec<Carry> {
        let mut carried = Vec::new();
        let remembered: Vec<ResourceId> = new.past.keys().copied().collect();
        for resource in remembered {
            let planned = &new.plan.resources[resource.index()];
            let planned_name = planned.name.clone();
            let on_resize = Tracker::on_resize(&new.plan, resource);
            let serves = |shape: &PlannedShape| {
                same_shape(shape, &planned.shape) || (on_resize == OnResize::Crop && same_kind(shape, &planned.shape))
            };
            let old = resources[resource.index()].and_then(|old| Some((old, *self.past.get(&old)?)));
            let past = match old {
                Some((old, Remembered::Here)) => {
                    let before = &self.plan.resources[old.index()];
                    let moved = planned.placement.map(|placement| memories[placement.memory.index()]);
                    let stays = moved == Some(before.placement.map(|placement| placement.memory)) && before.placement.is_some();
                    if stays && same_shape(&before.shape, &planned.shape) {
                        Remembered::Here
                    } else if serves(&before.shape) && before.placement.is_some() {
                        carried.push(Carry { name: planned.name.clone(), from: Some(old) });
                        new.carried.insert(planned.name.clone(), before.shape.clone());
                        Remembered::Carried
                    } else {
                        Remembered::Gone
                    }
                }
                Some((_, Remembered::Carried)) => match self.carried.get(&planned.name).filter(|shape| serves(shape)) {
                    Some(shape) => {
                        carried.push(Carry { name: planned.name.clone(), from: None });
                        new.carried.insert(planned.name.clone(), shape.clone());
                        Remembered::Carried
                    }
                    None => Remembered::Gone,
                },
                _ => Remembered::Gone,
            };
            // What was there is there no more. What is carried has not changed.
            if old.is_some_and(|(old, _)| self.first.contains(&old)) {
                new.first.insert(resource);
            }
            // The overlap of another extent is not yet what the resource holds now.
            let shape = new.carried.get(&planned_name);
            if past == Remembered::Carried && shape.is_some_and(|shape| !same_shape(shape, &new.plan.resources[resource.index()].shape)) {
                new.remade.insert(resource);
            }
            new.past.insert(resource, past);
        }
        carried
    }
}

fn keys(flow: &Flow, plan: &Plan, names: &mut Names) -> Vec<Key> {
    flow.nodes.iter().map(|node| (names.of(format!("pass {}", plan.steps[node.step as usize].name)), node.iteration)).collect()
}

fn signature(flow: &Flow, keys: &[Key], node: u32) -> Signature {
    let sorted = |nodes: &[u32]| {
        let mut found: Vec<Key> = nodes.iter().map(|node| keys[*node as usize]).collect();
        found.sort_unstable();
        found
    };
    let mut found: Signature = flow
        .reads
        .of(node as usize)
        .iter()
        .map(|source| {
            let source = &flow.sources[*source as usize];
            let mut makers = sorted(&source.makers);
            // A declared value among them.
            makers.extend(source.unmade.then_some((u32::MAX, None)));
            makers
        })
        .collect();
    found.sort_unstable();
    found.push(sorted(flow.modifies(node)));
    found
}

fn same_shape(a: &PlannedShape, b: &PlannedShape) -> bool {
    match (a, b) {
        (PlannedShape::Texture(a, format), PlannedShape::Texture(b, other)) => {
            let key = |shape: &crate::expand::types::TextureShape| {
                (shape.dimension, shape.width, shape.height, shape.depth, shape.layers, shape.mips, shape.samples)
            };
            format == other && key(a) == key(b)
        }
        (PlannedShape::Buffer(a), PlannedShape::Buffer(b)) => a == b,
        _ => false,
    }
}

/// Whether texels or bytes of one can be copied into the other.
fn same_kind(a: &PlannedShape, b: &PlannedShape) -> bool {
    match (a, b) {
        (PlannedShape::Texture(a, format), PlannedShape::Texture(b, other)) => {
            format == other && a.dimension == b.dimension && a.samples == b.samples
        }
        (PlannedShape::Buffer(_), PlannedShape::Buffer(_)) => true,
        _ => false,
    }
}
