//! Who makes, changes and reads each part of each resource.
//!
//! A resource is cut into the cells of the grid that its uses span, so that a whole texture with a thousand layers which is only
//! ever used whole is one cell. Each cell has a chain: its producer, then its modifiers in the order of the file. Readers of
//! the same rectangle are kept together as one [`Region`], so that a thousand readers of a thousand layers cost two thousand
//! steps and not a million. Accepted: a texture whose uses cut every mip and every layer has one cell for each.

use std::collections::BTreeMap;

use super::part::Rect;
use crate::bind::types::Bound;
use crate::expand::types::{PassId, ResourceId};
use crate::plan::{Access, Role, Use};

/// A use, by its pass and its place in the step's list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct UseRef {
    pub(crate) pass: PassId,
    pub(crate) index: u32,
}

impl UseRef {
    /// The use itself. References are made from the same `bound` and stay valid.
    pub(crate) fn get(self, bound: &Bound) -> &Use {
        &bound.steps[self.pass.index()].uses[self.index as usize]
    }
}

/// A part that no use cuts further.
#[derive(Debug)]
pub(crate) struct Cell {
    pub(crate) rect: Rect,
    /// The producer, if there is one, then the modifiers in the order of the file.
    pub(crate) writers: Vec<UseRef>,
    /// Whether the first writer is a producer.
    pub(crate) produced: bool,
}

/// A rectangle that passes read, or an output shows.
#[derive(Debug)]
pub(crate) struct Region {
    pub(crate) rect: Rect,
    /// The value as this pass left it, instead of the final one.
    pub(crate) version: Option<PassId>,
    pub(crate) readers: Vec<UseRef>,
    /// By index into the expanded outputs.
    pub(crate) outputs: Vec<usize>,
    /// The passes that left the value which is read, without repetition.
    pub(crate) writers: Vec<PassId>,
    /// The modifiers that destroy the value, without repetition.
    pub(crate) destroyers: Vec<PassId>,
    /// Cells that nothing writes.
    pub(crate) unwritten: Vec<usize>,
    /// Cells that the version's pass doesn't write.
    pub(crate) foreign: Vec<usize>,
}

impl Region {
    fn new(rect: Rect, version: Option<PassId>) -> Region {
        let (readers, outputs, writers, destroyers, unwritten, foreign) = Default::default();
        Region { rect, version, readers, outputs, writers, destroyers, unwritten, foreign }
    }
}

/// The cells and regions of a resource.
#[derive(Debug, Default)]
pub(crate) struct Grid {
    /// Empty where the resource is one cell, as most are.
    mip_cuts: Vec<u32>,
    layer_cuts: Vec<u32>,
    pub(crate) cells: Vec<Cell>,
    pub(crate) regions: Vec<Region>,
    /// Uses that see what the last frame left; they name all of the resource.
    pub(crate) recallers: Vec<UseRef>,
    /// Two producers of a part.
    pub(crate) rivals: Vec<(UseRef, UseRef, Rect)>,
    /// Two writes of one pass to a part.
    pub(crate) repeated: Vec<(UseRef, UseRef, Rect)>,
}

impl Grid {
    /// The cells of a rectangle, by index.
    pub(crate) fn cells_in(&self, rect: &Rect) -> impl Iterator<Item = usize> + use<> {
        let one = usize::from(self.mip_cuts.is_empty() && !self.cells.is_empty());
        let at = |cuts: &[u32], value: u32| cuts.binary_search(&value).unwrap_or_else(|place| place);
        let columns = self.layer_cuts.len().saturating_sub(1);
        let rows = at(&self.mip_cuts, rect.mips.0)..at(&self.mip_cuts, rect.mips.1).min(self.mip_cuts.len().saturating_sub(1));
        let (first, end) = (at(&self.layer_cuts, rect.layers.0), at(&self.layer_cuts, rect.layers.1).min(columns));
        (0..one).chain(rows.flat_map(move |row| (first..end).map(move |column| row * columns + column)))
    }

    fn cut(whole: &Rect, rects: impl Iterator<Item = Rect> + Clone) -> Grid {
        if rects.clone().all(|rect| rect == *whole) {
            let cell = Cell { rect: whole.clone(), writers: Vec::new(), produced: false };
            return Grid { cells: vec![cell], ..Grid::default() };
        }
        let mut mip_cuts = vec![whole.mips.0, whole.mips.1];
        let mut layer_cuts = vec![whole.layers.0, whole.layers.1];
        for rect in rects.filter(|rect| rect != whole) {
            mip_cuts.extend([rect.mips.0.min(whole.mips.1), rect.mips.1.min(whole.mips.1)]);
            layer_cuts.extend([rect.layers.0.min(whole.layers.1), rect.layers.1.min(whole.layers.1)]);
        }
        for cuts in [&mut mip_cuts, &mut layer_cuts] {
            cuts.sort_unstable();
            cuts.dedup();
        }
        let mut cells = Vec::with_capacity((mip_cuts.len() - 1) * (layer_cuts.len() - 1));
        for mips in mip_cuts.windows(2) {
            for layers in layer_cuts.windows(2) {
                let rect = Rect { mips: (mips[0], mips[1]), layers: (layers[0], layers[1]) };
                cells.push(Cell { rect, writers: Vec::new(), produced: false });
            }
        }
        Grid { mip_cuts, layer_cuts, cells, ..Grid::default() }
    }

