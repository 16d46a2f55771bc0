//! Whether a number fits the type that asks for it.
//!
//! Nothing wraps, and nothing becomes infinite. A suffix must be that of the type. A decimal integer may stand for a float;
//! it is rounded to the nearest, as its digits would be.

use serde::de::Expected;

use super::fault::{Fault, ReadError};
use super::tree::{Float, FloatType, Integer, IntegerType, Node, Value};

/// The integer, if it is one of the type.
pub(super) fn fit_integer(node: &Node, wanted: IntegerType, expected: &dyn Expected) -> Result<i128, ReadError> {
    let (least, most) = wanted.limits();
    let (value, shown) = match node.value {
        Value::Integer(Integer { suffix: Some(suffix), .. }) if suffix != wanted => {
            return Err(ReadError::wrong_type(node, expected, Some(format!("leave the suffix `{}` out", suffix.name()))));
        }
        Value::Integer(integer) => (Some(integer.value()), integer.value().to_string()),
        Value::Float(float) if float.whole => (None, "the number".to_owned()),
        _ => return Err(ReadError::wrong_type(node, expected, hint(node))),
    };
    value.filter(|value| (least..=most).contains(value)).ok_or_else(|| {
        let fault = Fault::OutOfRange { value: shown, expected: wanted.name(), least: least.to_string(), most: most.to_string() };
        ReadError::new(fault).at_node(node)
    })
}

/// The nearest `f32`.
pub(super) fn fit_f32(node: &Node, expected: &dyn Expected) -> Result<f32, ReadError> {
    match node.value {
        Value::Integer(Integer { negative, magnitude, decimal: true, .. }) => {
            let value = magnitude as f32;
            Ok(if negative { -value } else { value })
        }
        Value::Float(Float { value, single, suffix, .. }) if suffix != Some(FloatType::F64) => {
            if single.is_infinite() && value.is_finite() {
                let (least, most) = (format!("{:e}", f32::MIN), format!("{:e}", f32::MAX));
                return Err(ReadError::new(Fault::OutOfRange { value: format!("{value:e}"), expected: "f32", least, most }).at_node(node));
            }
            Ok(single)
        }
        _ => Err(ReadError::wrong_type(node, expected, hint(node))),
    }
}

/// The nearest `f64`.
pub(super) fn fit_f64(node: &Node, expected: &dyn Expected) -> Result<f64, ReadError> {
    match node.value {
        Value::Integer(Integer { negative, magnitude, decimal: true, .. }) => {
            let value = magnitude as f64;
            Ok(if negative { -value } else { value })
        }
        Value::Float(Float { value, suffix, .. }) if suffix != Some(FloatType::F32) => Ok(value),
        _ => Err(ReadError::wrong_type(node, expected, hint(node))),
    }
}

/// What may be wrong where a number is expected.
fn hint(node: &Node) -> Option<String> {
    match &node.value {
        Value::Str(text) if text.parse::<f64>().is_ok() => Some("numbers have no quotes".to_owned()),
        Value::Float(Float { suffix: Some(suffix), .. }) => Some(format!("leave the suffix `{}` out", suffix.name())),
        _ => None,
    }
}
