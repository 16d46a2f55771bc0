//! A two-dimensional packing of time and bytes.
//!
//! In descending order of size each item takes the tightest hole between its neighbours in time, see [`Strip`]. While the heap is
//! clearly larger than the peak of live bytes and items are few, further packings start with those that stood above the peak; the
//! smallest heap stays.

use std::cmp::Reverse;
use std::ops::Range;

use crate::allocate::strip::Strip;
use crate::schedule::flow::Flow;

/// Items times further packings. Many items fill each other's holes, and are packed once.
const EFFORT: usize = 200;
/// Further packings of the fewest items.
const MOST_REPACKS: usize = 16;
/// The part of the peak that a heap may be larger by without being packed again.
const NEAR: u64 = 256;

/// First byte of each item.
pub(crate) struct Packed {
    pub(crate) offsets: Vec<u64>,
    pub(crate) bytes: u64,
}

/// Places all items in an order of passes whose peak is `bound`.
pub(crate) fn pack(flow: &Flow, bytes: &[u64], units: &[u64], order: &[u32], bound: u64) -> Packed {
    let ranges = flow.ranges(order);
    let mut sequence: Vec<u32> = (0..bytes.len() as u32).collect();
    sequence.sort_unstable_by_key(|item| {
        let range = &ranges[*item as usize];
        (Reverse(bytes[*item as usize]), Reverse(range.len()), range.start, *item)
    });
    let mut best = pack_in(&sequence, bytes, units, &ranges, order.len());
    let repacks = (EFFORT / bytes.len().max(1)).min(MOST_REPACKS);
    let mut offsets = best.offsets.clone();
    for _ in 0..repacks {
        if best.bytes <= bound.saturating_add(bound / NEAR) {
            break;
        }
        // Stable: among those above and among the others the order stays.
        sequence.sort_by_key(|item| offsets[*item as usize].saturating_add(bytes[*item as usize]) <= bound);
        let again = pack_in(&sequence, bytes, units, &ranges, order.len());
        offsets.clone_from(&again.offsets);
        if again.bytes < best.bytes {
            best = again;
        }
    }
    best
}

fn pack_in(sequence: &[u32], bytes: &[u64], units: &[u64], ranges: &[Range<usize>], steps: usize) -> Packed {
    let mut strip = Strip::new(steps);
    let mut offsets = vec![0; bytes.len()];
    for item in sequence.iter().map(|item| *item as usize) {
        let fit = strip.fit(&ranges[item], bytes[item], units[item]);
        strip.insert(&ranges[item], fit.offset, bytes[item]);
        offsets[item] = fit.offset;
    }
    Packed { offsets, bytes: strip.size() }
}
