//! What a plan's memories hold, what each pass last ran on, and whose turn it is.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::closure::{Closure, Reached, is_plain};
use super::flow::{Flow, FlowInput, is_amortised};
use super::habit::Habit;
use super::place::Place;
use super::{Frame, Idle, Remembered};
use crate::expand::types::{ClearValue, OnResize, ResourceId, Run};
use crate::plan::{Input, PartView, Plan, PlannedShape, Step, StepKind};
use crate::schedule::part::Rect;

/// Where content is. Only [`Tracker::commit`], [`Tracker::fail`], [`Tracker::lose`] and [`Tracker::adopt`] change it.
#[derive(Debug, Clone, Default)]
pub(super) struct Held {
    /// By piece.
    pub(super) pieces: Vec<bool>,
    /// By resource: whether the parts that nothing makes hold the declared value.
    pub(super) declared: Vec<bool>,
    /// By memory: the resources whose content it has.
    pub(super) residents: Vec<Vec<ResourceId>>,
    /// Pieces of amortised units that are not held: they are filled, never pulled.
    pub(super) unheld_amortised: BTreeSet<u32>,
    /// Pieces of amortised units of which nobody has seen but the declared value.
    pub(super) unseen: BTreeSet<u32>,
}

/// The turn of an iteration of a spread loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Turn {
    /// Runs to go.
    pub(super) remaining: u32,
    /// The frame since which it waits.
    pub(super) since: u64,
}

/// Decides what runs. Knows one plan at a time.
#[derive(Debug, Clone)]
pub struct Tracker {
    pub(super) plan: Arc<Plan>,
    pub(super) flow: Flow,
    /// By resource.
    pub(super) places: Vec<Place>,
    /// By step: whether it neither clears nor remembers.
    pub(super) plain: Vec<bool>,
    pub(super) held: Held,
    /// Nodes that have not run as they are.
    pub(super) fresh: BTreeSet<u32>,
    /// By input: the revision when its readers last ran.
    pub(super) seen: Vec<Option<u64>>,
    /// Nodes that run in every frame.
    pub(super) always: Vec<u32>,
    /// Accumulating nodes, and how much they have gathered.
    pub(super) gathered: BTreeMap<u32, u32>,
    /// Units of spread iterations that stand in the plan.
    pub(super) turns: BTreeMap<u32, Turn>,
    /// Units whose turn has not come.
    pub(super) waiting: BTreeSet<u32>,
    /// Nodes that remember something that changed in the last frame.
    pub(super) recalling: BTreeSet<u32>,
    /// By resource that is remembered: where its value of the frame before is.
    pub(super) past: BTreeMap<ResourceId, Remembered>,
    /// Remembered resources whose histories hold the first value.
    pub(super) first: BTreeSet<ResourceId>,
    /// Remembered resources that others make than in the frame before.
    pub(super) remade: BTreeSet<ResourceId>,
    /// Of what backends carry: the shape.
    pub(super) carried: BTreeMap<String, PlannedShape>,
    /// Something that must be there at the end of a frame may be missing.
    pub(super) ends_open: bool,
    /// Submitted frames.
    pub(super) frames: u64,
    /// What the last frames had in common.
    pub(super) habit: Option<Habit>,
    /// Room to decide in; says nothing between frames.
    pub(super) reached: Reached,
}

impl Tracker {
    /// For a plan of which nothing is held.
    pub fn new(plan: Arc<Plan>) -> Tracker {
        let steps: Vec<&Step> = plan.steps.iter().collect();
        let outputs: Vec<(ResourceId, Rect)> =
            plan.outputs.iter().map(|output| (output.view.resource, Rect::new(&output.view.mips, &output.view.layers))).collect();
        let flow = Flow::of(&FlowInput { steps: &steps, resources: plan.resources.len(), inputs: plan.inputs.len(), outputs: &outputs });
        let nodes = || (0u32..).zip(&flow.nodes);
        let always = nodes().filter(|(_, node)| node.run == Run::EveryFrame).map(|(at, _)| at).collect();
        let gathered = nodes().filter(|(_, node)| matches!(node.run, Run::Accumulate(_))).map(|(at, _)| (at, 0)).collect();
        let spread = nodes().filter(|(_, node)| matches!(node.run, Run::Spread { .. }));
        let turns = spread.map(|(at, _)| (flow.unit_of[at as usize], Turn::default())).collect();
        let past = (0..plan.resources.len()).filter(|index| !flow.recallers.of(*index).is_empty());
        let past = past.map(|index| (ResourceId(index as u32), Remembered::Gone)).collect();
        let mut tracker = Tracker {
            fresh: (0..flow.nodes.len() as u32).collect(),
            seen: vec![None; plan.inputs.len()],
            held: Held {
                pieces: vec![false; flow.pieces.len()],
                declared: vec![false; plan.resources.len()],
                residents: vec![Vec::new(); plan.memories.len()],
                unheld_amortised: BTreeSet::new(),
                unseen: (0u32..).zip(&flow.pieces).filter(|(_, piece)| flow.is_amortised(piece.unit)).map(|(at, _)| at).collect(),
            },
            always,
            gathered,
            turns,
            waiting: BTreeSet::new(),
            recalling: BTreeSet::new(),
            past,
            first: BTreeSet::new(),
            remade: BTreeSet::new(),
            carried: BTreeMap::new(),
            ends_open: true,
            frames: 0,
            habit: None,
            reached: Reached::new(&flow, &plan),
            places: Place::all(&plan),
            plain: plan.steps.iter().map(is_plain).collect(),
            flow,
            plan,
        };
        tracker.find_unheld();
        tracker
    }

