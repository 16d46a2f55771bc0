//! Buffers as sub-ranges of arenas.
//!
//! In descending order of size each buffer takes the best place of all arenas that it may live in: the one that grows least,
//! then the tightest hole, then the oldest arena. Offsets are multiples of 256. Two buffers that one pass uses with different
//! access, or copies between, are never in one arena, since wgpu tracks whole buffers; that also keeps buffers of other passes
//! apart, which is the accepted cost.

use std::ops::Range;

use super::model::{Model, Pool};
use super::strip::{Fit, Strip};

/// No arena grows beyond this (WebGPU's default for `maxBufferSize`), so that an order is judged the same on every device; a
/// larger buffer has an arena for itself.
pub(crate) const ARENA_LIMIT: u64 = 256 << 20;

/// One buffer with what lives in it.
#[derive(Debug)]
pub(crate) struct Arena {
    /// Resources with their offsets, by descending size.
    pub(crate) holders: Vec<(u32, u64)>,
    strip: Strip,
}

impl Arena {
    /// Bytes that it takes.
    pub(crate) fn bytes(&self) -> u64 {
        self.strip.size()
    }
}

/// Places all transient buffers that are in use. No arena grows beyond `limit` by sharing.
pub(crate) fn pack(model: &Model, ranges: &[Range<usize>], limit: u64) -> Vec<Arena> {
    let mut buffers: Vec<usize> = (0..ranges.len())
        .filter(|index| model.pools[*index] == Pool::Buffer && model.is_transient(*index) && !ranges[*index].is_empty())
        .collect();
    buffers.sort_by_key(|index| (std::cmp::Reverse(model.charged[*index]), ranges[*index].start, *index));
    let steps = buffers.iter().map(|index| ranges[*index].end).max().unwrap_or(0);
    let mut arenas: Vec<Arena> = Vec::new();
    let mut home: Vec<Option<usize>> = vec![None; if model.conflicts.is_empty() { 0 } else { ranges.len() }];
    let mut forbidden: Vec<usize> = Vec::new();
    for index in buffers {
        let bytes = model.charged[index];
        forbidden.clear();
        let rivals = model.conflicts.get(&(index as u32)).map_or(&[][..], Vec::as_slice);
        forbidden.extend(rivals.iter().filter_map(|rival| home[*rival as usize]));
        forbidden.sort_unstable();
        let mut best: Option<(usize, Fit)> = None;
        for (number, arena) in arenas.iter_mut().enumerate() {
            if forbidden.binary_search(&number).is_ok() {
                continue;
            }
            let fit = arena.strip.fit(&ranges[index], bytes);
            let better = best.is_none_or(|(_, least)| (fit.growth, fit.waste) < (least.growth, least.waste));
            if better && fit.growth <= bytes && arena.bytes().saturating_add(fit.growth) <= limit {
                best = Some((number, fit));
            }
        }
        let (number, offset) = best.map_or((arenas.len(), 0), |(number, fit)| (number, fit.offset));
        if number == arenas.len() {
            arenas.push(Arena { holders: Vec::new(), strip: Strip::new(steps) });
        }
        arenas[number].strip.insert(&ranges[index], offset, bytes);
        arenas[number].holders.push((index as u32, offset));
        if let Some(entry) = home.get_mut(index) {
            *entry = Some(number);
        }
    }
    arenas
}
