//! Pipeline-overridable constants: which entry point uses which, and workgroup sizes that depend on them.

use std::collections::BTreeSet;

use naga::{ArraySize, BinaryOperator, Block, Expression, Function, Handle, Literal, Module, Statement, Type, TypeInner};

use super::interface::{Override, Shader};
use super::places::Places;
use super::types::type_text;

/// Steps that the evaluation of a workgroup size may take: overrides that double each other must not hang a compilation.
const MAX_STEPS: u32 = 10_000;
/// Expressions inside of expressions inside of expressions.
const MAX_DEPTH: u32 = 100;

/// The named overrides in the order of the text.
pub(super) fn declared(module: &Module, places: &Places<'_>) -> Vec<Override> {
    let mut found: Vec<_> = module
        .overrides
        .iter()
        .filter_map(|(handle, constant)| {
            let name = constant.name.clone()?;
            let (span, wgsl) = (places.value_span(&name), type_text(module, constant.ty));
            Some((places.value_order(&name), handle, Override { name, span, wgsl, has_default: constant.init.is_some() }))
        })
        .collect();
    found.sort_by_key(|(order, handle, _)| (*order, *handle));
    found.into_iter().map(|(_, _, constant)| constant).collect()
}

/// The names of the overrides that an entry point uses, directly or through what it calls, in the order of `declared`.
pub(super) fn used(module: &Module, entry: &naga::EntryPoint, declared: &[Override]) -> Vec<String> {
    let mut walk = Walk { module, functions: BTreeSet::new(), overrides: BTreeSet::new(), pending: Vec::new() };
    walk.function(&entry.function);
    let sizes = entry.workgroup_size_overrides.iter().flatten().flatten();
    sizes.for_each(|size| walk.global_expression(*size));
    while let Some(function) = walk.pending.pop() {
        if walk.functions.insert(function)
            && let Ok(function) = module.functions.try_get(function)
        {
            walk.function(function);
        }
    }
    let names: BTreeSet<&str> =
        walk.overrides.iter().filter_map(|handle| module.overrides.try_get(*handle).ok()?.name.as_deref()).collect();
    declared.iter().filter(|constant| names.contains(constant.name.as_str())).map(|constant| constant.name.clone()).collect()
}

/// Collects overrides from functions, global expressions and types.
struct Walk<'a> {
    module: &'a Module,
    functions: BTreeSet<Handle<Function>>,
    overrides: BTreeSet<Handle<naga::Override>>,
    pending: Vec<Handle<Function>>,
}

impl Walk<'_> {
    fn function(&mut self, function: &Function) {
        for (_, expression) in function.expressions.iter() {
            match expression {
                Expression::Override(handle) => self.constant(*handle),
                Expression::GlobalVariable(handle) => {
                    if let Ok(variable) = self.module.global_variables.try_get(*handle) {
                        self.array_sizes(variable.ty);
                        variable.init.into_iter().for_each(|init| self.global_expression(init));
                    }
                }
                _ => {}
            }
        }
        let mut blocks: Vec<&Block> = vec![&function.body];
        while let Some(block) = blocks.pop() {
            for statement in block {
                match statement {
                    Statement::Call { function, .. } => self.pending.push(*function),
                    Statement::Block(inner) => blocks.push(inner),
                    Statement::If { accept, reject, .. } => blocks.extend([accept, reject]),
                    Statement::Switch { cases, .. } => blocks.extend(cases.iter().map(|case| &case.body)),
                    Statement::Loop { body, continuing, .. } => blocks.extend([body, continuing]),
                    _ => {}
                }
            }
        }
    }

    fn constant(&mut self, handle: Handle<naga::Override>) {
        if self.overrides.insert(handle)
            && let Ok(constant) = self.module.overrides.try_get(handle)
        {
            constant.init.into_iter().for_each(|init| self.global_expression(init));
        }
    }

    /// Sizes of workgroup arrays.
    fn array_sizes(&mut self, ty: Handle<Type>) {
        let mut inner = self.module.types.get_handle(ty).map(|ty| &ty.inner);
        while let Ok(TypeInner::Array { base, size, .. }) = inner {
            if let ArraySize::Pending(handle) = size {
                self.constant(*handle);
            }
            inner = self.module.types.get_handle(*base).map(|ty| &ty.inner);
        }
    }

    fn global_expression(&mut self, root: Handle<Expression>) {
        let mut open = vec![root];
        let mut seen = BTreeSet::new();
        while let Some(handle) = open.pop() {
            if !seen.insert(handle) {
                continue;
            }
            let Ok(expression) = self.module.global_expressions.try_get(handle) else { continue };
            match expression {
                // One level of defaults at a time would recurse; they stand in the same arena.
                Expression::Override(constant) if self.overrides.insert(*constant) => {
                    open.extend(self.module.overrides.try_get(*constant).ok().and_then(|constant| constant.init));
                }
                Expression::Compose { components, .. } => open.extend(components),
                Expression::Access { base, index } => open.extend([*base, *index]),
                Expression::AccessIndex { base, .. } => open.push(*base),
                Expression::Splat { value, .. } => open.push(*value),
                Expression::Swizzle { vector, .. } => open.push(*vector),
                Expression::Unary { expr, .. } | Expression::As { expr, .. } => open.push(*expr),
                Expression::Binary { left, right, .. } => open.extend([*left, *right]),
                Expression::Select { condition, accept, reject } => open.extend([*condition, *accept, *reject]),
                Expression::Relational { argument, .. } => open.push(*argument),
                Expression::Math { arg, arg1, arg2, arg3, .. } => {
                    open.push(*arg);
                    open.extend([arg1, arg2, arg3].into_iter().filter_map(|argument| *argument));
                }
                _ => {}
            }
        }
    }
}

