//! Blocks: what they are given, when they stand, and what they bring.

use super::error::ValidateError;
use super::instances::Declared;
use super::params;
use super::passes::{after, condition, items as passes};
use super::scope::Scope;
use super::types::{BlockDecl, Condition, Item, ParamDecl, PlacedExpr};
use crate::expand::types::Value;
use crate::expression::Expression;
use crate::syntax::document::{DimensionDoc, Entries, InputDoc, Text, ValueDoc};
use crate::syntax::spanned::Spanned;

/// Checks how an instance is used; `None` if something is wrong.
pub(super) fn usage(scope: &mut Scope<'_>, index: usize) -> Option<BlockDecl> {
    let instance = &scope.instances[index];
    let path = instance.path.clone();
    let parent = instance.parent;
    let Some((name, block)) = instance.block else {
        return Some(BlockDecl { path, parent, condition: Condition { when: None, has: None }, after: Vec::new() });
    };
    let inner = instance.document();
    scope.within(parent, |scope| {
        let condition = condition(scope, block.when.as_ref(), block.has.as_ref());
        names(scope, "parameter of the block", &block.params, &inner.params);
        names(scope, "input of the block", &block.inputs, &inner.inputs);
        names(scope, "output of the block", &block.otherwise, &inner.outputs);
        for (input, doc) in &inner.inputs {
            match block.inputs.get(input) {
                Some(given) => self::input(scope, name, (input, doc), given),
                None => bad(scope, name, format!("its input `{}` is not given", input.value), Some("name a resource under `inputs`"), name),
            }
        }
        for otherwise in block.otherwise.values() {
            scope.readable(otherwise);
        }
        if let (Some((first, _)), None, None) = (block.otherwise.first(), &block.when, &block.has) {
            let hint = Some("give the block `when` or `has`, or leave `otherwise` out");
            bad(scope, name, "it always stands, so that nothing takes the place of its outputs".to_owned(), hint, first);
        }
        if let Some(budget) = &inner.retained_budget {
            let reason = "a block has no memory budget of its own".to_owned();
            let place = Spanned::new(String::new(), budget.span);
            bad(scope, name, reason, Some("`retained_budget` belongs to the pipeline"), &place);
        }
        Some(BlockDecl { path, parent, condition: condition?, after: after(scope, &block.after) })
    })
}

/// Every name that is given must be one that the block has.
fn names<T, U>(scope: &mut Scope<'_>, what: &'static str, given: &Entries<T>, known: &Entries<U>) {
    for name in given.keys().filter(|name| !known.contains_key(*name)) {
        let known = known.keys().map(|known| known.value.clone()).collect();
        scope.report(ValidateError::Unknown { what, name: name.value.clone(), known, span: name.span });
    }
}

/// Checks that what is given is what the block takes.
fn input(scope: &mut Scope<'_>, block: &Text, (name, doc): (&Text, &InputDoc), given: &Text) {
    let Some(part) = scope.readable(given) else { return };
    let mismatch = match (doc, scope.declaration(part.resource)) {
        (_, None) | (InputDoc::Buffer { .. }, Some(Declared::Buffer)) => None,
        (InputDoc::Buffer { .. }, Some(Declared::Texture(..))) => Some("a buffer, and this is a texture".to_owned()),
        (InputDoc::Texture { .. }, Some(Declared::Buffer)) => Some("a texture, and this is a buffer".to_owned()),
        (InputDoc::Texture { dimension, format, .. }, Some(Declared::Texture(given, given_formats))) => {
            // A face of a cube is an image.
            let given = if *given == DimensionDoc::Cube && part.layer.is_some() { DimensionDoc::D2 } else { *given };
            let allowed = format.as_ref().map(|format| format.value.names());
            let stray = allowed.as_ref().and_then(|allowed| given_formats.iter().find(|format| !allowed.contains(format)));
            if given != *dimension {
                Some(format!("{dimension:?}, and this is {given:?}"))
            } else {
                let allowed = crate::diagnostic::list_names(allowed.unwrap_or_default().iter().map(String::as_str));
                stray.map(|stray| format!("in one of the formats {allowed}, and this may be `{stray}`"))
            }
        }
    };
    if let Some(mismatch) = mismatch {
        scope.report(ValidateError::InputMismatch {
            block: block.value.clone(),
            input: name.value.clone(),
            mismatch,
            span: given.span,
            declared: name.span,
        });
    }
}

/// The parameters of the current file, with the values that it is given.
pub(super) fn params(scope: &mut Scope<'_>) -> Vec<ParamDecl> {
    let instance = scope.instance();
    let mut decls = Vec::new();
    for (name, doc) in &instance.document().params {
        let Some(decl) = params::param(scope, name, doc) else { continue };
        let given = instance.block.and_then(|(block_name, block)| Some((block_name, block.params.get(name)?)));
        let given = given.and_then(|(block, value)| scope.within(instance.parent, |scope| self::given(scope, block, value)));
        decls.push(ParamDecl { given, ..decl });
    }
    decls
}

fn given(scope: &mut Scope<'_>, block: &Text, given: &Spanned<ValueDoc>) -> Option<PlacedExpr> {
    let literal = |value| Some(PlacedExpr { expression: Expression::Literal(value), span: given.span });
    match &given.value {
        ValueDoc::Bool(value) => literal(Value::Bool(*value)),
        ValueDoc::Int(value) => literal(Value::Int(*value)),
        ValueDoc::Float(value) => literal(Value::Float(*value)),
        ValueDoc::Vector(values) => literal(Value::Vector(values.clone())),
        ValueDoc::Word(text) => {
            let expression = scope.parse(text, given.span, 0, text.len())?;
            let mut used = Vec::new();
            expression.names(&mut used);
            if used.iter().any(|(name, _)| name.starts_with('$')) {
                let reason = "extents of resources are not known yet where parameters get their values".to_owned();
                let place = Spanned::new(String::new(), given.span);
                bad(scope, block, reason, Some("use the parameters that the extent is computed from"), &place);
                return None;
            }
            Some(PlacedExpr { expression, span: given.span })
        }
    }
}

/// What an instance runs: its blocks, then its passes.
pub(super) fn items(scope: &mut Scope<'_>, index: usize) -> Vec<Item> {
    let instance = &scope.instances[index];
    let mut found: Vec<Item> = instance.children.values().map(|child| Item::Block(*child, items(scope, *child))).collect();
    found.extend(scope.within(index, |scope| passes(scope, &instance.document().passes)));
    found
}

fn bad(scope: &mut Scope<'_>, block: &Text, reason: String, hint: Option<&'static str>, at: &Text) {
    scope.report(ValidateError::BadBlock { block: block.value.clone(), reason, hint, span: at.span });
}
