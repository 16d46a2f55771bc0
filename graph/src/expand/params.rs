//! The values of parameters: defaults, and what the user set.

use super::environment::Environment;
use super::error::ExpandError;
use super::types::{Param, Value};
use crate::diagnostic::list_names;
use crate::expression::kind_of;
use crate::validate::types::ParamDecl;

/// Gives each parameter its value, in the order of declaration: those of a block may be given by expressions over those of its user.
/// `sets` are names with texts as from a command line.
pub(super) fn values(environment: &mut Environment<'_>, params: &[ParamDecl], sets: &[(String, String)]) {
    for (name, _) in sets {
        if !params.iter().any(|param| param.name.value == *name) {
            let known = params.iter().filter(|param| param.given.is_none()).map(|param| param.name.value.clone()).collect();
            environment.problems.push(ExpandError::UnknownParam { name: name.clone(), known }.into());
        }
    }
    for param in params {
        let (mut value, mut live) = (param.default.clone(), param.live);
        let name = &param.name.value;
        if let Some(given) = &param.given {
            let mut used = Vec::new();
            given.expression.names(&mut used);
            live |= environment.params.iter().any(|other| other.live && used.iter().any(|(name, _)| *name == other.name));
            if let Some(found) = environment.value(given, &format!("the parameter `{name}`")) {
                match fit(param, found) {
                    Ok(fitting) => value = fitting,
                    Err(reason) => {
                        let (name, span) = (name.clone(), given.span);
                        environment.report(ExpandError::BadGiven { name, reason, span, declared: param.name.span });
                    }
                }
            }
        }
        for (_, text) in sets.iter().filter(|(set, _)| set == name) {
            let parsed = match &param.given {
                None => parse(param, text),
                Some(_) => Err("the pipeline gives the block this value: set what it is computed from".to_owned()),
            };
            match parsed {
                Ok(parsed) => value = parsed,
                Err(reason) => {
                    let span = param.given.as_ref().map_or(param.name.span, |given| given.span);
                    let bad = ExpandError::BadSet { name: name.clone(), given: text.clone(), reason, span };
                    environment.problems.push(bad.into());
                }
            }
        }
        environment.params.push(Param { name: name.clone(), span: param.name.span, value, options: param.options.clone(), live });
    }
}

/// A value that a block is given, as one of its parameter's type.
fn fit(param: &ParamDecl, value: Value) -> Result<Value, String> {
    let value = match (&param.default, value) {
        (Value::Float(_), Value::Int(value)) => Value::Float(value as f64),
        (Value::Word(..), Value::Word(_, word)) => match param.options.iter().position(|option| *option == word) {
            Some(index) => Value::Word(index as u32, word),
            None => {
                let options = list_names(param.options.iter().map(String::as_str));
                return Err(format!("it is `{word}`, and the options are {options}"));
            }
        },
        (Value::Vector(expected), Value::Vector(values)) if expected.len() == values.len() => Value::Vector(values),
        (default, value) if std::mem::discriminant(default) == std::mem::discriminant(&value) && !matches!(value, Value::Vector(_)) => {
            value
        }
        (default, value) => return Err(format!("it is {}, and must be {}", kind_of(&value), kind_of(default))),
    };
    in_range(param, value)
}

fn parse(param: &ParamDecl, given: &str) -> Result<Value, String> {
    let value = match &param.default {
        Value::Bool(_) => given.parse().map(Value::Bool).map_err(|_| "expected true or false".to_owned())?,
        Value::Int(_) => given.parse().map(Value::Int).map_err(|_| "expected a whole number".to_owned())?,
        Value::Float(_) => Value::Float(finite(given).ok_or("expected a number")?),
        Value::Word(..) => {
            let index = param.options.iter().position(|option| option == given);
            let options = list_names(param.options.iter().map(String::as_str));
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
    in_range(param, value)
}

fn in_range(param: &ParamDecl, value: Value) -> Result<Value, String> {
    let number = match &value {
        Value::Int(value) => *value as f64,
        Value::Float(value) => *value,
        _ => return Ok(value),
    };
    let outside = param.range.is_some_and(|(low, high)| !(low..=high).contains(&number));
    let uneven = param.power_of_two && !matches!(value, Value::Int(whole) if u64::try_from(whole).is_ok_and(u64::is_power_of_two));
    if !outside && !uneven {
        return Ok(value);
    }
    let powers = if param.power_of_two { "powers of two" } else { "" };
    let between = param.range.map(|(low, high)| format!("{low} to {high}")).unwrap_or_default();
    let joined = if powers.is_empty() || between.is_empty() { "" } else { " from " };
    let unit = param.unit.as_ref().map(|unit| format!(" {unit}")).unwrap_or_default();
    Err(format!("allowed are {powers}{joined}{between}{unit}, and this is {value}"))
}

fn finite(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|value| value.is_finite())
}
