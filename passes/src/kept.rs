//! Objects that outlast a plan: found again by the plan that follows, forgotten by the one after that unless it used them.
//!
//! A parameter that is changed back and forth builds nothing anew, and a long day of edits and resizes does not pile up.

use std::collections::HashMap;
use std::hash::Hash;

/// Objects by what they were made from. Clones share nothing.
#[derive(Debug, Clone)]
pub(crate) struct Kept<K, V> {
    /// What this plan uses.
    now: HashMap<K, V>,
    /// What the plan before used.
    before: HashMap<K, V>,
}

impl<K, V> Default for Kept<K, V> {
    fn default() -> Kept<K, V> {
        Kept { now: HashMap::new(), before: HashMap::new() }
    }
}

impl<K: Clone + Eq + Hash, V: Clone> Kept<K, V> {
    /// For the next plan.
    pub(crate) fn successor(&self) -> Kept<K, V> {
        Kept { now: HashMap::new(), before: self.now.clone() }
    }

    /// An object, which this plan uses from now on.
    pub(crate) fn get(&mut self, key: &K) -> Option<V> {
        if let Some(found) = self.now.get(key) {
            return Some(found.clone());
        }
        let found = self.before.get(key)?.clone();
        self.now.insert(key.clone(), found.clone());
        Some(found)
    }

    /// Keeps an object that was made for this plan.
    pub(crate) fn insert(&mut self, key: K, value: V) {
        self.now.insert(key, value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_outlasts_one_plan_that_does_not_use_it() {
        let mut first = Kept::default();
        first.insert("used", 1);
        first.insert("unused", 2);
        let mut second = first.successor();
        assert_eq!(second.get(&"used"), Some(1));
        let mut third = second.successor();
        assert_eq!((third.get(&"used"), third.get(&"unused")), (Some(1), None));
        // The plan after the first may ask late.
        assert_eq!(second.get(&"unused"), Some(2));
    }
}
