//! Passes that wait for each other.
//!
//! Each strongly connected component is one problem. Of all the cycles in it the message walks a shortest one through its
//! first pass, with a label on every link; the rest of the component is counted in a note.

use std::collections::VecDeque;

use petgraph::Direction;
use petgraph::algo::tarjan_scc;
use petgraph::graph::{DiGraph, NodeIndex};
use petgraph::visit::EdgeRef;

use super::dag::{Reason, walk};
use super::uses::Uses;
use super::versions::Versions;
use crate::bind::types::Bound;
use crate::diagnostic::Diagnostic;
use crate::expand::types::{PassId, ResourceId};
use crate::source::Span;

/// Why one node comes before another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Dependency {
    reason: Reason,
    resource: Option<ResourceId>,
    span: Span,
}

/// A pass, or `None` for a join. A pass's id is its node's index.
type Why = DiGraph<Option<PassId>, Dependency>;

/// The graph with its reasons. Two nodes have at most one edge in each direction.
fn explained(bound: &Bound, uses: &Uses, versions: &Versions) -> Why {
    let mut edges = Vec::new();
    let nodes = walk(bound, uses, versions, |edge| {
        let span = match (edge.reason, edge.at) {
            (Reason::After, _) => bound.steps[edge.to as usize].span,
            (_, at) => at.map_or(Span::NOWHERE, |id| uses.in_step(bound, id).span),
        };
        edges.push((edge.from, edge.to, Dependency { reason: edge.reason, resource: edge.resource, span }));
    });
    edges.sort_unstable_by_key(|(from, to, why)| (*from, *to, why.reason, why.resource, why.span));
    edges.dedup_by_key(|(from, to, _)| (*from, *to));
    let mut graph = Why::with_capacity(nodes, edges.len());
    for index in 0..nodes {
        graph.add_node((index < bound.steps.len()).then_some(PassId(index as u32)));
    }
    for (from, to, why) in edges {
        graph.add_edge(NodeIndex::new(from as usize), NodeIndex::new(to as usize), why);
    }
    graph
}

/// All cycles, by their first pass.
pub(crate) fn cycles(bound: &Bound, uses: &Uses, versions: &Versions) -> Vec<Diagnostic> {
    let dag = &explained(bound, uses, versions);
    let mut found: Vec<(PassId, Diagnostic)> = Vec::new();
    for component in tarjan_scc(dag) {
        let first = component.iter().filter_map(|node| pass_of(dag, *node)).min();
        let Some(first) = first else { continue };
        let start = NodeIndex::new(first.index());
        if component.len() > 1 || dag.contains_edge(start, start) {
            let links = shortest(dag, start, &component);
            found.push((first, report(bound, &links, &component, dag)));
        }
    }
    found.sort_by_key(|(first, _)| *first);
    found.into_iter().map(|(_, diagnostic)| diagnostic).collect()
}

fn pass_of(dag: &Why, node: NodeIndex) -> Option<PassId> {
    dag.node_weight(node).copied().flatten()
}

/// A link of a cycle: the earlier pass, the later pass, and why.
type Link = (PassId, PassId, Dependency);

/// A shortest cycle through `start` by breadth-first search; joins are left out.
fn shortest(dag: &Why, start: NodeIndex, component: &[NodeIndex]) -> Vec<Link> {
    let mut inside = vec![false; dag.node_count()];
    for node in component {
        inside[node.index()] = true;
    }
    let mut came_from: Vec<Option<(NodeIndex, Dependency)>> = vec![None; dag.node_count()];
    let mut queue = VecDeque::from([start]);
    'search: while let Some(node) = queue.pop_front() {
        let mut next: Vec<_> = dag.edges_directed(node, Direction::Outgoing).map(|edge| (edge.target(), *edge.weight())).collect();
        next.sort_unstable_by_key(|(target, _)| *target);
        for (target, why) in next {
            if inside[target.index()] && came_from[target.index()].is_none() {
                came_from[target.index()] = Some((node, why));
                if target == start {
                    break 'search;
                }
                queue.push_back(target);
            }
        }
    }
    let mut links = Vec::new();
    let (mut node, mut later, mut why): (NodeIndex, Option<PassId>, Option<Dependency>) = (start, pass_of(dag, start), None);
    while let Some((before, link)) = came_from[node.index()] {
        // Of the two edges at a join the one to the reader says where the reading is written.
        let kept = why.unwrap_or(link);
        match pass_of(dag, before) {
            Some(earlier) => {
                links.extend(later.map(|later| (earlier, later, kept)));
                (later, why) = (Some(earlier), None);
            }
            None => why = Some(kept),
        }
        node = before;
        if node == start {
            break;
        }
    }
    links.reverse();
    links
}

fn report(bound: &Bound, links: &[Link], component: &[NodeIndex], dag: &Why) -> Diagnostic {
    let name = |pass: PassId| &*bound.steps[pass.index()].name;
    let resource = |why: &Dependency| why.resource.map_or("", |resource| bound.expanded.resources[resource.index()].name.as_str());
    let sentence = |(earlier, later, why): &Link| match why.reason {
        Reason::Value => format!("`{}` needs `{}` from `{}`", name(*later), resource(why), name(*earlier)),
        Reason::Destroys => format!("`{}` changes `{}` after `{}` has read it", name(*later), resource(why), name(*earlier)),
        Reason::After => format!("`{}` says that it comes after `{}`", name(*later), name(*earlier)),
    };
    let by_hand = links.iter().all(|(_, _, why)| why.reason == Reason::After);
    let code = if by_hand { "schedule::after-cycle" } else { "schedule::cycle" };
    let mut round: Vec<String> = links.iter().map(|(earlier, _, _)| format!("`{}`", name(*earlier))).collect();
    round.extend(links.first().map(|(earlier, _, _)| format!("`{}`", name(*earlier))));
    let message = match links.len() {
        1 => format!("{} waits for itself", round[0]),
        _ => format!("passes wait for each other: {}", round.join(" -> ")),
    };
    let mut diagnostic = Diagnostic::error(code, message);
    for (index, link) in links.iter().enumerate() {
        diagnostic = if index == 0 { diagnostic.at(link.2.span, sentence(link)) } else { diagnostic.and(link.2.span, sentence(link)) };
        diagnostic = diagnostic.note(sentence(link));
    }
    let passes = component.iter().filter(|node| pass_of(dag, **node).is_some()).count();
    if passes > links.len() {
        diagnostic = diagnostic.note(format!("{} further passes wait for these and these for them", passes - links.len()));
    }
    diagnostic.hint(if by_hand {
        "take one of these `after` away"
    } else {
        "let one of them read an earlier value (a version), or give it a resource of its own"
    })
}
