//! A resource cut into the cells that its uses span.
//!
//! A whole texture with a thousand layers that is only ever used whole is one cell. Accepted: uses that cut every mip and every
//! layer make a cell of each.

use crate::schedule::part::Rect;

/// The cuts along mip levels and layers; none where the resource is one cell.
#[derive(Debug, Default)]
pub(super) struct Cells {
    mips: Vec<u32>,
    layers: Vec<u32>,
}

impl Cells {
    /// Cuts at the edges of rectangles. All equal rectangles leave one cell.
    pub(super) fn cut<'a>(rects: impl Iterator<Item = &'a Rect> + Clone) -> Cells {
        let (mut mips, mut layers) = (Vec::new(), Vec::new());
        for rect in rects {
            if mips.len() == 2 && [rect.mips.0, rect.mips.1] == mips[..] && [rect.layers.0, rect.layers.1] == layers[..] {
                continue;
            }
            mips.extend([rect.mips.0, rect.mips.1]);
            layers.extend([rect.layers.0, rect.layers.1]);
        }
        for cuts in [&mut mips, &mut layers] {
            cuts.sort_unstable();
            cuts.dedup();
        }
        Cells { mips, layers }
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.mips.len().saturating_sub(1) * self.layers.len().saturating_sub(1)
    }

    /// The cells of a rectangle that was among those cut at.
    pub(super) fn within(&self, rect: &Rect) -> impl Iterator<Item = usize> + use<> {
        let at = |cuts: &[u32], value: u32| cuts.binary_search(&value).unwrap_or_else(|place| place);
        let columns = self.layers.len().saturating_sub(1);
        let rows = at(&self.mips, rect.mips.0)..at(&self.mips, rect.mips.1);
        let (first, end) = (at(&self.layers, rect.layers.0), at(&self.layers, rect.layers.1));
        rows.flat_map(move |row| (first..end).map(move |column| row * columns + column))
    }

    /// The rectangle of a cell.
    pub(super) fn rect(&self, cell: usize) -> Rect {
        let columns = self.layers.len().saturating_sub(1).max(1);
        let pair = |cuts: &[u32], at: usize| (cuts[at], cuts[at + 1]);
        Rect { mips: pair(&self.mips, cell / columns), layers: pair(&self.layers, cell % columns) }
    }
}
