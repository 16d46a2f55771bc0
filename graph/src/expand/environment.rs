//! The values of names while a pipeline is expanded.

use std::collections::HashSet;

use super::ExpandInput;
use super::error::ExpandError;
use super::types::{Param, Shape, Value};
use crate::diagnostic::Diagnostic;
use crate::expression::kind_of;
use crate::published::SceneCounts;
use crate::source::Span;
use crate::validate::types::{BlockDecl, Condition, PartExpr, PlacedExpr, Validated};

/// What expressions may name, and the problems found so far.
pub(super) struct Environment<'a> {
    /// Parameters with their values.
    pub params: Vec<Param>,
    /// Loop indices, outermost first.
    pub indices: Vec<(String, u32)>,
    /// Width and height of the rendered image.
    pub output: [u32; 2],
    /// How many of each thing the scene has.
    pub counts: &'a SceneCounts,
    /// What is known of resources' extents, by id.
    pub shapes: Vec<Option<Shape>>,
    /// What expressions ask the extents of.
    measured: &'a [PartExpr],
    /// Whether blocks stand, by index.
    pub blocks: Vec<bool>,
    /// Everything wrong.
    pub problems: Vec<Diagnostic>,
    /// Codes and places of `problems`.
    pub reported: HashSet<(&'static str, Span)>,
}

impl<'a> Environment<'a> {
    /// One in which nothing has a value yet but what comes from outside.
    pub fn new(validated: &'a Validated, input: &ExpandInput<'a>) -> Environment<'a> {
        let (params, indices, shapes, blocks, problems, reported) = Default::default();
        let (output, counts, measured) = (input.output, input.counts, validated.measured.as_slice());
        Environment { params, indices, output, counts, shapes, measured, blocks, problems, reported }
    }

    /// Decides which blocks stand.
    pub fn decide(&mut self, blocks: &[BlockDecl]) {
        for (index, block) in blocks.iter().enumerate() {
            let around = index == 0 || self.blocks.get(block.parent).copied().unwrap_or(false);
            let stands = around && self.stands(&block.condition, block.path.trim_end_matches('.'));
            self.blocks.push(stands);
        }
    }

    /// Whether a condition holds. `name` is whose.
    pub fn stands(&mut self, condition: &Condition, name: &str) -> bool {
        let has = condition.has.as_ref().is_none_or(|count| self.counts.get(count).is_some_and(|count| *count > 0));
        let when = match &condition.when {
            None => true,
            Some(when) => self.truth(when, &format!("the condition of `{name}`")).unwrap_or(false),
        };
        has && when
    }

    /// Records a problem; one place is reported once, however many iterations of a loop meet it.
    pub fn report(&mut self, error: ExpandError) {
        let problem = Diagnostic::from(error);
        let place = problem.primary.as_ref().map_or(Span::NOWHERE, |label| label.span);
        if self.reported.insert((problem.code, place)) {
            self.problems.push(problem);
        }
    }

    fn lookup(&self, name: &str) -> Option<Value> {
        if let Some(variable) = name.strip_prefix('@') {
            let index = self.indices.iter().rev().find(|(known, _)| known == variable)?.1;
            return Some(Value::Int(i64::from(index)));
        }
        if let Some((measured, extent)) = name.strip_prefix('$').and_then(|name| name.split_once('.')) {
            return self.extent(self.measured.get(measured.parse::<usize>().ok()?)?, extent);
        }
        match name {
            "output.width" => return Some(Value::Int(i64::from(self.output[0]))),
            "output.height" => return Some(Value::Int(i64::from(self.output[1]))),
            _ => {}
        }
        if let Some(count) = name.strip_prefix("scene.") {
            return Some(Value::Int(i64::from(self.counts.get(count).copied().unwrap_or(0))));
        }
        self.params.iter().find(|param| param.name == name).map(|param| param.value.clone())
    }

    /// What takes a part's place while a block does not stand, or the part.
    pub fn present<'p>(&self, part: &'p PartExpr) -> &'p PartExpr {
        match part.otherwise.iter().find(|instead| self.blocks.get(instead.block) == Some(&false)) {
            Some(instead) => self.present(&instead.part),
            None => part,
        }
    }

    fn extent(&self, part: &PartExpr, extent: &str) -> Option<Value> {
        let part = self.present(part);
        let shape = self.shapes.get(part.resource.index())?.as_ref()?;
        let mip = match &part.mip {
            None => 0,
            Some(mip) => match mip.expression.evaluate(&|name| self.lookup(name)) {
                Ok(Value::Int(mip)) => u32::try_from(mip).ok().filter(|mip| u64::from(*mip) < shape.extent("mips"))?,
                _ => return None,
            },
        };
        let value = match extent {
            "layers" if part.layer.is_some() => 1,
            "mips" if part.mip.is_some() => 1,
            "layers" | "mips" => shape.extent(extent),
            _ => (shape.extent(extent) >> mip).max(1),
        };
        Some(Value::Int(value as i64))
    }

    /// The value of an expression. `what` names it in messages: "the width of `radiance`".
    pub fn value(&mut self, expr: &PlacedExpr, what: &str) -> Option<Value> {
        match expr.expression.evaluate(&|name| self.lookup(name)) {
            Ok(value) => Some(value),
            Err(reason) => self.bad(what, reason, expr.span),
        }
    }

    /// A whole number that is not negative.
    pub fn count(&mut self, expr: &PlacedExpr, what: &str) -> Option<u64> {
        match self.value(expr, what)? {
            Value::Int(value) if value >= 0 => Some(value as u64),
            Value::Int(value) => self.bad(what, format!("it is {value}, below zero"), expr.span),
            Value::Float(value) => {
                self.bad(what, format!("it is {value}, and must be whole; use ceil(..), floor(..) or round(..)"), expr.span)
            }
            other => self.bad(what, format!("it must be a whole number, not {}", kind_of(&other)), expr.span),
        }
    }

    /// Any number.
    pub fn number(&mut self, expr: &PlacedExpr, what: &str) -> Option<f64> {
        match self.value(expr, what)? {
            Value::Int(value) => Some(value as f64),
            Value::Float(value) => Some(value),
            Value::Bool(value) => Some(f64::from(u8::from(value))),
            Value::Word(index, _) => Some(f64::from(index)),
            Value::Vector(_) => self.bad(what, "it must be a number, not a vector".to_owned(), expr.span),
        }
    }

    /// A number of MiB, as bytes.
    pub fn mebibytes(&mut self, expr: &PlacedExpr) -> Option<u64> {
        let what = "`retained_budget`";
        match self.number(expr, what)? {
            mebibytes if mebibytes >= 0.0 => Some((mebibytes * f64::from(1u32 << 20)) as u64),
            mebibytes => self.bad(what, format!("it is {mebibytes}, below zero"), expr.span),
        }
    }

    /// A truth value.
    pub fn truth(&mut self, expr: &PlacedExpr, what: &str) -> Option<bool> {
        match self.value(expr, what)? {
            Value::Bool(value) => Some(value),
            other => self.bad(what, format!("it must be true or false, not {}", kind_of(&other)), expr.span),
        }
    }

    /// Reports a bad value; always `None`.
    pub fn bad<T>(&mut self, what: &str, reason: String, span: Span) -> Option<T> {
        self.report(ExpandError::BadValue { what: what.to_owned(), reason, span });
        None
    }
}
