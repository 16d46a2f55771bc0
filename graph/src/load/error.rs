//! What can be wrong with the files that a pipeline is made of.

use crate::diagnostic::{Diagnostic, did_you_mean, list_names};
use crate::source::{FileError, Span};

/// A problem found while files are put together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum LoadError {
    #[error("can't read the pipeline `{path}`: {error}")]
    Unreadable { path: String, error: FileError, known: Vec<String>, span: Span },
    #[error("can't read the image `{path}`: {error}")]
    BadImage { path: String, error: FileError, known: Vec<String>, span: Span },
    #[error("a pipeline can't be a part of itself: {}", chain.join(" -> "))]
    Recursion { chain: Vec<String>, span: Span },
    #[error("`{path}` stands {limit} files deep")]
    TooDeep { path: String, limit: usize, span: Span },
    #[error("the pipeline has more than {limit} blocks")]
    TooManyBlocks { limit: usize, span: Span },
    #[error("`{base}` has no {what} `{name}`")]
    Unknown { what: &'static str, name: String, base: String, known: Vec<String>, span: Span },
    #[error("the {what} `{name}` stands in both files")]
    Conflict { what: &'static str, name: String, span: Span, base: Span },
    #[error("the {what} `{name}` is changed twice")]
    ChangedTwice { what: &'static str, name: String, span: Span, other: Span },
}

impl From<LoadError> for Diagnostic {
    fn from(error: LoadError) -> Diagnostic {
        let message = error.to_string();
        match error {
            LoadError::Unreadable { path, known, span, .. } => {
                let hint = did_you_mean(&path, known.iter().map(String::as_str));
                let hint =
                    hint.or_else(|| (!known.is_empty()).then(|| format!("there are {}", list_names(known.iter().map(String::as_str)))));
                Diagnostic::error("load::missing-file", message).at(span, "named here").maybe_hint(hint)
            }
            LoadError::BadImage { path, error, known, span } => {
                if matches!(error, FileError::Unreadable(_)) {
                    let hint = "save it again, as an OpenEXR or Radiance HDR file";
                    return Diagnostic::error("load::bad-image", message).at(span, "named here").hint(hint);
                }
                let hint = did_you_mean(&path, known.iter().map(String::as_str));
                let hint = hint.unwrap_or_else(|| "images are .exr and .hdr files in the folder of shaders".to_owned());
                Diagnostic::error("load::missing-image", message).at(span, "named here").hint(hint)
            }
            LoadError::Recursion { span, .. } => Diagnostic::error("load::recursion", message)
                .at(span, "this closes the circle")
                .hint("leave this one out, or move what both need to a file of its own"),
            LoadError::TooDeep { span, .. } => {
                Diagnostic::error("load::too-deep", message).at(span, "named here").hint("use it from a file nearer to the pipeline")
            }
            LoadError::TooManyBlocks { span, .. } => Diagnostic::error("load::too-many-blocks", message)
                .at(span, "this one is too much")
                .hint("blocks of blocks count each time: use a loop inside of a block instead"),
            LoadError::Unknown { name, known, span, what, .. } => {
                let hint = did_you_mean(&name, known.iter().map(String::as_str));
                let mut diagnostic = Diagnostic::error("load::unknown", message).at(span, format!("no such {what}")).maybe_hint(hint);
                if !known.is_empty() {
                    diagnostic = diagnostic.note(format!("it has {}", list_names(known.iter().map(String::as_str))));
                }
                diagnostic
            }
            LoadError::Conflict { span, base, what, .. } => Diagnostic::error("load::conflict", message)
                .at(span, format!("this {what} is added"))
                .and(base, "and stands here already")
                .hint("to change it, put it under `replace` of `extend`; else give it another name"),
            LoadError::ChangedTwice { span, other, .. } => {
                Diagnostic::error("load::changed-twice", message).at(span, "here").and(other, "and here").hint("leave one of the two out")
            }
        }
    }
}
