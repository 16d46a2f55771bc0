//! Who makes, changes and reads each part of each resource.
//!
//! A resource is cut into the cells of the grid that its uses span, so that a whole texture with a thousand layers which is only
//! ever used whole is one cell. Each cell has a chain: its producer, then its modifiers in the order of the file. Readers of
//! the same rectangle are kept together as one [`Region`], so that a thousand readers of a thousand layers cost two thousand
//! steps and not a million. Accepted: a texture whose uses cut every mip and every layer has one cell for each.
//!
//! All resources share a few long lists, since most have one cell, one writer and one region.

use std::collections::BTreeMap;

use super::part::Rect;
use super::uses::{UseId, Uses};
use crate::bind::types::Bound;
use crate::expand::types::{PassId, ResourceId};
use crate::lists::{Lists, Stretch};
use crate::plan::{Access, Role};

/// A part that no use cuts further.
#[derive(Debug)]
pub(crate) struct Cell {
    pub(crate) rect: Rect,
    /// Whether the first writer is a producer.
    pub(crate) produced: bool,
    writers: Stretch,
}

/// A rectangle that passes read, or an output shows.
#[derive(Debug)]
pub(crate) struct Region {
    pub(crate) rect: Rect,
    /// The value as this pass left it, instead of the final one.
    pub(crate) version: Option<PassId>,
    readers: Stretch,
    outputs: Stretch,
    makers: Stretch,
    destroyers: Stretch,
    unwritten: Stretch,
    foreign: Stretch,
}

/// What few resources have.
#[derive(Debug, Default)]
pub(crate) struct Exceptions {
    /// Uses that see what the last frame left; they name all of the resource.
    pub(crate) recallers: Vec<UseId>,
    /// Two producers of a part.
    pub(crate) rivals: Vec<(UseId, UseId, Rect)>,
    /// Two writes of one pass to a part.
    pub(crate) repeated: Vec<(UseId, UseId, Rect)>,
}

/// The cells and regions of all resources.
#[derive(Debug)]
pub(crate) struct Versions {
    /// Where those of each resource begin in the lists of cells and of regions, and where the last ones end.
    starts: Vec<(u32, u32)>,
    cells: Vec<Cell>,
    regions: Vec<Region>,
    exceptions: BTreeMap<u32, Exceptions>,
    none: Exceptions,
    /// Writers of cells and readers of regions.
    uses: Vec<UseId>,
    /// Makers and destroyers of regions.
    passes: Vec<PassId>,
    /// Outputs, and cells of regions.
    indices: Vec<u32>,
}

/// The cells and regions of one resource.
#[derive(Clone, Copy)]
pub(crate) struct Grid<'a> {
    all: &'a Versions,
    pub(crate) cells: &'a [Cell],
    pub(crate) regions: &'a [Region],
    pub(crate) exceptions: &'a Exceptions,
}

impl<'a> Grid<'a> {
    /// The producer of a cell, if there is one, then the modifiers in the order of the file.
    pub(crate) fn writers(&self, cell: &Cell) -> &'a [UseId] {
        cell.writers.of(&self.all.uses)
    }

    /// The same for all cells.
    pub(crate) fn all_writers(self) -> impl Iterator<Item = UseId> + Clone + 'a {
        self.cells.iter().flat_map(move |cell| self.writers(cell)).copied()
    }

    /// Who reads a region.
    pub(crate) fn readers(&self, region: &Region) -> &'a [UseId] {
        region.readers.of(&self.all.uses)
    }

    /// Which outputs show it, by index into the expanded ones.
    pub(crate) fn outputs(&self, region: &Region) -> &'a [u32] {
        region.outputs.of(&self.all.indices)
    }

    /// The passes that left the value which is read, without repetition.
    pub(crate) fn makers(&self, region: &Region) -> &'a [PassId] {
        region.makers.of(&self.all.passes)
    }

    /// The modifiers that destroy the value, without repetition.
    pub(crate) fn destroyers(&self, region: &Region) -> &'a [PassId] {
        region.destroyers.of(&self.all.passes)
    }

    /// Cells that nothing writes, by index.
    pub(crate) fn unwritten(&self, region: &Region) -> &'a [u32] {
        region.unwritten.of(&self.all.indices)
    }

    /// Cells that the version's pass doesn't write, by index.
    pub(crate) fn foreign(&self, region: &Region) -> &'a [u32] {
        region.foreign.of(&self.all.indices)
    }

    /// The rectangles of cells.
    pub(crate) fn rects(&self, cells: &[u32]) -> Vec<Rect> {
        cells.iter().map(|cell| self.cells[*cell as usize].rect.clone()).collect()
    }
}

