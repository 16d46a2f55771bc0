//! What `--frames` says: how many frames before one image is taken, or which frames become images.
//!
//! `64` is a number of frames, `0..120` are the frames 0 to 119, and `0..=120` ends with frame 120.

use std::ops::RangeInclusive;

/// The most images of one sequence: nine hours at 30 a second.
const MOST_IMAGES: u32 = 1_000_000;

/// What `--frames` says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum FrameSelection {
    /// So many frames, at least 1, and then one image.
    Count(u32),
    /// An image of each of these frames. Never empty.
    Range(RangeInclusive<u32>),
}

/// Reads `N`, `A..B` or `A..=B`. Errors: as the end of a sentence, for the command line's reader.
pub(super) fn parse_frames(text: &str) -> Result<FrameSelection, String> {
    let Some((first, end)) = text.split_once("..") else {
        return match number(text)? {
            0 => Err("at least one frame is rendered before an image is taken".to_owned()),
            count => Ok(FrameSelection::Count(count)),
        };
    };
    let (end, inclusive) = end.strip_prefix('=').map_or((end, false), |end| (end, true));
    if first.is_empty() || end.is_empty() {
        return Err("a range needs its first frame and its end, such as 0..120".to_owned());
    }
    let (first, end) = (number(first)?, number(end)?);
    if end < first {
        return Err(format!("the range ends before it begins; did you mean {end}..{first}?"));
    }
    let last = match inclusive {
        true => end,
        false if end == first => {
            return Err(format!("the range is empty, since its end is left out; {first}..={end} is frame {end} alone"));
        }
        false => end - 1,
    };
    if last - first >= MOST_IMAGES {
        return Err(format!("{} frames are more than the {MOST_IMAGES} of a sequence", u64::from(last - first) + 1));
    }
    Ok(FrameSelection::Range(first..=last))
}

fn number(text: &str) -> Result<u32, String> {
    if text.is_empty() || !text.bytes().all(|byte| byte.is_ascii_digit()) {
        return Err(format!("`{text}` is no whole number; expected a number of frames, such as 64, or a range, such as 0..120"));
    }
    text.parse().map_err(|_| format!("{text} is more than {}, the greatest number of a frame", u32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_ranges() {
        let range = |first, last| Ok(FrameSelection::Range(first..=last));
        assert_eq!(parse_frames("1"), Ok(FrameSelection::Count(1)));
        assert_eq!(parse_frames("4294967295"), Ok(FrameSelection::Count(u32::MAX)));
        assert_eq!(parse_frames("0..120"), range(0, 119));
        assert_eq!(parse_frames("0..=120"), range(0, 120));
        assert_eq!(parse_frames("7..=7"), range(7, 7));
        assert_eq!(parse_frames("4294967294..=4294967295"), range(u32::MAX - 1, u32::MAX));
        assert_eq!(parse_frames("5..1000005"), range(5, 1_000_004));
    }

    #[test]
    fn what_is_neither_is_explained() {
        let cases = [
            ("0", "at least one frame"),
            ("", "`` is no whole number"),
            ("-1", "`-1` is no whole number"),
            ("+5", "`+5` is no whole number"),
            ("1.5", "`1.5` is no whole number"),
            ("4294967296", "4294967296 is more than 4294967295"),
            ("..", "a range needs its first frame and its end"),
            ("..5", "a range needs its first frame and its end"),
            ("3..", "a range needs its first frame and its end"),
            ("3..=", "a range needs its first frame and its end"),
            ("5..3", "did you mean 3..5?"),
            ("5..=3", "did you mean 3..5?"),
            ("5..5", "5..=5 is frame 5 alone"),
            ("0...5", "`.5` is no whole number"),
            ("0..==5", "`=5` is no whole number"),
            ("0..1..2", "`1..2` is no whole number"),
            ("0..1000001", "1000001 frames are more than the 1000000"),
            ("0..=4294967295", "4294967296 frames are more than"),
            ("0..99999999999999999999", "is more than 4294967295"),
        ];
        for (text, expected) in cases {
            let problem = parse_frames(text).unwrap_err();
            assert!(problem.contains(expected), "`{text}`: {problem}");
        }
    }
}
