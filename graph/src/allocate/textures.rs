//! Whole textures, used one after the other by resources of equal descriptors.
//!
//! Resources of a descriptor are taken in the order of their first use, and each takes a texture that is free by then, or a
//! new one. For intervals that is the least possible number of textures: as many as are in use at once at the worst step. Among
//! free textures it takes the one whose usages grow least, since needless usages cost compression, then the last freed.

use std::ops::Range;

use super::model::{Model, Pool};
use crate::expand::types::ResourceId;
use crate::lists::Lists;
use crate::plan::Usage;
use crate::schedule::flow::Flow;

/// When transient textures begin and end to be in use.
pub(crate) struct Timeline {
    /// By step: the textures that are first used there, each with its descriptor, by id.
    begins: Lists,
    /// By step: the textures that are no longer used there and were before, by id.
    ends: Lists,
}

impl Timeline {
    /// Of what is in use at some step.
    pub(crate) fn new(model: &Model, ranges: &[Range<usize>]) -> Timeline {
        let steps = ranges.iter().map(|range| range.end).max().unwrap_or(0);
        let textures = (0u32..).zip(ranges).filter(|(index, range)| {
            let index = *index as usize;
            model.pools[index] != Pool::Buffer && !range.is_empty() && model.is_transient(index)
        });
        Timeline {
            begins: Lists::from_pairs(steps + 1, textures.clone().map(|(index, range)| (range.start as u32, index))),
            ends: Lists::from_pairs(steps + 1, textures.map(|(index, range)| (range.end as u32, index))),
        }
    }
}

fn descriptor(model: &Model, resource: u32) -> usize {
    match model.pools[resource as usize] {
        Pool::Texture(descriptor) => descriptor as usize,
        // A timeline has none.
        Pool::Buffer => 0,
    }
}

/// Bytes of the textures that an order needs: the peak of each descriptor times its size.
pub(crate) fn bytes_reached(flow: &Flow, model: &Model, order: &[u32], ranges: &[Range<usize>]) -> u64 {
    let mut live = vec![(0u32, 0u32); model.descriptors.len()];
    for (step, node) in order.iter().enumerate() {
        let touched = flow.touches.of(*node as usize).iter().map(|item| (&ranges[*item as usize], flow.pools[*item as usize]));
        for (range, pool) in touched.clone() {
            if let (true, Pool::Texture(descriptor)) = (range.start == step, pool) {
                let (now, peak) = &mut live[descriptor as usize];
                *now += 1;
                *peak = (*peak).max(*now);
            }
        }
        for (range, pool) in touched {
            if let (true, Pool::Texture(descriptor)) = (range.end == step + 1, pool) {
                live[descriptor as usize].0 -= 1;
            }
        }
    }
    live.iter().zip(&model.descriptors).fold(0, |sum, ((_, peak), bytes)| sum.saturating_add(bytes.saturating_mul(u64::from(*peak))))
}

/// For each descriptor the largest number of its textures in use at once, and the first step at which they are.
pub(crate) fn peaks(model: &Model, timeline: &Timeline) -> Vec<(usize, usize)> {
    let mut live = vec![0usize; model.descriptors.len()];
    let mut peaks = vec![(0usize, 0usize); model.descriptors.len()];
    for step in 0..timeline.begins.count() {
        for gone in timeline.ends.of(step) {
            live[descriptor(model, *gone)] -= 1;
        }
        for resource in timeline.begins.of(step) {
            let index = descriptor(model, *resource);
            live[index] += 1;
            if live[index] > peaks[index].0 {
                peaks[index] = (live[index], step);
            }
        }
    }
    peaks
}

/// A texture that resources share.
#[derive(Debug)]
pub(crate) struct Slot {
    /// The union of usages.
    pub(crate) usage: Usage,
    /// Resources by first use.
    pub(crate) holders: Vec<ResourceId>,
}

/// Assigns textures to all transient resources that are in use.
pub(crate) fn assign(model: &Model, timeline: &Timeline, usages: &[Usage]) -> Vec<Slot> {
    let mut slots: Vec<Slot> = Vec::new();
    let mut slot_of = vec![u32::MAX; usages.len()];
    // By descriptor: for each usage that came up the free slots, in the order in which they were freed.
    let mut free: Vec<Vec<(Usage, Vec<u32>)>> = vec![Vec::new(); model.descriptors.len()];
    let mut freed: Vec<(u32, usize)> = Vec::new();
    for step in 0..timeline.begins.count() {
        freed.clear();
        freed.extend(timeline.ends.of(step).iter().map(|resource| (slot_of[*resource as usize], descriptor(model, *resource))));
        freed.sort_unstable();
        for (slot, descriptor) in freed.iter().copied() {
            let usage = slots[slot as usize].usage;
            let groups = &mut free[descriptor];
            match groups.iter_mut().find(|(known, _)| *known == usage) {
                Some((_, group)) => group.push(slot),
                None => groups.push((usage, vec![slot])),
            }
        }
        for resource in timeline.begins.of(step) {
            let wanted = usages[*resource as usize];
            let groups = free[descriptor(model, *resource)].iter_mut().filter(|(_, slots)| !slots.is_empty());
            let best = groups.min_by_key(|(usage, _)| {
                // The usages that it would gain, then those that the resource does not need.
                let both = count(usage.union(wanted));
                (both - count(*usage), both - count(wanted), *usage)
            });
            let slot = best.and_then(|(_, slots)| slots.pop()).unwrap_or_else(|| {
                slots.push(Slot { usage: Usage::default(), holders: Vec::new() });
                slots.len() as u32 - 1
            });
            let entry = &mut slots[slot as usize];
            entry.usage = entry.usage.union(wanted);
            entry.holders.push(ResourceId(*resource));
            slot_of[*resource as usize] = slot;
        }
    }
    slots
}

fn count(usage: Usage) -> u32 {
    let Usage { sampled, storage, uniform, attachment, copy_source, copy_target, indirect } = usage;
    [sampled, storage, uniform, attachment, copy_source, copy_target, indirect].into_iter().map(u32::from).sum()
}
