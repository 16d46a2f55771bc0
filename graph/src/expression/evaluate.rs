//! The values of operators and functions.

use super::{Binary, Function, kind_of};
use crate::expand::types::Value;

pub(super) fn overflow() -> String {
    "the result does not fit into 64 bits".to_owned()
}

fn as_float(value: &Value) -> Option<f64> {
    match value {
        Value::Int(value) => Some(*value as f64),
        Value::Float(value) => Some(*value),
        _ => None,
    }
}

pub(super) fn binary(operator: Binary, left: &Value, right: &Value) -> Result<Value, String> {
    use Binary::{Add, And, Divide, Equal, Greater, GreaterEqual, Less, LessEqual, Multiply, NotEqual, Or, Remainder, Subtract};
    let mismatch = || format!("this operator can't take {} and {}", kind_of(left), kind_of(right));
    match operator {
        Or | And => match (left, right) {
            (Value::Bool(a), Value::Bool(b)) => Ok(Value::Bool(if operator == Or { *a || *b } else { *a && *b })),
            _ => Err(mismatch()),
        },
        Equal | NotEqual => {
            let equal = match (left, right) {
                (Value::Bool(a), Value::Bool(b)) => a == b,
                (Value::Word(_, a), Value::Word(_, b)) => a == b,
                (Value::Int(a), Value::Int(b)) => a == b,
                _ => as_float(left).ok_or_else(mismatch)? == as_float(right).ok_or_else(mismatch)?,
            };
            Ok(Value::Bool(equal == (operator == Equal)))
        }
        Less | LessEqual | Greater | GreaterEqual => {
            let (a, b) = (as_float(left).ok_or_else(mismatch)?, as_float(right).ok_or_else(mismatch)?);
            Ok(Value::Bool(match operator {
                Less => a < b,
                LessEqual => a <= b,
                Greater => a > b,
                _ => a >= b,
            }))
        }
        Add | Subtract | Multiply | Divide | Remainder => {
            if let (Value::Int(a), Value::Int(b)) = (left, right) {
                if *b == 0 && matches!(operator, Divide | Remainder) {
                    return Err("division by zero".to_owned());
                }
                let result = match operator {
                    Add => a.checked_add(*b),
                    Subtract => a.checked_sub(*b),
                    Multiply => a.checked_mul(*b),
                    Divide => a.checked_div(*b),
                    _ => a.checked_rem(*b),
                };
                return result.map(Value::Int).ok_or_else(overflow);
            }
            let (a, b) = (as_float(left).ok_or_else(mismatch)?, as_float(right).ok_or_else(mismatch)?);
            finite(match operator {
                Add => a + b,
                Subtract => a - b,
                Multiply => a * b,
                Divide => a / b,
                _ => a % b,
            })
        }
    }
}

fn finite(value: f64) -> Result<Value, String> {
    if value.is_finite() { Ok(Value::Float(value)) } else { Err("the result is not a finite number".to_owned()) }
}

pub(super) fn call(function: Function, values: &[Value]) -> Result<Value, String> {
    let mismatch = || "this function needs numbers".to_owned();
    match (function, values) {
        (Function::Min, [Value::Int(a), Value::Int(b)]) => Ok(Value::Int(*a.min(b))),
        (Function::Max, [Value::Int(a), Value::Int(b)]) => Ok(Value::Int(*a.max(b))),
        (Function::Min | Function::Max, [a, b]) => {
            let (a, b) = (as_float(a).ok_or_else(mismatch)?, as_float(b).ok_or_else(mismatch)?);
            finite(if function == Function::Min { a.min(b) } else { a.max(b) })
        }
        (Function::DivCeil, [Value::Int(a), Value::Int(b)]) if *a >= 0 && *b > 0 => Ok(Value::Int(a / b + i64::from(a % b != 0))),
        (Function::DivCeil, _) => Err("`div_ceil` needs two whole numbers, the second above zero".to_owned()),
        (Function::Log2, [Value::Int(a)]) if *a > 0 => Ok(Value::Int(i64::from(a.ilog2()))),
        (Function::Log2, _) => Err("`log2` needs a whole number above zero".to_owned()),
        (Function::Ceil | Function::Floor | Function::Round, [value]) => {
            let value = as_float(value).ok_or_else(mismatch)?;
            let rounded = match function {
                Function::Ceil => value.ceil(),
                Function::Floor => value.floor(),
                _ => value.round(),
            };
            if rounded.abs() < 9.0e15 { Ok(Value::Int(rounded as i64)) } else { Err(overflow()) }
        }
        _ => Err(mismatch()),
    }
}
