//! Values for some of many numbers, for work that is done again in every frame.
//!
//! Looking up and marking take constant time and emptying takes time in proportion to what is marked, so that a small change in a
//! large plan stays cheap. Accepted: room for every number is held all the time.

/// A value for some of the numbers below a count.
#[derive(Debug, Clone)]
pub(super) struct Marks<T = ()> {
    values: Vec<Option<T>>,
    /// Those that have one.
    marked: Vec<u32>,
}

impl<T> Default for Marks<T> {
    fn default() -> Marks<T> {
        Marks { values: Vec::new(), marked: Vec::new() }
    }
}

impl<T: Copy> Marks<T> {
    /// None is marked.
    pub(super) fn new(count: usize) -> Marks<T> {
        Marks { values: vec![None; count], marked: Vec::new() }
    }

    /// The value of a number, if it is marked.
    pub(super) fn get(&self, number: u32) -> Option<T> {
        self.values[number as usize]
    }

    /// Whether a number is marked.
    pub(super) fn contains(&self, number: u32) -> bool {
        self.values[number as usize].is_some()
    }

    /// Marks a number unless it is marked; returns whether it was not.
    pub(super) fn insert(&mut self, number: u32, value: T) -> bool {
        let entry = &mut self.values[number as usize];
        if entry.is_some() {
            return false;
        }
        *entry = Some(value);
        self.marked.push(number);
        true
    }

    /// Marks a number, whatever it was.
    pub(super) fn set(&mut self, number: u32, value: T) {
        if !self.insert(number, value) {
            self.values[number as usize] = Some(value);
        }
    }

    /// Marked numbers, in the order in which they were marked or sorted.
    pub(super) fn marked(&self) -> &[u32] {
        &self.marked
    }

    /// Puts the marked numbers into ascending order.
    pub(super) fn sort(&mut self) {
        self.marked.sort_unstable();
    }

    /// Unmarks all.
    pub(super) fn clear(&mut self) {
        for number in self.marked.drain(..) {
            self.values[number as usize] = None;
        }
    }
}
