//! One text made of several files, with a map from every byte back to where it stands.
//!
//! naga parses one text. A shader with imports is several, so they are joined; whatever naga says about the joined text is
//! translated back here. Pieces are whole ranges of bytes, so columns are exact, in any script. Accepted downside: a place that
//! reaches over the end of a file is cut there.

use std::ops::Range;

use crate::source::{FileId, Span};

/// The joined text and its map. Positions in it are called *joined* positions.
#[derive(Debug, Clone, Default)]
pub(super) struct JoinedText {
    text: String,
    pieces: Vec<Piece>,
}

/// A range of the joined text that is a range of one file, byte for byte.
#[derive(Debug, Clone, Copy)]
struct Piece {
    /// First byte in the joined text.
    joined: usize,
    /// First byte in the file.
    start: usize,
    /// Bytes.
    length: usize,
    file: FileId,
}

impl JoinedText {
    /// Appends a range of a file, with the ranges in `hidden` (positions in the file, in order) replaced by spaces: they keep
    /// their length, so that one piece maps the whole. A line break is appended, so that no comment runs into the next file.
    pub(super) fn push(&mut self, file: FileId, text: &str, range: Range<usize>, hidden: &[Range<usize>]) {
        let piece = Piece { joined: self.text.len(), start: range.start, length: range.len(), file };
        let mut at = range.start;
        for hole in hidden {
            let (from, to) = (hole.start.clamp(at, range.end), hole.end.clamp(at, range.end));
            self.text.push_str(text.get(at..from).unwrap_or(""));
            self.text.extend(std::iter::repeat_n(' ', to - from));
            at = to;
        }
        self.text.push_str(text.get(at..range.end).unwrap_or(""));
        self.text.push('\n');
        self.pieces.push(piece);
    }

    /// The whole text.
    pub(super) fn as_str(&self) -> &str {
        &self.text
    }

    /// Where a joined range stands. A range that starts in no file (only in an empty text) is nowhere.
    pub(super) fn locate(&self, range: Range<usize>) -> Span {
        let after = self.pieces.partition_point(|piece| piece.joined <= range.start);
        let Some(piece) = after.checked_sub(1).and_then(|index| self.pieces.get(index)) else {
            return Span::NOWHERE;
        };
        let in_file = |joined: usize| piece.start + joined.saturating_sub(piece.joined).min(piece.length);
        let start = in_file(range.start);
        Span::new(piece.file, start, in_file(range.end).max(start))
    }

    /// Where a place that naga names stands.
    pub(super) fn locate_naga(&self, span: naga::Span) -> Option<Span> {
        span.to_range().map(|range| self.locate(range))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::SourceMap;

    #[test]
    fn maps_back_across_pieces_and_holes() {
        let mut sources = SourceMap::default();
        let (one, two) = ("// ä\nfn a() {}", "#import \"one\"\nfn b() {}");
        let (first, second) = (sources.add("one", one), sources.add("two", two));
        let mut joined = JoinedText::default();
        let hole = 0..13;
        joined.push(first, one, 0..one.len(), &[]);
        joined.push(second, two, 0..two.len(), std::slice::from_ref(&hole));
        assert_eq!(joined.as_str(), "// ä\nfn a() {}\n             \nfn b() {}\n");
        let at = joined.as_str().find('b').unwrap();
        assert_eq!(sources.line_column(joined.locate(at..at + 1)), Some((2, 4)));
        assert_eq!(sources.text(joined.locate(at..at + 1)), "b");
        let a = joined.as_str().find("a()").unwrap();
        assert_eq!(sources.text(joined.locate(a..a + 1)), "a");
        // Over the end of a file: cut there.
        assert_eq!(sources.text(joined.locate(a..at)), "a() {}");
        assert_eq!(joined.locate(joined.as_str().len()..joined.as_str().len() + 5), Span::new(second, two.len(), two.len()));
    }
}
