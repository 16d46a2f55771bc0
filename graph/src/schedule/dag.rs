//! What must run before what.
//!
//! Edges go from a producer along its modifiers, from the last of them to every reader of the final value, from a reader of an
//! earlier version to the modifier that destroys it, from a pass that remembers the last frame to every writer of what it
//! remembers, and from each pass named under `after`. Where many passes write what many
//! read, a join stands between them, so that edges stay linear in uses.
//!
//! Planning needs the edges alone; why each stands there is found by a second walk where a cycle has to be explained.

use super::uses::{UseId, Uses};
use super::versions::Versions;
use crate::bind::types::Bound;
use crate::expand::types::ResourceId;
use crate::lists::Lists;

/// Why one node must come before another. In the order in which one of several is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Reason {
    /// The later one reads or modifies the value of the earlier one.
    Value,
    /// The later one destroys the value that the earlier one reads.
    Destroys,
    /// The author says so.
    After,
}

/// An edge. Nodes are the passes by id, and after them the joins, which stand for all writers of a rectangle and run nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge {
    pub(crate) from: u32,
    pub(crate) to: u32,
    pub(crate) reason: Reason,
    /// Through which resource; `None` for `after`.
    pub(crate) resource: Option<ResourceId>,
    /// Where the later pass (for `Destroys`, the earlier one) refers to it.
    pub(crate) at: Option<UseId>,
}

/// The graph of all passes, culled or not.
#[derive(Debug)]
pub(crate) struct Dag {
    /// How many nodes are passes.
    pub(crate) passes: usize,
    /// By node: those whose values it needs. Some may come twice.
    pub(crate) values: Lists,
    /// All other edges. Some may come twice.
    pub(crate) others: Vec<(u32, u32)>,
    /// Whether every pass stands in the file after all that it waits for. Then there is no cycle.
    pub(crate) in_order: bool,
}

impl Dag {
    /// Builds the graph.
    pub(crate) fn new(bound: &Bound, uses: &Uses, versions: &Versions) -> Dag {
        let passes = bound.steps.len();
        let mut values: Vec<(u32, u32)> = Vec::with_capacity(4 * passes);
        let mut others = Vec::new();
        // By join: the last of its writers, as far as they are known. They come before its readers.
        let mut joins: Vec<u32> = Vec::new();
        let mut in_order = true;
        let nodes = walk(bound, uses, versions, |Edge { from, to, reason, .. }| {
            match reason {
                Reason::Value => values.push((to, from)),
                Reason::Destroys | Reason::After => others.push((from, to)),
            }
            match (to as usize).checked_sub(passes) {
                Some(join) => {
                    joins.resize(joins.len().max(join + 1), 0);
                    joins[join] = joins[join].max(from);
                }
                None => in_order &= (from as usize).checked_sub(passes).map_or(from, |join| joins[join]) < to,
            }
        });
        Dag { passes, values: Lists::from_pairs(nodes, values.iter().copied()), others, in_order }
    }

    /// How many passes and joins there are.
    pub(crate) fn node_count(&self) -> usize {
        self.values.count()
    }

    /// All edges, from the earlier node to the later one.
    pub(crate) fn edges(&self) -> impl Iterator<Item = (u32, u32)> + Clone {
        let values = (0..self.node_count() as u32).flat_map(|to| self.values.of(to as usize).iter().map(move |from| (*from, to)));
        values.chain(self.others.iter().copied())
    }

    /// Whether some passes wait for each other.
    pub(crate) fn has_cycle(&self) -> bool {
        if self.in_order {
            return false;
        }
        let count = self.node_count();
        let after = Lists::from_pairs(count, self.edges());
        let mut waits = vec![0u32; count];
        self.edges().for_each(|(_, to)| waits[to as usize] += 1);
        let mut open: Vec<u32> = (0..count as u32).filter(|node| waits[*node as usize] == 0).collect();
        let mut released = 0;
        while let Some(node) = open.pop() {
            released += 1;
            for later in after.of(node as usize) {
                waits[*later as usize] -= 1;
                if waits[*later as usize] == 0 {
                    open.push(*later);
                }
            }
        }
        released < count
    }
}

/// Visits every edge, some more than once, and returns how many nodes there are.
pub(crate) fn walk(bound: &Bound, uses: &Uses, versions: &Versions, mut visit: impl FnMut(Edge)) -> usize {
    let mut nodes = bound.steps.len() as u32;
    // A pass that reads what it writes is reported elsewhere.
    let mut add = |edge: Edge| {
        if edge.from != edge.to {
            visit(edge);
        }
    };
    let pass = |id: UseId| uses.get(id).pass.0;
    for (index, grid) in versions.grids().enumerate() {
        let resource = Some(ResourceId(index as u32));
        for cell in grid.cells {
            for pair in grid.writers(cell).windows(2) {
                add(Edge { from: pass(pair[0]), to: pass(pair[1]), reason: Reason::Value, resource, at: Some(pair[1]) });
            }
        }
        // The past is remembered before anything touches it.
        for recaller in &grid.exceptions.recallers {
            // Before its first reader a part that nothing makes is filled.
            let fillers = grid.regions.iter().filter(|region| !grid.unwritten(region).is_empty()).flat_map(|region| grid.readers(region));
            for later in grid.all_writers().chain(fillers.copied()) {
                add(Edge { from: pass(*recaller), to: pass(later), reason: Reason::Destroys, resource, at: Some(*recaller) });
            }
        }
        for region in grid.regions {
            let (makers, readers) = (grid.makers(region), grid.readers(region));
            let joined = makers.len().saturating_mul(readers.len()) > 4 * (makers.len() + readers.len());
            if joined {
                let join = nodes;
                nodes += 1;
                for maker in makers {
                    add(Edge { from: maker.0, to: join, reason: Reason::Value, resource, at: None });
                }
                for reader in readers {
                    add(Edge { from: join, to: pass(*reader), reason: Reason::Value, resource, at: Some(*reader) });
                }
            }
            for reader in readers {
                let (to, at) = (pass(*reader), Some(*reader));
                for maker in makers.iter().filter(|_| !joined) {
                    add(Edge { from: maker.0, to, reason: Reason::Value, resource, at });
                }
                for destroyer in grid.destroyers(region) {
                    add(Edge { from: to, to: destroyer.0, reason: Reason::Destroys, resource, at });
                }
            }
        }
    }
    for (index, step) in (0u32..).zip(&bound.expanded.passes) {
        for earlier in &step.after {
            // A pass that comes after itself is a cycle.
            visit(Edge { from: earlier.0, to: index, reason: Reason::After, resource: None, at: None });
        }
    }
    nodes as usize
}