    /// Enters a write. In the order of the file.
    fn write(&mut self, writer: UseRef, role: Role, rect: &Rect) {
        for index in self.cells_in(rect) {
            let cell = &mut self.cells[index];
            if let Some(own) = cell.writers.iter().find(|other| other.pass == writer.pass) {
                note_pair(&mut self.repeated, *own, writer, &cell.rect);
            } else if role == Role::Modify {
                cell.writers.push(writer);
            } else if cell.produced {
                note_pair(&mut self.rivals, cell.writers[0], writer, &cell.rect);
            } else {
                cell.produced = true;
                cell.writers.insert(0, writer);
            }
        }
    }

    fn resolve(&mut self, mut region: Region) {
        for index in self.cells_in(&region.rect) {
            let writers = &self.cells[index].writers;
            let seen = match region.version {
                None => writers.len().checked_sub(1),
                Some(version) => writers.iter().position(|writer| writer.pass == version),
            };
            match seen {
                Some(place) => {
                    region.writers.push(writers[place].pass);
                    region.destroyers.extend(writers.get(place + 1).map(|next| next.pass));
                }
                None if writers.is_empty() && region.version.is_none() => region.unwritten.push(index),
                None => region.foreign.push(index),
            }
        }
        for passes in [&mut region.writers, &mut region.destroyers] {
            passes.sort_unstable();
            passes.dedup();
        }
        self.regions.push(region);
    }
}

fn note_pair(pairs: &mut Vec<(UseRef, UseRef, Rect)>, first: UseRef, second: UseRef, rect: &Rect) {
    // Cells of one pair follow each other: the message names the first of them.
    if !pairs.iter().rev().take(4).any(|pair| pair.0 == first && pair.1 == second) {
        pairs.push((first, second, rect.clone()));
    }
}

/// Whether a use writes. A depth attachment that is only tested against keeps its place among the modifiers if the file names
/// it there.
pub(crate) fn writes(role: Role) -> bool {
    matches!(role, Role::Produce | Role::Modify)
}

/// Whether a pass may read what this use writes: only where the hardware forbids the write.
pub(crate) fn only_tests(touched: &Use) -> bool {
    touched.access == Access::DepthReadOnly
}

/// The grids of all resources, by id.
pub(crate) fn versions(bound: &Bound) -> Vec<Grid> {
    let count = bound.expanded.resources.len();
    let named = |used: &Use| used.resource.index() < count;
    // All uses in one list, grouped by resource: `ends` first counts them, then says where each group ends.
    let mut ends = vec![0usize; count + 1];
    for used in bound.steps.iter().flat_map(|step| &step.uses).filter(|used| named(used)) {
        ends[used.resource.index() + 1] += 1;
    }
    for index in 0..count {
        ends[index + 1] += ends[index];
    }
    let mut uses = vec![UseRef { pass: PassId(0), index: 0 }; ends[count]];
    for (pass, step) in bound.steps.iter().enumerate() {
        for (index, used) in step.uses.iter().enumerate().filter(|(_, used)| named(used)) {
            let place = &mut ends[used.resource.index()];
            uses[*place] = UseRef { pass: PassId(pass as u32), index: index as u32 };
            *place += 1;
        }
    }
    let group = |index: usize| &uses[index.checked_sub(1).map_or(0, |before| ends[before])..ends[index]];
    let mut outputs: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (index, output) in bound.expanded.outputs.iter().enumerate() {
        if let Some(list) = outputs.get_mut(output.part.resource.index()) {
            list.push(index);
        }
    }
    (0..count).map(|index| grid(bound, ResourceId(index as u32), group(index), &outputs[index])).collect()
}

const FEW: usize = 8;

fn grid(bound: &Bound, resource: ResourceId, uses: &[UseRef], outputs: &[usize]) -> Grid {
    let shape = &bound.expanded.resources[resource.index()].shape;
    let rect_of = |used: &UseRef| {
        let touched = used.get(bound);
        Rect::new(&touched.mips, &touched.layers)
    };
    let output_rect = |index: &usize| Rect::of_reference(&bound.expanded.outputs[*index].part, shape);
    let mut grid = Grid::cut(&Rect::whole(shape), uses.iter().map(rect_of).chain(outputs.iter().map(output_rect)));
    for used in uses {
        let role = used.get(bound).role;
        if writes(role) {
            grid.write(*used, role, &rect_of(used));
        }
    }
    let mut regions: Vec<Region> = Vec::new();
    let mut known: BTreeMap<(Rect, Option<PassId>), usize> = BTreeMap::new();
    let mut region_of = |regions: &mut Vec<Region>, rect: Rect, version: Option<PassId>| {
        // Few regions are the rule; a map pays only for many.
        if let Some(found) = regions.iter().take(FEW).position(|region| region.rect == rect && region.version == version) {
            return found;
        }
        if regions.len() < FEW {
            // Mostly there is one, and room for four is large.
            regions.reserve_exact(1);
            regions.push(Region::new(rect, version));
            return regions.len() - 1;
        }
        *known.entry((rect.clone(), version)).or_insert_with(|| {
            regions.push(Region::new(rect, version));
            regions.len() - 1
        })
    };
    for used in uses.iter().filter(|used| used.get(bound).role == Role::Recall) {
        grid.recallers.push(*used);
    }
    for used in uses.iter().filter(|used| used.get(bound).role == Role::Read) {
        let index = region_of(&mut regions, rect_of(used), used.get(bound).version);
        regions[index].readers.push(*used);
    }
    for output in outputs {
        let index = region_of(&mut regions, output_rect(output), bound.expanded.outputs[*output].part.version);
        regions[index].outputs.push(*output);
    }
    for region in regions {
        grid.resolve(region);
    }
    grid
}
