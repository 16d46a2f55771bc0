//! The rows of a published table, in pages that states of a scene share.
//!
//! A copy shares all pages, and a changed row copies its page alone. So what changed between two states of a scene is found page by
//! page, at the cost of a pointer for each that did not. Equality is that of the bytes, however they came about.
//!
//! Accepted downside: a row that changes copies a page of about 8 KiB.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

/// Bytes of a page, as far as whole rows fill it.
const PAGE_BYTES: usize = 8 << 10;

/// Rows of equal size behind each other.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Table {
    stride: usize,
    /// All but the last are full.
    pages: Vec<Arc<Vec<u8>>>,
    len: usize,
}

impl Table {
    /// From the bytes of all rows, `stride` each.
    pub fn new(stride: usize, bytes: &[u8]) -> Table {
        let stride = stride.max(1);
        let pages = bytes.chunks(page_bytes(stride)).map(|page| Arc::new(page.to_vec())).collect();
        Table { stride, pages, len: bytes.len() }
    }

    /// Bytes of all rows together.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is not a byte.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Bytes of a row.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// How many rows there are; the last may be cut off.
    pub fn rows(&self) -> usize {
        self.len.div_ceil(self.stride.max(1))
    }

    /// A whole row.
    pub fn row(&self, index: usize) -> Option<&[u8]> {
        let start = index.checked_mul(self.stride)?;
        let page = start.checked_div(page_bytes(self.stride))?;
        let inside = start - page * page_bytes(self.stride);
        self.pages.get(page)?.get(inside..inside + self.stride)
    }

    /// Sets a row that is there; returns whether it was another. `row` has as many bytes as a row has.
    pub fn set_row(&mut self, index: usize, row: &[u8]) -> bool {
        if row.len() != self.stride || self.row(index).is_none_or(|known| known == row) {
            return false;
        }
        let start = index * self.stride;
        let page = start / page_bytes(self.stride);
        let inside = start - page * page_bytes(self.stride);
        if let Some(bytes) = self.pages.get_mut(page).map(Arc::make_mut).and_then(|page| page.get_mut(inside..inside + self.stride)) {
            bytes.copy_from_slice(row);
        }
        true
    }

    /// Brings the table to so many rows; new ones are zero.
    pub fn resize(&mut self, rows: usize) {
        let (len, size) = (rows * self.stride, page_bytes(self.stride));
        if len == self.len {
            return;
        }
        self.pages.truncate(len.div_ceil(size));
        for page in 0..len.div_ceil(size) {
            let wanted = (len - page * size).min(size);
            match self.pages.get_mut(page) {
                Some(known) if known.len() == wanted => {}
                Some(known) => Arc::make_mut(known).resize(wanted, 0),
                None => self.pages.push(Arc::new(vec![0; wanted])),
            }
        }
        self.len = len;
    }

    /// Turns to these rows; pages that stay the same stay shared.
    pub fn set(&mut self, bytes: &[u8]) {
        let size = page_bytes(self.stride);
        self.pages.truncate(bytes.len().div_ceil(size));
        for (index, wanted) in bytes.chunks(size).enumerate() {
            match self.pages.get_mut(index) {
                Some(known) if known.as_slice() == wanted => {}
                Some(known) => *known = Arc::new(wanted.to_vec()),
                None => self.pages.push(Arc::new(wanted.to_vec())),
            }
        }
        self.len = bytes.len();
    }

