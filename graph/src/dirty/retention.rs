//! Which resources keep their content from frame to frame, so that their readers can run without their makers.
//!
//! A pass's change set holds the outside inputs that reach it. Where a reader's is larger than its producer's, the reader can run
//! alone, and what it reads is retained; where they are equal they always run together, and it may share memory. Files count in no
//! change set, and parameters only if they are marked `live`. A poor choice costs time and never a wrong picture: a pass that is
//! due pulls what is not held.
//!
//! Where the pipeline states a budget, resources that cost least to make again for each byte give way first.

use std::collections::{BTreeMap, HashMap};

use super::flow::{Flow, FlowInput};
use crate::allocate::extent::{format_of, resource_bytes};
use crate::bind::types::Bound;
use crate::expand::types::{Keep, ResourceId, Run};
use crate::plan::{InputId, Retained, Step, StepKind};
use crate::schedule::part::Rect;

/// What is retained, and for the sake of which inputs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Retention {
    /// By resource.
    pub retained: Vec<Option<Retained>>,
    /// By resource: the inputs that reach a reader and not the maker.
    pub for_inputs: Vec<Vec<InputId>>,
}

/// Change sets as shared lists: many passes have the same.
struct ChangeSets {
    sets: Vec<Vec<u32>>,
    known: HashMap<Vec<u32>, u32>,
    unions: HashMap<(u32, u32), u32>,
}

impl ChangeSets {
    fn new() -> ChangeSets {
        ChangeSets { sets: vec![Vec::new()], known: [(Vec::new(), 0)].into_iter().collect(), unions: HashMap::new() }
    }

    fn intern(&mut self, set: Vec<u32>) -> u32 {
        if let Some(id) = self.known.get(&set) {
            return *id;
        }
        let id = self.sets.len() as u32;
        self.sets.push(set.clone());
        self.known.insert(set, id);
        id
    }

    fn union(&mut self, a: u32, b: u32) -> u32 {
        let key = (a.min(b), a.max(b));
        if a == b || key.0 == 0 {
            return key.1;
        }
        if let Some(id) = self.unions.get(&key) {
            return *id;
        }
        let mut both: Vec<u32> = self.sets[a as usize].iter().chain(&self.sets[b as usize]).copied().collect();
        both.sort_unstable();
        both.dedup();
        let id = self.intern(both);
        self.unions.insert(key, id);
        id
    }
}

/// Decides for what the asked-for outputs need.
pub fn retention(bound: &Bound) -> Retention {
    let steps: Vec<&Step> = bound.steps.iter().collect();
    let resources = &bound.expanded.resources;
    let outputs: Vec<(ResourceId, Rect)> = bound
        .expanded
        .outputs
        .iter()
        .map(|output| (output.part.resource, Rect::of_reference(&output.part, &resources[output.part.resource.index()].shape)))
        .collect();
    let flow = Flow::of(&FlowInput { steps: &steps, resources: resources.len(), inputs: bound.inputs.len(), outputs: &outputs });
    let alive = alive(&flow, &steps);
    let (sets, unit_sets) = change_sets(&flow, &steps, bound.inputs.len());
    let mut found = Retention { retained: vec![None; resources.len()], for_inputs: vec![Vec::new(); resources.len()] };
    let mut note = |resource: ResourceId, why: Retained| {
        let entry = &mut found.retained[resource.index()];
        *entry = Some(entry.map_or(why, |known| known.min(why)));
    };
    for (resource, _) in &outputs {
        note(*resource, Retained::Output);
    }
    for (index, resource) in resources.iter().enumerate() {
        let recallers = flow.recallers.of(index);
        if let Some(history) = resource.history
            && !flow.recallers.of(history.of.index()).is_empty()
        {
            note(ResourceId(index as u32), Retained::History);
        }
        if !recallers.is_empty() {
            note(ResourceId(index as u32), Retained::History);
        }
        if resource.keep == Keep::Always {
            note(ResourceId(index as u32), Retained::Kept);
        }
    }
    for piece in flow.pieces.iter().filter(|piece| alive[piece.unit as usize]) {
        if flow.is_amortised(piece.unit) {
            note(piece.resource, Retained::Amortised);
        }
    }
    let mut alone: BTreeMap<ResourceId, Vec<u32>> = BTreeMap::new();
    for (node, unit) in flow.unit_of.iter().enumerate().filter(|(_, unit)| alive[**unit as usize]) {
        let reader = unit_sets[*unit as usize];
        for source in flow.reads.of(node).iter().map(|source| &flow.sources[*source as usize]) {
            if flow.is_amortised(*unit) {
                note(source.resource, Retained::Amortised);
            }
            for piece in &source.pieces {
                let maker = flow.pieces[*piece as usize].unit;
                let maker_set = unit_sets[maker as usize];
                // An intermediate value is destroyed by its modifiers: keeping the resource would not help its reader.
                if maker != *unit && source.last && maker_set != reader {
                    let known = &sets.sets[maker_set as usize];
                    let more = sets.sets[reader as usize].iter().filter(|input| known.binary_search(input).is_err());
                    alone.entry(source.resource).or_default().extend(more);
                }
            }
        }
    }
    for (resource, mut inputs) in alone {
        inputs.sort_unstable();
        inputs.dedup();
        if inputs.is_empty() || resources[resource.index()].keep == Keep::Never {
            continue;
        }
        note(resource, Retained::Read);
        found.for_inputs[resource.index()] =
            inputs.into_iter().filter(|input| (*input as usize) < bound.inputs.len()).map(InputId).collect();
    }
    if let Some(budget) = bound.expanded.retained_budget {
        give_way(bound, &flow, &mut found, budget);
    }
    found
}

