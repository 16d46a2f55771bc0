//! What runs so that a running pass finds what it reads.
//!
//! A value is there if its maker runs in this frame, or if it was held when the frame began and nothing that runs before its reader
//! writes other content to the same bytes. Running one more unit may take another's bytes, so that the rules are followed until
//! nothing is added: the least set.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::flow::Flow;
use super::tracker::{Tracker, overlap};
use super::{Frame, Why};
use crate::expand::types::{ClearValue, ResourceId};
use crate::plan::{PartView, Role, Use};

/// What somebody relies on to be still there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Relied {
    Piece(u32),
    /// The declared values of a resource.
    Declared,
}

pub(super) struct Pull<'a> {
    tracker: &'a Tracker,
    flow: &'a Flow,
    running: BTreeMap<u32, Why>,
    open: Vec<u32>,
    needed: BTreeSet<u32>,
    /// By memory: resources that are written in this frame, and what is relied on.
    written: HashMap<u32, BTreeSet<ResourceId>>,
    relied: HashMap<u32, Vec<(ResourceId, Relied, Option<usize>)>>,
    /// Resources whose declared values have to be set again.
    fills: BTreeSet<ResourceId>,
    /// Sources that are read or shown, and pieces of amortised units among them.
    ends: Vec<ResourceId>,
}

