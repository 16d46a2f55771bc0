//! The passes that run, what each waits for, and the memory that they touch: all that choosing an order needs.
//!
//! Numbers and flat lists alone, so that it holds for any source of passes and resources. Nodes are passes, in the order of the
//! file, and after them the joins, which run nothing. Items are the transient resources that a node touches; retained ones cost
//! the same in every order and are left out.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

use super::dag::Dag;
use crate::allocate::model::{Model, Pool};
use crate::expand::types::{PassId, ResourceId};
use crate::lists::Lists;

/// See the module.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Flow {
    /// By node, the joins left out.
    pub(crate) passes: Vec<PassId>,
    /// By node: what must come first.
    pub(crate) before: Lists,
    /// By node: what waits for it.
    pub(crate) after: Lists,
    /// By node: the items that it touches, each once.
    pub(crate) touches: Lists,
    /// By item: the nodes that touch it.
    pub(crate) users: Lists,
    /// By item.
    pub(crate) resources: Vec<ResourceId>,
    /// By item.
    pub(crate) pools: Vec<Pool>,
    /// By item: what it is charged for.
    pub(crate) bytes: Vec<u64>,
    /// The passes in the declared order.
    pub(crate) declared: Vec<u32>,
}

impl Flow {
    /// The part of a graph that runs. The graph has no cycle.
    pub(crate) fn new(dag: &Dag, alive: &[bool], model: &Model) -> Flow {
        let mut numbers = vec![u32::MAX; dag.node_count()];
        let mut passes = Vec::with_capacity(dag.passes);
        let mut nodes = 0;
        for (index, number) in numbers.iter_mut().enumerate().filter(|(index, _)| alive[*index]) {
            *number = nodes;
            nodes += 1;
            if index < dag.passes {
                passes.push(PassId(index as u32));
            }
        }
        let number = |node: u32| Some(numbers[node as usize]).filter(|number| *number != u32::MAX);
        let edges: Vec<(u32, u32)> = dag.edges().filter_map(|(from, to)| Some((number(to)?, number(from)?))).collect();
        let before = Lists::from_pairs(nodes as usize, edges.iter().copied());
        // Turned around once, lists are ascending, and what comes twice lies side by side.
        let mut after = before.inverted(nodes as usize);
        after.dedup();
        let before = after.inverted(nodes as usize);

        let mut items = vec![u32::MAX; model.touches.resource_count()];
        let most = items.len();
        let (mut resources, mut pools, mut bytes) = (Vec::with_capacity(most), Vec::with_capacity(most), Vec::with_capacity(most));
        let mut touches = Lists::with_capacity(nodes as usize, 4 * passes.len());
        for pass in &passes {
            for resource in model.touches.of(*pass).iter().filter(|resource| model.is_transient(**resource as usize)) {
                let item = &mut items[*resource as usize];
                if *item == u32::MAX {
                    *item = resources.len() as u32;
                    resources.push(ResourceId(*resource));
                    pools.push(model.pools[*resource as usize]);
                    bytes.push(model.charged[*resource as usize]);
                }
                touches.push(*item);
            }
            touches.finish_list();
        }
        for _ in passes.len()..nodes as usize {
            touches.finish_list();
        }
        let users = touches.inverted(resources.len());
        let mut flow = Flow { passes, before, after, touches, users, resources, pools, bytes, declared: Vec::new() };
        flow.declared = if dag.in_order { (0..flow.passes.len() as u32).collect() } else { flow.by_place() };
        flow
    }

    /// How many passes and joins there are.
    pub(crate) fn node_count(&self) -> usize {
        self.before.count()
    }

    /// Whether a node is a pass.
    pub(crate) fn is_pass(&self, node: u32) -> bool {
        (node as usize) < self.passes.len()
    }

    /// An order of nodes as passes.
    pub(crate) fn passes_of(&self, order: &[u32]) -> Vec<PassId> {
        order.iter().map(|node| self.passes[*node as usize]).collect()
    }

    /// Always the ready pass that stands first in the file.
    fn by_place(&self) -> Vec<u32> {
        let mut waits: Vec<u32> = (0..self.node_count()).map(|node| self.before.of(node).len() as u32).collect();
        let mut order = Vec::with_capacity(self.passes.len());
        let mut ready: BinaryHeap<Reverse<u32>> = BinaryHeap::new();
        let mut open: Vec<u32> = (0..self.node_count() as u32).filter(|node| waits[*node as usize] == 0).collect();
        loop {
            while let Some(node) = open.pop() {
                if self.is_pass(node) {
                    ready.push(Reverse(node));
                } else {
                    self.release(node, &mut waits, &mut open);
                }
            }
            let Some(Reverse(node)) = ready.pop() else { break };
            order.push(node);
            self.release(node, &mut waits, &mut open);
        }
        order
    }

    fn release(&self, node: u32, waits: &mut [u32], open: &mut Vec<u32>) {
        for later in self.after.of(node as usize) {
            waits[*later as usize] -= 1;
            if waits[*later as usize] == 0 {
                open.push(*later);
            }
        }
    }

    /// First to last touching place of each item in an order, end exclusive.
    pub(crate) fn ranges(&self, order: &[u32]) -> Vec<Range<usize>> {
        let mut ranges = vec![0..0; self.bytes.len()];
        for (place, node) in order.iter().enumerate() {
            for item in self.touches.of(*node as usize) {
                let range = &mut ranges[*item as usize];
                if Range::is_empty(range) {
                    range.start = place;
                }
                range.end = place + 1;
            }
        }
        ranges
    }

    /// The largest sum of live bytes at any pass of an order.
    pub(crate) fn peak(&self, order: &[u32], bytes: &[u64]) -> u64 {
        let mut left: Vec<u32> = (0..self.bytes.len()).map(|item| self.users.of(item).len() as u32).collect();
        let (mut live, mut peak) = (0u64, 0u64);
        for node in order {
            let touched = self.touches.of(*node as usize);
            for item in touched.iter().map(|item| *item as usize) {
                if left[item] == self.users.of(item).len() as u32 {
                    live = live.saturating_add(bytes[item]);
                }
                left[item] -= 1;
            }
            peak = peak.max(live);
            for item in touched.iter().map(|item| *item as usize).filter(|item| left[*item] == 0) {
                live = live.saturating_sub(bytes[item]);
            }
        }
        peak
    }
}
