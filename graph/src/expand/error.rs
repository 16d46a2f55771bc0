//! What can be wrong once expressions have values.

use std::sync::Arc;

use crate::diagnostic::{Diagnostic, did_you_mean, list_names};
use crate::source::Span;

use super::types::Located;

/// The code of the message that a block gets which stands alone. Nothing else is wrong with it.
pub const BLOCK_ALONE: &str = "expand::block-alone";

/// A problem found by expansion.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum ExpandError {
    #[error("there is no parameter `{name}` to set")]
    UnknownParam { name: String, known: Vec<String> },
    #[error("parameter `{name}` can't be set to `{given}`: {reason}")]
    BadSet { name: String, given: String, reason: String, span: Span },
    #[error("the parameter `{name}` can't have this value: {reason}")]
    BadGiven { name: String, reason: String, span: Span, declared: Span },
    #[error("it is a block: somebody has to give it {}", list_names(inputs.iter().map(|input| input.value.as_str())))]
    BlockAlone { inputs: Vec<Located<String>> },
    #[error("the extent of `{name}` depends on itself: {}", chain.join(" -> "))]
    CircularExtent { name: String, chain: Vec<String>, span: Span },
    #[error("`{first}` and `{second}` both modify `{resource}`, and nothing says which comes first")]
    ModifierOrder { resource: String, first: Arc<str>, second: Arc<str>, spans: [Span; 2] },
    #[error("there is no output `{name}`")]
    UnknownOutput { name: String, known: Vec<String> },
    #[error("{what}: {reason}")]
    BadValue { what: String, reason: String, span: Span },
    #[error("resource `{name}`: {what} is 0")]
    SizeZero { name: String, what: &'static str, span: Span },
    #[error("resource `{name}`: {what} is {value}, and the limit is {limit} ({device})")]
    SizeOverLimit { name: String, what: &'static str, value: u64, limit: u64, device: String, span: Span },
    #[error("resource `{name}`: {reason}")]
    BadResource { name: String, reason: String, hint: &'static str, span: Span },
    #[error("pass `{pass}` writes `{image}`, which holds what a file says")]
    WritesImage { image: String, pass: Arc<str>, span: Span, declared: Span },
    #[error("pass `{pass}`: `{resource}` has no {what} {index}: it has {count}")]
    PartOutOfRange { pass: String, resource: String, what: &'static str, index: i64, count: u32, span: Span },
    #[error("pass `{pass}`: `{resource}` is a buffer and has no {what}")]
    PartOfBuffer { pass: String, resource: String, what: &'static str, span: Span },
    #[error("loop `{name}` makes the pipeline longer than {limit} passes")]
    TooManyPasses { name: String, limit: usize, span: Span },
    #[error("with `{path}` more than {limit} pairs of passes wait for each other by `after`")]
    TooManyAfter { path: String, limit: usize, span: Span },
    #[error("`{path}` stands for {count} passes here")]
    AmbiguousPass { path: String, count: usize, span: Span },
    #[error("`{path}` does not stand in this scene or with these parameters, and its value is read")]
    AbsentPass { path: String, span: Span },
    #[error("resource `{name}` can't be `keep: Never`: {why}")]
    MustBeKept { name: String, why: &'static str, span: Span },
    #[error("`{resource}` is written by `{pass}`, which does not run in every frame, and by `{other}`")]
    SharedWithAmortised { resource: String, pass: Arc<str>, other: Arc<str>, span: Span, other_span: Span },
    #[error("`{resource}` has no declared value, and `{pass}` needs one before it has run")]
    NoValueBefore { resource: String, pass: Arc<str>, span: Span, declared: Span },
    #[error("the cycle {cycle} would never settle: each pass in it runs because the one before has run")]
    NeverSettles { cycle: String, span: Span, pass: Span },
}

impl From<ExpandError> for Diagnostic {
    fn from(error: ExpandError) -> Diagnostic {
        let message = error.to_string();
        match error {
            ExpandError::UnknownParam { name, known } => {
                let names = list_names(known.iter().map(String::as_str));
                let hint = did_you_mean(&name, known.iter().map(String::as_str));
                Diagnostic::error("expand::unknown-param", message).note(format!("the pipeline's parameters: {names}")).maybe_hint(hint)
            }
            ExpandError::BadSet { span, .. } => Diagnostic::error("expand::bad-set", message).at(span, "declared here"),
            ExpandError::BadGiven { span, declared, .. } => {
                Diagnostic::error("expand::bad-given", message).at(span, "given here").and(declared, "declared here")
            }
            ExpandError::BlockAlone { inputs } => {
                let place = inputs.first().map_or(Span::NOWHERE, |input| input.span);
                Diagnostic::error(BLOCK_ALONE, message)
                    .at(place, "asked for here")
                    .hint("name it under `blocks` of a pipeline, with `inputs`")
            }
            ExpandError::CircularExtent { span, .. } => {
                Diagnostic::error("expand::circular-extent", message).at(span, "here").hint("compute one of the sizes from parameters")
            }
            ExpandError::ModifierOrder { spans, .. } => Diagnostic::error("expand::modifier-order", message)
                .at(spans[1], "this one modifies it")
                .and(spans[0], "and this one, which stands in another list")
                .hint("the order of a file says it only for the passes of that file: name one under `after` of the other, or of its block"),
            ExpandError::UnknownOutput { name, known } => {
                let names = list_names(known.iter().map(String::as_str));
                let hint = did_you_mean(&name, known.iter().map(String::as_str));
                Diagnostic::error("expand::unknown-output", message).note(format!("the pipeline's outputs: {names}")).maybe_hint(hint)
            }
            ExpandError::BadValue { span, .. } => Diagnostic::error("expand::bad-value", message).at(span, "this value"),
            ExpandError::SizeZero { span, .. } => Diagnostic::error("expand::size-zero", message)
                .at(span, "computed here")
                .hint("every extent is at least 1; guard a size that may vanish with `max(1, ..)`"),
            ExpandError::SizeOverLimit { span, .. } => Diagnostic::error("expand::size-over-limit", message)
                .at(span, "computed here")
                .hint("choose a smaller size, or render a smaller image"),
            ExpandError::BadResource { hint, span, .. } => Diagnostic::error("expand::bad-resource", message).at(span, "here").hint(hint),
            ExpandError::WritesImage { span, declared, .. } => Diagnostic::error("expand::writes-image", message)
                .at(span, "written here")
                .and(declared, "the file")
                .hint("copy it to a `Texture` of the same size and format, and change that one"),
            ExpandError::PartOutOfRange { span, .. } => {
                Diagnostic::error("expand::part-out-of-range", message).at(span, "this part").hint("indices start at 0")
            }
            ExpandError::PartOfBuffer { span, .. } => Diagnostic::error("expand::part-of-buffer", message).at(span, "this part"),
            ExpandError::TooManyPasses { span, .. } => Diagnostic::error("expand::too-many-passes", message)
                .at(span, "this loop")
                .hint("lower its count, or do the work of many iterations in one Compute"),
            ExpandError::TooManyAfter { span, .. } => Diagnostic::error("expand::too-many-after", message)
                .at(span, "here")
                .hint("name one pass: what the first loop writes and the second reads is in order without `after`"),
            ExpandError::AmbiguousPass { span, .. } => {
                Diagnostic::error("expand::ambiguous-pass", message).at(span, "this name").hint("name one iteration: `loop[3].pass`")
            }
            ExpandError::MustBeKept { span, .. } => {
                Diagnostic::error("expand::must-be-kept", message).at(span, "here").hint("leave `keep` out: it can't be made again")
            }
            ExpandError::SharedWithAmortised { span, other_span, .. } => Diagnostic::error("expand::shared-with-amortised", message)
                .at(span, "written here")
                .and(other_span, "and by this pass")
                .hint("what accumulates or is spread over frames is written by nobody else: give each a resource of its own"),
            ExpandError::NoValueBefore { span, declared, .. } => Diagnostic::error("expand::no-value-before", message)
                .at(span, "written here")
                .and(declared, "declared here")
                .hint("add `clear: Zero`, or what it shall hold at first"),
            ExpandError::NeverSettles { span, pass, .. } => Diagnostic::error("expand::never-settles", message)
                .at(span, "the past is read here")
                .and(pass, "by this pass, on change")
                .hint("say when one of them runs: `run: Accumulate(n)` ends after n frames, `run: EveryFrame` never"),
            ExpandError::AbsentPass { span, .. } => Diagnostic::error("expand::absent-pass", message)
                .at(span, "this name")
                .hint("give the reader the same `when` or `has`, or read the final value"),
        }
    }
}