/// The units that outputs need, a little generously: all of a unit, and through history.
fn alive(flow: &Flow, steps: &[&Step]) -> Vec<bool> {
    let units = flow.unit_of.iter().copied().max().map_or(0, |last| last as usize + 1);
    let mut alive = vec![false; units];
    let makers = |source: &u32| flow.sources[*source as usize].makers.iter().map(|maker| flow.unit_of[*maker as usize]);
    let mut open: Vec<u32> = flow.outputs.iter().flat_map(makers).collect();
    while let Some(unit) = open.pop() {
        if std::mem::replace(&mut alive[unit as usize], true) {
            continue;
        }
        for node in flow.units.of(unit as usize) {
            open.extend(flow.reads.of(*node as usize).iter().flat_map(makers));
            if let StepKind::Remember { source, .. } = &steps[flow.nodes[*node as usize].step as usize].kind {
                open.extend(flow.resource_pieces.of(source.resource.index()).iter().map(|piece| flow.pieces[*piece as usize].unit));
            }
        }
    }
    alive
}

/// The change set of each unit. Numbers above those of the inputs stand for frames, turns of amortised units, and histories.
fn change_sets(flow: &Flow, steps: &[&Step], inputs: usize) -> (ChangeSets, Vec<u32>) {
    let mut sets = ChangeSets::new();
    let units = flow.unit_of.iter().copied().max().map_or(0, |last| last as usize + 1);
    let mut own: Vec<Vec<u32>> = vec![Vec::new(); units];
    let pseudo = inputs as u32;
    for (node, entry) in flow.nodes.iter().enumerate() {
        let unit = flow.unit_of[node];
        let step = steps[entry.step as usize];
        let iteration = entry.iteration.and_then(|iteration| step.batch.get(iteration as usize)).map_or(&[][..], |own| &own.inputs);
        let set = &mut own[unit as usize];
        set.extend(step.inputs.iter().chain(iteration).map(|input| input.0));
        match entry.run {
            Run::EveryFrame => set.push(pseudo),
            Run::Accumulate(_) | Run::Spread { .. } => set.push(pseudo + 1 + unit),
            Run::OnChange if matches!(step.kind, StepKind::Remember { .. }) => set.push(pseudo + 1 + unit),
            Run::OnChange => {}
        }
    }
    let mut unit_sets: Vec<u32> = own
        .into_iter()
        .map(|mut set| {
            set.sort_unstable();
            set.dedup();
            sets.intern(set)
        })
        .collect();
    // In the order of the nodes one walk is enough, but for units whose passes have others between them.
    loop {
        let mut changed = false;
        for (node, unit) in flow.unit_of.iter().enumerate() {
            let mut set = unit_sets[*unit as usize];
            for source in flow.reads.of(node) {
                for maker in &flow.sources[*source as usize].makers {
                    set = sets.union(set, unit_sets[flow.unit_of[*maker as usize] as usize]);
                }
            }
            changed |= set != unit_sets[*unit as usize];
            unit_sets[*unit as usize] = set;
        }
        if !changed {
            return (sets, unit_sets);
        }
    }
}

/// Lets resources go that only spare work, until the rest is within the budget.
fn give_way(bound: &Bound, flow: &Flow, found: &mut Retention, budget: u64) {
    let bytes_of = |index: usize| {
        let resource = &bound.expanded.resources[index];
        resource_bytes(resource, format_of(bound, ResourceId(index as u32))).unwrap_or(u64::MAX)
    };
    let spare: Vec<usize> = (0..found.retained.len()).filter(|index| found.retained[*index] == Some(Retained::Read)).collect();
    let mut total = spare.iter().fold(0u64, |sum, index| sum.saturating_add(bytes_of(*index)));
    // What it costs to make again: the bytes that its units touch, for each byte kept.
    let cost = |index: usize| -> f64 {
        let units = flow.resource_pieces.of(index).iter().map(|piece| flow.pieces[*piece as usize].unit);
        let nodes = units.flat_map(|unit| flow.units.of(unit as usize));
        let touched: f64 = nodes
            .flat_map(|node| flow.reads.of(*node as usize).iter().map(|source| flow.sources[*source as usize].resource.index()))
            .chain([index])
            .map(|resource| bytes_of(resource) as f64)
            .sum();
        touched / (bytes_of(index) as f64).max(1.0)
    };
    let mut by_cost: Vec<(f64, usize)> = spare.into_iter().map(|index| (cost(index), index)).collect();
    by_cost.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    for (_, index) in by_cost {
        if total <= budget {
            break;
        }
        total = total.saturating_sub(bytes_of(index));
        found.retained[index] = None;
        found.for_inputs[index].clear();
    }
}
