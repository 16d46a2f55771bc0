//! Expressions over parameters: sizes, counts, loop bounds, conditions.
//!
//! `"max(1, resolution / 2)"`, `"tone_mapping == 'aces' and scene.local_lights > 0"`. Whole numbers stay whole: division truncates
//! as in WGSL, and overflow is an error. Names are parameters, loop variables, `output.width`, `output.height` and `scene.NAME`.
//! Parsing is limited in depth, so no text can overflow the stack.

mod evaluate;
mod parse;

use std::fmt;
use std::ops::Range;

use crate::expand::types::Value;

pub use parse::parse;

/// A parsed expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A literal.
    Literal(Value),
    /// A name, and where it stands in the text.
    Name(String, Range<usize>),
    /// `-x`, `not x`
    Unary(Unary, Box<Expression>),
    /// `x + y`
    Binary(Binary, Box<Expression>, Box<Expression>),
    /// `max(x, y)`
    Call(Function, Vec<Expression>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Unary {
    Negate,
    Not,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Binary {
    Or,
    And,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Function {
    Min,
    Max,
    DivCeil,
    Ceil,
    Floor,
    Round,
    Log2,
}

/// What is wrong with an expression, and where in its text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// One sentence.
    pub message: String,
    /// Byte range in the text.
    pub range: Range<usize>,
}

impl Expression {
    /// Every name that is used, with its place in the text.
    pub fn names(&self, found: &mut Vec<(String, Range<usize>)>) {
        match self {
            Expression::Literal(_) => {}
            Expression::Name(name, range) => found.push((name.clone(), range.clone())),
            Expression::Unary(_, inner) => inner.names(found),
            Expression::Binary(_, left, right) => {
                left.names(found);
                right.names(found);
            }
            Expression::Call(_, arguments) => arguments.iter().for_each(|argument| argument.names(found)),
        }
    }

    /// Puts other names in place of all that are used, in the order of [`Expression::names`].
    pub fn rename(&mut self, names: &mut dyn Iterator<Item = String>) {
        match self {
            Expression::Literal(_) => {}
            Expression::Name(name, _) => {
                if let Some(other) = names.next() {
                    *name = other;
                }
            }
            Expression::Unary(_, inner) => inner.rename(names),
            Expression::Binary(_, left, right) => {
                left.rename(names);
                right.rename(names);
            }
            Expression::Call(_, arguments) => arguments.iter_mut().for_each(|argument| argument.rename(names)),
        }
    }

    /// Every word literal.
    pub fn words(&self, found: &mut Vec<String>) {
        match self {
            Expression::Literal(Value::Word(_, word)) => found.push(word.clone()),
            Expression::Literal(_) | Expression::Name(..) => {}
            Expression::Unary(_, inner) => inner.words(found),
            Expression::Binary(_, left, right) => {
                left.words(found);
                right.words(found);
            }
            Expression::Call(_, arguments) => arguments.iter().for_each(|argument| argument.words(found)),
        }
    }

    /// Computes the value. `lookup` gives the value of a name.
    pub fn evaluate(&self, lookup: &dyn Fn(&str) -> Option<Value>) -> Result<Value, String> {
        match self {
            Expression::Literal(value) => Ok(value.clone()),
            Expression::Name(name, _) => lookup(name).ok_or_else(|| format!("`{name}` has no value here")),
            Expression::Unary(operator, inner) => match (operator, inner.evaluate(lookup)?) {
                (Unary::Negate, Value::Int(value)) => value.checked_neg().map(Value::Int).ok_or_else(evaluate::overflow),
                (Unary::Negate, Value::Float(value)) => Ok(Value::Float(-value)),
                (Unary::Not, Value::Bool(value)) => Ok(Value::Bool(!value)),
                (Unary::Negate, other) => Err(format!("`-` needs a number, not {}", kind_of(&other))),
                (Unary::Not, other) => Err(format!("`not` needs true or false, not {}", kind_of(&other))),
            },
            Expression::Binary(operator, left, right) => evaluate::binary(*operator, &left.evaluate(lookup)?, &right.evaluate(lookup)?),
            Expression::Call(function, arguments) => {
                let values = arguments.iter().map(|argument| argument.evaluate(lookup)).collect::<Result<Vec<_>, _>>()?;
                evaluate::call(*function, &values)
            }
        }
    }
}

/// What a value is, for messages.
pub fn kind_of(value: &Value) -> &'static str {
    match value {
        Value::Bool(_) => "a truth value",
        Value::Int(_) => "a whole number",
        Value::Float(_) => "a number with a point",
        Value::Word(..) => "a word",
        Value::Vector(_) => "a vector",
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Bool(value) => write!(f, "{value}"),
            Value::Int(value) => write!(f, "{value}"),
            Value::Float(value) => write!(f, "{value:?}"),
            Value::Word(_, word) => f.write_str(word),
            Value::Vector(values) => {
                let parts: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
                write!(f, "({})", parts.join(", "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: &str) {
        let lookup = |name: &str| match name {
            "n" => Some(Value::Int(7)),
            "x" => Some(Value::Float(0.5)),
            "mode" => Some(Value::Word(1, "aces".to_owned())),
            "output.width" => Some(Value::Int(1280)),
            _ => None,
        };
        let result = match parse(text) {
            Ok(expression) => match expression.evaluate(&lookup) {
                Ok(value) => value.to_string(),
                Err(message) => format!("error: {message}"),
            },
            Err(error) => format!("error at {:?}: {error}", error.range),
        };
        assert_eq!(result, expected, "{text}");
    }

    #[test]
    fn arithmetic_and_precedence() {
        check("1 + 2 * 3", "7");
        check("(1 + 2) * 3", "9");
        check("10 - 3 - 2", "5");
        check("n / 2", "3");
        check("n % 4", "3");
        check("-n + 1", "-6");
        check("n * x", "3.5");
        check("output.width / 2", "640");
        check("div_ceil(n, 2)", "4");
        check("ceil(n * x)", "4");
        check("log2(1_024)", "10");
        check("min(n, 3) + max(1.5, 2)", "5.0");
    }

    #[test]
    fn conditions() {
        check("mode == 'aces' and n > 3", "true");
        check("not n == 7 or x < 1", "true");
        check("mode != 'aces'", "false");
    }

    #[test]
    fn errors_have_places() {
        check("1 +", "error at 3..3: expected a number, a name or `(`, found end of the expression");
        check("n n", "error at 2..3: unexpected `n`");
        check(
            "maxi(1, 2)",
            "error at 0..4: there is no function `maxi`; there are `min`, `max`, `div_ceil`, `ceil`, `floor`, `round`, `log2`",
        );
        check("max(1)", "error at 0..3: `max` takes 2 arguments, not 1");
        check("1 / 0", "error: division by zero");
        check("9223372036854775807 + 1", "error: the result does not fit into 64 bits");
        check("1 + true", "error: this operator can't take a whole number and a truth value");
        check("é", "error at 0..2: unexpected character `é`");
        check(&"(".repeat(200), "error at 65..66: nested deeper than 64 levels");
        check(&"-".repeat(200), "error at 65..66: nested deeper than 64 levels");
        assert!(parse(&"1 + ".repeat(100_000)).is_err_and(|error| error.message.starts_with("longer than")));
    }
}
