//! Sweeps over an order that take bytes out of use early and into use late.
//!
//! A sweep walks an order forwards. A pass that is ready and after which fewer bytes are in use than before runs at once; all
//! others stay where they stood. Walked backwards, with first and last use in each other's place, the same sweep moves passes
//! that bring bytes into use to just before what first needs them. A pass is looked at again only when it becomes ready, or when
//! one of its resources comes into use or has one user left, each of which happens once: the work is linear in uses, times the
//! uses of a pass.

use super::flow::Flow;

/// A sweep from the last pass to the first, then one from the first to the last.
pub(crate) fn sink_and_hoist(flow: &Flow, bytes: &[u64], order: &[u32]) -> Vec<u32> {
    let mut sunk = Sweep::new(flow, bytes, true).run(order.iter().rev());
    sunk.reverse();
    Sweep::new(flow, bytes, false).run(sunk.iter())
}

/// How often an item is still to be touched.
#[derive(Clone, Copy)]
struct Item {
    bytes: u64,
    /// How many users are not placed yet.
    left: u32,
    begun: bool,
}

/// Instead of how much a node waits for, once it stands in the order.
const PLACED: u32 = u32::MAX;

struct Sweep<'a> {
    flow: &'a Flow,
    backwards: bool,
    /// By node: how many of those that come first are not placed yet, or [`PLACED`].
    waits: Vec<u32>,
    items: Vec<Item>,
    /// Ready passes whose cost may have changed, and joins that are ready.
    open: Vec<u32>,
    order: Vec<u32>,
}

impl<'a> Sweep<'a> {
    fn new(flow: &'a Flow, bytes: &[u64], backwards: bool) -> Sweep<'a> {
        let needs = if backwards { &flow.after } else { &flow.before };
        let waits: Vec<u32> = (0..flow.node_count()).map(|node| needs.of(node).len() as u32).collect();
        let item = |(item, bytes): (usize, &u64)| Item { bytes: *bytes, left: flow.users.of(item).len() as u32, begun: false };
        let mut open = Vec::with_capacity(flow.node_count());
        open.extend((0..flow.node_count() as u32).filter(|node| waits[*node as usize] == 0));
        Sweep {
            flow,
            backwards,
            open,
            waits,
            items: bytes.iter().enumerate().map(item).collect(),
            order: Vec::with_capacity(flow.passes.len()),
        }
    }

    fn run<'b>(mut self, order: impl Iterator<Item = &'b u32>) -> Vec<u32> {
        self.settle();
        for node in order {
            if self.waits[*node as usize] != PLACED {
                self.place(*node);
                self.settle();
            }
        }
        self.order
    }

    /// Places what costs nothing.
    fn settle(&mut self) {
        while let Some(node) = self.open.pop() {
            if self.waits[node as usize] != PLACED && (!self.flow.is_pass(node) || self.frees(node)) {
                self.place(node);
            }
        }
    }

    /// Whether fewer bytes are in use after a pass than before it.
    fn frees(&self, node: u32) -> bool {
        let (mut begins, mut ends) = (0u64, 0u64);
        for Item { bytes, left, begun } in self.flow.touches.of(node as usize).iter().map(|item| self.items[*item as usize]) {
            begins = begins.saturating_add(if begun { 0 } else { bytes });
            ends = ends.saturating_add(if left == 1 { bytes } else { 0 });
        }
        ends > begins
    }

    fn place(&mut self, node: u32) {
        let flow = self.flow;
        self.waits[node as usize] = PLACED;
        if flow.is_pass(node) {
            self.order.push(node);
        }
        for item in flow.touches.of(node as usize).iter().map(|item| *item as usize) {
            let Item { left, begun, .. } = &mut self.items[item];
            *left -= 1;
            let began = !std::mem::replace(begun, true);
            if began || *left == 1 {
                self.open.extend(flow.users.of(item).iter().filter(|user| self.waits[**user as usize] == 0));
            }
        }
        let later = if self.backwards { flow.before.of(node as usize) } else { flow.after.of(node as usize) };
        for later in later {
            let waits = &mut self.waits[*later as usize];
            *waits -= 1;
            if *waits == 0 {
                self.open.push(*later);
            }
        }
    }
}
