//! What must hold between passes that keep something from frame to frame.
//!
//! What an accumulating pass or an iteration of a spread loop writes is written by nobody else, is never made again, and shows its
//! declared value until it is written. A cycle through the past needs a pass that runs though nothing else has changed, and
//! an end that is chosen by the author.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

use petgraph::algo::tarjan_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use super::environment::Environment;
use super::error::ExpandError;
use super::types::{Keep, PartRef, Pass, PassId, PassKind, Resource, ResourceId, Run, Slot};
use super::writers::{Writers, Written};
use crate::validate::types::Validated;

/// Reports what does not hold.
pub(super) fn check(environment: &mut Environment<'_>, validated: &Validated, resources: &[Resource], passes: &[Pass]) {
    let amortised = passes.iter().any(|pass| is_amortised(pass.run));
    if !amortised && validated.histories.is_empty() && validated.resources.iter().all(|decl| decl.keep.value == Keep::Auto) {
        return;
    }
    let writers = Writers::new(resources, passes);
    let mut needed: Vec<Option<&'static str>> = vec![None; resources.len()];
    for history in resources.iter().filter_map(|resource| resource.history) {
        needed[history.of.index()] = Some("its past is read");
    }
    for (index, pass) in passes.iter().enumerate().filter(|(_, pass)| is_amortised(pass.run)) {
        for slot in pass.writes.iter().chain(&pass.modifies) {
            needed[slot.part.resource.index()] = Some("a pass writes it that does not run in every frame");
        }
        check_amortised(environment, resources, passes, &writers, PassId(index as u32));
    }
    for (decl, needed) in validated.resources.iter().zip(needed) {
        if let (Some(why), Keep::Never) = (needed, decl.keep.value) {
            environment.report(ExpandError::MustBeKept { name: decl.name.value.clone(), why, span: decl.keep.span });
        }
    }
    if !validated.histories.is_empty() {
        check_cycles(environment, resources, passes, &writers);
    }
}

fn is_amortised(run: Run) -> bool {
    matches!(run, Run::Accumulate(_) | Run::Spread { .. })
}

fn check_amortised(environment: &mut Environment<'_>, resources: &[Resource], passes: &[Pass], writers: &Writers<'_>, id: PassId) {
    let pass = &passes[id.index()];
    let spread = matches!(pass.run, Run::Spread { .. });
    // What else may write: passes of the same iteration. A batched pass stands for all of its loop's.
    let together = |other: &Pass| match (pass.run, other.run) {
        (Run::Spread { .. }, Run::Spread { .. }) => pass.run == other.run,
        _ => false,
    };
    let declared: &[(&[Slot], bool)] = &[(&pass.writes, spread), (&pass.modifies, true)];
    for (slots, needs_value) in declared {
        for slot in *slots {
            let resource = &resources[slot.part.resource.index()];
            let mut others = writers.overlapping(&slot.part).into_iter().flat_map(Written::passes);
            if let Some(other) = others.find(|other| *other != id && !together(&passes[other.index()])) {
                let other = &passes[other.index()];
                environment.report(ExpandError::SharedWithAmortised {
                    resource: resource.name.clone(),
                    pass: pass.name.clone(),
                    other: other.name.clone(),
                    span: slot.part.span,
                    other_span: other.span,
                });
            }
            if *needs_value && resource.clear.is_none() {
                environment.report(ExpandError::NoValueBefore {
                    resource: resource.name.clone(),
                    pass: pass.name.clone(),
                    span: slot.part.span,
                    declared: resource.span,
                });
            }
        }
    }
}

/// A cycle through the past without a pass that says when it runs would never settle.
fn check_cycles(environment: &mut Environment<'_>, resources: &[Resource], passes: &[Pass], writers: &Writers<'_>) {
    let mut graph: DiGraph<(), ()> = DiGraph::with_capacity(passes.len(), passes.len());
    for _ in passes {
        graph.add_node(());
    }
    let mut read_parts = BTreeMap::new();
    let node = |pass: PassId| NodeIndex::new(pass.index());
    for (index, pass) in passes.iter().enumerate() {
        let to = NodeIndex::new(index);
        for slot in &pass.reads {
            if let Some(version) = slot.part.version {
                graph.add_edge(node(version), to, ());
                continue;
            }
            // Readers of one part share a node, so that a thousand readers of a thousand writers cost two thousand edges.
            let key = (slot.part.resource, slot.part.mips, slot.part.layers);
            let read = *read_parts.entry(key).or_insert_with(|| {
                let read = graph.add_node(());
                for from in writers.overlapping(&slot.part).into_iter().flat_map(Written::passes) {
                    graph.add_edge(node(from), read, ());
                }
                read
            });
            graph.add_edge(read, to, ());
        }
        for slot in &pass.modifies {
            for written in writers.overlapping(&slot.part) {
                // The last before it is enough: those before are before that one.
                let before = written.modifiers.iter().rev().find(|other| other.index() < index);
                for from in written.producers.iter().chain(before) {
                    graph.add_edge(node(*from), to, ());
                }
            }
        }
        if let (PassKind::Remember, Some(source)) = (&pass.kind, source(resources, pass)) {
            let all = PartRef { resource: source, mips: None, layers: None, version: None, span: pass.span };
            for from in writers.overlapping(&all).into_iter().flat_map(Written::passes) {
                graph.add_edge(node(from), to, ());
            }
        }
    }
    // One pass alone is no cycle: nothing both is a past and reads it.
    for component in tarjan_scc(&graph).into_iter().filter(|component| component.len() > 1) {
        let members = || component.iter().filter_map(|node| passes.get(node.index()));
        let remembers = members().find(|pass| matches!(pass.kind, PassKind::Remember));
        let Some(remember) = remembers.filter(|_| members().all(|pass| pass.run == Run::OnChange)) else { continue };
        let start = passes.iter().position(|pass| std::ptr::eq(pass, remember)).unwrap_or(0);
        let round = round(&graph, NodeIndex::new(start), &component);
        let names: Vec<String> = round.iter().filter_map(|node| passes.get(node.index())).map(|pass| format!("`{}`", pass.name)).collect();
        let first = round.iter().filter_map(|node| passes.get(node.index())).find(|pass| !matches!(pass.kind, PassKind::Remember));
        environment.report(ExpandError::NeverSettles {
            cycle: format!("{} -> `{}`", names.join(" -> "), remember.name),
            span: remember.span,
            pass: first.map_or(remember.span, |pass| pass.span),
        });
    }
}

fn source(resources: &[Resource], pass: &Pass) -> Option<ResourceId> {
    let target = pass.writes.first()?.part.resource;
    resources[target.index()].history.map(|history| history.of)
}

/// A shortest way from a pass back to itself, within a component, without the last step.
fn round(graph: &DiGraph<(), ()>, start: NodeIndex, component: &[NodeIndex]) -> Vec<NodeIndex> {
    let inside: BTreeSet<NodeIndex> = component.iter().copied().collect();
    let mut reached = BTreeMap::new();
    let mut queue = VecDeque::from([start]);
    while let Some(node) = queue.pop_front() {
        let mut next: Vec<NodeIndex> = graph.neighbors(node).filter(|next| inside.contains(next)).collect();
        next.sort_unstable();
        for next in next {
            if next == start {
                let mut way = vec![node];
                let mut at = node;
                while let Some(before) = reached.get(&at) {
                    at = *before;
                    way.push(at);
                }
                way.reverse();
                return way;
            }
            if let Entry::Vacant(entry) = reached.entry(next) {
                entry.insert(node);
                queue.push_back(next);
            }
        }
    }
    vec![start]
}
