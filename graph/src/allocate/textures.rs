//! Whole textures, used one after the other by resources of equal descriptors.
//!
//! Resources of a descriptor are taken in the order of their first use, and each takes a texture that is free by then, or a
//! new one. For intervals that is the least possible number of textures: as many as are in use at once at the worst step. Among
//! free textures it takes the one whose usages grow least, since needless usages cost compression, then the last freed.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};
use std::ops::Range;

use super::model::{Model, Pool};
use crate::plan::Usage;
use crate::schedule::flow::Flow;

/// Transient textures that are in use, by first use and then by id.
fn by_first_use(model: &Model, ranges: &[Range<usize>]) -> Vec<(u32, u32)> {
    let mut found: Vec<(u32, u32)> = (0..ranges.len())
        .filter(|index| model.is_transient(*index) && !ranges[*index].is_empty() && model.pools[*index] != Pool::Buffer)
        .map(|index| (ranges[index].start as u32, index as u32))
        .collect();
    found.sort_unstable();
    found
}

/// Bytes of the textures that an order needs: the peak of each descriptor times its size.
pub(crate) fn bytes_reached(flow: &Flow, model: &Model, order: &[u32], ranges: &[Range<usize>]) -> u64 {
    let mut live = vec![0u32; model.descriptors.len()];
    let mut peaks = vec![0u32; model.descriptors.len()];
    for (step, node) in order.iter().enumerate() {
        let textures = flow.touches.of(*node as usize).iter().filter_map(|item| match flow.pools[*item as usize] {
            Pool::Texture(descriptor) => Some((&ranges[*item as usize], descriptor as usize)),
            Pool::Buffer => None,
        });
        for (_, descriptor) in textures.clone().filter(|(range, _)| range.start == step) {
            live[descriptor] += 1;
            peaks[descriptor] = peaks[descriptor].max(live[descriptor]);
        }
        for (_, descriptor) in textures.filter(|(range, _)| range.end == step + 1) {
            live[descriptor] -= 1;
        }
    }
    peaks.iter().zip(&model.descriptors).fold(0, |sum, (peak, bytes)| sum.saturating_add(bytes.saturating_mul(u64::from(*peak))))
}

/// For each descriptor the largest number of its textures in use at once, and the first step at which they are.
pub(crate) fn peaks(model: &Model, ranges: &[Range<usize>]) -> Vec<(usize, usize)> {
    let mut ends: Vec<(u32, u32)> = Vec::new();
    let starts = by_first_use(model, ranges);
    ends.extend(starts.iter().map(|(_, resource)| (ranges[*resource as usize].end as u32, *resource)));
    ends.sort_unstable();
    let mut live = vec![0usize; model.descriptors.len()];
    let mut peaks = vec![(0usize, 0usize); model.descriptors.len()];
    let mut ended = ends.iter().peekable();
    let descriptor = |resource: u32| match model.pools[resource as usize] {
        Pool::Texture(descriptor) => descriptor as usize,
        Pool::Buffer => 0,
    };
    for (start, resource) in starts {
        while let Some((_, gone)) = ended.next_if(|(end, _)| *end <= start) {
            live[descriptor(*gone)] -= 1;
        }
        let index = descriptor(resource);
        live[index] += 1;
        if live[index] > peaks[index].0 {
            peaks[index] = (live[index], start as usize);
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
    pub(crate) holders: Vec<u32>,
}

/// Assigns textures to all transient resources that are in use.
pub(crate) fn assign(model: &Model, ranges: &[Range<usize>], usages: &[Usage]) -> Vec<Slot> {
    let mut slots: Vec<Slot> = Vec::new();
    // Per descriptor and usage, free slots in the order in which they were freed.
    let mut free: BTreeMap<(u32, Usage), Vec<usize>> = BTreeMap::new();
    let mut busy: BinaryHeap<Reverse<(usize, usize, u32)>> = BinaryHeap::new();
    for (start, resource) in by_first_use(model, ranges) {
        while let Some(Reverse((end, slot, descriptor))) = busy.peek().copied() {
            if end > start as usize {
                break;
            }
            busy.pop();
            free.entry((descriptor, slots[slot].usage)).or_default().push(slot);
        }
        let Pool::Texture(descriptor) = model.pools[resource as usize] else { continue };
        let wanted = usages[resource as usize];
        let all = (descriptor, Usage::default())..=(descriptor, ALL);
        let best = free.range(all).filter(|(_, slots)| !slots.is_empty()).map(|(key, _)| *key).min_by_key(|(_, usage)| {
            // The usages that it would gain, then those that the resource does not need.
            (count(usage.union(wanted)) - count(*usage), count(usage.union(wanted)) - count(wanted))
        });
        let slot = match best.and_then(|key| free.get_mut(&key)).and_then(Vec::pop) {
            Some(slot) => slot,
            None => {
                slots.push(Slot { usage: Usage::default(), holders: Vec::new() });
                slots.len() - 1
            }
        };
        slots[slot].usage = slots[slot].usage.union(wanted);
        slots[slot].holders.push(resource);
        busy.push(Reverse((ranges[resource as usize].end, slot, descriptor)));
    }
    slots
}

const ALL: Usage =
    Usage { sampled: true, storage: true, uniform: true, attachment: true, copy_source: true, copy_target: true, indirect: true };

fn count(usage: Usage) -> u32 {
    let Usage { sampled, storage, uniform, attachment, copy_source, copy_target, indirect } = usage;
    [sampled, storage, uniform, attachment, copy_source, copy_target, indirect].into_iter().map(u32::from).sum()
}
