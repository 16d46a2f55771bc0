//! What can be wrong with a text before any type is known, and the collector that keeps all of it.
//!
//! What can be wrong with a value of a wrong type is in `fault.rs`.

use crate::diagnostic::{Diagnostic, did_you_mean, list_names};
use crate::source::{FileId, Span};

use super::tree::MAX_DEPTH;

/// Largest text that is read, in bytes.
pub const MAX_BYTES: usize = 64 << 20;
/// How many problems of one text are kept. Further ones are counted in no way: a text with so many is not RON.
pub const MAX_PROBLEMS: usize = 1000;

/// One problem of a text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)]
pub enum SyntaxError {
    #[error("the file has {bytes} bytes, and at most {MAX_BYTES} are read")]
    TooLarge { bytes: usize },
    #[error("more than {MAX_PROBLEMS} problems: the rest of the text was not read")]
    TooMany,
    #[error("unexpected character `{}`", .0.escape_debug())]
    UnexpectedCharacter(char),
    #[error("the file starts with a byte order mark")]
    ByteOrderMark,
    #[error("expected {expected}, found {found}")]
    Unexpected { expected: &'static str, found: String },
    #[error("missing comma between {0}")]
    MissingComma(&'static str),
    #[error("missing `:` between a {key} and its value")]
    MissingColon { key: &'static str },
    #[error("the `{0}` is never closed")]
    Unclosed(char, Option<(char, Span)>, Vec<Span>),
    #[error("this `{0}` closes nothing")]
    StrayCloser(char),
    #[error("the string is never closed")]
    UnclosedString,
    #[error("the string is probably not closed where it should be")]
    RunawayString { end: Span },
    #[error("the comment is never closed")]
    UnclosedComment,
    #[error("{0}")]
    BadEscape(&'static str),
    #[error("{0}")]
    BadChar(&'static str),
    #[error("`{text}` is not a number: {why}")]
    BadNumber { text: String, why: &'static str },
    #[error("`{text}` is out of range{limits}")]
    NumberRange { text: String, limits: &'static str },
    #[error("`{0}` is not an identifier")]
    BadIdentifier(String),
    #[error("nested more than {MAX_DEPTH} levels deep")]
    TooDeep,
    #[error("{key} is there twice")]
    DuplicateKey { key: String, first: Span },
    #[error("the field `{field}` is there twice")]
    DuplicateField { field: String, first: Span },
    #[error("a value without a name among named fields")]
    UnnamedField,
    #[error("a named field among values without names")]
    NamedField,
    #[error("field names are written without quotes")]
    QuotedField(String),
    #[error("unknown extension `{0}`")]
    UnknownExtension(String),
    #[error("the extension `{0}` is not supported here")]
    UnsupportedExtension(&'static str),
    #[error("text after the end of the document")]
    TrailingText,
}

/// The extensions of RON that a text may enable. They are always on.
pub(super) const EXTENSIONS: [&str; 2] = ["implicit_some", "unwrap_newtypes"];
/// The extensions of RON that would change what a text means.
pub(super) const UNSUPPORTED_EXTENSIONS: [&str; 2] = ["unwrap_variant_newtypes", "explicit_struct_names"];

impl SyntaxError {
    /// The stable code.
    pub fn code(&self) -> &'static str {
        match self {
            SyntaxError::TooLarge { .. } => "syntax::file-too-large",
            SyntaxError::TooMany => "syntax::too-many-problems",
            SyntaxError::UnexpectedCharacter(_) => "syntax::unexpected-character",
            SyntaxError::ByteOrderMark => "syntax::byte-order-mark",
            SyntaxError::Unexpected { .. } => "syntax::unexpected",
            SyntaxError::MissingComma(_) => "syntax::missing-comma",
            SyntaxError::MissingColon { .. } => "syntax::missing-colon",
            SyntaxError::Unclosed(..) => "syntax::unclosed-bracket",
            SyntaxError::StrayCloser(_) => "syntax::stray-bracket",
            SyntaxError::UnclosedString | SyntaxError::RunawayString { .. } => "syntax::unclosed-string",
            SyntaxError::UnclosedComment => "syntax::unclosed-comment",
            SyntaxError::BadEscape(_) => "syntax::bad-escape",
            SyntaxError::BadChar(_) => "syntax::bad-character-literal",
            SyntaxError::BadNumber { .. } => "syntax::bad-number",
            SyntaxError::NumberRange { .. } => "syntax::number-out-of-range",
            SyntaxError::BadIdentifier(_) => "syntax::bad-identifier",
            SyntaxError::TooDeep => "syntax::too-deep",
            SyntaxError::DuplicateKey { .. } => "syntax::duplicate-key",
            SyntaxError::DuplicateField { .. } => "syntax::duplicate-field",
            SyntaxError::UnnamedField | SyntaxError::NamedField => "syntax::mixed-fields",
            SyntaxError::QuotedField(_) => "syntax::quoted-field",
            SyntaxError::UnknownExtension(_) | SyntaxError::UnsupportedExtension(_) => "syntax::unknown-extension",
            SyntaxError::TrailingText => "syntax::trailing-text",
        }
    }

    /// The diagnostic with its primary place.
    pub fn diagnostic(&self, span: Span) -> Diagnostic {
        let problem = Diagnostic::error(self.code(), self.to_string());
        match self {
            SyntaxError::TooLarge { .. } => problem,
            SyntaxError::TooMany => problem.at(span, "reading stopped here"),
            SyntaxError::UnexpectedCharacter(_) => problem.at(span, "not part of RON"),
            SyntaxError::ByteOrderMark => problem.at(span, "invisible character").hint("save the file as UTF-8 without a byte order mark"),
            SyntaxError::Unexpected { expected, .. } => problem.at(span, format!("expected {expected}")),
            SyntaxError::MissingComma(_) => problem.at(span, "expected `,` here"),
            SyntaxError::MissingColon { .. } => problem.at(span, "expected `:` here"),
            SyntaxError::Unclosed(_, closer, others) => {
                let mut problem = problem.at(span, "opened here");
                if let Some((closer, place)) = closer {
                    problem = problem.and(*place, format!("this `{closer}` belongs to an earlier bracket"));
                }
                for other in others {
                    problem = problem.and(*other, "this one is not closed either");
                }
                problem
            }
            SyntaxError::StrayCloser(_) => problem.at(span, "no open bracket matches"),
            SyntaxError::UnclosedString => {
                problem.at(span, "starts here").note("strings may span lines, so the quote that is missing may also be one before this")
            }
            SyntaxError::RunawayString { end } => {
                problem.at(span, "starts here").and(*end, "and ends here, at what looks like the start of another string")
            }
            SyntaxError::UnclosedComment => problem.at(span, "starts here").note("block comments nest: each `/*` needs its own `*/`"),
            SyntaxError::BadEscape(_) => problem
                .at(span, "in this escape")
                .note(r#"escapes are \n, \r, \t, \0, \\, \', \", \x41, \u{1F600}, and a backslash at the end of a line"#),
            SyntaxError::BadChar(_) => problem.at(span, "not a single character"),
            SyntaxError::BadNumber { why, .. } => problem.at(span, *why),
            SyntaxError::NumberRange { .. } => problem.at(span, "too large"),
            SyntaxError::BadIdentifier(text) => {
                problem.at(span, "only letters, digits and `_`").hint(format!("as a raw identifier it is written `r#{text}`"))
            }
            SyntaxError::TooDeep => problem.at(span, "this bracket is one too many"),
            SyntaxError::DuplicateKey { first, .. } | SyntaxError::DuplicateField { first, .. } => {
                problem.at(span, "again here").and(*first, "first here")
            }
            SyntaxError::UnnamedField => problem.at(span, "expected `name: value`"),
            SyntaxError::NamedField => problem.at(span, "this value has a name"),
            SyntaxError::QuotedField(name) => {
                problem.at(span, "in quotes").hint(format!("write `{name}`, or use a map: `{{..}}` instead of `(..)`"))
            }
            SyntaxError::UnknownExtension(name) => problem
                .at(span, "not an extension of RON")
                .maybe_hint(did_you_mean(name, EXTENSIONS))
                .note(format!("always on: {}", list_names(EXTENSIONS))),
            SyntaxError::UnsupportedExtension(_) => {
                problem.at(span, "it would change what the text means").note(format!("always on: {}", list_names(EXTENSIONS)))
            }
            SyntaxError::TrailingText => problem.at(span, "expected nothing more").note("a document is a single value"),
        }
    }
}

/// Collects the problems of one text.
#[derive(Debug)]
pub(super) struct Problems {
    file: FileId,
    found: Vec<Diagnostic>,
    /// While what follows a reported problem is skipped, it is not reported again.
    pub(super) muted: bool,
    /// Nothing after this can be trusted, so nothing more is reported.
    stopped: bool,
}

impl Problems {
    /// None yet.
    pub(super) fn new(file: FileId) -> Problems {
        Problems { file, found: Vec::new(), muted: false, stopped: false }
    }

    /// A place in the text.
    pub(super) fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.file, start, end)
    }

    /// Keeps a problem, unless it follows from another.
    pub(super) fn report(&mut self, span: Span, error: &SyntaxError) {
        if self.muted || self.stopped {
            return;
        }
        if self.found.len() >= MAX_PROBLEMS {
            self.found.push(SyntaxError::TooMany.diagnostic(span));
            self.stopped = true;
        } else {
            self.found.push(error.diagnostic(span));
        }
    }

    /// Keeps a problem even while muted, and no other from here on.
    pub(super) fn report_last(&mut self, span: Span, error: &SyntaxError) {
        self.muted = false;
        self.report(span, error);
        self.stopped = true;
    }

    /// Keeps a problem in place of all that were reported from `from` on, and no other from here on.
    pub(super) fn replace_from(&mut self, from: Span, span: Span, error: &SyntaxError) {
        self.found.retain(|problem| problem.primary.as_ref().is_none_or(|label| label.span < from));
        self.stopped = false;
        self.report_last(span, error);
    }

    /// Whether nothing more is reported.
    pub(super) fn is_stopped(&self) -> bool {
        self.stopped
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// All, in the order of the text.
    pub(super) fn into_sorted(mut self) -> Vec<Diagnostic> {
        sort_by_place(&mut self.found);
        self.found
    }
}

/// Sorts by the primary place; problems of one place keep their order.
pub(super) fn sort_by_place(diagnostics: &mut [Diagnostic]) {
    diagnostics.sort_by_key(|diagnostic| diagnostic.primary.as_ref().map(|label| label.span));
}
