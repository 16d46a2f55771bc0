//! Why a resource has bytes that no other resource ever uses. Every refusal has a name, for the dump.

use std::ops::Range;

use super::model::{Model, Pool};
use super::textures::{Timeline, peaks};
use crate::expand::types::ResourceId;
use crate::lifetime::Lifetimes;
use crate::plan::{Alone, Memory, MemoryKind, Placement};

/// By resource id; `None` where bytes are shared, or not in use at all.
pub(crate) fn refusals(
    model: &Model,
    lifetimes: &Lifetimes,
    timeline: &Timeline,
    memories: &[Memory],
    placements: &[Option<Placement>],
) -> Vec<Option<Alone>> {
    let ranges = &lifetimes.ranges;
    let peaks = peaks(model, timeline);
    let mut of_descriptor = vec![0usize; model.descriptors.len()];
    let mut buffers: Vec<usize> = Vec::new();
    for index in (0..ranges.len()).filter(|index| model.is_transient(*index) && !ranges[*index].is_empty()) {
        match model.pools[index] {
            Pool::Texture(descriptor) => of_descriptor[descriptor as usize] += 1,
            Pool::Buffer => buffers.push(index),
        }
    }
    let mut found = vec![None; ranges.len()];
    for (index, retained) in lifetimes.retained.iter().enumerate() {
        found[index] = retained.filter(|_| placements[index].is_some()).map(Alone::Retained);
    }
    for memory in memories {
        for holder in &memory.holders {
            let index = holder.index();
            if found[index].is_some() || shares(model, memory, *holder, placements) {
                continue;
            }
            found[index] = Some(match model.pools[index] {
                Pool::Texture(descriptor) if of_descriptor[descriptor as usize] == 1 => Alone::OnlyOfItsDescriptor,
                Pool::Texture(descriptor) => {
                    let (count, step) = peaks[descriptor as usize];
                    Alone::InUseTogether { count, step }
                }
                Pool::Buffer => buffer(model, ranges, memories, placements, index, &buffers),
            });
        }
    }
    found
}

/// Whether another holder of the memory has some of the same bytes, at another time.
fn shares(model: &Model, memory: &Memory, holder: ResourceId, placements: &[Option<Placement>]) -> bool {
    if memory.kind != MemoryKind::Arena {
        return memory.holders.len() > 1;
    }
    let bytes = |resource: ResourceId| {
        let start = placements[resource.index()].map_or(0, |placement| placement.offset);
        start..start.saturating_add(model.charged[resource.index()])
    };
    let own = bytes(holder);
    memory.holders.iter().filter(|other| **other != holder).map(|other| bytes(*other)).any(|other| overlap(&own, &other))
}

fn overlap<T: PartialOrd>(a: &Range<T>, b: &Range<T>) -> bool {
    a.start < b.end && b.start < a.end
}

fn buffer(
    model: &Model,
    ranges: &[Range<usize>],
    memories: &[Memory],
    placements: &[Option<Placement>],
    index: usize,
    buffers: &[usize],
) -> Alone {
    if buffers.len() == 1 {
        return Alone::OnlyBuffer;
    }
    let mut apart = buffers.iter().copied().filter(|other| !overlap(&ranges[index], &ranges[*other])).peekable();
    let Some(first) = apart.peek().copied() else { return Alone::BuffersInUse };
    let rivals = model.conflicts.get(&(index as u32)).map_or(&[][..], Vec::as_slice);
    let rival_beside = |other: usize| {
        let holders = &memories.get(placements[other]?.memory.index())?.holders;
        holders.iter().copied().find(|holder| rivals.binary_search(&holder.0).is_ok())
    };
    match rival_beside(first) {
        Some(rival) if apart.all(|other| rival_beside(other).is_some()) => Alone::AccessConflict { rival },
        _ => Alone::NothingToGain,
    }
}
