//! What runs so that a running pass finds what it reads.
//!
//! A value is there if its maker runs in this frame, or if it was held when the frame began and nothing that runs before its reader
//! writes other content to the same bytes. Running one more unit may take another's bytes, so that the rules are followed until
//! nothing is added: the least set.
//!
//! Only memories that several resources live in are looked at: what has its own is there until it is written again.

use super::flow::Flow;
use super::marks::Marks;
use super::tracker::Tracker;
use super::{Frame, Why};
use crate::expand::types::{ClearValue, ResourceId};
use crate::plan::{MemoryId, PartView, Plan, Role, Use};

/// What somebody relies on to be still there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Relied {
    Piece(u32),
    /// The declared values of a resource.
    Declared,
}

/// What runs and what it needs: room that every frame uses again.
#[derive(Debug, Clone, Default)]
pub(super) struct Pulled {
    /// Units, with the first reason.
    running: Marks<Why>,
    open: Vec<u32>,
    /// Sources that are read or shown.
    needed: Marks,
    /// Resources that are written.
    written: Marks,
    /// Resources whose declared values have to be set again.
    fills: Marks,
    /// By memory; those that are not empty are marked.
    memories: Vec<Memory>,
    touched: Marks,
}

/// What happens to a memory in a frame.
#[derive(Debug, Clone, Default)]
struct Memory {
    written: Vec<ResourceId>,
    relied: Vec<(ResourceId, Relied, Option<usize>)>,
}

impl Pulled {
    /// For the units of a plan.
    pub(super) fn new(flow: &Flow, plan: &Plan) -> Pulled {
        Pulled {
            running: Marks::new(flow.units.count()),
            open: Vec::new(),
            needed: Marks::new(flow.sources.len()),
            written: Marks::new(plan.resources.len()),
            fills: Marks::new(plan.resources.len()),
            memories: vec![Memory::default(); plan.memories.len()],
            touched: Marks::new(plan.memories.len()),
        }
    }

    fn clear(&mut self) {
        self.running.clear();
        self.open.clear();
        self.needed.clear();
        self.written.clear();
        self.fills.clear();
        for memory in self.touched.marked() {
            let Memory { written, relied } = &mut self.memories[*memory as usize];
            written.clear();
            relied.clear();
        }
        self.touched.clear();
    }

    fn memory(&mut self, memory: MemoryId) -> &mut Memory {
        self.touched.insert(memory.0, ());
        &mut self.memories[memory.index()]
    }
}

pub(super) struct Pull<'a> {
    tracker: &'a Tracker,
    flow: &'a Flow,
    pulled: &'a mut Pulled,
    /// Whether outputs and histories are asked for what they show.
    ends: bool,
}

