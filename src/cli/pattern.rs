//! Paths of the images of a sequence: `frames/%04d.png`, where the field stands for the frame's number.
//!
//! A field is `%d`, or `%0Nd` with N digits at least, filled up with zeros; a longer number is written whole. `%%` is a percent sign.
//! The field belongs to the file's name, so that a sequence is the content of one folder.

use std::path::{Path, PathBuf};

use luminaire_graph::diagnostic::Diagnostic;

/// A path with one field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FramePattern {
    folder: PathBuf,
    before: String,
    /// The least number of digits.
    digits: usize,
    after: String,
}

/// A part of a file's name.
enum Piece<'a> {
    Text(&'a str),
    Field {
        digits: usize,
    },
    /// After a percent sign, and no field.
    Unknown(&'a str),
}

impl FramePattern {
    /// Reads a pattern. Errors: `output::no-field`, `output::several-fields`, `output::bad-field`.
    pub(super) fn parse(path: &Path) -> Result<FramePattern, Diagnostic> {
        let shown = path.display();
        let error = |code, message: String| Diagnostic::error(code, message).hint("give the images' names a field: frames/%04d.png");
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
            return Err(error("output::bad-field", format!("`{shown}` does not end in a name that is UTF-8")));
        };
        let mut found: Option<FramePattern> = None;
        let mut text = String::new();
        for piece in pieces(name) {
            match piece {
                Piece::Text(more) => text.push_str(more),
                Piece::Field { .. } if found.is_some() => {
                    return Err(error("output::several-fields", format!("`{shown}` has several fields for the frame's number")));
                }
                Piece::Field { digits } => {
                    found = Some(FramePattern { folder: folder.clone(), before: std::mem::take(&mut text), digits, after: String::new() });
                }
                Piece::Unknown(what) => {
                    let message = format!("`%{what}` in `{shown}` is no field for the frame's number");
                    return Err(Diagnostic::error("output::bad-field", message)
                        .hint("a field is %d, or %04d for at least four digits; %% is a percent sign"));
                }
            }
        }
        match found {
            Some(pattern) => Ok(FramePattern { after: text, ..pattern }),
            None if path.parent().and_then(Path::to_str).is_some_and(has_field) => {
                Err(error("output::no-field", format!("the field for the frame's number stands in a folder of `{shown}`"))
                    .hint("the field belongs to the file's name: frames/%04d.png"))
            }
            None => Err(error("output::no-field", format!("`{shown}` is the path of one image, and a range of frames has several"))),
        }
    }

    /// Where all of them are.
    pub(super) fn folder(&self) -> &Path {
        if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder }
    }

    /// Where a frame's image is.
    pub(super) fn path(&self, frame: u32) -> PathBuf {
        self.folder.join(format!("{}{frame:0digits$}{}", self.before, self.after, digits = self.digits))
    }
}

/// Whether a text has a field for the frame's number.
pub(super) fn has_field(text: &str) -> bool {
    pieces(text).any(|piece| matches!(piece, Piece::Field { .. }))
}

fn pieces(text: &str) -> impl Iterator<Item = Piece<'_>> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let Some(behind) = rest.strip_prefix('%') else {
            let (piece, more) = rest.split_at(rest.find('%').unwrap_or(rest.len()));
            rest = more;
            return (!piece.is_empty()).then_some(Piece::Text(piece));
        };
        if let Some(more) = behind.strip_prefix('%') {
            rest = more;
            return Some(Piece::Text("%"));
        }
        let (flags, more) = behind.split_at(behind.find(|c: char| !c.is_ascii_digit()).unwrap_or(behind.len()));
        let digits = match flags.as_bytes() {
            [] => Some(1),
            [b'0', digit @ b'1'..=b'9'] => Some(usize::from(digit - b'0')),
            _ => None,
        };
        match (digits, more.strip_prefix('d')) {
            (Some(digits), Some(more)) => {
                rest = more;
                Some(Piece::Field { digits })
            }
            _ => {
                let end = flags.len() + more.chars().next().map_or(0, char::len_utf8);
                let (unknown, more) = behind.split_at(end);
                rest = more;
                Some(Piece::Unknown(unknown))
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(pattern: &str, frame: u32) -> Result<String, &'static str> {
        FramePattern::parse(Path::new(pattern)).map(|pattern| pattern.path(frame).display().to_string()).map_err(|problem| problem.code)
    }

    #[test]
    fn numbers_stand_where_the_field_is() {
        assert_eq!(at("frames/%04d.png", 7), Ok("frames/0007.png".to_owned()));
        assert_eq!(at("frames/%04d.png", 12345), Ok("frames/12345.png".to_owned()));
        assert_eq!(at("%d.exr", 0), Ok("0.exr".to_owned()));
        assert_eq!(at("/a/50%%_%02d_x.png", 3), Ok("/a/50%_03_x.png".to_owned()));
        assert_eq!(at("ä%09dö.png", u32::MAX), Ok("ä4294967295ö.png".to_owned()));
        assert_eq!(at("100%/%d.png", 1), Ok("100%/1.png".to_owned()));
    }

    #[test]
    fn what_is_no_pattern_is_refused() {
        let cases = [
            ("a.png", "output::no-field"),
            ("%%d.png", "output::no-field"),
            ("%04d/a.png", "output::no-field"),
            ("%d_%d.png", "output::several-fields"),
            ("%4d.png", "output::bad-field"),
            ("%0d.png", "output::bad-field"),
            ("%010d.png", "output::bad-field"),
            ("%s.png", "output::bad-field"),
            ("%ä.png", "output::bad-field"),
            ("a%", "output::bad-field"),
            ("a%04", "output::bad-field"),
            ("..", "output::bad-field"),
        ];
        for (pattern, code) in cases {
            assert_eq!(at(pattern, 0), Err(code), "{pattern}");
        }
    }

    #[test]
    fn only_fields_count_in_the_name_of_one_image() {
        assert!(has_field("a%04d.png") && has_field("%d.png"));
        assert!(!has_field("100%.png") && !has_field("100%%d.png") && !has_field("a%s.png"));
    }
}