/// Whether a use writes. A depth attachment that is only tested against keeps its place among the modifiers if the file names
/// it there.
pub(crate) fn writes(role: Role) -> bool {
    matches!(role, Role::Produce | Role::Modify)
}

/// Whether a pass may read what this use writes: only where the hardware forbids the write.
pub(crate) fn only_tests(access: Access) -> bool {
    access == Access::DepthReadOnly
}

impl Versions {
    /// Walks the uses of every resource.
    pub(crate) fn new(bound: &Bound, uses: &Uses) -> Versions {
        let resources = &bound.expanded.resources;
        let count = resources.len();
        let outputs = (0u32..).zip(&bound.expanded.outputs).filter(|(_, output)| output.part.resource.index() < count);
        let outputs = Lists::from_pairs(count, outputs.map(|(index, output)| (output.part.resource.0, index)));
        let versions = Versions {
            starts: Vec::with_capacity(count + 1),
            cells: Vec::with_capacity(count),
            regions: Vec::with_capacity(count),
            exceptions: BTreeMap::new(),
            none: Exceptions::default(),
            uses: Vec::with_capacity(4 * count),
            passes: Vec::with_capacity(count),
            indices: Vec::new(),
        };
        let (mips, layers, chains, reads, makers, destroyers, foreign) = Default::default();
        let mut builder = Builder { bound, uses, versions, mips, layers, chains, reads, makers, destroyers, foreign };
        for resource in 0..count {
            builder.resource(ResourceId(resource as u32), outputs.of(resource));
        }
        let mut versions = builder.versions;
        versions.starts.push((versions.cells.len() as u32, versions.regions.len() as u32));
        versions
    }

    /// The cells and regions of a resource.
    pub(crate) fn grid(&self, resource: usize) -> Grid<'_> {
        let ((cell, region), (cells_end, regions_end)) = (self.starts[resource], self.starts[resource + 1]);
        Grid {
            all: self,
            cells: &self.cells[cell as usize..cells_end as usize],
            regions: &self.regions[region as usize..regions_end as usize],
            exceptions: self.exceptions.get(&(resource as u32)).unwrap_or(&self.none),
        }
    }

    /// Those of all resources, by id.
    pub(crate) fn grids(&self) -> impl Iterator<Item = Grid<'_>> + Clone {
        (0..self.starts.len() - 1).map(|resource| self.grid(resource))
    }

    /// Those of the few resources that have [`Exceptions`].
    pub(crate) fn exceptional(&self) -> impl Iterator<Item = Grid<'_>> {
        self.exceptions.keys().map(|resource| self.grid(*resource as usize))
    }
}

/// So many regions of a resource are looked through one by one; a map pays only for more.
const FEW: usize = 8;

/// Walks one resource after the other, in lists that are used again.
struct Builder<'a> {
    bound: &'a Bound,
    uses: &'a Uses,
    versions: Versions,
    /// Where the resource is cut; empty where it is one cell, as most are.
    mips: Vec<u32>,
    layers: Vec<u32>,
    /// By cell: its writers.
    chains: Vec<Vec<UseId>>,
    /// Readers of the resource, each after its region.
    reads: Vec<(u32, UseId)>,
    /// Of a region, see there.
    makers: Vec<PassId>,
    destroyers: Vec<PassId>,
    foreign: Vec<u32>,
}

