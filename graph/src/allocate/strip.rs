//! Rectangles of time and bytes, placed so that none overlap: the memory of arenas, and of the `placed` figure.
//!
//! Each entry takes the smallest hole between its neighbours in time that holds it, else the lowest bytes above them. Fed in
//! descending order of size this stays within a few per cent of the peak of live bytes on frames. To find neighbours, time is
//! cut into blocks with a list each, so that the work follows how many entries are alive at once and not how many there are.

use std::ops::Range;

/// Steps of a block.
const BLOCK: usize = 64;

/// An entry: first and last step, first byte and end.
#[derive(Debug, Clone, Copy)]
struct Entry {
    first: u32,
    last: u32,
    start: u64,
    end: u64,
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

/// Memory over time.
#[derive(Debug, Default)]
pub(crate) struct Strip {
    entries: Vec<Entry>,
    blocks: Vec<Vec<u32>>,
    size: u64,
    neighbours: Vec<(u64, u64)>,
}

impl Strip {
    /// Bytes that it takes.
    pub(crate) fn size(&self) -> u64 {
        self.size
    }

    /// The best place for `bytes` during `steps`. Sizes are expected in the unit of the strip's offsets.
    pub(crate) fn fit(&mut self, steps: &Range<usize>, bytes: u64) -> Fit {
        let (first, last) = (steps.start as u32, steps.end.saturating_sub(1) as u32);
        let Strip { entries, blocks, neighbours, .. } = self;
        neighbours.clear();
        let (low, high) = (steps.start / BLOCK, steps.end.saturating_sub(1) / BLOCK);
        for (index, block) in blocks.iter().enumerate().take(high + 1).skip(low) {
            for entry in block {
                let entry = &entries[*entry as usize];
                // Entries of several blocks count in the first that both are in.
                let met = (entry.first.max(first) as usize) / BLOCK == index;
                if met && entry.first <= last && entry.last >= first {
                    neighbours.push((entry.start, entry.end));
                }
            }
        }
        neighbours.sort_unstable();
        let mut top = 0;
        let mut best: Option<(u64, u64)> = None;
        for (start, end) in neighbours.iter().copied() {
            if start > top && start - top >= bytes {
                let waste = start - top - bytes;
                if best.is_none_or(|(least, _)| waste < least) {
                    best = Some((waste, top));
                }
            }
            top = top.max(end);
        }
        match best {
            Some((waste, offset)) => Fit { offset, growth: 0, waste },
            None => Fit { offset: top, growth: top.saturating_add(bytes).saturating_sub(self.size), waste: 0 },
        }
    }

    /// Takes a place.
    pub(crate) fn insert(&mut self, steps: &Range<usize>, offset: u64, bytes: u64) {
        let (low, high) = (steps.start / BLOCK, steps.end.saturating_sub(1) / BLOCK);
        if self.blocks.len() <= high {
            self.blocks.resize(high + 1, Vec::new());
        }
        for block in &mut self.blocks[low..=high] {
            block.push(self.entries.len() as u32);
        }
        let end = offset.saturating_add(bytes);
        self.entries.push(Entry { first: steps.start as u32, last: steps.end.saturating_sub(1) as u32, start: offset, end });
        self.size = self.size.max(end);
    }
}
