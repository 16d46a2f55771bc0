//! What can be wrong between a pass and its shader.

use std::sync::Arc;

use crate::diagnostic::{Diagnostic, did_you_mean, list_names};
use crate::source::Span;

/// A problem found by binding.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub enum BindError {
    #[error("pass `{pass}`: `{file}` has no {stage} entry point{}", name.as_ref().map(|name| format!(" `{name}`")).unwrap_or_default())]
    NoEntry { pass: Arc<str>, file: String, stage: &'static str, name: Option<String>, known: Vec<String>, span: Span },
    #[error("pass `{pass}`: `{file}` has {} {stage} entry points, and the pass says not which", known.len())]
    ManyEntries { pass: Arc<str>, file: String, stage: &'static str, field: &'static str, known: Vec<String>, span: Span },
    #[error("pass `{pass}`: nothing feeds the shader's variable `{variable}`")]
    Unfed { pass: Arc<str>, variable: String, known: Vec<String>, span: Span, pass_span: Span },
    #[error("pass `{pass}`: no variable or output of the shader takes the slot `{slot}`")]
    NoTaker { pass: Arc<str>, slot: String, declared: bool, known: Vec<String>, span: Span },
    #[error("pass `{pass}`: `{variable}` {reason}")]
    Mismatch {
        kind: Mismatch,
        pass: Arc<str>,
        variable: String,
        reason: String,
        hint: Option<String>,
        slot_span: Span,
        variable_span: Span,
    },
    #[error("pass `{pass}`: `{variable}` {reason}")]
    Table { kind: Mismatch, pass: Arc<str>, variable: String, reason: String, hint: Option<String>, variable_span: Span, pass_span: Span },
    #[error("pass `{pass}`: {reason}")]
    Param { pass: Arc<str>, reason: String, hint: Option<String>, span: Span, pass_span: Span },
    #[error("pass `{pass}`: {reason}")]
    Constant { pass: Arc<str>, reason: String, hint: Option<String>, span: Span },
    #[error("pass `{pass}`: {reason}")]
    Target { pass: Arc<str>, reason: String, hint: Option<String>, span: Span },
    #[error("pass `{pass}`: {reason}")]
    Work { pass: Arc<str>, reason: String, hint: Option<String>, span: Span },
    #[error("resource `{resource}`: no format of its list can do what passes do with it")]
    NoFormat { resource: String, reasons: Vec<String>, span: Span, first: Option<(Span, String)> },
    #[error("pass `{pass}`: {reason}")]
    OverLimit { pass: Arc<str>, reason: String, span: Span },
    #[error("pass `{pass}` needs the feature `{feature}` {why}, which is not there ({device})")]
    MissingFeature { pass: Arc<str>, feature: &'static str, why: String, device: String, span: Span },
}

/// Which property of a resource and a shader variable differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Mismatch {
    Access,
    Kind,
    Format,
    Dimension,
    Filtering,
    Samples,
    Part,
    Layout,
}

impl Mismatch {
    fn code(self) -> &'static str {
        match self {
            Mismatch::Access => "bind::access",
            Mismatch::Kind => "bind::kind",
            Mismatch::Format => "bind::format",
            Mismatch::Dimension => "bind::dimension",
            Mismatch::Filtering => "bind::filtering",
            Mismatch::Samples => "bind::samples",
            Mismatch::Part => "bind::part",
            Mismatch::Layout => "bind::layout",
        }
    }
}

impl From<BindError> for Diagnostic {
    fn from(error: BindError) -> Diagnostic {
        let message = error.to_string();
        match error {
            BindError::NoEntry { name, known, span, stage, .. } => {
                let hint = name.as_ref().and_then(|name| did_you_mean(name, known.iter().map(String::as_str)));
                Diagnostic::error("bind::no-entry-point", message)
                    .at(span, format!("needs a `@{stage}` function"))
                    .note(format!("its {stage} entry points: {}", list_names(known.iter().map(String::as_str))))
                    .maybe_hint(hint)
            }
            BindError::ManyEntries { known, span, field, .. } => Diagnostic::error("bind::many-entry-points", message)
                .at(span, "this file")
                .hint(format!("name one: {}", known.iter().map(|name| format!("{field}: \"{name}\"")).collect::<Vec<_>>().join(" or "))),
            BindError::Unfed { variable, known, span, pass_span, .. } => {
                let hint = did_you_mean(&variable, known.iter().map(String::as_str))
                    .unwrap_or_else(|| format!("name a resource for it in the pass: read: {{\"{variable}\": \"..\"}}"));
                Diagnostic::error("bind::unfed-variable", message)
                    .at(span, "declared here")
                    .and(pass_span, "the pass that uses the shader")
                    .hint(hint)
            }
            BindError::NoTaker { slot, declared, known, span, .. } => {
                let hint = if declared {
                    format!("the file declares `{slot}`, and the entry point does not use it: use it, or leave out the slot")
                } else {
                    did_you_mean(&slot, known.iter().map(String::as_str))
                        .unwrap_or_else(|| format!("the shader has {}", list_names(known.iter().map(String::as_str))))
                };
                Diagnostic::error("bind::slot-without-variable", message).at(span, "this slot").hint(hint)
            }
            BindError::Mismatch { kind, hint, slot_span, variable_span, .. } => {
                Diagnostic::error(kind.code(), message).at(slot_span, "given here").and(variable_span, "declared here").maybe_hint(hint)
            }
            BindError::Table { kind, hint, variable_span, pass_span, .. } => Diagnostic::error(kind.code(), message)
                .at(variable_span, "declared here")
                .and(pass_span, "the pass that uses the shader")
                .maybe_hint(hint),
            BindError::Param { hint, span, pass_span, .. } => Diagnostic::error("bind::params-member", message)
                .at(span, "this member")
                .and(pass_span, "the pass that uses the shader")
                .maybe_hint(hint),
            BindError::Constant { hint, span, .. } => Diagnostic::error("bind::constant", message).at(span, "here").maybe_hint(hint),
            BindError::Target { hint, span, .. } => Diagnostic::error("bind::target", message).at(span, "here").maybe_hint(hint),
            BindError::Work { hint, span, .. } => Diagnostic::error("bind::work-size", message).at(span, "here").maybe_hint(hint),
            BindError::NoFormat { reasons, span, first, .. } => {
                let mut diagnostic = Diagnostic::error("bind::no-format", message).at(span, "declared here");
                if let Some((span, text)) = first {
                    diagnostic = diagnostic.and(span, text);
                }
                for reason in reasons {
                    diagnostic = diagnostic.note(reason);
                }
                diagnostic.hint("choose a format that can, or a list of formats: the first that can is taken")
            }
            BindError::OverLimit { span, .. } => Diagnostic::error("bind::over-limit", message).at(span, "this pass"),
            BindError::MissingFeature { span, .. } => Diagnostic::error("bind::missing-feature", message)
                .at(span, "here")
                .hint("choose another adapter, or a format or method that does without it"),
        }
    }
}
