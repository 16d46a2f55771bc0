//! Parameters: types from defaults, ranges and options that fit.

use super::error::ValidateError;
use super::scope::Scope;
use super::types::ParamDecl;
use crate::expand::types::{Located, Value};
use crate::expression::kind_of;
use crate::syntax::document::{ParamDoc, Text, ValueDoc};
use crate::syntax::spanned::Spanned;

/// Checks one parameter.
pub(super) fn param(scope: &mut Scope<'_>, name: &Text, doc: &ParamDoc) -> Option<ParamDecl> {
    scope.check_name(name);
    let bad = |reason: String, hint: Option<&str>, span| ValidateError::BadParam {
        name: name.value.clone(),
        reason,
        hint: hint.map(str::to_owned),
        span,
    };
    let options = doc.options.as_ref().map(|options| options.value.clone()).unwrap_or_default();
    let default = match &doc.default.value {
        ValueDoc::Bool(value) => Value::Bool(*value),
        ValueDoc::Int(value) => Value::Int(*value),
        ValueDoc::Float(value) if value.is_finite() => Value::Float(*value),
        ValueDoc::Float(_) => {
            scope.report(bad("the default is not a finite number".to_owned(), None, doc.default.span));
            return None;
        }
        ValueDoc::Vector(values) => {
            if !(2..=4).contains(&values.len()) || values.iter().any(|value| !value.is_finite()) {
                scope.report(bad("a vector holds two to four finite numbers".to_owned(), None, doc.default.span));
                return None;
            }
            Value::Vector(values.clone())
        }
        ValueDoc::Word(word) => match options.iter().position(|option| option == word) {
            Some(index) => Value::Word(index as u32, word.clone()),
            None if options.is_empty() => {
                let hint = Some("add `options: [\"..\", ..]`, the words that may be chosen");
                scope.report(bad("a word needs `options`".to_owned(), hint, doc.default.span));
                return None;
            }
            None => {
                scope.report(bad(format!("the default \"{word}\" is none of its options"), None, doc.default.span));
                return None;
            }
        },
    };
    if let Some(stray) = &doc.options
        && !matches!(default, Value::Word(..))
    {
        let reason = format!("`options` are for words, and the default is {}", kind_of(&default));
        scope.report(bad(reason, None, stray.span));
    }
    let power_of_two = match (&doc.power_of_two, &default) {
        (None | Some(Spanned { value: false, .. }), _) => false,
        (Some(_), Value::Int(value)) => {
            if !u64::try_from(*value).is_ok_and(u64::is_power_of_two) {
                scope.report(bad(format!("the default {value} is no power of two"), None, doc.default.span));
            }
            true
        }
        (Some(stray), _) => {
            let reason = format!("`power_of_two` is for whole numbers, and the default is {}", kind_of(&default));
            scope.report(bad(reason, None, stray.span));
            false
        }
    };
    let mut range = None;
    if let Some(given) = &doc.range {
        let numbers = (number(&given.value.0), number(&given.value.1));
        match (numbers, &default) {
            ((Some(low), Some(high)), Value::Int(_) | Value::Float(_)) => {
                if low > high {
                    scope.report(bad("the range is empty: its first number is the larger one".to_owned(), None, given.span));
                } else {
                    range = Some((low, high));
                    let value = number(&doc.default.value).unwrap_or(low);
                    if value < low || value > high {
                        let reason = format!("the default {value} is outside of the range {low} to {high}");
                        scope.report(bad(reason, None, doc.default.span));
                    }
                }
            }
            ((None, _) | (_, None), _) => scope.report(bad("a range is two numbers".to_owned(), None, given.span)),
            _ => scope.report(bad(format!("a range is for numbers, and the default is {}", kind_of(&default)), None, given.span)),
        }
    }
    Some(ParamDecl {
        name: Located { value: format!("{}{}", scope.instance().path, name.value), span: name.span },
        given: None,
        default,
        range,
        options,
        power_of_two,
        live: doc.live,
        unit: doc.unit.clone(),
        doc: doc.doc.clone(),
    })
}

fn number(value: &ValueDoc) -> Option<f64> {
    match value {
        ValueDoc::Int(value) => Some(*value as f64),
        ValueDoc::Float(value) if value.is_finite() => Some(*value),
        _ => None,
    }
}
