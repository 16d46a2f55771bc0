//! In which order passes run.
//!
//! The declared order takes, of all passes that are ready, the one that stands first in the file. Besides it other orders are
//! tried: depth first from the outputs, and sweeps ([`super::sweep`]) over both. The one with the fewest bytes that an executor
//! would really allocate wins; on a tie the declared order does, so the chosen order is never worse than it. Finding the best
//! order is NP-hard, so none of this promises it.

use super::flow::Flow;
use super::sweep::sink_and_hoist;
use crate::allocate::bytes_reached;
use crate::allocate::model::Model;

/// The order with the fewest bytes.
pub(crate) fn chosen(flow: &Flow, model: &Model) -> Vec<u32> {
    let mut best = (bytes_reached(flow, model, &flow.declared), flow.declared.clone());
    let debug = std::env::var_os("DEBUG_ORDER").is_some();
    let mut consider = |what: &str, candidate: Vec<u32>| {
        let bytes = bytes_reached(flow, model, &candidate);
        if debug {
            eprintln!("{what} {:.3} peak {:.3}", bytes as f64 / best.0 as f64, flow.peak(&candidate, &flow.bytes) as f64 / flow.peak(&flow.declared, &flow.bytes) as f64);
        }
        if bytes < best.0 {
            best = (bytes, candidate);
        }
    };
    let swept = sink_and_hoist(flow, &flow.bytes, &flow.declared);
    if debug {
    consider("again", sink_and_hoist(flow, &flow.bytes, &swept));
    let deep = depth_first(flow);
    consider("deep", deep.clone());
    consider("deep swept", sink_and_hoist(flow, &flow.bytes, &deep));
    }
    consider("swept", swept);
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
