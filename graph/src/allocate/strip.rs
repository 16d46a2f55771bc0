//! Rectangles of time and bytes, placed so that none overlap: the memory of arenas, and of the `placed` figure.
//!
//! Each entry takes the smallest hole between its neighbours in time that holds it, else the lowest bytes above them. Fed in
//! descending order of size this stays within a few per cent of the peak of live bytes on frames.
//!
//! Neighbours are found through a binary tree over blocks of steps. An entry is kept at the few nodes that together are just
//! the blocks that it is in use all through, at the leaves where it begins and ends, and in the summary of every node above
//! those. Byte ranges that touch are joined, so that thousands of long-lived entries cost as much as one. All lists are kept in
//! ascending order, so that what is in use is found by merging them.

use std::ops::Range;

/// Steps of a leaf.
const BLOCK: usize = 64;

/// An entry: first and last step, first byte and end.
#[derive(Debug, Clone, Copy)]
struct Entry {
    steps: (u32, u32),
    bytes: (u64, u64),
}

/// Where an entry can go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Fit {
    /// First byte.
    pub(crate) offset: u64,
    /// Bytes by which the strip grows.
    pub(crate) growth: u64,
    /// Bytes that stay free in the hole; zero on top.
    pub(crate) waste: u64,
}

/// Some steps: a leaf, or all of two other nodes.
#[derive(Debug, Clone, Default)]
struct Node {
    /// Byte ranges of entries kept here, that is, in use during all of its steps. Disjoint and joined, like the next.
    throughout: Vec<(u64, u64)>,
    /// Byte ranges of entries in use during some of its steps and kept at it (a leaf) or below.
    within: Vec<(u64, u64)>,
    /// Of a leaf: entries that begin or end in it, by first byte.
    passing: Vec<Entry>,
}

/// Memory over time.
#[derive(Debug)]
pub(crate) struct Strip {
    /// The root at 1, the children of node n at 2n and 2n + 1.
    nodes: Vec<Node>,
    size: u64,
    neighbours: Union,
}

impl Strip {
    /// An empty strip of so many steps.
    pub(crate) fn new(steps: usize) -> Strip {
        let leaves = steps.div_ceil(BLOCK).max(1).next_power_of_two();
        Strip { nodes: vec![Node::default(); 2 * leaves], size: 0, neighbours: Union::default() }
    }

    /// Bytes that it takes.
    pub(crate) fn size(&self) -> u64 {
        self.size
    }

    /// The best place for `bytes` during `steps`, at a multiple of `unit`.
    pub(crate) fn fit(&mut self, steps: &Range<usize>, bytes: u64, unit: u64) -> Fit {
        self.gather(steps);
        let aligned = |offset: u64| offset.checked_next_multiple_of(unit).unwrap_or(u64::MAX);
        let mut top = 0;
        let mut best: Option<(u64, u64)> = None;
        for (start, end) in self.neighbours.ranges.iter().copied() {
            if start > top && start - top >= bytes {
                let waste = start - top - bytes;
                if best.is_none_or(|(least, _)| waste < least) {
                    best = Some((waste, top));
                }
            }
            top = top.max(aligned(end));
        }
        match best {
            Some((waste, offset)) => Fit { offset, growth: 0, waste },
            None => Fit { offset: top, growth: top.saturating_add(bytes).saturating_sub(self.size), waste: 0 },
        }
    }

    /// Takes a place.
    pub(crate) fn insert(&mut self, steps: &Range<usize>, offset: u64, bytes: u64) {
        let bytes = (offset, offset.saturating_add(bytes));
        let covered = Covered::new(steps, self.nodes.len() / 2);
        let entry = Entry { steps: (steps.start as u32, steps.end.saturating_sub(1) as u32), bytes };
        for leaf in covered.partly() {
            let passing = &mut self.nodes[leaf].passing;
            let place = passing.partition_point(|other| other.bytes.0 < bytes.0);
            passing.insert(place, entry);
        }
        for node in covered.wholly() {
            join(&mut self.nodes[node].throughout, bytes);
        }
        for node in covered.paths() {
            join(&mut self.nodes[node].within, bytes);
        }
        self.size = self.size.max(bytes.1);
    }

    /// Finds the byte ranges in use during any of the steps.
    fn gather(&mut self, steps: &Range<usize>) {
        let Strip { nodes, neighbours, .. } = self;
        neighbours.ranges.clear();
        let covered = Covered::new(steps, nodes.len() / 2);
        let (first, last) = (steps.start as u32, steps.end.saturating_sub(1) as u32);
        // Short lists first.
        for node in covered.paths() {
            neighbours.add(nodes[node].throughout.iter().copied());
        }
        for node in covered.wholly() {
            neighbours.add(nodes[node].throughout.iter().copied());
            neighbours.add(nodes[node].within.iter().copied());
        }
        for leaf in covered.partly() {
            let met = nodes[leaf].passing.iter().filter(|entry| entry.steps.0 <= last && entry.steps.1 >= first);
            neighbours.add(met.map(|entry| entry.bytes));
        }
    }
}