    /// All bytes.
    pub fn bytes(&self) -> Cow<'_, [u8]> {
        match self.pages.as_slice() {
            [] => Cow::Borrowed(&[]),
            [one] => Cow::Borrowed(one),
            several => Cow::Owned(several.iter().flat_map(|page| page.iter().copied()).collect()),
        }
    }

    /// The byte ranges in which this may differ from another state, neighbours as one. Where the other has no bytes is a difference.
    pub fn changes(&self, before: &Table) -> Vec<Range<usize>> {
        let size = page_bytes(self.stride);
        let mut changes: Vec<Range<usize>> = Vec::new();
        for (index, page) in self.pages.iter().enumerate() {
            let same = |known: &Arc<Vec<u8>>| self.stride == before.stride && (Arc::ptr_eq(known, page) || known == page);
            if before.pages.get(index).is_some_and(same) {
                continue;
            }
            let range = index * size..index * size + page.len();
            match changes.last_mut() {
                Some(last) if last.end == range.start => last.end = range.end,
                _ => changes.push(range),
            }
        }
        changes
    }

    /// Bytes of a range as they stand in pages, in order.
    pub fn slices(&self, range: Range<usize>) -> impl Iterator<Item = &[u8]> {
        let size = page_bytes(self.stride);
        let pages = range.start / size..range.end.div_ceil(size).min(self.pages.len());
        pages.filter_map(move |index| {
            let start = index * size;
            let page = self.pages.get(index)?;
            page.get(range.start.saturating_sub(start)..(range.end - start).min(page.len()))
        })
    }

    /// Rows whose bytes differ from those of another state, or that it does not have; rising.
    pub fn changed_rows(&self, before: &Table) -> Vec<u32> {
        let rows =
            self.changes(before).into_iter().flat_map(|range| range.start / self.stride.max(1)..range.end.div_ceil(self.stride.max(1)));
        rows.filter(|row| self.stride != before.stride || self.row(*row) != before.row(*row)).map(|row| row as u32).collect()
    }
}

/// A table of one row.
impl From<Vec<u8>> for Table {
    fn from(bytes: Vec<u8>) -> Table {
        let len = bytes.len();
        Table { stride: len.max(1), pages: if bytes.is_empty() { Vec::new() } else { vec![Arc::new(bytes)] }, len }
    }
}

fn page_bytes(stride: usize) -> usize {
    let stride = stride.max(1);
    stride * (PAGE_BYTES / stride).max(1)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_changed_row_copies_its_page_alone() {
        let table = Table::new(128, &vec![7; 128 * 1000]);
        let mut next = table.clone();
        assert!(!next.set_row(500, &[7; 128]), "the same bytes");
        assert_eq!(next.changes(&table), []);
        assert!(next.set_row(500, &[8; 128]));
        assert_eq!(next.changed_rows(&table), [500]);
        let [range] = &next.changes(&table)[..] else { panic!("one page") };
        assert!(range.contains(&(500 * 128)) && range.len() == PAGE_BYTES);
        assert_eq!(table.row(500), Some(&[7; 128][..]));
    }

    #[test]
    fn rows_beyond_the_end_are_not_there() {
        let mut table = Table::new(300, &vec![1; 300 * 100]);
        assert_eq!((table.rows(), table.row(100)), (100, None));
        assert!(!table.set_row(100, &[0; 300]));
        table.resize(60);
        table.resize(61);
        assert_eq!((table.row(59), table.row(60)), (Some(&[1; 300][..]), Some(&[0; 300][..])));
        assert_eq!(Table::default().row(0), None);
    }

    proptest! {
        /// Against plain bytes.
        #[test]
        fn states_differ_where_their_bytes_do(stride in 1_usize..5000, rows in 0_usize..40, writes in prop::collection::vec((0_usize..40, any::<u8>()), 0..20)) {
            let before = Table::new(stride, &vec![0; stride * rows]);
            let (mut table, mut bytes) = (before.clone(), vec![0; stride * rows]);
            for (row, value) in writes.into_iter().filter(|(row, _)| *row < rows) {
                table.set_row(row, &vec![value; stride]);
                bytes[row * stride..(row + 1) * stride].fill(value);
            }
            prop_assert_eq!(&*table.bytes(), &bytes[..]);
            prop_assert_eq!(&table, &Table::new(stride, &bytes));
            let changed: Vec<u32> = (0..rows).filter(|row| bytes[row * stride] != 0).map(|row| row as u32).collect();
            prop_assert_eq!(table.changed_rows(&before), changed);
            let mut patched = before.bytes().to_vec();
            for range in table.changes(&before) {
                let fresh: Vec<u8> = table.slices(range.clone()).flatten().copied().collect();
                patched[range].copy_from_slice(&fresh);
            }
            prop_assert_eq!(patched, bytes.clone());
            let mut set = before.clone();
            set.set(&bytes);
            prop_assert_eq!(set, table);
        }
    }
}
