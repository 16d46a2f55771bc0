//! In which order passes run.
//!
//! The declared order takes, of all passes that are ready, the one that stands first in the file. Besides it three cheap orders
//! are tried: ready passes by how little they add to the bytes in use, the same from the end of the frame backwards, and depth
//! first from the outputs. The one with the fewest bytes that an executor would really allocate wins; on a tie the declared
//! order does, so the chosen order is never worse than it. Finding the best order is NP-hard, so none of them promises that.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use petgraph::visit::EdgeRef;

use super::dag::{Dag, Node};
use crate::allocate::model::Model;
use crate::allocate::{bytes_reached, ranges_in};
use crate::expand::types::PassId;

/// The chosen order and the declared one.
pub(crate) struct Orders {
    pub(crate) chosen: Vec<PassId>,
    pub(crate) declared: Vec<PassId>,
}

/// Orders the live passes. The graph has no cycle.
pub(crate) fn orders(dag: &Dag, alive: &[bool], model: &Model) -> Orders {
    let live = Live::new(dag, alive);
    let declared = live.by_place();
    let reached = |order: &[PassId]| bytes_reached(model, &ranges_in(model, order));
    let mut best = (reached(&declared), declared.clone());
    for candidate in [live.by_bytes(model, false), live.by_bytes(model, true), live.depth_first()] {
        let bytes = reached(&candidate);
        if bytes < best.0 && candidate.len() == declared.len() {
            best = (bytes, candidate);
        }
    }
    Orders { chosen: best.1, declared }
}

/// Neighbours of every live node in one list.
struct Neighbours {
    ends: Vec<u32>,
    nodes: Vec<u32>,
}

impl Neighbours {
    fn of(&self, node: u32) -> &[u32] {
        let start = (node as usize).checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        &self.nodes[start..self.ends[node as usize] as usize]
    }

    /// From edges sorted by the node that they belong to.
    fn new(count: usize, edges: &[(u32, u32)]) -> Neighbours {
        let mut ends = vec![0u32; count];
        for (node, _) in edges {
            ends[*node as usize] += 1;
        }
        let mut sum = 0;
        for end in &mut ends {
            sum += *end;
            *end = sum;
        }
        Neighbours { ends, nodes: edges.iter().map(|(_, other)| *other).collect() }
    }
}

/// The part of the graph that runs.
struct Live<'a> {
    dag: &'a Dag,
    nodes: Vec<u32>,
    before: Neighbours,
    after: Neighbours,
}

