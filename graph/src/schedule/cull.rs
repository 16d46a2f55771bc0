//! Which passes an output needs.
//!
//! A pass is alive if it left a value that an asked-for output shows or a live pass reads or modifies. `after` and the order of a
//! reader before a modifier keep nothing alive.

use super::dag::Dag;
use super::uses::Uses;
use super::versions::{Grid, Versions, writes};
use crate::bind::types::Bound;
use crate::expand::types::PassId;
use crate::lists::Lists;
use crate::plan::{CullReason, Culled, Role};

/// For each node of the graph, whether it is needed.
pub(crate) fn alive(bound: &Bound, uses: &Uses, dag: &Dag, versions: &Versions) -> Vec<bool> {
    let mut alive = vec![false; dag.node_count()];
    let mut open: Vec<u32> = Vec::new();
    for grid in bound.expanded.outputs.iter().map(|output| versions.grid(output.part.resource.index())) {
        let shown = grid.regions.iter().filter(|region| !grid.outputs(region).is_empty());
        open.extend(shown.flat_map(|region| grid.makers(region)).map(|pass| pass.0));
    }
    // A pass that remembers the last frame needs whoever left the value then, without coming after it.
    let mut recalled: Vec<(u32, u32)> = versions.exceptional().flat_map(|grid| recalled(uses, grid)).collect();
    recalled.sort_unstable();
    while let Some(node) = open.pop() {
        if std::mem::replace(&mut alive[node as usize], true) {
            continue;
        }
        let first = recalled.partition_point(|(recaller, _)| *recaller < node);
        open.extend(recalled[first..].iter().take_while(|(recaller, _)| *recaller == node).map(|(_, writer)| *writer));
        open.extend(dag.values.of(node as usize).iter().filter(|source| !alive[**source as usize]));
    }
    alive
}

/// Passes that remember a resource, each with every writer of it.
fn recalled<'a>(uses: &'a Uses, grid: Grid<'a>) -> impl Iterator<Item = (u32, u32)> + 'a {
    let pass = |id| uses.get(id).pass.0;
    grid.exceptions.recallers.iter().flat_map(move |recaller| grid.all_writers().map(move |writer| (pass(*recaller), pass(writer))))
}

/// The passes that do not run, in the order of the file, each with what would have used its results.
pub(crate) fn culled(bound: &Bound, uses: &Uses, dag: &Dag, alive: &[bool]) -> Vec<Culled> {
    let users = users(dag, alive);
    let mut found = Vec::new();
    for (index, step) in bound.steps.iter().enumerate().filter(|(index, _)| !alive[*index]) {
        let touched = |wanted: fn(Role) -> bool| {
            let mut resources: Vec<_> = uses.of_pass(index).iter().filter(|used| wanted(used.role)).map(|used| used.resource).collect();
            resources.sort_unstable();
            resources.dedup();
            resources
        };
        let writes = touched(writes);
        let users = users.of(index);
        let reason = match (writes.is_empty(), users.is_empty()) {
            (true, _) => CullReason::WritesNothing,
            (false, true) => CullReason::Unread,
            (false, false) => CullReason::OnlyCulledReaders(users.iter().map(|pass| PassId(*pass)).collect()),
        };
        let kind = bound.expanded.passes.get(index).map_or("", |pass| pass.kind.name());
        let pass = PassId(index as u32);
        found.push(Culled { pass, name: step.name.clone(), kind, writes, reads: touched(|role| role != Role::Produce), reason });
    }
    found
}

/// By pass that does not run: the passes that take a value from it, by id. They do not run either.
fn users(dag: &Dag, alive: &[bool]) -> Lists {
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    for user in (0..dag.passes as u32).filter(|pass| !alive[*pass as usize]) {
        for source in dag.values.of(user as usize) {
            // A join stands between passes, never before another join.
            let behind = if (*source as usize) < dag.passes { std::slice::from_ref(source) } else { dag.values.of(*source as usize) };
            pairs.extend(behind.iter().filter(|source| !alive[**source as usize]).map(|source| (*source, user)));
        }
    }
    // Users come in ascending order.
    let mut users = Lists::from_pairs(dag.passes, pairs.iter().copied());
    users.dedup();
    users
}
