//! Which passes an output needs.
//!
//! A pass is alive if it left a value that an asked-for output shows or a live pass reads or modifies. `after` and the order of a
//! reader before a modifier keep nothing alive.

use petgraph::Direction;
use petgraph::graph::NodeIndex;
use petgraph::visit::EdgeRef;

use super::dag::{Dag, Node, Reason};
use super::versions::Grid;
use crate::bind::types::Bound;
use crate::expand::types::PassId;
use crate::plan::{CullReason, Culled, Role};

/// For each node of the graph, whether it is needed.
pub(crate) fn alive(dag: &Dag, grids: &[Grid]) -> Vec<bool> {
    let mut alive = vec![false; dag.node_count()];
    let roots = grids.iter().flat_map(|grid| &grid.regions).filter(|region| !region.outputs.is_empty());
    let mut open: Vec<NodeIndex> = roots.flat_map(|region| &region.writers).map(|pass| NodeIndex::new(pass.index())).collect();
    // A pass that remembers the last frame needs whoever left the value then, without coming after it.
    let mut recalled: Vec<(NodeIndex, NodeIndex)> = grids.iter().flat_map(recalled).collect();
    recalled.sort_unstable();
    while let Some(node) = open.pop() {
        if std::mem::replace(&mut alive[node.index()], true) {
            continue;
        }
        let first = recalled.partition_point(|(recaller, _)| *recaller < node);
        open.extend(recalled[first..].iter().take_while(|(recaller, _)| *recaller == node).map(|(_, writer)| *writer));
        let values = dag.edges_directed(node, Direction::Incoming).filter(|edge| edge.weight().reason == Reason::Value);
        open.extend(values.map(|edge| edge.source()).filter(|source| !alive[source.index()]));
    }
    alive
}

/// Passes that remember a resource, each with every writer of it.
fn recalled(grid: &Grid) -> impl Iterator<Item = (NodeIndex, NodeIndex)> {
    let node = |pass: PassId| NodeIndex::new(pass.index());
    let writers = || grid.cells.iter().flat_map(|cell| &cell.writers).map(|writer| writer.pass);
    grid.recallers.iter().flat_map(move |recaller| writers().map(move |writer| (node(recaller.pass), node(writer))))
}

/// The passes that do not run, in the order of the file, each with what would have used its results.
pub(crate) fn culled(bound: &Bound, dag: &Dag, alive: &[bool]) -> Vec<Culled> {
    let mut found = Vec::new();
    for (index, step) in bound.steps.iter().enumerate().filter(|(index, _)| !alive[*index]) {
        let touched = |wanted: fn(Role) -> bool| {
            let mut resources: Vec<_> = step.uses.iter().filter(|used| wanted(used.role)).map(|used| used.resource).collect();
            resources.sort_unstable();
            resources.dedup();
            resources
        };
        let writes = touched(super::versions::writes);
        let users = users(dag, NodeIndex::new(index));
        let reason = match (writes.is_empty(), users.is_empty()) {
            (true, _) => CullReason::WritesNothing,
            (false, true) => CullReason::Unread,
            (false, false) => CullReason::OnlyCulledReaders(users),
        };
        let kind = bound.expanded.passes.get(index).map_or("", |pass| pass.kind.name());
        let pass = PassId(index as u32);
        found.push(Culled { pass, name: step.name.clone(), kind, writes, reads: touched(|role| role != Role::Produce), reason });
    }
    found
}

/// Passes that take a value from this one, by id.
fn users(dag: &Dag, node: NodeIndex) -> Vec<PassId> {
    let mut users = Vec::new();
    let mut open = vec![node];
    while let Some(node) = open.pop() {
        for edge in dag.edges_directed(node, Direction::Outgoing).filter(|edge| edge.weight().reason == Reason::Value) {
            match dag[edge.target()] {
                Node::Pass(pass) => users.push(pass),
                Node::Join => open.push(edge.target()),
            }
        }
    }
    users.sort_unstable();
    users.dedup();
    users
}
