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
        let owners = |index: usize| self.of(index).iter().map(move |entry| (*entry, index as u32));
        Lists::from_pairs(count, (0..self.count()).flat_map(owners))
    }
}
