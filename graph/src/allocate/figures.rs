//! What the memory of transients comes to, and what it could come to.

use std::cmp::Reverse;
use std::ops::Range;

use super::extent::round_up;
use super::model::Model;
use super::strip::Strip;

/// Offsets of placed memory are multiples of this: what drivers ask of textures in heaps.
const PLACED_ALIGNMENT: u64 = 64 << 10;

fn transients<'a>(model: &'a Model, ranges: &'a [Range<usize>]) -> impl Iterator<Item = usize> + 'a {
    (0..ranges.len()).filter(|index| model.is_transient(*index) && !ranges[*index].is_empty())
}

/// Every transient in memory of its own.
pub(crate) fn without_sharing(model: &Model, ranges: &[Range<usize>]) -> u64 {
    transients(model, ranges).fold(0, |sum, index| sum.saturating_add(model.charged[index]))
}

/// The largest sum of live bytes at any step.
pub(crate) fn peak(model: &Model, ranges: &[Range<usize>]) -> u64 {
    let steps = ranges.iter().map(|range| range.end).max().unwrap_or(0);
    let mut begins = vec![0u64; steps + 1];
    let mut ends = vec![0u64; steps + 1];
    for index in transients(model, ranges) {
        let range = &ranges[index];
        begins[range.start] = begins[range.start].saturating_add(model.charged[index]);
        ends[range.end] = ends[range.end].saturating_add(model.charged[index]);
    }
    let (mut live, mut peak) = (0u64, 0u64);
    for (begin, end) in begins.iter().zip(&ends) {
        live = live.saturating_sub(*end).saturating_add(*begin);
        peak = peak.max(live);
    }
    peak
}

/// What byte-placed memory would take in this order: size-descending best fit, 64 KiB aligned.
pub(crate) fn placed(model: &Model, ranges: &[Range<usize>]) -> u64 {
    let units = |index: usize| round_up(model.charged[index], PLACED_ALIGNMENT).unwrap_or(u64::MAX);
    let mut order: Vec<usize> = transients(model, ranges).collect();
    order.sort_unstable_by_key(|index| (Reverse(units(*index)), Reverse(ranges[*index].len()), ranges[*index].start, *index));
    let mut strip = Strip::new(order.iter().map(|index| ranges[*index].end).max().unwrap_or(0));
    for index in order {
        let fit = strip.fit(&ranges[index], units(index));
        strip.insert(&ranges[index], fit.offset, units(index));
    }
    strip.size()
}