impl Builder<'_> {
    fn resource(&mut self, resource: ResourceId, outputs: &[u32]) {
        let uses = self.uses;
        let of_resource = || uses.of_resource(resource.index());
        let (first_cell, first_region) = (self.versions.cells.len(), self.versions.regions.len());
        self.versions.starts.push((first_cell as u32, first_region as u32));
        let shape = &self.bound.expanded.resources[resource.index()].shape;
        let shown = outputs.iter().map(|output| {
            let part = &self.bound.expanded.outputs[*output as usize].part;
            (*output, Rect::of_reference(part, shape), part.version)
        });
        let rects = of_resource().map(|id| uses.get(id).rect.clone()).chain(shown.clone().map(|(_, rect, _)| rect));
        cut(&Rect::whole(shape), rects, &mut self.mips, &mut self.layers, &mut self.versions.cells);

        let cells = self.versions.cells.len() - first_cell;
        if self.chains.len() < cells {
            self.chains.resize_with(cells, Vec::new);
        }
        self.chains[..cells].iter_mut().for_each(Vec::clear);
        for id in of_resource() {
            match uses.get(id).role {
                role @ (Role::Produce | Role::Modify) => self.write(resource, first_cell, id, role),
                Role::Recall => self.versions.exceptions.entry(resource.0).or_default().recallers.push(id),
                Role::Read => {}
            }
        }
        for (cell, chain) in self.versions.cells[first_cell..].iter_mut().zip(&self.chains) {
            cell.writers = Stretch::append(&mut self.versions.uses, chain.iter().copied());
        }

        self.reads.clear();
        let mut known: BTreeMap<(Rect, Option<PassId>), u32> = BTreeMap::new();
        for id in of_resource().filter(|id| uses.get(*id).role == Role::Read) {
            let touch = uses.get(id);
            let region = region(&mut self.versions.regions, first_region, &mut known, &touch.rect, touch.version);
            self.reads.push((region, id));
        }
        let readers_end = self.versions.regions.len();
        let mut shows: Vec<(u32, u32)> = Vec::new();
        for (output, rect, version) in shown {
            shows.push((region(&mut self.versions.regions, first_region, &mut known, &rect, version), output));
        }
        if readers_end > first_region + 1 {
            self.reads.sort_unstable();
        }
        let mut reads = &self.reads[..];
        for (number, region) in (0u32..).zip(&mut self.versions.regions[first_region..readers_end]) {
            let (own, others) = reads.split_at(reads.partition_point(|(region, _)| *region == number));
            region.readers = Stretch::append(&mut self.versions.uses, own.iter().map(|(_, id)| *id));
            reads = others;
        }
        for number in first_region..self.versions.regions.len() {
            let own = shows.iter().filter(|(region, _)| *region as usize == number - first_region).map(|(_, output)| *output);
            self.versions.regions[number].outputs = Stretch::append(&mut self.versions.indices, own);
            self.resolve(first_cell, number);
        }
    }

    /// Enters a write. In the order of the file.
    fn write(&mut self, resource: ResourceId, first_cell: usize, id: UseId, role: Role) {
        let Builder { uses, versions, mips, layers, chains, .. } = self;
        let touch = uses.get(id);
        for index in cells_in(mips, layers, &touch.rect) {
            let (cell, chain) = (&mut versions.cells[first_cell + index], &mut chains[index]);
            if let Some(own) = chain.iter().find(|other| uses.get(**other).pass == touch.pass) {
                note_pair(&mut versions.exceptions.entry(resource.0).or_default().repeated, *own, id, &cell.rect);
            } else if role == Role::Modify {
                chain.push(id);
            } else if cell.produced {
                note_pair(&mut versions.exceptions.entry(resource.0).or_default().rivals, chain[0], id, &cell.rect);
            } else {
                cell.produced = true;
                chain.insert(0, id);
            }
        }
    }

    /// Finds out what a region shows, and what destroys it.
    fn resolve(&mut self, first_cell: usize, number: usize) {
        let Builder { uses, versions, mips, layers, chains, makers, destroyers, foreign, .. } = self;
        let Versions { regions, passes, indices, cells, .. } = versions;
        let region = &mut regions[number];
        let unwritten = indices.len();
        for index in cells_in(mips, layers, &region.rect).filter(|index| first_cell + index < cells.len()) {
            let chain = &chains[index];
            // The place in the chain whose value is seen.
            let seen = match region.version {
                None => chain.len().checked_sub(1),
                Some(version) => chain.iter().position(|writer| uses.get(*writer).pass == version),
            };
            match seen {
                Some(place) => {
                    makers.push(uses.get(chain[place]).pass);
                    destroyers.extend(chain.get(place + 1).map(|next| uses.get(*next).pass));
                }
                None if chain.is_empty() && region.version.is_none() => indices.push(index as u32),
                None => foreign.push(index as u32),
            }
        }
        region.unwritten = Stretch::since(indices, unwritten);
        region.foreign = Stretch::append(indices, foreign.drain(..));
        region.makers = Stretch::append_set(passes, makers.drain(..));
        region.destroyers = Stretch::append_set(passes, destroyers.drain(..));
    }
}