impl<'a> Pull<'a> {
    pub(super) fn new(tracker: &'a Tracker) -> Pull<'a> {
        Pull {
            tracker,
            flow: &tracker.flow,
            running: BTreeMap::new(),
            open: Vec::new(),
            needed: BTreeSet::new(),
            written: HashMap::new(),
            relied: HashMap::new(),
            fills: BTreeSet::new(),
            ends: Vec::new(),
        }
    }

    /// The units that run.
    pub(super) fn units(&self) -> Vec<u32> {
        self.running.keys().copied().collect()
    }

    /// Why a node runs whose value does not change.
    pub(super) fn why(&self, unit: u32) -> Option<Why> {
        self.running.get(&unit).copied()
    }

    /// Adds the unit of a node whose value changes, and whatever it needs.
    pub(super) fn run(&mut self, node: u32) {
        let step = self.flow.nodes[node as usize].step as usize;
        self.enter(self.flow.unit_of[node as usize], Why::Together { step });
        self.drain();
    }

    fn drain(&mut self) {
        while let Some(unit) = self.open.pop() {
            for piece in self.flow.unit_pieces.of(unit as usize) {
                self.write(self.flow.pieces[*piece as usize].resource);
            }
            for node in self.flow.units.of(unit as usize) {
                let step = self.flow.nodes[*node as usize].step as usize;
                for source in self.flow.reads.of(*node as usize) {
                    self.need(*source, Some(step));
                }
            }
        }
    }

    fn enter(&mut self, unit: u32, why: Why) {
        if let std::collections::btree_map::Entry::Vacant(entry) = self.running.entry(unit) {
            entry.insert(why);
            self.open.push(unit);
        }
    }

    /// What outputs show and histories remember has to be there when the frame ends.
    pub(super) fn finish_ends(&mut self, something_runs: bool) {
        if !self.tracker.ends_open && !something_runs {
            return;
        }
        let plan = &self.tracker.plan;
        self.ends = plan.outputs.iter().map(|output| output.view.resource).collect();
        self.ends.extend(self.tracker.past.keys());
        if !self.tracker.ends_open {
            return;
        }
        for source in &self.flow.outputs {
            self.need(*source, None);
        }
        for resource in self.tracker.past.keys() {
            for piece in self.flow.resource_pieces.of(resource.index()) {
                self.need_piece(*piece, true, None);
            }
            if !self.flow.unmade[resource.index()].is_empty() {
                self.need_declared(*resource, None);
            }
        }
        self.drain();
    }

    fn need(&mut self, source: u32, reader: Option<usize>) {
        if !self.needed.insert(source) {
            return;
        }
        let source = &self.flow.sources[source as usize];
        for piece in &source.pieces {
            self.need_piece(*piece, source.last, reader);
        }
        if !source.last {
            for maker in &source.makers {
                let why = Why::Pulled { step: reader, resource: source.resource };
                self.enter(self.flow.unit_of[*maker as usize], why);
            }
        }
        if source.unmade {
            self.need_declared(source.resource, reader);
        }
    }

    fn need_piece(&mut self, piece: u32, last: bool, reader: Option<usize>) {
        let entry = &self.flow.pieces[piece as usize];
        if self.flow.is_amortised(entry.unit) || self.running.contains_key(&entry.unit) {
            return;
        }
        if last && self.tracker.held.pieces[piece as usize] && !self.is_taken(entry.resource) {
            self.rely(entry.resource, Relied::Piece(piece), reader);
        } else {
            self.enter(entry.unit, Why::Pulled { step: reader, resource: entry.resource });
        }
    }

    fn need_declared(&mut self, resource: ResourceId, reader: Option<usize>) {
        if self.tracker.plan.resources[resource.index()].clear.is_none() {
            return;
        }
        if self.tracker.held.declared[resource.index()] && !self.is_taken(resource) {
            self.rely(resource, Relied::Declared, reader);
        } else {
            self.set_declared(resource);
        }
    }

    fn set_declared(&mut self, resource: ResourceId) {
        if self.fills.insert(resource) {
            self.write(resource);
        }
    }

    fn memory(&self, resource: ResourceId) -> Option<u32> {
        self.tracker.plan.resources[resource.index()].placement.map(|placement| placement.memory.0)
    }

    /// Whether content of one resource is gone before the readers of another come.
    fn takes(&self, writer: ResourceId, held: ResourceId) -> bool {
        let plan = &self.tracker.plan;
        let start = |resource: ResourceId| plan.resources[resource.index()].lifetime.start;
        writer != held && start(writer) < start(held) && overlap(plan, writer, held)
    }

    fn is_taken(&self, resource: ResourceId) -> bool {
        let written = self.memory(resource).and_then(|memory| self.written.get(&memory));
        written.into_iter().flatten().any(|writer| self.takes(*writer, resource))
    }

    fn rely(&mut self, resource: ResourceId, what: Relied, reader: Option<usize>) {
        if let Some(memory) = self.memory(resource) {
            self.relied.entry(memory).or_default().push((resource, what, reader));
        }
    }

    /// A resource is written in this frame: whoever relied on other content of its bytes has it made again.
    fn write(&mut self, resource: ResourceId) {
        let Some(memory) = self.memory(resource) else { return };
        if !self.written.entry(memory).or_default().insert(resource) {
            return;
        }
        let Some(mut relied) = self.relied.remove(&memory) else { return };
        let lost: Vec<_> = relied.iter().copied().filter(|(held, ..)| self.takes(resource, *held)).collect();
        relied.retain(|entry| !lost.contains(entry));
        self.relied.insert(memory, relied);
        for (held, what, reader) in lost {
            match what {
                Relied::Piece(piece) => {
                    let unit = self.flow.pieces[piece as usize].unit;
                    self.enter(unit, Why::Pulled { step: reader, resource: held });
                }
                Relied::Declared => self.set_declared(held),
            }
        }
    }

    /// Enters declared values before the first step that touches their resource, or at the end.
    pub(super) fn fill(&self, frame: &mut Frame) {
        let held = &self.tracker.held;
        let mut wanted: BTreeMap<ResourceId, Vec<(PartView, ClearValue)>> = BTreeMap::new();
        for resource in &self.fills {
            let rects = &self.flow.unmade[resource.index()];
            wanted.entry(*resource).or_default().extend(self.tracker.fills_of(*resource, rects));
            frame.filled.push(resource.0);
        }
        for piece in &held.unheld_amortised {
            let entry = &self.flow.pieces[*piece as usize];
            let resource = entry.resource;
            let declared = self.tracker.plan.resources[resource.index()].clear.is_some();
            if declared && (self.flow.shared[resource.index()] || !self.running.contains_key(&entry.unit)) {
                let parts = wanted.entry(resource).or_default();
                for fill in self.tracker.fills_of(resource, &entry.rects) {
                    if !parts.contains(&fill) {
                        parts.push(fill);
                    }
                }
            }
        }
        for (resource, fills) in wanted {
            // What the last frame left is remembered before it is filled.
            let uses = |used: &Use| used.resource == resource && used.role != Role::Recall;
            let touches = |step: usize| self.tracker.plan.steps[step].uses.iter().any(uses);
            match frame.runs.iter_mut().find(|run| touches(run.step)) {
                Some(run) => run.fills.extend(fills),
                None if self.ends.contains(&resource) => frame.last_fills.extend(fills),
                None => {}
            }
        }
    }
}
