//! The names that are visible at a place, and the expressions that use them.
//!
//! A file sees its own names alone. What they stand for is known to all: in a checked expression a parameter has its whole path
//! (`shadows.texels`), the index of a loop is marked (`@face`), and the extent of what a reference names has the
//! number of that reference (`$3.width`).

use std::collections::HashSet;

use indexmap::IndexMap;

use super::error::ValidateError;
use super::instances::{Declared, Instance};
use super::types::{PartExpr, PlacedExpr};
use crate::diagnostic::Diagnostic;
use crate::expand::types::{Located, ResourceId, Value};
use crate::expression::{self, Expression};
use crate::published::Collection;
use crate::source::Span;
use crate::syntax::document::{Document, Expr, ExprDoc, Text};

/// What names mean, and the problems found so far.
pub(super) struct Scope<'a> {
    /// Every document at every place.
    pub instances: &'a [Instance<'a>],
    /// The one whose names are visible.
    pub current: usize,
    /// What is known of resources, by id.
    pub declared: &'a [Declared],
    /// Words of parameters' options, for comparisons.
    pub words: Vec<&'a str>,
    /// Names of scene counts.
    pub counts: &'a [String],
    /// What loops may run over.
    pub collections: &'a IndexMap<String, Collection>,
    /// Resources whose past is read.
    pub histories: Vec<Located<ResourceId>>,
    /// What expressions ask the extents of.
    pub measured: Vec<PartExpr>,
    /// The loops around.
    pub loops: Loops,
    /// References that are being followed, by instance and text.
    pub following: Vec<(usize, String)>,
    /// Everything wrong.
    pub problems: Vec<Diagnostic>,
    /// Codes, places and messages of `problems`, where a file may be met several times.
    pub reported: HashSet<(&'static str, Option<Span>, String)>,
}

/// The loops around a place.
#[derive(Debug, Default)]
pub(super) struct Loops {
    /// Their variables, outermost first.
    pub variables: Vec<String>,
    /// The index of the batched one.
    pub batched: Option<String>,
    /// Whether one spreads its iterations over frames.
    pub spread: bool,
}

/// What can be said of a resource's extent in an expression.
const EXTENTS: [&str; 5] = ["width", "height", "depth", "layers", "mips"];

/// Names start with a letter and hold letters, digits and underscores.
pub(super) fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Where a byte range of a string literal's value stands in the file. Exact unless the literal has escapes.
pub(super) fn inside(span: Span, range: &std::ops::Range<usize>, length: usize) -> Span {
    let quoted = length + 2 == (span.end - span.start) as usize;
    if !quoted || !span.is_somewhere() {
        return span;
    }
    let start = span.start as usize + 1 + range.start;
    // An empty range (the end of the text) still shows one character.
    let end = span.start as usize + 1 + range.end.max(range.start + 1);
    Span::new(span.file, start, end)
}

impl<'a> Scope<'a> {
    /// The instance whose names are visible.
    pub fn instance(&self) -> &'a Instance<'a> {
        &self.instances[self.current]
    }

    /// Its document.
    pub fn document(&self) -> &'a Document {
        self.instance().document()
    }

    /// Does something with the names of another instance.
    pub fn within<T>(&mut self, instance: usize, work: impl FnOnce(&mut Self) -> T) -> T {
        let current = std::mem::replace(&mut self.current, instance);
        let loops = std::mem::take(&mut self.loops);
        let result = work(self);
        self.current = current;
        self.loops = loops;
        result
    }

    /// Whether a parameter has this name.
    pub fn is_param(&self, name: &str) -> bool {
        self.document().params.contains_key(name)
    }

    /// Records a problem. One of a block is recorded once, however often the block stands.
    pub fn report(&mut self, error: ValidateError) {
        let mut problem = Diagnostic::from(error);
        let place = problem.primary.as_ref().map(|label| label.span);
        if self.instances.len() > 1 && !self.reported.insert((problem.code, place, problem.message.clone())) {
            return;
        }
        let instance = self.instance();
        let path = instance.path.trim_end_matches('.');
        let at_its_user = place
            .map(|place| place.file)
            .is_some_and(|file| file != instance.loaded.file && file == self.instances[instance.parent].loaded.file);
        if !path.is_empty() && !at_its_user {
            problem = problem.note(format!("in the block `{path}`"));
        }
        self.problems.push(problem);
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
        if let Some(variable) = &self.loops.batched {
            let mut names = Vec::new();
            expression.names(&mut names);
            if names.iter().any(|(name, _)| name.strip_prefix('@') == Some(variable)) {
                self.report(ValidateError::BatchedIndex { variable: variable.clone(), span: expr.span });
                return None;
            }
        }
        Some(PlacedExpr { expression, span: expr.span })
    }

    /// Parses a part of a string literal as an expression.
    pub fn parse(&mut self, text: &str, span: Span, offset: usize, length: usize) -> Option<Expression> {
        let place = |range: &std::ops::Range<usize>| inside(span, &(range.start + offset..range.end + offset), length);
        let mut expression = match expression::parse(text) {
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
        let mut meanings = Vec::with_capacity(names.len());
        for (name, range) in names {
            let meaning = self.expression_name(&name, place(&range));
            known &= meaning.is_some();
            meanings.push(meaning.unwrap_or(name));
        }
        expression.rename(&mut meanings.into_iter());
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

    /// What a name of an expression stands for.
    fn expression_name(&mut self, name: &str, span: Span) -> Option<String> {
        let is_variable = self.loops.variables.iter().any(|variable| variable == name);
        match (self.is_param(name), is_variable) {
            (true, true) => {
                self.report(ValidateError::Ambiguous { name: name.to_owned(), first: "a parameter", second: "a loop variable", span });
                return None;
            }
            (true, false) => return Some(format!("{}{name}", self.instance().path)),
            (false, true) => return Some(format!("@{name}")),
            (false, false) => {}
        }
        if name == "output.width" || name == "output.height" {
            return Some(name.to_owned());
        }
        if let Some(count) = name.strip_prefix("scene.") {
            if self.counts.iter().any(|known| known == count) {
                return Some(name.to_owned());
            }
            self.report(ValidateError::Unknown { what: "scene count", name: count.to_owned(), known: self.counts.to_vec(), span });
            return None;
        }
        if let Some((resource, extent)) = name.rsplit_once('.')
            && EXTENTS.contains(&extent)
        {
            let part = self.resolve(resource, span)?;
            let measured = self.present(part);
            let known = self.measured.iter().position(|part| *part == measured);
            let index = known.unwrap_or_else(|| {
                self.measured.push(measured);
                self.measured.len() - 1
            });
            return Some(format!("${index}.{extent}"));
        }
        let known = self.document().params.keys().map(|param| param.value.clone()).chain(self.loops.variables.iter().cloned());
        let known = known.chain(["output.width".to_owned(), "output.height".to_owned()]).collect();
        self.report(ValidateError::Unknown { what: "parameter or loop variable", name: name.to_owned(), known, span });
        None
    }
}
