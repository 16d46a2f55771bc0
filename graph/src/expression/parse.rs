//! From text to an expression: a lexer, and precedence climbing over its tokens.

use std::fmt;
use std::ops::Range;

use super::{Binary, Expression, ExpressionError, Function, Unary};
use crate::expand::types::Value;

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

/// Reads an expression.
pub fn parse(text: &str) -> Result<Expression, ExpressionError> {
    let mut parser = Parser { text, tokens: lex(text)?, position: 0 };
    let expression = parser.expression(0, 0)?;
    match parser.peek() {
        Token::End => Ok(expression),
        token => Err(parser.error(format!("unexpected {token}"))),
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
