//! The names that are visible at a place, and the texts that use them: expressions and references.

use std::collections::HashMap;

use indexmap::IndexMap;

use super::error::ValidateError;
use super::types::{PartExpr, PlacedExpr};
use crate::diagnostic::Diagnostic;
use crate::expand::types::{Located, ResourceId, Value};
use crate::expression::{self, Expression};
use crate::published::Collection;
use crate::source::Span;
use crate::syntax::document::{Expr, ExprDoc, ResourceDoc, Text};

/// What names mean, and the problems found so far.
pub(super) struct Scope<'a> {
    /// Resource ids by name.
    pub resources: HashMap<&'a str, ResourceId>,
    /// Parameter names in the order of the file.
    pub params: Vec<&'a str>,
    /// Words of parameters' options, for comparisons.
    pub words: Vec<&'a str>,
    /// Names of scene counts.
    pub counts: &'a [String],
    /// Paths of all passes and loops: `faces`, `faces.draw`.
    pub passes: Vec<String>,
    /// Loop variables, outermost first.
    pub variables: Vec<String>,
    /// Declarations by [`ResourceId`].
    pub declared: Vec<&'a ResourceDoc>,
    /// Resources whose past is read.
    pub histories: Vec<Located<ResourceId>>,
    /// What loops may run over.
    pub collections: &'a IndexMap<String, Collection>,
    /// The index of the batched loop around.
    pub batched: Option<String>,
    /// Whether a loop around spreads its iterations over frames.
    pub spread: bool,
    /// Everything wrong.
    pub problems: Vec<Diagnostic>,
}

/// Begins a reference to what a resource held at the end of the frame before.
const PREVIOUS: &str = "previous(";

/// Names start with a letter and hold letters, digits and underscores.
pub(super) fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Where a byte range of a string literal's value stands in the file. Exact unless the literal has escapes.
fn inside(span: Span, range: &std::ops::Range<usize>, length: usize) -> Span {
    let quoted = length + 2 == (span.end - span.start) as usize;
    if !quoted || !span.is_somewhere() {
        return span;
    }
    let start = span.start as usize + 1 + range.start;
    // An empty range (the end of the text) still shows one character.
    let end = span.start as usize + 1 + range.end.max(range.start + 1);
    Span::new(span.file, start, end)
}

