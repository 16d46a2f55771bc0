//! From text to a document.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::source::{FileId, Span};
use serde::de::DeserializeOwned;

/// Reads a document of any type. Errors: `scene::syntax`, one at a time.
pub(super) fn parse<T: DeserializeOwned>(text: &str, file: FileId) -> Result<T, Vec<Diagnostic>> {
    use ron::extensions::Extensions;
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES);
    options.from_str(text).map_err(|error| {
        let offset = |position: ron::error::Position| {
            let line = text.split_inclusive('\n').take(position.line.saturating_sub(1)).map(str::len).sum::<usize>();
            let column: usize = text.get(line..).unwrap_or("").chars().take(position.col.saturating_sub(1)).map(char::len_utf8).sum();
            (line + column).min(text.len())
        };
        let span = Span::new(file, offset(error.span.start), offset(error.span.end));
        vec![Diagnostic::error("scene::syntax", error.code.to_string()).at(span, "here")]
    })
}
