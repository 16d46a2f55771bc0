//! What can be wrong with a document by itself.

use crate::diagnostic::{Diagnostic, did_you_mean, list_names};
use crate::source::Span;

/// A problem found by validation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum ValidateError {
    #[error("`{name}` is not a name: {rule}")]
    BadName { name: String, rule: &'static str, span: Span },
    #[error("there is no {what} `{name}`")]
    Unknown { what: &'static str, name: String, known: Vec<String>, span: Span },
    #[error("`{text}` is not a reference to a resource: {reason}")]
    BadReference { text: String, reason: String, span: Span },
    #[error("in the expression `{text}`: {reason}")]
    BadExpression { text: String, reason: String, span: Span },
    #[error("`{name}` means two things here: {first} and {second}")]
    Ambiguous { name: String, first: &'static str, second: &'static str, span: Span },
    #[error("parameter `{name}`: {reason}")]
    BadParam { name: String, reason: String, hint: Option<String>, span: Span },
    #[error("resource `{name}`: {reason}")]
    BadResource { name: String, reason: String, hint: Option<String>, span: Span },
    #[error("pass `{pass}`: {reason}")]
    BadPass { pass: String, reason: String, hint: Option<String>, span: Span },
    #[error("`{text}` can't stand here: {reason}")]
    BadPrevious { text: String, reason: &'static str, hint: &'static str, span: Span },
    #[error("`{variable}` counts the iterations of a batched loop, and this value is one for all of them")]
    BatchedIndex { variable: String, span: Span },
    #[error("pass `{pass}`: {reason}")]
    BadRun { pass: String, reason: String, hint: &'static str, span: Span },
    #[error("block `{block}`: {reason}")]
    BadBlock { block: String, reason: String, hint: Option<&'static str>, span: Span },
    #[error("the input `{input}` of block `{block}` is {mismatch}")]
    InputMismatch { block: String, input: String, mismatch: String, span: Span, declared: Span },
    #[error("the pipeline has no {what}")]
    Empty { what: &'static str, span: Span },
}

impl From<ValidateError> for Diagnostic {
    fn from(error: ValidateError) -> Diagnostic {
        let message = error.to_string();
        match error {
            ValidateError::BadName { span, .. } => Diagnostic::error("validate::bad-name", message).at(span, "this name"),
            ValidateError::Unknown { what, name, known, span } => {
                let code = match what {
                    "resource" => "validate::unknown-resource",
                    "pass" => "validate::unknown-pass",
                    "format" => "validate::unknown-format",
                    "scene count" => "validate::unknown-scene-count",
                    "collection" => "validate::unknown-collection",
                    "slot" => "validate::unknown-slot",
                    _ => "validate::unknown-name",
                };
                let hint = did_you_mean(&name, known.iter().map(String::as_str));
                let mut diagnostic = Diagnostic::error(code, message).at(span, format!("no such {what}")).maybe_hint(hint);
                if !known.is_empty() {
                    diagnostic = diagnostic.note(format!("known here: {}", list_names(known.iter().map(String::as_str))));
                }
                diagnostic
            }
            ValidateError::BadReference { span, .. } => Diagnostic::error("validate::bad-reference", message)
                .at(span, "this reference")
                .hint("a reference is `name`, `name.mip(i)`, `name.layer(i)` or `name.face(i)`; `name@pass` is the value as that pass left it"),
            ValidateError::BadExpression { span, .. } => Diagnostic::error("validate::bad-expression", message).at(span, "here"),
            ValidateError::Ambiguous { span, .. } => {
                Diagnostic::error("validate::ambiguous-name", message).at(span, "used here").hint("give one of the two another name")
            }
            ValidateError::BadParam { hint, span, .. } => Diagnostic::error("validate::bad-param", message).at(span, "this parameter").maybe_hint(hint),
            ValidateError::BadResource { hint, span, .. } => {
                Diagnostic::error("validate::bad-resource", message).at(span, "here").maybe_hint(hint)
            }
            ValidateError::BadPass { hint, span, .. } => Diagnostic::error("validate::bad-pass", message).at(span, "here").maybe_hint(hint),
            ValidateError::BadPrevious { hint, span, .. } => {
                Diagnostic::error("validate::bad-previous", message).at(span, "this reference").hint(hint)
            }
            ValidateError::BatchedIndex { span, .. } => Diagnostic::error("validate::batched-index", message)
                .at(span, "here")
                .hint("only parts may name the index: the shader finds those of the iterations that run in `batch`"),
            ValidateError::BadRun { hint, span, .. } => Diagnostic::error("validate::bad-run", message).at(span, "here").hint(hint),
            ValidateError::BadBlock { hint, span, .. } => {
                Diagnostic::error("validate::bad-block", message).at(span, "here").maybe_hint(hint.map(str::to_owned))
            }
            ValidateError::InputMismatch { span, declared, .. } => {
                Diagnostic::error("validate::input-mismatch", message).at(span, "given here").and(declared, "asked for here")
            }
            ValidateError::Empty { span, .. } => Diagnostic::error("validate::empty", message).at(span, "nothing here"),
        }
    }
}
