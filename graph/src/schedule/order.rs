//! In which order passes run.
//!
//! The declared order takes, of all passes that are ready, the one that stands first in the file. Besides it other orders are
//! tried: two sweeps over it ([`super::sweep`]), and for few passes depth first from the outputs, swept or not. The one with the
//! fewest bytes that an executor would really allocate wins; on a tie the declared order does, so the chosen order is never worse
//! than it. Finding the best order is NP-hard, so none of this promises it.

use std::ops::Range;

use super::flow::Flow;
use super::sweep::sink_and_hoist;
use crate::allocate::model::{Model, Pool};
use crate::allocate::{arenas, textures};

/// So many passes are tried depth first, too: with more of them that order hardly ever wins.
const FEW: usize = 64;

/// The order with the fewest bytes.
pub(crate) fn chosen(flow: &Flow, model: &Model) -> Vec<u32> {
    let buffers = flow.pools.iter().zip(&flow.bytes).filter(|(pool, _)| **pool == Pool::Buffer);
    let buffers = buffers.fold(0u64, |sum, (_, bytes)| sum.saturating_add(*bytes));
    let mut best = Candidate::new(flow, model, flow.declared.clone());
    let mut consider = |order: Vec<u32>| {
        let mut candidate = Candidate::new(flow, model, order);
        if candidate.takes_less(&mut best, buffers, flow, model) {
            best = candidate;
        }
    };
    consider(sink_and_hoist(flow, &flow.bytes, &flow.declared));
    if flow.passes.len() <= FEW {
        let deep = depth_first(flow);
        consider(sink_and_hoist(flow, &flow.bytes, &deep));
        consider(deep);
    }
    best.order
}

/// An order with the bytes that an executor would allocate for it.
struct Candidate {
    order: Vec<u32>,
    ranges: Vec<Range<usize>>,
    textures: u64,
    /// Packed only where textures don't decide.
    arenas: Option<u64>,
}

impl Candidate {
    fn new(flow: &Flow, model: &Model, order: Vec<u32>) -> Candidate {
        let ranges = flow.ranges(&order);
        let textures = textures::bytes_reached(flow, model, &order, &ranges);
        Candidate { order, ranges, textures, arenas: None }
    }

    /// Arenas take between nothing and `buffers`, each buffer in an arena of its own.
    fn takes_less(&mut self, other: &mut Candidate, buffers: u64, flow: &Flow, model: &Model) -> bool {
        if self.textures.saturating_add(buffers) < other.textures {
            return true;
        }
        if self.textures >= other.textures.saturating_add(buffers) {
            return false;
        }
        self.bytes(flow, model) < other.bytes(flow, model)
    }

    fn bytes(&mut self, flow: &Flow, model: &Model) -> u64 {
        let arenas = *self.arenas.get_or_insert_with(|| {
            let buffers = flow.pools.iter().enumerate().filter(|(_, pool)| **pool == Pool::Buffer);
            let buffers = buffers.map(|(item, _)| (flow.resources[item].0, self.ranges[item].clone()));
            arenas::pack(model, buffers, arenas::ARENA_LIMIT).iter().fold(0, |sum, arena| sum.saturating_add(arena.bytes()))
        });
        self.textures.saturating_add(arenas)
    }
}

/// Every pass right after what it needs, results in the order of the file.
fn depth_first(flow: &Flow) -> Vec<u32> {
    let mut order = Vec::with_capacity(flow.passes.len());
    let mut entered = vec![false; flow.node_count()];
    let mut stack: Vec<(u32, usize)> = Vec::new();
    for root in (0..flow.node_count() as u32).filter(|node| flow.after.of(*node as usize).is_empty()) {
        if !std::mem::replace(&mut entered[root as usize], true) {
            stack.push((root, 0));
        }
        while let Some((node, place)) = stack.pop() {
            match flow.before.of(node as usize).get(place) {
                Some(needed) => {
                    stack.push((node, place + 1));
                    if !std::mem::replace(&mut entered[*needed as usize], true) {
                        stack.push((*needed, 0));
                    }
                }
                None if flow.is_pass(node) => order.push(node),
                None => {}
            }
        }
    }
    order
}
