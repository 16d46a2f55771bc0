//! Buffers as sub-ranges of arenas.
//!
//! In descending order of size each buffer takes the best place of all arenas that it may live in: the one that grows least,
//! then the tightest hole, then the oldest arena. Offsets are multiples of 256. Two buffers that one pass uses with different
//! access, or copies between, are never in one arena, since wgpu tracks whole buffers; that also keeps buffers of other passes
//! apart, which is the accepted cost.

use std::ops::Range;

use super::extent::ARENA_ALIGNMENT;
use super::model::Model;
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

/// Places buffers, given with when they are in use. No arena grows beyond `limit` by sharing.
pub(crate) fn pack(model: &Model, buffers: impl Iterator<Item = (u32, Range<usize>)>, limit: u64) -> Vec<Arena> {
    let mut buffers: Vec<(u32, Range<usize>)> = buffers.collect();
    buffers.sort_unstable_by_key(|(index, range)| (std::cmp::Reverse(model.charged[*index as usize]), range.start, *index));
    let steps = buffers.iter().map(|(_, range)| range.end).max().unwrap_or(0);
    let mut arenas: Vec<Arena> = Vec::new();
    let mut home: Vec<Option<usize>> = vec![None; if model.conflicts.is_empty() { 0 } else { model.pools.len() }];
    let mut forbidden: Vec<usize> = Vec::new();
    for (index, range) in buffers {
        let bytes = model.charged[index as usize];
        forbidden.clear();
        let rivals = model.conflicts.get(&index).map_or(&[][..], Vec::as_slice);
        forbidden.extend(rivals.iter().filter_map(|rival| home[*rival as usize]));
        forbidden.sort_unstable();
        let mut best: Option<(usize, Fit)> = None;
        for (number, arena) in arenas.iter_mut().enumerate() {
            if forbidden.binary_search(&number).is_ok() {
                continue;
            }
            let fit = arena.strip.fit(&range, bytes, ARENA_ALIGNMENT);
            let better = best.is_none_or(|(_, least)| (fit.growth, fit.waste) < (least.growth, least.waste));
            if better && fit.growth <= bytes && arena.bytes().saturating_add(fit.growth) <= limit {
                best = Some((number, fit));
            }
        }
        let (number, offset) = best.map_or((arenas.len(), 0), |(number, fit)| (number, fit.offset));
        if number == arenas.len() {
            arenas.push(Arena { holders: Vec::new(), strip: Strip::new(steps) });
        }
        arenas[number].strip.insert(&range, offset, bytes);
        arenas[number].holders.push((index, offset));
        if let Some(entry) = home.get_mut(index as usize) {
            *entry = Some(number);
        }
    }
    arenas
}