/// Disjoint byte ranges in ascending order.
#[derive(Debug, Default)]
struct Union {
    ranges: Vec<(u64, u64)>,
    spare: Vec<(u64, u64)>,
}

impl Union {
    /// Adds ranges that ascend by first byte.
    fn add(&mut self, others: impl Iterator<Item = (u64, u64)>) {
        let Union { ranges, spare } = self;
        spare.clear();
        let mut own = 0;
        for other in others {
            while let Some(range) = ranges.get(own).filter(|range| range.0 <= other.0) {
                append(spare, *range);
                own += 1;
            }
            append(spare, other);
        }
        if spare.is_empty() {
            return;
        }
        for range in &ranges[own..] {
            append(spare, *range);
        }
        std::mem::swap(ranges, spare);
    }
}

/// Adds a range to disjoint ones, none of which begins after it.
fn append(ranges: &mut Vec<(u64, u64)>, range: (u64, u64)) {
    match ranges.last_mut() {
        Some(last) if range.0 <= last.1 => last.1 = last.1.max(range.1),
        _ => ranges.push(range),
    }
}

/// The nodes that a range of steps meets.
struct Covered {
    /// The leaves of its first and last step.
    ends: (usize, usize),
    /// The leaves that it covers wholly.
    whole: Range<usize>,
}

impl Covered {
    fn new(steps: &Range<usize>, leaves: usize) -> Covered {
        let last = steps.end.saturating_sub(1);
        let whole = leaves + steps.start.div_ceil(BLOCK)..leaves + steps.end / BLOCK;
        Covered { ends: (leaves + steps.start / BLOCK, leaves + last / BLOCK), whole }
    }

    /// Leaves that it covers in part.
    fn partly(&self) -> impl Iterator<Item = usize> {
        let (first, last) = self.ends;
        let whole = self.whole.clone();
        [Some(first), (last != first).then_some(last)].into_iter().flatten().filter(move |leaf| !whole.contains(leaf))
    }

    /// The fewest nodes that are together what it covers wholly.
    fn wholly(&self) -> impl Iterator<Item = usize> {
        let (mut low, mut high) = (self.whole.start, self.whole.end);
        let mut right = None;
        std::iter::from_fn(move || {
            loop {
                if let Some(node) = right.take() {
                    return Some(node);
                }
                if low >= high {
                    return None;
                }
                let left = (low % 2 == 1).then_some(low);
                right = (high % 2 == 1).then(|| high - 1);
                (low, high) = (low.div_ceil(2), high / 2);
                if left.is_some() {
                    return left;
                }
            }
        })
    }

    /// The two leaves at its ends and every node above them, each once.
    fn paths(&self) -> impl Iterator<Item = usize> {
        let up = |leaf: usize| std::iter::successors(Some(leaf), |node| (*node > 1).then_some(node / 2));
        let (first, last) = self.ends;
        up(first).chain(up(last).zip(up(first)).take_while(|(a, b)| a != b).map(|(node, _)| node))
    }
}

/// Adds a byte range to disjoint ones.
fn join(ranges: &mut Vec<(u64, u64)>, (start, end): (u64, u64)) {
    let first = ranges.partition_point(|range| range.1 < start);
    let beyond = first + ranges[first..].partition_point(|range| range.0 <= end);
    let joined = match &ranges[first..beyond] {
        [] => return ranges.insert(first, (start, end)),
        [one] => (one.0.min(start), one.1.max(end)),
        [one, .., other] => (one.0.min(start), other.1.max(end)),
    };
    ranges[first] = joined;
    ranges.drain(first + 1..beyond);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against all pairs: nothing overlaps, and a hole that holds the entry is used.
    #[test]
    fn entries_never_overlap() {
        let mut state = 7u64;
        let mut below = |limit: u64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) % limit
        };
        for steps in [1, 15, 16, 17, 100, 1000] {
            let mut strip = Strip::new(steps);
            let mut placed: Vec<(Range<usize>, u64, u64)> = Vec::new();
            for _ in 0..300 {
                let start = below(steps as u64) as usize;
                let end = start + 1 + below((steps - start) as u64) as usize;
                let bytes = 1 + below(20);
                let fit = strip.fit(&(start..end), bytes, 1);
                for (other, offset, size) in placed.iter().filter(|(other, ..)| other.start < end && start < other.end) {
                    assert!(*offset >= fit.offset + bytes || fit.offset >= offset + size, "{other:?} {start}..{end} of {steps}");
                }
                let met = |byte: u64| placed.iter().any(|(o, at, size)| o.start < end && start < o.end && *at <= byte && byte < at + size);
                let top = (0..strip.size()).rev().find(|byte| met(*byte)).map_or(0, |byte| byte + 1);
                assert!(fit.offset <= top);
                strip.insert(&(start..end), fit.offset, bytes);
                placed.push((start..end, fit.offset, bytes));
            }
        }
    }
}
