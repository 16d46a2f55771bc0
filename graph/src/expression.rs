//! Expressions over parameters: sizes, counts, loop bounds, conditions.
//!
//! `"max(1, resolution / 2)"`, `"tone_mapping == 'aces' and scene.local_lights > 0"`. Whole numbers stay whole: division truncates
//! as in WGSL, and overflow is an error. Names are parameters, loop variables, `output.width`, `output.height` and `scene.NAME`.
//! Parsing is limited in depth, so no text can overflow the stack.

use std::fmt;
use std::ops::Range;

use crate::expand::types::Value;

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

/// Name and number of arguments of every function.
const FUNCTIONS: &[(&str, Function, usize)] = &[
    ("min", Function::Min, 2),
    ("max", Function::Max, 2),
    ("div_ceil", Function::DivCeil, 2),
    ("ceil", Function::Ceil, 1),
    ("floor", Function::Floor, 1),
    ("round", Function::Round, 1),
    ("log2", Function::Log2, 1),
];

/// Nesting beyond this is refused.
const MAX_DEPTH: usize = 64;

/// Longer expressions are refused: a chain of operators nests as deep as it is long.
const MAX_TOKENS: usize = 512;

/// What is wrong with an expression, and where in its text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// One sentence.
    pub message: String,
    /// Byte range in the text.
    pub range: Range<usize>,
}

/// Reads an expression.
pub fn parse(text: &str) -> Result<Expression, ExpressionError> {
    let mut parser = Parser { text, tokens: lex(text)?, position: 0 };
    let expression = parser.expression(0, 0)?;
    match parser.peek() {
        Token::End => Ok(expression),
        token => Err(parser.error(format!("unexpected {token}"))),
    }
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
                (Unary::Negate, Value::Int(value)) => value.checked_neg().map(Value::Int).ok_or_else(overflow),
                (Unary::Negate, Value::Float(value)) => Ok(Value::Float(-value)),
                (Unary::Not, Value::Bool(value)) => Ok(Value::Bool(!value)),
                (Unary::Negate, other) => Err(format!("`-` needs a number, not {}", kind_of(&other))),
                (Unary::Not, other) => Err(format!("`not` needs true or false, not {}", kind_of(&other))),
            },
            Expression::Binary(operator, left, right) => binary(*operator, &left.evaluate(lookup)?, &right.evaluate(lookup)?),
            Expression::Call(function, arguments) => {
                let values = arguments.iter().map(|argument| argument.evaluate(lookup)).collect::<Result<Vec<_>, _>>()?;
                call(*function, &values)
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

fn overflow() -> String {
    "the result does not fit into 64 bits".to_owned()
}

fn as_float(value: &Value) -> Option<f64> {
    match value {
        Value::Int(value) => Some(*value as f64),
        Value::Float(value) => Some(*value),
        _ => None,
    }
}

fn binary(operator: Binary, left: &Value, right: &Value) -> Result<Value, String> {
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

fn call(function: Function, values: &[Value]) -> Result<Value, String> {
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

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Number(Value),
    Name(String),
    Word(String),
    Symbol(&'static str),
    End,
}

impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Token::Number(value) => write!(f, "`{value}`"),
            Token::Name(name) => write!(f, "`{name}`"),
            Token::Word(word) => write!(f, "`'{word}'`"),
            Token::Symbol(symbol) => write!(f, "`{symbol}`"),
            Token::End => f.write_str("end of the expression"),
        }
    }
}

const SYMBOLS: &[&str] = &["==", "!=", "<=", ">=", "<", ">", "+", "-", "*", "/", "%", "(", ")", ","];

fn lex(text: &str) -> Result<Vec<(Token, Range<usize>)>, ExpressionError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    let fail = |message: String, range: Range<usize>| Err(ExpressionError { message, range });
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let length_while = |accept: &dyn Fn(char) -> bool| rest.find(|c: char| !accept(c)).unwrap_or(rest.len());
        if first.is_whitespace() {
            at += first.len_utf8();
            continue;
        }
        let (token, length) = if first.is_ascii_digit() {
            let length = length_while(&|c| c.is_ascii_digit() || c == '.' || c == '_');
            let digits = rest[..length].replace('_', "");
            let value = if digits.contains('.') { digits.parse().ok().map(Value::Float) } else { digits.parse().ok().map(Value::Int) };
            match value {
                Some(value) => (Token::Number(value), length),
                None => return fail(format!("`{}` is not a number", &rest[..length]), at..at + length),
            }
        } else if first.is_ascii_alphabetic() || first == '_' {
            let length = length_while(&|c| c.is_ascii_alphanumeric() || c == '_' || c == '.');
            (Token::Name(rest[..length].to_owned()), length)
        } else if first == '\'' {
            match rest[1..].find('\'') {
                Some(end) => (Token::Word(rest[1..end + 1].to_owned()), end + 2),
                None => return fail("this word has no closing `'`".to_owned(), at..text.len()),
            }
        } else if let Some(symbol) = SYMBOLS.iter().find(|symbol| rest.starts_with(**symbol)) {
            (Token::Symbol(symbol), symbol.len())
        } else {
            return fail(format!("unexpected character `{first}`"), at..at + first.len_utf8());
        };
        tokens.push((token, at..at + length));
        at += length;
        if tokens.len() > MAX_TOKENS {
            return fail(format!("longer than {MAX_TOKENS} words and operators"), at..text.len());
        }
    }
    tokens.push((Token::End, text.len()..text.len()));
    Ok(tokens)
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<(Token, Range<usize>)>,
    position: usize,
}