    /// The plan that it knows.
    pub fn plan(&self) -> &Arc<Plan> {
        &self.plan
    }

    /// The inputs whose revisions a frame takes, in order.
    pub fn inputs(&self) -> &[Input] {
        &self.plan.inputs
    }

    /// By memory: the resources whose bytes were left there by the last submitted frame.
    pub fn residents(&self) -> &[Vec<ResourceId>] {
        &self.held.residents
    }

    /// Decides what runs, given the revision of each input. Changes nothing but the room that it decides in.
    pub fn frame(&mut self, revisions: &[u64]) -> Arc<Frame> {
        if let Some(frame) = self.habit.as_ref().and_then(|habit| habit.recall(self.changed_inputs(revisions))) {
            let frame = Arc::clone(frame);
            debug_assert_eq!(*frame, self.decide(revisions), "a habit that is none");
            return frame;
        }
        Arc::new(self.decide(revisions))
    }

    fn decide(&mut self, revisions: &[u64]) -> Frame {
        let mut reached = std::mem::take(&mut self.reached);
        let frame = Closure::new(self, &mut reached).frame(revisions);
        self.reached = reached;
        frame
    }

    /// Inputs whose revision is another than when their readers last ran.
    fn changed_inputs(&self, revisions: &[u64]) -> impl Iterator<Item = u32> {
        let changed = (0u32..).zip(self.seen.iter().zip(revisions)).filter(|(_, (seen, revision))| **seen != Some(**revision));
        changed.map(|(input, _)| input)
    }

    /// Records a frame that was submitted.
    pub fn commit(&mut self, frame: &Arc<Frame>, revisions: &[u64]) {
        if frame.is_empty() {
            return;
        }
        if self.habit.as_ref().is_some_and(|habit| habit.is(frame)) {
            // All else is as the frame before left it.
            self.see(revisions);
            self.frames += 1;
            return;
        }
        let repeats = !self.amortises() || self.counts_nothing_on(frame);
        let changed = self.changed_inputs(revisions).collect();
        self.habit = repeats.then(|| Habit::next(self.habit.take(), changed, frame));
        self.see(revisions);
        self.settle_frame(frame);
    }

    /// Whether amortised passes are left as an equal frame would leave them: what starts again has gathered one part, whatever it had
    /// before, and all else stands still.
    fn counts_nothing_on(&self, frame: &Frame) -> bool {
        let run = |node: &u32| self.flow.nodes[*node as usize].run;
        let restarted = |node: &u32| frame.restarted.binary_search(node).is_ok();
        frame.restarted.iter().all(|node| matches!(run(node), Run::Accumulate(_)))
            && frame.changed.iter().all(|node| !is_amortised(run(node)) || restarted(node))
    }

    fn see(&mut self, revisions: &[u64]) {
        for (seen, revision) in self.seen.iter_mut().zip(revisions) {
            *seen = Some(*revision);
        }
    }

    fn settle_frame(&mut self, frame: &Frame) {
        self.occupy(frame);
        if !self.fresh.is_empty() {
            for node in &frame.changed {
                self.fresh.remove(node);
            }
            self.fresh.retain(|node| !is_amortised(self.flow.nodes[*node as usize].run));
        }
        if self.amortises() {
            self.advance_turns(frame);
        }
        if !self.past.is_empty() {
            self.remember(frame);
        }
        self.carried.clear();
        self.ends_open = false;
        self.frames += 1;
    }

    /// Whether the plan has passes that run a few at a time.
    fn amortises(&self) -> bool {
        !self.gathered.is_empty() || !self.turns.is_empty()
    }

