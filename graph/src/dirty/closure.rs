//! What is due, and who has to run for it.
//!
//! A worklist: each node and source is entered once, so that a frame costs what its changes reach. The lists are kept from frame to
//! frame and only emptied.

use std::collections::BTreeSet;

use super::flow::{Flow, is_amortised};
use super::marks::Marks;
use super::pull::{Pull, Pulled};
use super::tracker::Tracker;
use super::{Frame, Remembered, StepRun, Why};
use crate::expand::types::{ClearValue, ResourceId, Run};
use crate::plan::{InputId, PartView, Plan, Step, StepKind};

/// What a change reached, and what was pulled: room that every frame uses again.
#[derive(Debug, Clone, Default)]
pub(super) struct Reached {
    /// Nodes whose value changes, with the first reason.
    due: Marks<Why>,
    open: Vec<u32>,
    /// Sources that changed, with the cycle of the maker; twice, if by makers of two cycles.
    sources: Marks<(u32, bool)>,
    /// Cycles with amortised nodes that a change from outside reached.
    cycles: Marks,
    /// Amortised nodes that start anew.
    restarted: Marks,
    /// Nodes that run.
    running: Vec<u32>,
    pulled: Pulled,
}

impl Reached {
    /// For the nodes of a plan.
    pub(super) fn new(flow: &Flow, plan: &Plan) -> Reached {
        Reached {
            due: Marks::new(flow.nodes.len()),
            sources: Marks::new(flow.sources.len()),
            cycles: Marks::new(flow.nodes.len()),
            restarted: Marks::new(flow.nodes.len()),
            pulled: Pulled::new(flow, plan),
            ..Reached::default()
        }
    }

    fn clear(&mut self) {
        self.due.clear();
        self.open.clear();
        self.sources.clear();
        self.cycles.clear();
        self.restarted.clear();
        self.running.clear();
    }
}

/// The nodes whose values change in a frame.
pub(super) struct Closure<'a> {
    tracker: &'a Tracker,
    flow: &'a Flow,
    reached: &'a mut Reached,
    /// Units of spread loops that a change reached.
    called: BTreeSet<u32>,
}

