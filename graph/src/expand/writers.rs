//! Who writes which part of which resource, found without comparing everything with everything.
//!
//! Writers of one part are kept together. Parts of a single mip and layer, of which loops make many, are found by their place;
//! the others are few and are looked through. Accepted: a texture with thousands of different wide parts costs their square.

use std::collections::BTreeMap;

use super::types::{PartRef, Pass, PassId, Resource};
use crate::schedule::part::Rect;

/// A part that is written, with those that write it.
#[derive(Debug, Default)]
pub(super) struct Written {
    /// In the order of the file.
    pub producers: Vec<PassId>,
    /// In the order of the file.
    pub modifiers: Vec<PassId>,
}

impl Written {
    /// All of them.
    pub fn passes(&self) -> impl Iterator<Item = PassId> + '_ {
        self.producers.iter().chain(&self.modifiers).copied()
    }
}

/// The written parts of a resource.
#[derive(Debug, Default)]
struct Parts {
    single: BTreeMap<(u32, u32), usize>,
    wide: BTreeMap<Rect, usize>,
    written: Vec<Written>,
}

/// The written parts of all resources.
pub(super) struct Writers<'a> {
    resources: &'a [Resource],
    parts: Vec<Parts>,
}

fn single(rect: &Rect) -> Option<(u32, u32)> {
    (rect.mips.1 - rect.mips.0 == 1 && rect.layers.1 - rect.layers.0 == 1).then_some((rect.mips.0, rect.layers.0))
}

impl<'a> Writers<'a> {
    /// Of all passes.
    pub fn new(resources: &'a [Resource], passes: &[Pass]) -> Writers<'a> {
        let mut writers = Writers { resources, parts: resources.iter().map(|_| Parts::default()).collect() };
        for (index, pass) in passes.iter().enumerate() {
            let id = PassId(index as u32);
            pass.writes.iter().for_each(|slot| writers.part(&slot.part).producers.push(id));
            pass.modifies.iter().for_each(|slot| writers.part(&slot.part).modifiers.push(id));
        }
        writers
    }

    fn rect(&self, part: &PartRef) -> Rect {
        Rect::of_reference(part, &self.resources[part.resource.index()].shape)
    }

    fn part(&mut self, part: &PartRef) -> &mut Written {
        let rect = self.rect(part);
        let parts = &mut self.parts[part.resource.index()];
        let next = parts.written.len();
        let index = match single(&rect) {
            Some(place) => *parts.single.entry(place).or_insert(next),
            None => *parts.wide.entry(rect).or_insert(next),
        };
        if index == next {
            parts.written.push(Written::default());
        }
        &mut parts.written[index]
    }

    /// The written parts that share something with a part.
    pub fn overlapping(&self, part: &PartRef) -> Vec<&Written> {
        let rect = self.rect(part);
        let parts = &self.parts[part.resource.index()];
        let mut found: Vec<usize> = parts.wide.iter().filter(|(wide, _)| wide.intersection(&rect).is_some()).map(|(_, at)| *at).collect();
        let cells = (rect.mips.1 - rect.mips.0) as usize * (rect.layers.1 - rect.layers.0) as usize;
        if cells <= parts.single.len() {
            let places = (rect.mips.0..rect.mips.1).flat_map(|mip| (rect.layers.0..rect.layers.1).map(move |layer| (mip, layer)));
            found.extend(places.filter_map(|place| parts.single.get(&place)));
        } else {
            let (mips, layers) = (rect.mips.0..rect.mips.1, rect.layers.0..rect.layers.1);
            found.extend(parts.single.iter().filter(|((mip, layer), _)| mips.contains(mip) && layers.contains(layer)).map(|(_, at)| *at));
        }
        found.into_iter().filter_map(|index| parts.written.get(index)).collect()
    }
}