    /// What histories see in the next frame.
    fn remember(&mut self, frame: &Frame) {
        self.recalling.clear();
        for node in &frame.changed {
            for piece in self.flow.unit_pieces.of(self.flow.unit_of[*node as usize] as usize) {
                let resource = self.flow.pieces[*piece as usize].resource;
                let recallers = self.flow.recallers.of(resource.index());
                if !recallers.is_empty() && self.writes(*node, resource) {
                    self.recalling.extend(recallers);
                }
            }
        }
        for run in &frame.runs {
            if let (Some(remembered), StepKind::Remember { source, .. }) = (run.remembered, &self.plan.steps[run.step].kind) {
                match remembered {
                    Remembered::Gone => self.first.insert(source.resource),
                    Remembered::Here | Remembered::Carried => self.first.remove(&source.resource),
                };
            }
        }
        for (resource, past) in &mut self.past {
            if *past == Remembered::Gone {
                self.recalling.extend(self.flow.recallers.of(resource.index()));
            }
            *past = Remembered::Here;
        }
        for resource in std::mem::take(&mut self.remade) {
            self.recalling.extend(self.flow.recallers.of(resource.index()));
        }
    }

    /// Records that a frame was not submitted, although some of it may have run.
    pub fn fail(&mut self, frame: &Frame) {
        self.habit = None;
        let mut touched: BTreeSet<ResourceId> = frame.filled.iter().map(|resource| ResourceId(*resource)).collect();
        touched.extend(frame.runs.iter().flat_map(|run| self.flow.writes.of(run.step)).map(|resource| ResourceId(*resource)));
        let fills = frame.runs.iter().flat_map(|run| &run.fills).chain(&frame.last_fills);
        touched.extend(fills.map(|(part, _)| part.resource));
        for resource in touched {
            self.evict_for(resource);
            self.evict(resource);
            if let Some(past) = self.past.get_mut(&resource).filter(|past| **past == Remembered::Here) {
                *past = Remembered::Gone;
                self.recall_first(resource);
            }
        }
        self.start_unheld_anew();
        self.ends_open = true;
    }

    /// Records that the device is lost: nothing is held.
    pub fn lose(&mut self) {
        let frames = self.frames;
        *self = Tracker { frames, ..Tracker::new(Arc::clone(&self.plan)) };
    }

    /// The steps of a frame, with their iterations, whose values change: they are due. All others only run for their sake.
    pub fn changed(&self, frame: &Frame) -> Vec<(usize, Option<u32>)> {
        let nodes = frame.changed.iter().map(|node| self.flow.nodes[*node as usize]);
        nodes.map(|node| (node.step as usize, node.iteration)).collect()
    }

    /// The unit of a step, or of its iteration: whatever has the same number runs together.
    pub fn unit(&self, step: usize, iteration: Option<u32>) -> u32 {
        let node = self.flow.of_step(step).start + iteration.unwrap_or(0);
        self.flow.unit_of[node as usize]
    }

    /// Why a step did not run in the last frame, if it did not.
    pub fn idle(&self, step: usize) -> Idle {
        let waits = self.flow.of_step(step).any(|node| self.waiting.contains(&self.flow.unit_of[node as usize]));
        match self.plan.steps[step].run {
            Run::Accumulate(count) => Idle::Gathered(count),
            Run::Spread { .. } if waits => Idle::Waits,
            _ => Idle::Clean,
        }
    }

    /// Whether a node writes a resource.
    pub(super) fn writes(&self, node: u32, resource: ResourceId) -> bool {
        self.flow.writes.of(self.flow.nodes[node as usize].step as usize).contains(&resource.0)
    }

    /// Moves content as the frame's steps did, in their order.
    fn occupy(&mut self, frame: &Frame) {
        for run in &frame.runs {
            for (part, _) in &run.fills {
                self.fill(part.resource, frame);
            }
            for at in 0..self.flow.writes.of(run.step).len() {
                self.settle(ResourceId(self.flow.writes.of(run.step)[at]));
            }
            let first = self.flow.of_step(run.step).start;
            match run.iterations.as_slice() {
                [] => self.hold(first),
                some => some.iter().for_each(|iteration| self.hold(first + iteration)),
            }
        }
        for (part, _) in &frame.last_fills {
            self.fill(part.resource, frame);
        }
    }

    /// The unit of a node leaves its value: the last of its steps does, until then nobody relies on it.
    fn hold(&mut self, node: u32) {
        let unit = self.flow.unit_of[node as usize];
        for piece in self.flow.unit_pieces.of(unit as usize) {
            self.held.pieces[*piece as usize] = true;
            if self.flow.is_amortised(unit) {
                self.held.unheld_amortised.remove(piece);
                self.held.unseen.remove(piece);
            }
        }
    }

    /// A declared value is set in a resource: in parts that nothing makes, and in those of amortised units that have not run.
    fn fill(&mut self, resource: ResourceId, frame: &Frame) {
        self.settle(resource);
        if frame.filled.contains(&resource.0) {
            self.held.declared[resource.index()] = true;
        }
        for piece in self.flow.resource_pieces.of(resource.index()) {
            if self.held.unheld_amortised.remove(piece) {
                self.held.pieces[*piece as usize] = true;
                self.held.unseen.insert(*piece);
            }
        }
    }