impl Parser<'_> {
    fn peek(&self) -> Token {
        self.tokens.get(self.position).map_or(Token::End, |(token, _)| token.clone())
    }

    fn range(&self) -> Range<usize> {
        self.tokens.get(self.position).map_or(self.text.len()..self.text.len(), |(_, range)| range.clone())
    }

    fn error(&self, message: String) -> ExpressionError {
        ExpressionError { message, range: self.range() }
    }

    /// Precedence climbing: everything that binds at least as strongly as `minimum`.
    fn expression(&mut self, minimum: u8, depth: usize) -> Result<Expression, ExpressionError> {
        if depth > MAX_DEPTH {
            return Err(self.error(format!("nested deeper than {MAX_DEPTH} levels")));
        }
        let mut left = self.operand(depth)?;
        while let Some((operator, strength)) = operator_of(&self.peek()) {
            if strength < minimum {
                break;
            }
            self.position += 1;
            let right = self.expression(strength + 1, depth + 1)?;
            left = Expression::Binary(operator, Box::new(left), Box::new(right));
        }
        Ok(left)
    }

    fn operand(&mut self, depth: usize) -> Result<Expression, ExpressionError> {
        let (token, range) = (self.peek(), self.range());
        self.position += 1;
        match token {
            Token::Number(value) => Ok(Expression::Literal(value)),
            Token::Word(word) => Ok(Expression::Literal(Value::Word(0, word))),
            Token::Symbol("-") => Ok(Expression::Unary(Unary::Negate, Box::new(self.expression(UNARY, depth + 1)?))),
            Token::Symbol("(") => {
                let inner = self.expression(0, depth + 1)?;
                self.expect(")")?;
                Ok(inner)
            }
            Token::Name(name) => match name.as_str() {
                "true" => Ok(Expression::Literal(Value::Bool(true))),
                "false" => Ok(Expression::Literal(Value::Bool(false))),
                "not" => Ok(Expression::Unary(Unary::Not, Box::new(self.expression(NOT, depth + 1)?))),
                _ if self.peek() == Token::Symbol("(") => self.call(&name, range, depth),
                _ => Ok(Expression::Name(name, range)),
            },
            token => {
                self.position -= 1;
                Err(self.error(format!("expected a number, a name or `(`, found {token}")))
            }
        }
    }

    fn call(&mut self, name: &str, range: Range<usize>, depth: usize) -> Result<Expression, ExpressionError> {
        let Some((_, function, arity)) = FUNCTIONS.iter().find(|(known, _, _)| *known == name) else {
            let known = crate::diagnostic::list_names(FUNCTIONS.iter().map(|(known, _, _)| *known));
            return Err(ExpressionError { message: format!("there is no function `{name}`; there are {known}"), range });
        };
        self.position += 1;
        let mut arguments = Vec::new();
        while self.peek() != Token::Symbol(")") {
            if !arguments.is_empty() {
                self.expect(",")?;
            }
            arguments.push(self.expression(0, depth + 1)?);
        }
        self.position += 1;
        if arguments.len() != *arity {
            let message = format!("`{name}` takes {arity} argument{}, not {}", if *arity == 1 { "" } else { "s" }, arguments.len());
            return Err(ExpressionError { message, range });
        }
        Ok(Expression::Call(*function, arguments))
    }

    fn expect(&mut self, symbol: &'static str) -> Result<(), ExpressionError> {
        if self.peek() == Token::Symbol(symbol) {
            self.position += 1;
            Ok(())
        } else {
            Err(self.error(format!("expected `{symbol}`, found {}", self.peek())))
        }
    }
}

/// Strength of `not`: weaker than comparisons.
const NOT: u8 = 3;
/// Strength of unary minus: stronger than all binary operators.
const UNARY: u8 = 7;

fn operator_of(token: &Token) -> Option<(Binary, u8)> {
    Some(match token {
        Token::Name(name) if name == "or" => (Binary::Or, 1),
        Token::Name(name) if name == "and" => (Binary::And, 2),
        Token::Symbol(symbol) => match *symbol {
            "==" => (Binary::Equal, 4),
            "!=" => (Binary::NotEqual, 4),
            "<" => (Binary::Less, 4),
            "<=" => (Binary::LessEqual, 4),
            ">" => (Binary::Greater, 4),
            ">=" => (Binary::GreaterEqual, 4),
            "+" => (Binary::Add, 5),
            "-" => (Binary::Subtract, 5),
            "*" => (Binary::Multiply, 6),
            "/" => (Binary::Divide, 6),
            "%" => (Binary::Remainder, 6),
            _ => return None,
        },
        _ => return None,
    })
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
        check(&"(".repeat(400), "error at 65..66: nested deeper than 64 levels");
        check(&"-".repeat(400), "error at 65..66: nested deeper than 64 levels");
    }
}