impl Scope<'_> {
    /// Whether a parameter has this name.
    pub fn is_param(&self, name: &str) -> bool {
        self.params.contains(&name)
    }

    /// Records a problem.
    pub fn report(&mut self, error: ValidateError) {
        self.problems.push(error.into());
    }

    /// Whether a text is a fit name; reports it if not.
    pub fn check_name(&mut self, name: &Text) -> bool {
        let fit = is_name(&name.value);
        if !fit {
            self.report(ValidateError::BadName {
                name: name.value.clone(),
                rule: "names hold letters, digits and `_`, and do not start with a digit",
                span: name.span,
            });
        }
        fit
    }

    /// Parses an expression and checks its names.
    pub fn expression(&mut self, expr: &Expr) -> Option<PlacedExpr> {
        let expression = match &expr.value {
            ExprDoc::Int(value) => Expression::Literal(Value::Int(*value)),
            ExprDoc::Float(value) => Expression::Literal(Value::Float(*value)),
            ExprDoc::Text(text) => self.parse(text, expr.span, 0, text.len())?,
        };
        if let Some(variable) = &self.batched {
            let mut names = Vec::new();
            expression.names(&mut names);
            if names.iter().any(|(name, _)| name == variable) {
                self.report(ValidateError::BatchedIndex { variable: variable.clone(), span: expr.span });
                return None;
            }
        }
        Some(PlacedExpr { expression, span: expr.span })
    }

    /// Parses a part of a string literal as an expression.
    fn parse(&mut self, text: &str, span: Span, offset: usize, length: usize) -> Option<Expression> {
        let place = |range: &std::ops::Range<usize>| inside(span, &(range.start + offset..range.end + offset), length);
        let expression = match expression::parse(text) {
            Ok(expression) => expression,
            Err(error) => {
                let span = place(&error.range);
                self.report(ValidateError::BadExpression { text: text.to_owned(), reason: error.message, span });
                return None;
            }
        };
        let mut names = Vec::new();
        expression.names(&mut names);
        let mut known = true;
        for (name, range) in names {
            known &= self.check_expression_name(&name, place(&range));
        }
        let mut words = Vec::new();
        expression.words(&mut words);
        for word in words {
            if !self.words.contains(&word.as_str()) {
                let options = self.words.iter().map(|word| (*word).to_owned()).collect();
                self.report(ValidateError::Unknown { what: "option of a parameter", name: word, known: options, span });
                known = false;
            }
        }
        known.then_some(expression)
    }

    fn check_expression_name(&mut self, name: &str, span: Span) -> bool {
        let is_param = self.params.contains(&name);
        let is_variable = self.variables.iter().any(|variable| variable == name);
        if is_param && is_variable {
            self.report(ValidateError::Ambiguous { name: name.to_owned(), first: "a parameter", second: "a loop variable", span });
            return false;
        }
        if is_param || is_variable || name == "output.width" || name == "output.height" {
            return true;
        }
        if let Some(count) = name.strip_prefix("scene.") {
            if self.counts.iter().any(|known| known == count) {
                return true;
            }
            self.report(ValidateError::Unknown { what: "scene count", name: count.to_owned(), known: self.counts.to_vec(), span });
            return false;
        }
        let known = self.params.iter().map(|param| (*param).to_owned()).chain(self.variables.iter().cloned());
        let known = known.chain(["output.width".to_owned(), "output.height".to_owned()]).collect();
        self.report(ValidateError::Unknown { what: "parameter or loop variable", name: name.to_owned(), known, span });
        false
    }

    /// Parses a reference such as `radiance.mip(m - 1)` and resolves its resource.
    pub fn part(&mut self, text: &Text) -> Option<PartExpr> {
        let value = text.value.as_str();
        if value.trim_start().starts_with(PREVIOUS) {
            self.report(ValidateError::BadPrevious {
                text: value.to_owned(),
                reason: "the past can only stand under `read`",
                hint: "a Copy can keep it: `Copy(read: \"previous(x)\", write: ..)`",
                span: text.span,
            });
            return None;
        }
        self.reference(text)
    }

    /// Parses a reference under `read`, where the past may stand: `previous(radiance).mip(0)`.
    pub fn readable(&mut self, text: &Text) -> Option<PartExpr> {
        let value = text.value.as_str();
        let Some(rest) = value.trim_start().strip_prefix(PREVIOUS) else { return self.reference(text) };
        let bad = |reason, hint| ValidateError::BadPrevious { text: value.to_owned(), reason, hint, span: text.span };
        if rest.trim_start().starts_with(PREVIOUS) {
            self.report(bad("the past of the past is not kept", "copy the past to a resource of its own, and read the past of that one"));
            return None;
        }
        if value.contains('@') {
            self.report(bad("the past is the value at the end of the frame before", "leave `@` and the pass out"));
            return None;
        }
        let Some((inner, selectors)) = rest.split_once(')') else {
            self.report(bad("it has no closing `)`", "write `previous(name)`, and parts behind it: `previous(name).mip(0)`"));
            return None;
        };
        let start = value.len() - rest.len();
        if inner.contains('(') {
            self.report(bad("a part stands inside of the brackets", "write parts behind them: `previous(name).mip(0)`"));
            return None;
        }
        let source = self.name(inner.trim(), text, start..start + inner.len())?;
        let known = self.histories.iter().position(|history| history.value == source);
        let index = known.unwrap_or_else(|| {
            self.histories.push(Located { value: source, span: text.span });
            self.histories.len() - 1
        });
        let id = ResourceId((self.declared.len() + index) as u32);
        self.selectors(text, id, value.len() - selectors.len(), value)
    }

    /// The resource of a name that stands in a range of a reference.
    fn name(&mut self, name: &str, text: &Text, range: std::ops::Range<usize>) -> Option<ResourceId> {
        if !is_name(name) {
            let reason = format!("`{name}` is not a name");
            self.report(ValidateError::BadReference { text: text.value.clone(), reason, span: text.span });
            return None;
        }
        let found = self.resources.get(name).copied();
        if found.is_none() {
            let known = self.sorted_resources();
            let span = inside(text.span, &range, text.value.len());
            self.report(ValidateError::Unknown { what: "resource", name: name.to_owned(), known, span });
        }
        found
    }

    fn reference(&mut self, text: &Text) -> Option<PartExpr> {
        let value = text.value.as_str();
        let (reference, version) = match value.split_once('@') {
            Some((reference, version)) => (reference, Some(version.trim())),
            None => (value, None),
        };
        let name_end = reference.find('.').unwrap_or(reference.len());
        let resource = self.name(reference[..name_end].trim(), text, 0..name_end)?;
        let mut part = self.selectors(text, resource, name_end, reference)?;
        if let Some(version) = version {
            let place = inside(text.span, &(reference.len() + 1..value.len()), value.len());
            part.version = Some(self.pass_path(version, place)?);
        }
        Some(part)
    }

    /// `.mip(m).face(f)`, from a byte of a reference to its end.
    fn selectors(&mut self, text: &Text, resource: ResourceId, start: usize, reference: &str) -> Option<PartExpr> {
        let value = text.value.as_str();
        let bad = |reason: String| ValidateError::BadReference { text: value.to_owned(), reason, span: text.span };
        let mut part = PartExpr { resource, mip: None, layer: None, version: None, span: text.span };
        let mut at = start;
        while at < reference.len() {
            let rest = &reference[at..];
            let Some((selector, index)) = rest.strip_prefix('.').and_then(|rest| rest.split_once('(')) else {
                self.report(bad(format!("expected `.mip(i)`, `.layer(i)` or `.face(i)`, found `{rest}`")));
                return None;
            };
            let Some(length) = closing(index) else {
                self.report(bad(format!("`.{selector}(` has no closing `)`")));
                return None;
            };
            let start = at + 1 + selector.len() + 1;
            let expression = self.parse(&index[..length], text.span, start, value.len())?;
            let target = match selector {
                "mip" => &mut part.mip,
                "layer" | "face" => &mut part.layer,
                other => {
                    self.report(bad(format!("there is no `.{other}(i)`")));
                    return None;
                }
            };
            if target.is_some() {
                self.report(bad(format!("`.{selector}(i)` stands twice")));
                return None;
            }
            *target = Some(PlacedExpr { expression, span: text.span });
            at = start + length + 1;
        }
        Some(part)
    }

    /// Checks that a path names a pass: `shade`, `faces.draw`, `faces[3].draw`.
    pub fn pass_path(&mut self, path: &str, span: Span) -> Option<Located<String>> {
        let plain = without_indices(path);
        let exists =
            self.passes.iter().any(|known| *known == plain || known.strip_suffix(&plain).is_some_and(|outer| outer.ends_with('.')));
        if exists {
            return Some(Located { value: path.to_owned(), span });
        }
        let known = self.passes.clone();
        self.report(ValidateError::Unknown { what: "pass", name: path.to_owned(), known, span });
        None
    }

    /// Resource names in the order of the file.
    fn sorted_resources(&self) -> Vec<String> {
        let mut names: Vec<_> = self.resources.iter().map(|(name, id)| (*id, (*name).to_owned())).collect();
        names.sort();
        names.into_iter().map(|(_, name)| name).collect()
    }
}

/// `faces[3].draw` without `[3]`.
pub(crate) fn without_indices(path: &str) -> String {
    let mut depth = 0;
    path.chars()
        .filter(|c| {
            depth += i32::from(*c == '[');
            let keep = depth == 0;
            depth -= i32::from(*c == ']');
            keep
        })
        .collect()
}

/// The length of the text before the parenthesis that closes an open one.
fn closing(text: &str) -> Option<usize> {
    let mut depth = 0usize;
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' if depth == 0 => return Some(at),
            ')' => depth -= 1,
            _ => {}
        }
    }
    None
}