    /// Makes a resource the holder of its bytes.
    fn settle(&mut self, resource: ResourceId) {
        self.evict_for(resource);
        let Some(memory) = self.places[resource.index()].memory else { return };
        let residents = &mut self.held.residents[memory.index()];
        if !residents.contains(&resource) {
            residents.push(resource);
        }
    }

    /// Whatever else had these bytes is gone.
    fn evict_for(&mut self, resource: ResourceId) {
        let place = self.places[resource.index()];
        let Some(memory) = place.memory.filter(|_| place.shared) else { return };
        let mut residents = std::mem::take(&mut self.held.residents[memory.index()]);
        residents.retain(|other| {
            let stays = *other == resource || !place.overlaps(&self.places[other.index()]);
            if !stays {
                self.lose_content(*other);
            }
            stays
        });
        self.held.residents[memory.index()] = residents;
    }

    fn evict(&mut self, resource: ResourceId) {
        self.lose_content(resource);
        if let Some(memory) = self.places[resource.index()].memory {
            self.held.residents[memory.index()].retain(|resident| *resident != resource);
        }
    }

    fn lose_content(&mut self, resource: ResourceId) {
        for piece in self.flow.resource_pieces.of(resource.index()) {
            self.held.pieces[*piece as usize] = false;
            if self.flow.is_amortised(self.flow.pieces[*piece as usize].unit) {
                self.held.unheld_amortised.insert(*piece);
            }
        }
        self.held.declared[resource.index()] = false;
    }

    pub(super) fn find_unheld(&mut self) {
        let unheld =
            (0u32..).zip(&self.flow.pieces).filter(|(at, piece)| !self.held.pieces[*at as usize] && self.flow.is_amortised(piece.unit));
        self.held.unheld_amortised = unheld.map(|(at, _)| at).collect();
    }

    /// What a resource held in the frame before is lost: its history changes to the first value, unless it has that already.
    pub(super) fn recall_first(&mut self, resource: ResourceId) {
        for recaller in self.flow.recallers.of(resource.index()) {
            if self.first.contains(&resource) {
                self.recalling.remove(recaller);
            } else {
                self.recalling.insert(*recaller);
            }
        }
    }

    /// Amortised units whose content is lost start again.
    pub(super) fn start_unheld_anew(&mut self) {
        for piece in &self.held.unheld_amortised {
            self.fresh.extend(self.flow.units.of(self.flow.pieces[*piece as usize].unit as usize));
        }
    }

    /// Counts what amortised units did.
    fn advance_turns(&mut self, frame: &Frame) {
        let now = self.frames;
        for node in &frame.restarted {
            match self.flow.nodes[*node as usize].run {
                Run::Accumulate(_) => {
                    self.gathered.insert(*node, 0);
                }
                Run::Spread { spread, .. } => {
                    let unit = self.flow.unit_of[*node as usize];
                    let rounds = self.plan.spreads.get(spread as usize).map_or(1, |spread| spread.rounds);
                    let turn = self.turns.entry(unit).or_default();
                    if turn.remaining == 0 {
                        turn.since = now;
                    }
                    turn.remaining = rounds;
                    self.waiting.insert(unit);
                }
                _ => {}
            }
        }
        let mut ran: BTreeSet<u32> = BTreeSet::new();
        for node in &frame.changed {
            match self.flow.nodes[*node as usize].run {
                Run::Accumulate(_) => *self.gathered.entry(*node).or_default() += 1,
                Run::Spread { .. } => {
                    ran.insert(self.flow.unit_of[*node as usize]);
                }
                _ => {}
            }
        }
        for unit in ran {
            let turn = self.turns.entry(unit).or_default();
            turn.remaining = turn.remaining.saturating_sub(1);
            turn.since = now + 1;
            if turn.remaining == 0 {
                self.waiting.remove(&unit);
            }
        }
    }

    /// What a history gets where the value of the frame before has another extent.
    pub(super) fn on_resize(plan: &Plan, of: ResourceId) -> OnResize {
        let histories = plan.resources.iter().filter_map(|resource| resource.history);
        histories.filter(|history| history.of == of).map(|history| history.on_resize).next().unwrap_or_default()
    }

    /// Parts of a resource as fills.
    pub(super) fn fills_of<'a>(&'a self, resource: ResourceId, rects: &'a [Rect]) -> impl Iterator<Item = (PartView, ClearValue)> + 'a {
        let planned = &self.plan.resources[resource.index()];
        let value = planned.clear.unwrap_or(ClearValue::Zero);
        rects.iter().map(move |rect| (rect.view_in(resource, &planned.shape), value))
    }
}
