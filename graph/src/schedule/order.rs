//! In which order passes run.
//!
//! The declared order takes, of all passes that are ready, the one that stands first in the file. Besides it other orders are
//! tried: depth first from the outputs, and ready passes by what they add to memory ([`super::greedy`]), with several weights,
//! forwards and from the end of the frame backwards. The one with the fewest bytes that an executor would really allocate wins;
//! on a tie the declared order does, so the chosen order is never worse than it. Small graphs get more tries than large ones.
//! Finding the best order is NP-hard, so none of this promises it.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use petgraph::visit::EdgeRef;

use super::dag::{Dag, Node};
use super::greedy::{Greedy, Users, Weights};
use crate::allocate::model::Model;
use crate::allocate::{bytes_reached, ranges_in};
use crate::expand::types::PassId;

/// The chosen order and the declared one.
pub(crate) struct Orders {
    pub(crate) chosen: Vec<PassId>,
    pub(crate) declared: Vec<PassId>,
}

/// Weights of new textures and of bytes in use, the most useful first.
const WEIGHTS: &[(i64, i64)] = &[(1, 1), (0, 1), (4, 1), (1, 0), (1, 4), (2, 1), (1, 2), (16, 1)];
/// Passes times tries.
const EFFORT: usize = 40_000;
/// Also for the largest graphs.
const FEWEST_TRIES: usize = 4;

/// Orders the live passes. The graph has no cycle.
pub(crate) fn orders(dag: &Dag, alive: &[bool], model: &Model) -> Orders {
    let live = Live::new(dag, alive);
    let declared = live.by_place();
    let reached = |order: &[PassId]| bytes_reached(model, &ranges_in(model, order));
    let mut best = (reached(&declared), declared.clone());
    let mut consider = |candidate: Vec<PassId>| {
        let bytes = reached(&candidate);
        if bytes < best.0 && candidate.len() == declared.len() {
            best = (bytes, candidate);
        }
    };
    consider(live.depth_first());
    let users = Users::new(model, live.passes());
    let tries = (EFFORT / live.nodes.len().max(1)).clamp(FEWEST_TRIES, WEIGHTS.len() * 2);
    let directions = WEIGHTS.iter().flat_map(|weights| [(weights, false), (weights, true)]);
    for ((fresh, growth), backwards) in directions.take(tries) {
        consider(live.by_memory(model, &users, Weights { fresh: *fresh, growth: *growth, backwards }));
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

    /// The ready pass that costs least; ties by place in the file.
    fn by_memory(&self, model: &Model, users: &Users, weights: Weights) -> Vec<PassId> {
        let mut state = Greedy::new(model, users, weights);
        self.run(weights.backwards, &mut state, Greedy::ready, Greedy::next)
    }

    fn passes(&self) -> impl Iterator<Item = PassId> + Clone {
        self.nodes.iter().filter_map(|node| self.pass(*node))
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
