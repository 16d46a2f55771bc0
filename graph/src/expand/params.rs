//! The values of parameters: defaults, and what the user set.

use super::error::ExpandError;
use super::types::{Param, Value};
use crate::diagnostic::Diagnostic;
use crate::validate::types::ParamDecl;

/// Gives each parameter its value. `sets` are names with texts as from a command line.
pub(super) fn values(params: &[ParamDecl], sets: &[(String, String)], problems: &mut Vec<Diagnostic>) -> Vec<Param> {
    for (name, _) in sets {
        if !params.iter().any(|param| param.name.value == *name) {
            let known = params.iter().map(|param| param.name.value.clone()).collect();
            problems.push(ExpandError::UnknownParam { name: name.clone(), known }.into());
        }
    }
    let value_of = |param: &ParamDecl, problems: &mut Vec<Diagnostic>| {
        let mut value = param.default.clone();
        for (_, given) in sets.iter().filter(|(name, _)| *name == param.name.value) {
            match parse(param, given) {
                Ok(parsed) => value = parsed,
                Err(reason) => {
                    let name = param.name.value.clone();
                    problems.push(ExpandError::BadSet { name, given: given.clone(), reason, span: param.name.span }.into());
                }
            }
        }
        value
    };
    params
        .iter()
        .map(|param| Param {
            name: param.name.value.clone(),
            span: param.name.span,
            value: value_of(param, problems),
            options: param.options.clone(),
            live: param.live,
        })
        .collect()
}

fn parse(param: &ParamDecl, given: &str) -> Result<Value, String> {
    let value = match &param.default {
        Value::Bool(_) => given.parse().map(Value::Bool).map_err(|_| "expected true or false".to_owned())?,
        Value::Int(_) => given.parse().map(Value::Int).map_err(|_| "expected a whole number".to_owned())?,
        Value::Float(_) => Value::Float(finite(given).ok_or("expected a number")?),
        Value::Word(..) => {
            let index = param.options.iter().position(|option| option == given);
            let options = crate::diagnostic::list_names(param.options.iter().map(String::as_str));
            Value::Word(index.ok_or_else(|| format!("expected one of {options}"))? as u32, given.to_owned())
        }
        Value::Vector(default) => {
            let parts: Vec<f64> = given.trim_matches(|c| c == '(' || c == ')').split(',').map_while(|part| finite(part.trim())).collect();
            if parts.len() != default.len() || given.split(',').count() != default.len() {
                return Err(format!("expected {} numbers with commas between them", default.len()));
            }
            Value::Vector(parts)
        }
    };
    let number = match &value {
        Value::Int(value) => Some(*value as f64),
        Value::Float(value) => Some(*value),
        _ => None,
    };
    if let (Some((low, high)), Some(number)) = (param.range, number)
        && !(low..=high).contains(&number)
    {
        let unit = param.unit.as_ref().map(|unit| format!(" {unit}")).unwrap_or_default();
        return Err(format!("allowed are {low} to {high}{unit}"));
    }
    Ok(value)
}

fn finite(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|value| value.is_finite())
}
