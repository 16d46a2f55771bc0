//! What must run before what.
//!
//! Edges go from a producer along its modifiers, from the last of them to every reader of the final value, from a reader of an
//! earlier version to the modifier that destroys it, from a pass that remembers the last frame to every writer of what it
//! remembers, and from each pass named under `after`. Where many passes write what many
//! read, a join stands between them, so that edges stay linear in uses.

use petgraph::graph::{DiGraph, NodeIndex};

use super::versions::Grid;
use crate::bind::types::Bound;
use crate::expand::types::{PassId, ResourceId};
use crate::source::Span;

/// A node of the graph. The passes come first, so that a pass's id is its node's index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Node {
    /// A pass.
    Pass(PassId),
    /// Stands for all writers of a rectangle; runs nothing.
    Join,
}

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

/// The weight of an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Dependency {
    pub(crate) reason: Reason,
    /// Through which resource; `None` for `after`.
    pub(crate) resource: Option<ResourceId>,
    /// Where the later pass (for `Destroys`, the earlier one) refers to it.
    pub(crate) span: Span,
}

/// The graph of all passes, culled or not.
pub(crate) type Dag = DiGraph<Node, Dependency>;

/// Builds the graph. Two nodes have at most one edge in each direction.
pub(crate) fn dag(bound: &Bound, grids: &[Grid]) -> Dag {
    let mut edges = Edges { list: Vec::new(), nodes: bound.steps.len() };
    for (index, grid) in grids.iter().enumerate() {
        let resource = Some(ResourceId(index as u32));
        for cell in &grid.cells {
            for pair in cell.writers.windows(2) {
                let dependency = Dependency { reason: Reason::Value, resource, span: pair[1].get(bound).span };
                edges.add(pair[0].pass.index(), pair[1].pass.index(), dependency);
            }
        }
        // The past is remembered before anything touches it.
        for recaller in &grid.recallers {
            let span = recaller.get(bound).span;
            let writers = grid.cells.iter().flat_map(|cell| &cell.writers);
            // Before its first reader a part that nothing makes is filled.
            let fillers = grid.regions.iter().filter(|region| !region.unwritten.is_empty()).flat_map(|region| &region.readers);
            for later in writers.chain(fillers) {
                edges.add(recaller.pass.index(), later.pass.index(), Dependency { reason: Reason::Destroys, resource, span });
            }
        }
        for region in &grid.regions {
            let value = |span| Dependency { reason: Reason::Value, resource, span };
            let (writers, readers) = (region.writers.len(), region.readers.len());
            let joined = writers.saturating_mul(readers) > 4 * (writers + readers);
            if joined {
                let join = edges.join();
                for writer in &region.writers {
                    edges.add(writer.index(), join, value(Span::NOWHERE));
                }
                for reader in &region.readers {
                    edges.add(join, reader.pass.index(), value(reader.get(bound).span));
                }
            }
            for reader in &region.readers {
                let span = reader.get(bound).span;
                for writer in region.writers.iter().filter(|_| !joined) {
                    edges.add(writer.index(), reader.pass.index(), value(span));
                }
                for destroyer in &region.destroyers {
                    edges.add(reader.pass.index(), destroyer.index(), Dependency { reason: Reason::Destroys, resource, span });
                }
            }
        }
    }
    for (index, (pass, step)) in bound.expanded.passes.iter().zip(&bound.steps).enumerate() {
        for earlier in &pass.after {
            edges.add_after(earlier.index(), index, step.span);
        }
    }
    edges.finish(bound.steps.len())
}

struct Edges {
    list: Vec<(u32, u32, Dependency)>,
    nodes: usize,
}

impl Edges {
    fn join(&mut self) -> usize {
        self.nodes += 1;
        self.nodes - 1
    }

    fn add(&mut self, from: usize, to: usize, dependency: Dependency) {
        // A pass that reads what it writes is reported elsewhere.
        if from != to {
            self.list.push((from as u32, to as u32, dependency));
        }
    }

    fn add_after(&mut self, from: usize, to: usize, span: Span) {
        self.list.push((from as u32, to as u32, Dependency { reason: Reason::After, resource: None, span }));
    }

    fn finish(mut self, passes: usize) -> Dag {
        self.list.sort_unstable_by_key(|(from, to, why)| (*from, *to, why.reason, why.resource, why.span));
        self.list.dedup_by_key(|(from, to, _)| (*from, *to));
        let mut graph = Dag::with_capacity(self.nodes, self.list.len());
        for index in 0..self.nodes {
            graph.add_node(if index < passes { Node::Pass(PassId(index as u32)) } else { Node::Join });
        }
        for (from, to, why) in self.list {
            graph.add_edge(NodeIndex::new(from as usize), NodeIndex::new(to as usize), why);
        }
        graph
    }
}
