//! What can be wrong with a value of a known type: serde's errors, with the place where they happened.
//!
//! An error starts without a place, since serde knows none; each layer of the reader that it passes offers its own, and the
//! innermost wins. It also collects the innermost field or entry around it, which a retry leaves out.

use std::fmt;

use serde::de::{Error, Expected, Unexpected};

use crate::diagnostic::{Diagnostic, list_names, nearest};
use crate::source::Span;

use super::recover::Unit;
use super::tree::Node;

/// What is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)]
pub(super) enum Fault {
    #[error("expected {expected}, found {found}")]
    WrongType { expected: String, found: String },
    #[error("{value} is out of range: {expected} goes from {least} to {most}")]
    OutOfRange { value: String, expected: &'static str, least: String, most: String },
    #[error("expected {expected}, found {found}")]
    WrongLength { expected: String, found: String },
    #[error("expected {expected}, found {found}")]
    InvalidValue { expected: String, found: String },
    #[error("expected a `{expected}`, found a `{found}`")]
    WrongName { expected: &'static str, found: String },
    #[error("{} has no field `{field}`", in_code(owner, "this struct"))]
    UnknownField { field: String, accepted: &'static [&'static str], owner: String },
    #[error("{} has no variant `{variant}`", in_code(owner, "this enum"))]
    UnknownVariant { variant: String, accepted: &'static [&'static str], owner: String },
    #[error("missing field `{field}` in {}", in_code(owner, "a struct"))]
    MissingField { field: String, owner: String },
    #[error("duplicate field `{field}`")]
    DuplicateField { field: &'static str },
    #[error("{0}")]
    Other(String),
    #[error("the type wraps itself without end")]
    EndlessType,
}

fn in_code(name: &str, otherwise: &str) -> String {
    if name.is_empty() { otherwise.to_owned() } else { format!("`{name}`") }
}

/// A number of values in words.
pub(super) fn values(count: usize) -> String {
    match count {
        0 => "no value".to_owned(),
        1 => "one value".to_owned(),
        _ => format!("{count} values"),
    }
}

/// A fault on its way out of the layers of the reader.
#[derive(Debug)]
pub(super) struct ReadError(Box<Travelling>);

#[derive(Debug)]
struct Travelling {
    fault: Fault,
    place: Option<Span>,
    hint: Option<String>,
    /// The innermost field or entry around the fault, as a [`Unit`].
    unit: Option<Unit>,
    /// It follows from what was reported before.
    silent: bool,
}

impl ReadError {
    pub(super) fn new(fault: Fault) -> ReadError {
        ReadError(Box::new(Travelling { fault, place: None, hint: None, unit: None, silent: false }))
    }

    /// The node is of another kind than the type wants.
    pub(super) fn wrong_type(node: &Node, expected: &dyn Expected, hint: Option<String>) -> ReadError {
        let mut error = ReadError::new(Fault::WrongType { expected: friendly(&expected.to_string()), found: node.describe() });
        error.0.place = Some(node.head());
        error.0.hint = hint;
        error
    }

    pub(super) fn fault(&self) -> &Fault {
        &self.0.fault
    }

    pub(super) fn fault_mut(&mut self) -> &mut Fault {
        &mut self.0.fault
    }

    pub(super) fn has_place(&self) -> bool {
        self.0.place.is_some()
    }

    /// Sets the place, unless an inner layer has.
    pub(super) fn at(mut self, span: Span) -> ReadError {
        self.0.place.get_or_insert(span);
        self
    }

    /// Sets the place to a node, and says what it holds, unless an inner layer has.
    pub(super) fn at_node(mut self, node: &Node) -> ReadError {
        if self.0.place.is_none() {
            if let Fault::WrongType { found, .. } = &mut self.0.fault {
                *found = node.describe();
            }
            self.0.place = Some(node.head());
        }
        self
    }

    /// Sets the field or entry that a retry leaves out, unless an inner layer has.
    pub(super) fn within(mut self, unit: Unit) -> ReadError {
        self.0.unit.get_or_insert(unit);
        self
    }

    pub(super) fn unit(&self) -> Option<Unit> {
        self.0.unit
    }

    pub(super) fn silence(&mut self) {
        self.0.silent = true;
    }

    pub(super) fn is_silent(&self) -> bool {
        self.0.silent
    }

