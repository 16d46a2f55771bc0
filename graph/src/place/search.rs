//! The order with the least peak of live bytes, for few passes.
//!
//! A set of passes that holds all that its members need can be what has run so far; how many bytes are live after it does not
//! depend on the order inside of it. So the search goes over such sets, least peak first, and the first complete one is the
//! best. A pass after which no more bytes are live than before, and which stays within the peak so far, runs at once: whatever
//! order follows is no worse for it. The number of sets can be exponential, hence the budget.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};

use crate::lists::Lists;
use crate::mixer::BuildMixer;
use crate::schedule::flow::Flow;

/// Sets that are looked at.
const BUDGET: usize = 20_000;
/// So many that most searches look at no more.
const MOST: usize = 1_000;

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
    /// The passes that could run next.
    ready: u64,
    live: u64,
    peak: u64,
    /// The state before the last pass, and that pass.
    came_from: Option<(u32, u32)>,
}

/// Least peak, then most passes, then least live bytes, then the first found; and which state.
type Ranked = (Reverse<u64>, u32, Reverse<u64>, Reverse<u32>);

struct Search<'a> {
    flow: &'a Flow,
    /// By pass: what it needs, joins resolved.
    needs: Vec<u64>,
    /// By pass: what needs it.
    needed_by: Vec<u64>,
    /// By item: who touches it, and its bytes.
    items: Vec<(u64, u64)>,
    states: Vec<State>,
    /// Passes that are ready, with what [`Search::cost`] says.
    costs: Vec<(u32, u64, u64)>,
}

/// The numbers of a set.
fn members(mut set: u64) -> impl Iterator<Item = u32> {
    std::iter::from_fn(move || {
        let first = (set != 0).then(|| set.trailing_zeros())?;
        set &= set - 1;
        Some(first)
    })
}

impl<'a> Search<'a> {
    fn new(flow: &'a Flow, bytes: &[u64]) -> Search<'a> {
        let bit = |node: &u32| 1u64 << node;
        let passes_of = |nodes: &[u32]| nodes.iter().filter(|node| flow.is_pass(**node)).map(bit).fold(0, |set, bit| set | bit);
        // A join stands between passes, never before another join.
        let behind = |lists: &Lists, pass: usize| {
            let direct = lists.of(pass);
            let joins = direct.iter().filter(|node| !flow.is_pass(**node));
            joins.fold(passes_of(direct), |set, join| set | passes_of(lists.of(*join as usize)))
        };
        let needs = (0..flow.passes.len()).map(|pass| behind(&flow.before, pass)).collect();
        let needed_by = (0..flow.passes.len()).map(|pass| behind(&flow.after, pass)).collect();
        let items = bytes.iter().enumerate().map(|(item, bytes)| (passes_of(flow.users.of(item)), *bytes)).collect();
        Search { flow, needs, needed_by, items, states: Vec::with_capacity(MOST), costs: Vec::new() }
    }

    /// What no order can do without: the most that one pass touches.
    fn floor(&self) -> u64 {
        let touched = |pass: usize| self.flow.touches.of(pass).iter().map(|item| self.items[*item as usize].1);
        let sums = (0..self.needs.len()).map(|pass| touched(pass).fold(0, u64::saturating_add));
        sums.max().unwrap_or(0)
    }

    fn run(&mut self, limit: u64) -> Option<(Vec<u32>, u64)> {
        // What no order can do without counts from the start, so that whatever stays below it does no harm.
        let floor = self.floor();
        if limit <= floor {
            return None;
        }
        let all = u64::MAX >> (64 - self.flow.passes.len());
        let mut known: HashSet<u64, BuildMixer> = HashSet::with_capacity_and_hasher(MOST, Default::default());
        let mut queue: BinaryHeap<Ranked> = BinaryHeap::new();
        let ready = self.needs.iter().enumerate().fold(0, |set, (pass, needs)| if *needs == 0 { set | 1 << pass } else { set });
        self.states.push(State { done: 0, ready, live: 0, peak: floor, came_from: None });
        queue.push((Reverse(floor), 0, Reverse(0), Reverse(0)));
        while let Some((.., Reverse(index))) = queue.pop() {
            // A set that was reached before was reached with no larger a peak.
            if !known.insert(self.states[index as usize].done) {
                continue;
            }
            let settled = self.settle(index);
            let state = self.states[settled as usize];
            if state.done == all {
                return Some((self.order(settled), state.peak));
            }
            if self.states.len() > BUDGET {
                return None;
            }
            if settled != index && !known.insert(state.done) {
                continue;
            }
            for place in 0..self.costs.len() {
                let (pass, live, peak) = self.costs[place];
                if peak < limit && !known.contains(&(state.done | 1 << pass)) {
                    let number = self.states.len() as u32;
                    queue.push((Reverse(peak), state.done.count_ones() + 1, Reverse(live), Reverse(number)));
                    self.states.push(self.after(settled, pass, live, peak));
                }
            }
        }
        None
    }

    /// Live bytes after one more pass, and the peak by then.
    fn cost(&self, &State { done, live, peak, .. }: &State, pass: u32) -> (u64, u64) {
        let now = done | 1 << pass;
        let (mut during, mut freed) = (live, 0u64);
        for item in self.flow.touches.of(pass as usize) {
            let (users, bytes) = self.items[*item as usize];
            if users & done == 0 {
                during = during.saturating_add(bytes);
            }
            if users & !now == 0 {
                freed = freed.saturating_add(bytes);
            }
        }
        (during.saturating_sub(freed), peak.max(during))
    }

    fn after(&self, from: u32, pass: u32, live: u64, peak: u64) -> State {
        let State { done, ready, .. } = self.states[from as usize];
        let now = done | 1 << pass;
        let released = members(self.needed_by[pass as usize]).filter(|later| self.needs[*later as usize] & !now == 0);
        let ready = released.fold(ready & !(1 << pass), |set, later| set | 1 << later);
        State { done: now, ready, live, peak, came_from: Some((from, pass)) }
    }

    /// Runs every pass that can do no harm. Leaves what the others cost.
    fn settle(&mut self, mut index: u32) -> u32 {
        'settled: loop {
            let state = self.states[index as usize];
            self.costs.clear();
            for pass in members(state.ready) {
                let (live, peak) = self.cost(&state, pass);
                if live <= state.live && peak <= state.peak {
                    let next = self.after(index, pass, live, peak);
                    index = self.states.len() as u32;
                    self.states.push(next);
                    continue 'settled;
                }
                self.costs.push((pass, live, peak));
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
