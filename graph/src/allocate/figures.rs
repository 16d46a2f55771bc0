//! What the memory of transients comes to, and what it could come to.

use std::ops::Range;

use super::model::Model;

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
