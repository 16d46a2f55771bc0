//! From RON text to a tree with places, and from that to a document.
//!
//! [`parse`] reads the text and finds everything that is wrong with it as text; [`from_tree`] and [`deserialize_document`] fill
//! any serde type and find everything that is wrong with the values. Both are linear in the text.
//!
//! Guarantees: no text makes them panic or overflow the stack; what is accepted has the value that the `ron` crate (0.12, with
//! `implicit_some` and `unwrap_newtypes`) reads. Refused here though accepted there: duplicate keys and fields, nesting
//! beyond [`tree::MAX_DEPTH`], digits that overflow to infinity, a `Some` without brackets, and two extensions that
//! change what a text means.
//!
//! ```
//! use luminaire_graph::source::SourceMap;
//! use luminaire_graph::syntax::{read_document, spanned::Spanned};
//!
//! #[derive(serde::Deserialize)]
//! struct Document {
//!     name: Spanned<String>,
//! }
//!
//! let mut sources = SourceMap::default();
//! let text = r#"(name: "lamp")"#;
//! let file = sources.add("scene.ron", text);
//! let document: Document = read_document(text, file).unwrap();
//! assert_eq!(sources.text(document.name.span), r#""lamp""#);
//! ```

pub mod document;
pub mod error;
pub mod spanned;
pub mod tree;

mod access;
mod attributes;
mod deserialize;
mod duplicates;
mod fault;
mod fit;
mod lex;
mod literal;
mod number;
mod parse;
mod recover;
mod sequence;
mod variant;

pub use parse::parse;
pub use recover::{deserialize_document, from_tree};

use serde::de::DeserializeOwned;

use crate::diagnostic::Diagnostic;
use crate::source::FileId;

/// Reads a RON text as a value of any type.
///
/// # Errors
/// Those of [`parse`], or, where the text is RON, those of [`deserialize_document`].
pub fn read_document<T: DeserializeOwned>(text: &str, file: FileId) -> Result<T, Vec<Diagnostic>> {
    deserialize_document(&parse(text, file)?)
}