    pub(super) fn into_diagnostic(self) -> Diagnostic {
        let Travelling { fault, place, hint, .. } = *self.0;
        let (code, label) = match &fault {
            Fault::WrongType { expected, .. } => ("syntax::wrong-type", format!("expected {expected}")),
            Fault::OutOfRange { .. } => ("syntax::number-out-of-range", "out of range".to_owned()),
            Fault::WrongLength { expected, .. } => ("syntax::wrong-length", format!("expected {expected}")),
            Fault::InvalidValue { .. } => ("syntax::invalid-value", "not allowed here".to_owned()),
            Fault::WrongName { expected, .. } => ("syntax::wrong-name", format!("expected `{expected}`, or no name")),
            Fault::UnknownField { .. } => ("syntax::unknown-field", "unknown field".to_owned()),
            Fault::UnknownVariant { .. } => ("syntax::unknown-variant", "unknown variant".to_owned()),
            Fault::MissingField { field, .. } => ("syntax::missing-field", format!("lacks `{field}`")),
            Fault::DuplicateField { .. } => ("syntax::duplicate-field", "again here".to_owned()),
            Fault::Other(_) => ("syntax::invalid-value", "in this value".to_owned()),
            Fault::EndlessType => ("syntax::invalid-value", "in this value".to_owned()),
        };
        let problem = Diagnostic::error(code, fault.to_string()).at(place.unwrap_or(Span::NOWHERE), label).maybe_hint(hint);
        match &fault {
            Fault::UnknownField { field: wrong, accepted, .. } | Fault::UnknownVariant { variant: wrong, accepted, .. } => {
                let named = nearest(wrong, accepted.iter().copied()).map(|name| format!("did you mean `{name}`?"));
                problem.maybe_hint(named).note(format!("accepted: {}", list_names(accepted.iter().copied())))
            }
            _ => problem,
        }
    }
}

/// serde's names for what it expects, in the words of RON.
pub(super) fn friendly(expected: &str) -> String {
    match expected {
        "i8" | "i16" | "i32" | "i64" | "u8" | "u16" | "u32" | "u64" | "usize" | "isize" => format!("an integer ({expected})"),
        "f32" | "f64" => "a number".to_owned(),
        "unit" => "`()`".to_owned(),
        "a sequence" => "a list `[..]`".to_owned(),
        "a map" => "a map `{..}`".to_owned(),
        "a boolean" => "`true` or `false`".to_owned(),
        _ => of_shape(expected).unwrap_or_else(|| expected.to_owned()),
    }
}

/// What serde's derived visitors and tuples expect.
fn of_shape(expected: &str) -> Option<String> {
    let of_length = |text: &str| {
        let (name, count) = text.split_once(" with ")?;
        let count = values(count.split_once(' ')?.0.parse().ok()?);
        Some(format!("{count} in `{}(..)`", name.rsplit("::").next()?))
    };
    if let Some(count) = expected.strip_prefix("a tuple of size ").or_else(|| expected.strip_prefix("an array of length ")) {
        return Some(format!("{} in `(..)`", values(count.parse().ok()?)));
    }
    if let Some(rest) = expected.strip_prefix("tuple variant ").or_else(|| expected.strip_prefix("tuple struct ")) {
        return of_length(rest).or_else(|| Some(format!("the values of `{}(..)`", rest.rsplit("::").next()?)));
    }
    if let Some(name) = expected.strip_prefix("struct variant ") {
        return Some(format!("the fields of `{}(..)`", name.rsplit("::").next()?));
    }
    if let Some(rest) = expected.strip_prefix("struct ") {
        return of_length(rest).or_else(|| Some(format!("a struct `{rest}(..)`")));
    }
    expected.strip_prefix("enum ").map(|name| format!("a variant of `{name}`"))
}

impl fmt::Display for ReadError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fault.fmt(formatter)
    }
}

impl std::error::Error for ReadError {}

impl Error for ReadError {
    fn custom<T: fmt::Display>(message: T) -> ReadError {
        let message = message.to_string();
        // serde gives these no error of their own.
        let fault = match message.strip_prefix("data did not match any variant of untagged enum ") {
            Some(name) => Fault::Other(format!("this value has none of the forms of `{name}`")),
            None => Fault::Other(message),
        };
        ReadError::new(fault)
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> ReadError {
        ReadError::new(Fault::WrongType { expected: friendly(&expected.to_string()), found: found.to_string() })
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> ReadError {
        ReadError::new(Fault::InvalidValue { expected: friendly(&expected.to_string()), found: found.to_string() })
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> ReadError {
        ReadError::new(Fault::WrongLength { expected: friendly(&expected.to_string()), found: values(length) })
    }

    fn unknown_variant(variant: &str, accepted: &'static [&'static str]) -> ReadError {
        ReadError::new(Fault::UnknownVariant { variant: variant.to_owned(), accepted, owner: String::new() })
    }

    fn unknown_field(field: &str, accepted: &'static [&'static str]) -> ReadError {
        ReadError::new(Fault::UnknownField { field: field.to_owned(), accepted, owner: String::new() })
    }

    fn missing_field(field: &'static str) -> ReadError {
        ReadError::new(Fault::MissingField { field: field.to_owned(), owner: String::new() })
    }

    fn duplicate_field(field: &'static str) -> ReadError {
        ReadError::new(Fault::DuplicateField { field })
    }
}
