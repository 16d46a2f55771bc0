//! In which order passes run.
//!
//! The declared order takes, of all passes that are ready, the one that stands first in the file. Besides it other orders are
//! tried: two sweeps over it ([`super::sweep`]), and for few passes depth first from the outputs, swept or not. The one with the
//! fewest bytes that an executor would really allocate wins; on a tie the declared order does, so the chosen order is never worse
//! than it. Finding the best order is NP-hard, so none of this promises it.

use super::flow::Flow;
use super::sweep::sink_and_hoist;
use crate::allocate::bytes_reached;
use crate::allocate::model::Model;

/// So many passes are tried depth first, too: with more of them that order hardly ever wins.
const FEW: usize = 256;

/// The order with the fewest bytes.
pub(crate) fn chosen(flow: &Flow, model: &Model) -> Vec<u32> {
    let mut best = (bytes_reached(flow, model, &flow.declared), flow.declared.clone());
    let mut consider = |candidate: Vec<u32>| {
        let bytes = bytes_reached(flow, model, &candidate);
        if bytes < best.0 {
            best = (bytes, candidate);
        }
    };
    consider(sink_and_hoist(flow, &flow.bytes, &flow.declared));
    if flow.passes.len() <= FEW {
        let deep = depth_first(flow);
        consider(sink_and_hoist(flow, &flow.bytes, &deep));
        consider(deep);
    }
    best.1
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
