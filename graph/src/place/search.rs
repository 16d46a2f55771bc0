//! The order with the least peak of live bytes, for few passes.
//!
//! A set of passes that holds all that its members need can be what has run so far; how many bytes are live after it does not
//! depend on the order inside of it. So the search goes over such sets, least peak first, and the first complete one is the
//! best. A pass after which no more bytes are live than before, and which stays within the peak so far, runs at once: whatever
//! order follows is no worse for it. The number of sets can be exponential, hence the budget.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};

use crate::schedule::flow::Flow;

/// Sets that are looked at.
const BUDGET: usize = 20_000;

/// An order whose peak is below `limit`, and that peak. `None` if there is none, there are more than 64 passes, or the budget ran out.
pub(crate) fn best_order(flow: &Flow, bytes: &[u64], limit: u64) -> Option<(Vec<u32>, u64)> {
    if flow.passes.len() > 64 || flow.passes.is_empty() {
        return None;
    }
    Search::new(flow, bytes).run(limit)
}

/// A set of passes that have run.
#[derive(Clone, Copy)]
struct State {
    done: u64,
    live: u64,
    peak: u64,
    /// The state before the last pass, and that pass.
    came_from: Option<(u32, u32)>,
}

/// Least peak, then most passes, then least live bytes, then the first found; and which state.
type Ranked = (Reverse<u64>, u32, Reverse<u64>, Reverse<u32>);

struct Search<'a> {
    flow: &'a Flow,
    bytes: &'a [u64],
    /// By pass: what it needs, joins resolved.
    needs: Vec<u64>,
    /// By item: who touches it.
    users: Vec<u64>,
    states: Vec<State>,
}

impl<'a> Search<'a> {
    fn new(flow: &'a Flow, bytes: &'a [u64]) -> Search<'a> {
        let bit = |node: &u32| 1u64 << node;
        let passes_of = |nodes: &[u32]| nodes.iter().filter(|node| flow.is_pass(**node)).map(bit).fold(0, |set, bit| set | bit);
        let needs = (0..flow.passes.len())
            .map(|pass| {
                let before = flow.before.of(pass);
                // A join stands between passes, never before another join.
                let joins = before.iter().filter(|node| !flow.is_pass(**node));
                joins.fold(passes_of(before), |set, join| set | passes_of(flow.before.of(*join as usize)))
            })
            .collect();
        let users = (0..bytes.len()).map(|item| passes_of(flow.users.of(item))).collect();
        Search { flow, bytes, needs, users, states: Vec::new() }
    }

    fn run(&mut self, limit: u64) -> Option<(Vec<u32>, u64)> {
        let all = u64::MAX >> (64 - self.flow.passes.len());
        // Looked up and never walked.
        let mut known: HashSet<u64> = HashSet::new();
        let mut queue: BinaryHeap<Ranked> = BinaryHeap::new();
        self.states.push(State { done: 0, live: 0, peak: 0, came_from: None });
        queue.push((Reverse(0), 0, Reverse(0), Reverse(0)));
        while let Some((.., Reverse(index))) = queue.pop() {
            let index = self.settle(index);
            let state = self.states[index as usize];
            if state.done == all {
                return Some((self.order(index), state.peak));
            }
            if self.states.len() > BUDGET {
                return None;
            }
            // A set that was reached before was reached with no larger a peak.
            if !known.insert(state.done) {
                continue;
            }
            for pass in self.ready(state.done) {
                let next = self.after(index, pass);
                if next.peak < limit && !known.contains(&next.done) {
                    let number = self.states.len() as u32;
                    queue.push((Reverse(next.peak), next.done.count_ones(), Reverse(next.live), Reverse(number)));
                    self.states.push(next);
                }
            }
        }
        None
    }

    fn ready(&self, done: u64) -> impl Iterator<Item = u32> + use<> {
        let ready: u64 = self.needs.iter().enumerate().fold(0, |set, (pass, needs)| if needs & !done == 0 { set | 1 << pass } else { set });
        let ready = ready & !done;
        (0..64u32).filter(move |pass| ready >> pass & 1 == 1)
    }

    fn after(&self, from: u32, pass: u32) -> State {
        let State { done, live, peak, .. } = self.states[from as usize];
        let now = done | 1 << pass;
        let (mut during, mut freed) = (live, 0u64);
        for item in self.flow.touches.of(pass as usize).iter().map(|item| *item as usize) {
            if self.users[item] & done == 0 {
                during = during.saturating_add(self.bytes[item]);
            }
            if self.users[item] & !now == 0 {
                freed = freed.saturating_add(self.bytes[item]);
            }
        }
        State { done: now, live: during.saturating_sub(freed), peak: peak.max(during), came_from: Some((from, pass)) }
    }

    /// Runs every pass that can do no harm.
    fn settle(&mut self, mut index: u32) -> u32 {
        'again: loop {
            let state = self.states[index as usize];
            for pass in self.ready(state.done) {
                let next = self.after(index, pass);
                if next.live <= state.live && next.peak <= state.peak {
                    index = self.states.len() as u32;
                    self.states.push(next);
                    continue 'again;
                }
            }
            return index;
        }
    }

    fn order(&self, mut index: u32) -> Vec<u32> {
        let mut order = Vec::with_capacity(self.flow.passes.len());
        while let Some((before, pass)) = self.states[index as usize].came_from {
            order.push(pass);
            index = before;
        }
        order.reverse();
        order
    }
}