/// The workgroup size of a compute entry point. `value` gives the overrides that have a value from outside; the others have
/// their defaults. The error says which axis has no value and why.
pub(super) fn workgroup_size(module: &Module, entry: &naga::EntryPoint, value: &dyn Fn(&str) -> Option<f64>) -> Result<[u32; 3], String> {
    let mut size = entry.workgroup_size;
    let Some(expressions) = entry.workgroup_size_overrides else { return Ok(size) };
    for ((axis, expression), size) in ["x", "y", "z"].into_iter().zip(expressions).zip(&mut size) {
        let Some(expression) = expression else { continue };
        let mut evaluation = Evaluation { module, value, steps: 0 };
        let result = evaluation.expression(expression, 0).map_err(|why| format!("along {axis}, {why}"))?;
        *size = u32::try_from(result).ok().filter(|size| *size > 0).ok_or_else(|| format!("along {axis} it would be {result}"))?;
    }
    Ok(size)
}

/// Evaluates whole-number expressions over overrides.
struct Evaluation<'a> {
    module: &'a Module,
    value: &'a dyn Fn(&str) -> Option<f64>,
    steps: u32,
}

impl Evaluation<'_> {
    fn expression(&mut self, handle: Handle<Expression>, depth: u32) -> Result<i64, String> {
        self.steps += 1;
        let (steps, module) = (self.steps, self.module);
        let Some(expression) = module.global_expressions.try_get(handle).ok().filter(|_| steps < MAX_STEPS && depth < MAX_DEPTH) else {
            return Err("the expression is too long".to_owned());
        };
        match expression {
            Expression::Literal(literal) => whole(*literal),
            Expression::Constant(constant) => match module.constants.try_get(*constant) {
                Ok(constant) => self.expression(constant.init, depth + 1),
                Err(_) => Err("a constant is missing".to_owned()),
            },
            Expression::Override(constant) => {
                let Ok(constant) = module.overrides.try_get(*constant) else { return Err("an override is missing".to_owned()) };
                let name = constant.name.as_deref().unwrap_or_default();
                match ((self.value)(name), constant.init) {
                    (Some(value), _) if value.fract() == 0.0 && value.abs() < 1e9 => Ok(value as i64),
                    (Some(value), _) => Err(format!("the override `{name}` is {value}")),
                    (None, Some(init)) => self.expression(init, depth + 1),
                    (None, None) => Err(format!("the override `{name}` has no default")),
                }
            }
            Expression::As { expr, .. } => self.expression(*expr, depth + 1),
            Expression::Binary { op, left, right } => {
                let (left, right) = (self.expression(*left, depth + 1)?, self.expression(*right, depth + 1)?);
                let result = match op {
                    BinaryOperator::Add => left.checked_add(right),
                    BinaryOperator::Subtract => left.checked_sub(right),
                    BinaryOperator::Multiply => left.checked_mul(right),
                    BinaryOperator::Divide => left.checked_div(right),
                    BinaryOperator::Modulo => left.checked_rem(right),
                    _ => return Err("only + - * / % are evaluated here".to_owned()),
                };
                result.ok_or_else(|| "the arithmetic overflows or divides by zero".to_owned())
            }
            _ => Err("only numbers, overrides and + - * / % are evaluated here".to_owned()),
        }
    }
}

/// A whole number.
fn whole(literal: Literal) -> Result<i64, String> {
    match literal {
        Literal::U32(value) => Ok(i64::from(value)),
        Literal::I32(value) => Ok(i64::from(value)),
        Literal::AbstractInt(value) => Ok(value),
        _ => Err("a number is not whole".to_owned()),
    }
}

impl Shader {
    /// The workgroup size of a compute entry point with these values of overrides; those without one have their defaults. `None` where
    /// there is no such entry point or an override has no value, or one that gives no positive whole size.
    pub fn workgroup_size(&self, entry: &str, value: &dyn Fn(&str) -> Option<f64>) -> Option<[u32; 3]> {
        let entry = self.module.entry_points.iter().find(|known| known.name == entry)?;
        workgroup_size(&self.module, entry, value).ok()
    }
}