impl<'a> Live<'a> {
    fn new(dag: &'a Dag, alive: &[bool]) -> Live<'a> {
        let live = |node: usize| alive.get(node).copied().unwrap_or(false);
        let mut edges: Vec<(u32, u32)> = dag
            .edge_references()
            .map(|edge| (edge.source().index() as u32, edge.target().index() as u32))
            .filter(|(from, to)| live(*from as usize) && live(*to as usize))
            .collect();
        edges.sort_unstable();
        let after = Neighbours::new(dag.node_count(), &edges);
        for edge in &mut edges {
            *edge = (edge.1, edge.0);
        }
        edges.sort_unstable();
        let before = Neighbours::new(dag.node_count(), &edges);
        let nodes = (0..dag.node_count()).filter(|node| live(*node)).map(|node| node as u32).collect();
        Live { dag, nodes, before, after }
    }

    fn pass(&self, node: u32) -> Option<PassId> {
        match self.dag.raw_nodes().get(node as usize)?.weight {
            Node::Pass(pass) => Some(pass),
            Node::Join => None,
        }
    }

    /// Runs a ready queue. `ready` is told each pass that becomes ready, and `next` names the one to run; joins run at once.
    fn run<State>(
        &self,
        backwards: bool,
        state: &mut State,
        ready: impl Fn(&mut State, PassId),
        next: impl Fn(&mut State) -> Option<PassId>,
    ) -> Vec<PassId> {
        let (needs, frees) = if backwards { (&self.after, &self.before) } else { (&self.before, &self.after) };
        let mut waits: Vec<u32> = (0..self.dag.node_count()).map(|node| needs.of(node as u32).len() as u32).collect();
        let mut order = Vec::with_capacity(self.nodes.len());
        let mut open: Vec<u32> = self.nodes.iter().copied().filter(|node| waits[*node as usize] == 0).collect();
        loop {
            while let Some(node) = open.pop() {
                match self.pass(node) {
                    Some(pass) => ready(state, pass),
                    None => release(node, frees, &mut waits, &mut open),
                }
            }
            let Some(pass) = next(state) else { break };
            order.push(pass);
            release(pass.0, frees, &mut waits, &mut open);
        }
        if backwards {
            order.reverse();
        }
        order
    }

    /// The ready pass that stands first in the file.
    fn by_place(&self) -> Vec<PassId> {
        let mut queue: BinaryHeap<Reverse<PassId>> = BinaryHeap::new();
        self.run(false, &mut queue, |queue, pass| queue.push(Reverse(pass)), |queue| queue.pop().map(|Reverse(pass)| pass))
    }

    /// The ready pass that adds the fewest bytes to those in use; ties by place in the file.
    fn by_bytes(&self, model: &Model, backwards: bool) -> Vec<PassId> {
        let mut state = InUse::new(model, self, backwards);
        self.run(backwards, &mut state, InUse::ready, InUse::next)
    }

    /// Every pass right after what it needs, results in the order of the file.
    fn depth_first(&self) -> Vec<PassId> {
        let mut order = Vec::with_capacity(self.nodes.len());
        let mut entered = vec![false; self.dag.node_count()];
        let roots = self.nodes.iter().copied().filter(|node| self.after.of(*node).is_empty());
        let mut stack: Vec<(u32, usize)> = Vec::new();
        for root in roots {
            if !std::mem::replace(&mut entered[root as usize], true) {
                stack.push((root, 0));
            }
            while let Some((node, place)) = stack.pop() {
                match self.before.of(node).get(place) {
                    Some(needed) => {
                        stack.push((node, place + 1));
                        if !std::mem::replace(&mut entered[*needed as usize], true) {
                            stack.push((*needed, 0));
                        }
                    }
                    None => order.extend(self.pass(node)),
                }
            }
        }
        order
    }
}

fn release(node: u32, frees: &Neighbours, waits: &mut [u32], open: &mut Vec<u32>) {
    for later in frees.of(node) {
        let waiting = &mut waits[*later as usize];
        *waiting -= 1;
        if *waiting == 0 {
            open.push(*later);
        }
    }
}

/// Which resources are in use while passes are chosen, and what each ready pass would add. Scores change only when a resource
/// comes into use or has one user left, so all updates together are linear in uses.
struct InUse<'a> {
    model: &'a Model,
    users: Vec<Vec<u32>>,
    left: Vec<u32>,
    in_use: Vec<bool>,
    /// By pass: the score of a ready pass.
    scores: Vec<Option<i64>>,
    queue: BinaryHeap<Reverse<(i64, i64, u32)>>,
    backwards: bool,
}

impl<'a> InUse<'a> {
    fn new(model: &'a Model, live: &Live<'_>, backwards: bool) -> InUse<'a> {
        let resources = model.touches.resource_count();
        let mut users: Vec<Vec<u32>> = vec![Vec::new(); resources];
        let mut passes = 0;
        for pass in live.nodes.iter().filter_map(|node| live.pass(*node)) {
            passes = passes.max(pass.index() + 1);
            for resource in model.touches.of(pass) {
                users[*resource as usize].push(pass.0);
            }
        }
        let left = users.iter().map(|users| users.len() as u32).collect();
        let in_use = vec![false; resources];
        InUse { model, users, left, in_use, scores: vec![None; passes], queue: BinaryHeap::new(), backwards }
    }

    fn score(&self, pass: PassId) -> i64 {
        let mut sum = 0i64;
        for resource in self.model.touches.of(pass).iter().map(|resource| *resource as usize) {
            if !self.model.is_transient(resource) {
                continue;
            }
            let bytes = i64::try_from(self.model.charged[resource]).unwrap_or(i64::MAX);
            if !self.in_use[resource] {
                sum = sum.saturating_add(bytes);
            }
            if self.left[resource] == 1 {
                sum = sum.saturating_sub(bytes);
            }
        }
        sum
    }

    fn ready(&mut self, pass: PassId) {
        let score = self.score(pass);
        if self.scores[pass.index()] != Some(score) {
            self.scores[pass.index()] = Some(score);
            let place = i64::from(pass.0);
            self.queue.push(Reverse((score, if self.backwards { -place } else { place }, pass.0)));
        }
    }

    fn next(&mut self) -> Option<PassId> {
        let pass = loop {
            let Reverse((score, _, pass)) = self.queue.pop()?;
            if self.scores[pass as usize] == Some(score) {
                break PassId(pass);
            }
        };
        self.scores[pass.index()] = None;
        let model = self.model;
        for resource in model.touches.of(pass).iter().map(|resource| *resource as usize) {
            let began = !std::mem::replace(&mut self.in_use[resource], true);
            self.left[resource] -= 1;
            if began || self.left[resource] == 1 {
                let users = std::mem::take(&mut self.users[resource]);
                for user in &users {
                    if self.scores[*user as usize].is_some() {
                        self.ready(PassId(*user));
                    }
                }
                self.users[resource] = users;
            }
        }
        Some(pass)
    }
}
