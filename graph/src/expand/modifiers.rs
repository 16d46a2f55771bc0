//! Who modifies a part first, where the order of one file does not say it.
//!
//! The passes of one file are in the order of the file. Between files and blocks `after` decides, and it must: for each modifier of
//! a part and the one before it, one list or one `after`.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::environment::Environment;
use super::error::ExpandError;
use super::types::{Output, Pass, PassId, Resource, ResourceId};
use super::writers::{Writers, Written};

/// Brings passes of different lists in the order that `after` says, and reports modifiers that nothing orders.
pub(super) fn order(environment: &mut Environment<'_>, resources: &[Resource], passes: &mut Vec<Pass>, outputs: &mut [Output]) {
    let first = passes.first().map_or(0, |pass| pass.list);
    if passes.iter().all(|pass| pass.list == first) {
        return;
    }
    let backwards =
        |(index, pass): (usize, &Pass)| pass.after.iter().any(|before| before.index() > index && passes[before.index()].list != pass.list);
    if passes.iter().enumerate().any(backwards)
        && let Some(order) = sorted(passes)
    {
        rearrange(passes, outputs, &order);
    }
    let writers = Writers::new(resources, passes);
    for (index, pass) in passes.iter().enumerate() {
        for slot in &pass.modifies {
            // Modifiers of a part stand in rising order.
            let before = |written: &Written| {
                let end = written.modifiers.partition_point(|other| other.index() < index);
                end.checked_sub(1).map(|last| written.modifiers[last])
            };
            let Some(before) = writers.overlapping(&slot.part).into_iter().filter_map(before).max() else { continue };
            let other = &passes[before.index()];
            if other.list != pass.list && !pass.after.contains(&before) {
                environment.report(ExpandError::ModifierOrder {
                    resource: resources[slot.part.resource.index()].name.clone(),
                    first: other.name.clone(),
                    second: pass.name.clone(),
                    spans: [other.span, pass.span],
                });
            }
        }
    }
}

/// The least order in which each pass comes behind those under its `after`, and modifiers of a resource keep the order of their list.
/// `None` where there is none, which is reported as a cycle later.
fn sorted(passes: &[Pass]) -> Option<Vec<PassId>> {
    let mut followers: Vec<Vec<PassId>> = vec![Vec::new(); passes.len()];
    let mut waits = vec![0usize; passes.len()];
    let mut last: BTreeMap<(u32, ResourceId), PassId> = BTreeMap::new();
    for (index, pass) in passes.iter().enumerate() {
        let id = PassId(index as u32);
        let lists = pass.modifies.iter().filter_map(|slot| last.insert((pass.list, slot.part.resource), id)).filter(|before| *before != id);
        let before: Vec<PassId> = lists.chain(pass.after.iter().copied()).collect();
        waits[index] = before.len();
        for before in before {
            followers[before.index()].push(id);
        }
    }
    let mut ready: BinaryHeap<Reverse<PassId>> =
        (0..passes.len()).filter(|index| waits[*index] == 0).map(|index| Reverse(PassId(index as u32))).collect();
    let mut order = Vec::with_capacity(passes.len());
    while let Some(Reverse(next)) = ready.pop() {
        order.push(next);
        for follower in &followers[next.index()] {
            waits[follower.index()] -= 1;
            if waits[follower.index()] == 0 {
                ready.push(Reverse(*follower));
            }
        }
    }
    (order.len() == passes.len()).then_some(order)
}

/// Moves passes to their places, and every id with them.
fn rearrange(passes: &mut Vec<Pass>, outputs: &mut [Output], order: &[PassId]) {
    let mut places = vec![PassId(0); passes.len()];
    for (place, id) in order.iter().enumerate() {
        places[id.index()] = PassId(place as u32);
    }
    let moved = |id: &mut PassId| *id = places[id.index()];
    for pass in passes.iter_mut() {
        pass.after.iter_mut().for_each(moved);
        let iterations = pass.batch.iter_mut().flat_map(|batch| &mut batch.iterations).flat_map(|iteration| &mut iteration.parts);
        let slots = pass.reads.iter_mut().chain(&mut pass.writes).chain(&mut pass.modifies).map(|slot| &mut slot.part);
        slots.chain(iterations).filter_map(|part| part.version.as_mut()).for_each(moved);
    }
    outputs.iter_mut().filter_map(|output| output.part.version.as_mut()).for_each(moved);
    let mut taken: Vec<Option<Pass>> = std::mem::take(passes).into_iter().map(Some).collect();
    passes.extend(order.iter().filter_map(|id| taken[id.index()].take()));
}