impl<'a> Closure<'a> {
    pub(super) fn new(tracker: &'a Tracker, reached: &'a mut Reached) -> Closure<'a> {
        reached.clear();
        Closure { tracker, flow: &tracker.flow, reached, called: BTreeSet::new() }
    }

    /// Everything that runs.
    pub(super) fn frame(mut self, revisions: &[u64]) -> Frame {
        let tracker = self.tracker;
        for node in &tracker.fresh {
            self.reach(*node, Why::New, true);
        }
        for (input, (seen, revision)) in tracker.seen.iter().zip(revisions).enumerate() {
            if *seen != Some(*revision) {
                for node in self.flow.input_readers.of(input) {
                    self.reach(*node, Why::Input(InputId(input as u32)), true);
                }
            }
        }
        // Whoever gathers what others make now starts again.
        for node in tracker.remade.iter().flat_map(|resource| self.flow.recallers.of(resource.index())) {
            self.enter(*node);
        }
        // Content that is lost becomes the declared value, until its turn comes.
        for piece in tracker.held.unheld_amortised.difference(&tracker.held.unseen) {
            let piece = &self.flow.pieces[*piece as usize];
            for node in self.flow.units.of(piece.unit as usize) {
                self.carry(*node, Some(piece.resource));
            }
        }
        for node in &tracker.always {
            self.reach(*node, Why::EveryFrame, false);
        }
        for node in &tracker.recalling {
            self.reach(*node, Why::Remembers, false);
        }
        for (node, gathered) in &tracker.gathered {
            if matches!(self.flow.nodes[*node as usize].run, Run::Accumulate(count) if *gathered < count) {
                self.change(*node, Why::Accumulates);
            }
        }
        self.spread();
        for spread in 0..tracker.plan.spreads.len() as u32 {
            self.choose(spread);
            self.spread();
        }
        self.finish()
    }

    /// A change from outside reaches the cycle of a node.
    fn enter(&mut self, node: u32) {
        let cycle = self.flow.cycle_of[node as usize];
        let members = self.flow.amortised.of(cycle as usize);
        if !members.is_empty() && self.reached.cycles.insert(cycle, ()) {
            for member in members {
                self.restart(*member);
            }
        }
    }

    /// A change reaches a node; from outside of its cycle or from within.
    fn reach(&mut self, node: u32, why: Why, outside: bool) {
        if outside {
            self.enter(node);
        }
        if !is_amortised(self.flow.nodes[node as usize].run) {
            self.change(node, why);
        }
    }

    fn restart(&mut self, node: u32) {
        match self.flow.nodes[node as usize].run {
            Run::Accumulate(count) => {
                self.reached.restarted.insert(node, ());
                if count > 0 {
                    self.change(node, Why::Accumulates);
                }
            }
            Run::Spread { .. } => {
                self.reached.restarted.insert(node, ());
                self.called.insert(self.flow.unit_of[node as usize]);
            }
            Run::OnChange | Run::EveryFrame => {}
        }
    }

    /// A node's value changes.
    fn change(&mut self, node: u32, why: Why) {
        if self.reached.due.insert(node, why) {
            self.reached.open.push(node);
        }
    }

    /// Carries changes on to readers and modifiers.
    fn spread(&mut self) {
        while let Some(node) = self.reached.open.pop() {
            self.carry(node, None);
        }
    }

    /// Tells readers and modifiers that what a node leaves is another.
    fn carry(&mut self, node: u32, only: Option<ResourceId>) {
        let cycle = self.flow.cycle_of[node as usize];
        let step = self.flow.nodes[node as usize].step as usize;
        for source in self.flow.feeds.of(node as usize) {
            let resource = self.flow.sources[*source as usize].resource;
            if only.is_some_and(|only| only != resource) {
                continue;
            }
            // A second maker tells a reader something new only if it stands in another cycle.
            let known = self.reached.sources.get(*source);
            if known.is_some_and(|(first, both)| both || first == cycle) {
                continue;
            }
            self.reached.sources.set(*source, known.map_or((cycle, false), |(first, _)| (first, true)));
            for reader in self.flow.readers.of(*source as usize) {
                let outside = self.flow.cycle_of[*reader as usize] != cycle;
                self.reach(*reader, Why::Reads { step, resource }, outside);
            }
        }
        for modifier in self.flow.modifiers.of(node as usize) {
            let outside = self.flow.cycle_of[*modifier as usize] != cycle;
            let resource = self.tracker.plan.steps[step].uses.iter().find(|used| crate::schedule::writes(used.role));
            let resource = resource.map_or(ResourceId(0), |used| used.resource);
            self.reach(*modifier, Why::Reads { step, resource }, outside);
        }
    }

    /// Whose turn it is among the iterations of a loop: longest waiting first, then by index.
    fn choose(&mut self, spread: u32) {
        let tracker = self.tracker;
        let Some(rule) = tracker.plan.spreads.get(spread as usize) else { return };
        let units: BTreeSet<u32> = tracker.waiting.union(&self.called).copied().collect();
        let mut candidates: Vec<(u64, u32, u32)> = Vec::new();
        for unit in units {
            let first = self.flow.nodes[self.flow.units.of(unit as usize)[0] as usize];
            let Run::Spread { spread: own, iteration } = first.run else { continue };
            let turn = tracker.turns.get(&unit).copied().unwrap_or_default();
            let since = if turn.remaining == 0 { tracker.frames } else { turn.since };
            if own == spread {
                candidates.push((since, iteration, unit));
            }
        }
        candidates.sort_unstable();
        for (_, _, unit) in candidates.into_iter().take(rule.per_frame as usize) {
            for node in self.flow.units.of(unit as usize) {
                self.change(*node, Why::Turn);
            }
        }
    }

    /// From what changes to what runs, as steps in order.
    fn finish(self) -> Frame {
        let tracker = self.tracker;
        let Reached { due, restarted, running, pulled, .. } = &mut *self.reached;
        due.sort();
        restarted.sort();
        let mut pull = Pull::new(tracker, pulled);
        for node in due.marked() {
            pull.run(*node);
        }
        pull.finish_ends(!due.marked().is_empty());
        running.extend(pull.units().iter().flat_map(|unit| self.flow.units.of(*unit as usize)));
        running.sort_unstable();
        let mut frame = Frame {
            runs: Vec::with_capacity(running.len()),
            changed: due.marked().to_vec(),
            restarted: restarted.marked().to_vec(),
            ..Frame::default()
        };
        let accumulated = |node: u32| match self.flow.nodes[node as usize].run {
            Run::Accumulate(_) if !restarted.contains(node) => tracker.gathered.get(&node).copied().unwrap_or(0),
            _ => 0,
        };
        for node in running.iter().copied() {
            let entry = self.flow.nodes[node as usize];
            let why = due.get(node).or_else(|| pull.why(self.flow.unit_of[node as usize])).unwrap_or(Why::New);
            match frame.runs.last_mut().filter(|run| run.step == entry.step as usize) {
                Some(run) => run.iterations.extend(entry.iteration),
                None => frame.runs.push(StepRun {
                    step: entry.step as usize,
                    iterations: entry.iteration.into_iter().collect(),
                    accumulated: accumulated(node),
                    fills: Vec::new(),
                    clears: Vec::new(),
                    remembered: None,
                    why,
                }),
            }
        }
        for run in frame.runs.iter_mut().filter(|run| !tracker.plain[run.step]) {
            let step = &tracker.plan.steps[run.step];
            run.clears = clears(step, run);
            if let StepKind::Remember { source, .. } = &step.kind {
                run.remembered = Some(tracker.past.get(&source.resource).copied().unwrap_or(Remembered::Gone));
            }
        }
        pull.fill(&mut frame);
        frame
    }
}

/// Whether a step neither clears nor remembers, whenever it runs.
pub(super) fn is_plain(step: &Step) -> bool {
    step.clears.is_empty() && !matches!(step.kind, StepKind::Remember { .. })
}

/// What a step's clears come to: those of an accumulating step only at its start; of a batched one in the parts of the iterations that
/// run, or in the part that all of them name if all run.
fn clears(step: &Step, run: &StepRun) -> Vec<(PartView, ClearValue)> {
    if matches!(step.run, Run::Accumulate(_)) && run.accumulated > 0 {
        return Vec::new();
    }
    if step.batch.is_empty() {
        return step.clears.clone();
    }
    let mut found = Vec::new();
    for (part, value) in &step.clears {
        let whole = (part.mips.clone(), part.layers.clone());
        let Some(used) = step.uses.iter().position(|used| used.resource == part.resource && crate::schedule::writes(used.role)) else {
            continue;
        };
        let parts = || step.batch.iter().filter_map(|iteration| iteration.parts.get(used));
        if parts().any(|part| *part == whole) {
            if run.iterations.len() == step.batch.len() && !matches!(step.run, Run::Spread { .. }) {
                found.push((part.clone(), *value));
            }
            continue;
        }
        for iteration in &run.iterations {
            if let Some((mips, layers)) = step.batch.get(*iteration as usize).and_then(|iteration| iteration.parts.get(used)) {
                found.push((PartView { mips: mips.clone(), layers: layers.clone(), ..part.clone() }, *value));
            }
        }
    }
    found
}