/// The number of a region among those of its resource.
fn region(
    regions: &mut Vec<Region>,
    first: usize,
    known: &mut BTreeMap<(Rect, Option<PassId>), u32>,
    rect: &Rect,
    version: Option<PassId>,
) -> u32 {
    let own = &regions[first..];
    if let Some(found) = own.iter().take(FEW).position(|region| region.rect == *rect && region.version == version) {
        return found as u32;
    }
    let next = own.len() as u32;
    let number = if own.len() < FEW { next } else { *known.entry((rect.clone(), version)).or_insert(next) };
    if number == next {
        let (readers, outputs, makers, destroyers, unwritten, foreign) = Default::default();
        regions.push(Region { rect: rect.clone(), version, readers, outputs, makers, destroyers, unwritten, foreign });
    }
    number
}

/// Cuts a resource and adds its cells.
fn cut(whole: &Rect, rects: impl Iterator<Item = Rect> + Clone, mips: &mut Vec<u32>, layers: &mut Vec<u32>, cells: &mut Vec<Cell>) {
    let mut add = |rect: Rect| cells.push(Cell { rect, produced: false, writers: Stretch::default() });
    mips.clear();
    layers.clear();
    if rects.clone().all(|rect| rect == *whole) {
        return add(whole.clone());
    }
    mips.extend([whole.mips.0, whole.mips.1]);
    layers.extend([whole.layers.0, whole.layers.1]);
    for rect in rects.filter(|rect| rect != whole) {
        mips.extend([rect.mips.0.min(whole.mips.1), rect.mips.1.min(whole.mips.1)]);
        layers.extend([rect.layers.0.min(whole.layers.1), rect.layers.1.min(whole.layers.1)]);
    }
    for cuts in [&mut *mips, &mut *layers] {
        cuts.sort_unstable();
        cuts.dedup();
    }
    for mips in mips.windows(2) {
        for layers in layers.windows(2) {
            add(Rect { mips: (mips[0], mips[1]), layers: (layers[0], layers[1]) });
        }
    }
}

/// The cells of a rectangle, by index among those of the resource that is cut so.
fn cells_in(mips: &[u32], layers: &[u32], rect: &Rect) -> impl Iterator<Item = usize> + Clone + use<> {
    let one = usize::from(mips.is_empty());
    let at = |cuts: &[u32], value: u32| cuts.binary_search(&value).unwrap_or_else(|place| place);
    let columns = layers.len().saturating_sub(1);
    let rows = at(mips, rect.mips.0)..at(mips, rect.mips.1).min(mips.len().saturating_sub(1));
    let (first, end) = (at(layers, rect.layers.0), at(layers, rect.layers.1).min(columns));
    (0..one).chain(rows.flat_map(move |row| (first..end).map(move |column| row * columns + column)))
}

fn note_pair(pairs: &mut Vec<(UseId, UseId, Rect)>, first: UseId, second: UseId, rect: &Rect) {
    // Cells of one pair follow each other: the message names the first of them.
    if !pairs.iter().rev().take(4).any(|pair| pair.0 == first && pair.1 == second) {
        pairs.push((first, second, rect.clone()));
    }
}
