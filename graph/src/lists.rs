//! Many short lists of numbers in two allocations.
//!
//! Planning walks neighbours, users and touched resources many times over, so that they lie side by side. A list can't grow
//! once the next one stands. Indices come from earlier steps: asking for a list that is not there is a fault of the planner.

/// Lists of numbers, by index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Lists {
    /// Where each list begins, and where the last one ends.
    starts: Vec<u32>,
    entries: Vec<u32>,
}

impl Default for Lists {
    fn default() -> Lists {
        Lists { starts: vec![0], entries: Vec::new() }
    }
}

impl Lists {
    /// No list, with room for some.
    pub(crate) fn with_capacity(lists: usize, entries: usize) -> Lists {
        let mut starts = Vec::with_capacity(lists + 1);
        starts.push(0);
        Lists { starts, entries: Vec::with_capacity(entries) }
    }

    /// One list for each of `count` owners, out of pairs of owner and entry; entries keep the order of the pairs.
    pub(crate) fn from_pairs(count: usize, pairs: impl Iterator<Item = (u32, u32)> + Clone) -> Lists {
        let mut starts = vec![0u32; count + 1];
        for (owner, _) in pairs.clone() {
            starts[owner as usize + 1] += 1;
        }
        for index in 0..count {
            starts[index + 1] += starts[index];
        }
        let mut entries = vec![0u32; starts[count] as usize];
        let mut next = starts.clone();
        for (owner, entry) in pairs {
            let place = &mut next[owner as usize];
            entries[*place as usize] = entry;
            *place += 1;
        }
        Lists { starts, entries }
    }

    /// The same with every list in ascending order and without repetition.
    pub(crate) fn sets(count: usize, mut pairs: Vec<(u32, u32)>) -> Lists {
        pairs.sort_unstable();
        pairs.dedup();
        Lists::from_pairs(count, pairs.iter().copied())
    }

    /// Adds an entry to the list that is being built.
    pub(crate) fn push(&mut self, entry: u32) {
        self.entries.push(entry);
    }

    /// Ends the list that is being built.
    pub(crate) fn finish_list(&mut self) {
        self.starts.push(self.entries.len() as u32);
    }

    /// How many lists there are.
    pub(crate) fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// A list.
    pub(crate) fn of(&self, index: usize) -> &[u32] {
        &self.entries[self.starts[index] as usize..self.starts[index + 1] as usize]
    }

    /// For each of `count` entries the lists that have it, ascending.
    pub(crate) fn inverted(&self, count: usize) -> Lists {
        let mut starts = vec![0u32; count + 1];
        for entry in &self.entries {
            starts[*entry as usize + 1] += 1;
        }
        for index in 0..count {
            starts[index + 1] += starts[index];
        }
        let mut entries = vec![0u32; self.entries.len()];
        let mut next = starts.clone();
        for index in 0..self.count() {
            for entry in self.of(index) {
                let place = &mut next[*entry as usize];
                entries[*place as usize] = index as u32;
                *place += 1;
            }
        }
        Lists { starts, entries }
    }

    /// Leaves neighbours that are equal away, as they are in ascending lists.
    pub(crate) fn dedup(&mut self) {
        let (mut kept, mut start) = (0, 0);
        for index in 0..self.count() {
            let end = self.starts[index + 1] as usize;
            let first = kept;
            for place in start..end {
                let entry = self.entries[place];
                if kept == first || self.entries[kept - 1] != entry {
                    self.entries[kept] = entry;
                    kept += 1;
                }
            }
            start = end;
            self.starts[index + 1] = kept as u32;
        }
        self.entries.truncate(kept);
    }
}

/// A list inside of a longer one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Stretch {
    start: u32,
    end: u32,
}

impl Stretch {
    /// Adds a list at the end of the long one.
    pub(crate) fn append<T>(long: &mut Vec<T>, entries: impl Iterator<Item = T>) -> Stretch {
        let start = long.len();
        long.extend(entries);
        Stretch::since(long, start)
    }

    /// What was added to the long one since it had so many entries.
    pub(crate) fn since<T>(long: &[T], start: usize) -> Stretch {
        Stretch { start: start as u32, end: long.len() as u32 }
    }

    /// The same in ascending order and without repetition.
    pub(crate) fn append_set<T: Ord + Copy>(long: &mut Vec<T>, entries: impl Iterator<Item = T>) -> Stretch {
        let Stretch { start, .. } = Stretch::append(long, entries);
        let own = &mut long[start as usize..];
        own.sort_unstable();
        let mut kept = own.len().min(1);
        for place in 1..own.len() {
            if own[place] != own[kept - 1] {
                own[kept] = own[place];
                kept += 1;
            }
        }
        long.truncate(start as usize + kept);
        Stretch { start, end: long.len() as u32 }
    }

    /// The list, in the same long one.
    pub(crate) fn of<T>(self, long: &[T]) -> &[T] {
        &long[self.start as usize..self.end as usize]
    }
}
