//! Parts that nothing produces, and the first step that needs each: that step fills them with the declared value.

use std::collections::BTreeMap;

use super::InitialClear;
use super::part::{Rect, merged};
use super::uses::{UseId, Uses};
use super::versions::Versions;
use crate::bind::types::Bound;
use crate::expand::types::{PassId, ResourceId};

/// All implicit clears, by the place of their step in the order, then by resource and part.
pub(crate) fn initial_clears(bound: &Bound, uses: &Uses, versions: &Versions, order: &[PassId]) -> Vec<InitialClear> {
    if bound.expanded.resources.iter().all(|resource| resource.clear.is_none()) {
        return Vec::new();
    }
    let mut places: Vec<Option<usize>> = vec![None; bound.steps.len()];
    for (place, pass) in order.iter().enumerate() {
        places[pass.index()] = Some(place);
    }
    let place_of = |id: &UseId| places[uses.get(*id).pass.index()];
    // By step, resource, and whether it is modified: what is modified and what is not stay apart.
    let mut needed: BTreeMap<(usize, usize, bool), Vec<Rect>> = BTreeMap::new();
    for (index, _) in bound.expanded.resources.iter().enumerate().filter(|(_, resource)| resource.clear.is_some()) {
        let grid = versions.grid(index);
        let mut first: Vec<Option<usize>> = vec![None; grid.cells.len()];
        let mut need = |cell: usize, place: Option<usize>| {
            first[cell] = [first[cell], place].into_iter().flatten().min();
        };
        for (cell, content) in grid.cells.iter().enumerate().filter(|(_, content)| !content.produced) {
            // A modifier that does not run leaves the value as declared.
            need(cell, grid.writers(content).iter().filter_map(place_of).min());
        }
        for region in grid.regions {
            // An output that no step touches is filled by the first step there is.
            let shown = (!grid.outputs(region).is_empty() && !order.is_empty()).then_some(0);
            let reader = grid.readers(region).iter().filter_map(place_of).min();
            for cell in grid.unwritten(region) {
                need(*cell as usize, [shown, reader].into_iter().flatten().min());
            }
        }
        if let Some(recaller) = grid.exceptions.recallers.iter().filter_map(place_of).min() {
            for (cell, _) in grid.cells.iter().enumerate().filter(|(_, content)| grid.writers(content).is_empty()) {
                need(cell, Some(recaller));
            }
        }
        for (cell, place) in first.iter().enumerate() {
            if let Some(place) = place {
                let modified = !grid.writers(&grid.cells[cell]).is_empty();
                needed.entry((*place, index, modified)).or_default().push(grid.cells[cell].rect.clone());
            }
        }
    }
    let mut clears = Vec::new();
    for ((place, index, modified), rects) in needed {
        let resource = &bound.expanded.resources[index];
        let Some(value) = resource.clear else { continue };
        for rect in merged(rects) {
            clears.push(InitialClear { pass: order[place], part: rect.view(ResourceId(index as u32), &resource.shape), value, modified });
        }
    }
    clears
}