impl<'a> Pull<'a> {
    pub(super) fn new(tracker: &'a Tracker, pulled: &'a mut Pulled) -> Pull<'a> {
        pulled.clear();
        Pull { tracker, flow: &tracker.flow, pulled, ends: false }
    }

    /// The units that run.
    pub(super) fn units(&self) -> &[u32] {
        self.pulled.running.marked()
    }

    /// Why a node runs whose value does not change.
    pub(super) fn why(&self, unit: u32) -> Option<Why> {
        self.pulled.running.get(unit)
    }

    /// Adds the unit of a node whose value changes, and whatever it needs.
    pub(super) fn run(&mut self, node: u32) {
        let step = self.flow.nodes[node as usize].step as usize;
        self.enter(self.flow.unit_of[node as usize], Why::Together { step });
        self.drain();
    }

    fn drain(&mut self) {
        while let Some(unit) = self.pulled.open.pop() {
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
        if self.pulled.running.insert(unit, why) {
            self.pulled.open.push(unit);
        }
    }

    /// What outputs show and histories remember has to be there when the frame ends.
    pub(super) fn finish_ends(&mut self, something_runs: bool) {
        self.ends = self.tracker.ends_open || something_runs;
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
        if !self.pulled.needed.insert(source, ()) {
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
        if self.pulled.running.contains(entry.unit) || self.flow.is_amortised(entry.unit) {
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
        if self.pulled.fills.insert(resource.0, ()) {
            self.write(resource);
        }
    }

    /// The memory that a resource shares with others.
    fn shared_memory(&self, resource: ResourceId) -> Option<MemoryId> {
        let place = &self.tracker.places[resource.index()];
        place.memory.filter(|_| place.shared)
    }

    /// Whether content of a resource is gone before the readers of another come.
    fn takes(&self, writer: ResourceId, held: ResourceId) -> bool {
        let place = |resource: ResourceId| &self.tracker.places[resource.index()];
        writer != held && place(writer).first < place(held).first && place(writer).overlaps(place(held))
    }

    fn is_taken(&self, resource: ResourceId) -> bool {
        let memory = self.shared_memory(resource).map(|memory| &self.pulled.memories[memory.index()]);
        memory.is_some_and(|memory| memory.written.iter().any(|writer| self.takes(*writer, resource)))
    }

    fn rely(&mut self, resource: ResourceId, what: Relied, reader: Option<usize>) {
        if let Some(memory) = self.shared_memory(resource) {
            self.pulled.memory(memory).relied.push((resource, what, reader));
        }
    }

    /// A resource is written in this frame: whoever relied on other content of its bytes has it made again.
    fn write(&mut self, resource: ResourceId) {
        let Some(memory) = self.shared_memory(resource) else { return };
        if !self.pulled.written.insert(resource.0, ()) {
            return;
        }
        let entry = self.pulled.memory(memory);
        entry.written.push(resource);
        if entry.relied.is_empty() {
            return;
        }
        let mut relied = std::mem::take(&mut entry.relied);
        let lost: Vec<_> = relied.iter().copied().filter(|(held, ..)| self.takes(resource, *held)).collect();
        relied.retain(|entry| !lost.contains(entry));
        self.pulled.memory(memory).relied = relied;
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
    pub(super) fn fill(&mut self, frame: &mut Frame) {
        let held = &self.tracker.held;
        let mut wanted: Vec<(ResourceId, (PartView, ClearValue))> = Vec::new();
        self.pulled.fills.sort();
        frame.filled = self.pulled.fills.marked().to_vec();
        for resource in frame.filled.iter().map(|resource| ResourceId(*resource)) {
            let rects = &self.flow.unmade[resource.index()];
            wanted.extend(self.tracker.fills_of(resource, rects).map(|fill| (resource, fill)));
        }
        for piece in &held.unheld_amortised {
            let entry = &self.flow.pieces[*piece as usize];
            let resource = entry.resource;
            let declared = self.tracker.plan.resources[resource.index()].clear.is_some();
            if declared && (self.flow.shared[resource.index()] || !self.pulled.running.contains(entry.unit)) {
                for fill in self.tracker.fills_of(resource, &entry.rects).map(|fill| (resource, fill)) {
                    if !wanted.contains(&fill) {
                        wanted.push(fill);
                    }
                }
            }
        }
        wanted.sort_by_key(|(resource, _)| *resource);
        for same in wanted.chunk_by(|a, b| a.0 == b.0) {
            let resource = same[0].0;
            let fills = same.iter().map(|(_, fill)| fill.clone());
            // What the last frame left is remembered before it is filled.
            let uses = |used: &Use| used.resource == resource && used.role != Role::Recall;
            let plan = &self.tracker.plan;
            let touches = |step: usize| plan.steps[step].uses.iter().any(uses);
            let lifetime = &plan.resources[resource.index()].lifetime;
            let from = frame.runs.partition_point(|run| run.step < lifetime.start);
            let mut users = frame.runs[from..].iter_mut().take_while(|run| run.step < lifetime.end);
            let shown = || plan.outputs.iter().any(|output| output.view.resource == resource) || self.tracker.past.contains_key(&resource);
            match users.find(|run| touches(run.step)) {
                Some(run) => run.fills.extend(fills),
                None if self.ends && shown() => frame.last_fills.extend(fills),
                None => {}
            }
        }
    }
}
