//! From the characters of a number to its value.
//!
//! The rules are those of the `ron` crate (0.12): underscores between digits, four bases, a type as suffix; a whole decimal
//! number beyond 64 bits is a float, for who wants one. One difference: digits that overflow to infinity are an error.

use super::error::SyntaxError;
use super::tree::{Float, FloatType, Integer, IntegerType};

/// A number of either kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Number {
    Integer(Integer),
    Float(Float),
}

/// The value of a word such as `-0x1F`, `1_000u32`, `.5e-3` or `-inf`.
pub(super) fn parse_number(word: &str) -> Result<Number, SyntaxError> {
    let (negative, body) = match word.as_bytes().first() {
        Some(b'-') => (true, word.get(1..).unwrap_or("")),
        Some(b'+') => (false, word.get(1..).unwrap_or("")),
        _ => (false, word),
    };
    if let Some(float) = special_float(body, negative) {
        return Ok(Number::Float(float));
    }
    for (prefix, base) in [("0b", 2), ("0o", 8), ("0x", 16)] {
        if let Some(digits) = body.strip_prefix(prefix) {
            return parse_integer(word, digits, negative, base);
        }
    }
    let bytes = body.as_bytes();
    let (digits, _) = split_integer_suffix(body);
    let whole = bytes.first().is_some_and(u8::is_ascii_digit) && digits.bytes().all(|byte| byte.is_ascii_digit() || byte == b'_');
    if whole { parse_integer(word, body, negative, 10) } else { parse_float(word) }
}

/// `inf` and `NaN`, with or without a suffix; the sign has been cut off.
pub(super) fn special_float(body: &str, negative: bool) -> Option<Float> {
    let (name, suffix) = match body {
        "inf" | "NaN" => (body, None),
        "inff32" | "NaNf32" => (body.get(..3)?, Some(FloatType::F32)),
        "inff64" | "NaNf64" => (body.get(..3)?, Some(FloatType::F64)),
        _ => return None,
    };
    let (value, single) = if name == "inf" { (f64::INFINITY, f32::INFINITY) } else { (f64::NAN, f32::NAN) };
    let (value, single) = if negative { (-value, -single) } else { (value, single) };
    Some(Float { value, single, suffix, whole: false })
}

fn split_integer_suffix(text: &str) -> (&str, Option<IntegerType>) {
    for (name, suffix) in IntegerType::ALL {
        if let Some(digits) = text.strip_suffix(name) {
            return (digits, Some(suffix));
        }
    }
    (text, None)
}

fn bad(word: &str, why: &'static str) -> SyntaxError {
    SyntaxError::BadNumber { text: shorten(word), why }
}

fn out_of_range(word: &str, limits: &'static str) -> SyntaxError {
    SyntaxError::NumberRange { text: shorten(word), limits }
}

/// Messages show no more than this of a number.
fn shorten(word: &str) -> String {
    if word.chars().count() <= 40 { word.to_owned() } else { word.chars().take(37).chain("...".chars()).collect() }
}

fn parse_integer(word: &str, text: &str, negative: bool, base: u32) -> Result<Number, SyntaxError> {
    let (digits, suffix) = split_integer_suffix(text);
    if digits.is_empty() {
        return Err(bad(word, "digits are missing"));
    }
    if digits.starts_with('_') {
        return Err(bad(word, "the first digit is missing"));
    }
    let mut magnitude = Some(0u64);
    for char in digits.chars().filter(|char| *char != '_') {
        let Some(digit) = char.to_digit(base) else {
            return Err(bad(word, why_no_digit(text, base)));
        };
        magnitude = magnitude.and_then(|value| value.checked_mul(u64::from(base))?.checked_add(u64::from(digit)));
    }
    let integer = magnitude.map(|magnitude| Integer { negative, magnitude, decimal: base == 10 && suffix.is_none(), suffix });
    let (least, most) = suffix.map_or((i64::MIN.into(), u64::MAX.into()), IntegerType::limits);
    match integer {
        Some(integer) if (least..=most).contains(&integer.value()) => Ok(Number::Integer(integer)),
        _ => match (suffix, base) {
            (Some(_), _) => Err(out_of_range(word, " of the type of its suffix")),
            (None, 10) => parse_float(word).map(|number| match number {
                Number::Float(float) => Number::Float(Float { whole: true, ..float }),
                Number::Integer(_) => number,
            }),
            (None, _) => Err(out_of_range(word, " of 64 bits")),
        },
    }
}

const TOO_WIDE: &str = "integers have at most 64 bits";

fn is_too_wide(text: &str) -> bool {
    text.ends_with("i128") || text.ends_with("u128")
}

fn why_no_float(text: &str) -> &'static str {
    match split_integer_suffix(text) {
        _ if is_too_wide(text) => TOO_WIDE,
        (digits, Some(_)) if digits.parse::<f64>().is_ok() => "it has a point or an exponent, and the suffix of an integer",
        _ => "this is no number, and names don't start like one",
    }
}

fn why_no_digit(text: &str, base: u32) -> &'static str {
    if is_too_wide(text) {
        return TOO_WIDE;
    }
    match base {
        2 => "a binary number has the digits 0 and 1",
        8 => "an octal number has the digits 0 to 7",
        16 => "a hexadecimal number has the digits 0 to 9 and a to f",
        _ => "a decimal number has the digits 0 to 9",
    }
}

fn parse_float(word: &str) -> Result<Number, SyntaxError> {
    let (digits, suffix) = match (word.strip_suffix("f32"), word.strip_suffix("f64")) {
        (Some(digits), _) => (digits, Some(FloatType::F32)),
        (None, Some(digits)) => (digits, Some(FloatType::F64)),
        (None, None) => (word, None),
    };
    let mut plain = String::with_capacity(digits.len());
    let mut underscore_allowed = false;
    for char in digits.chars() {
        match char {
            '_' if underscore_allowed => continue,
            '_' => return Err(bad(word, "an underscore stands behind a digit")),
            '0'..='9' | 'e' | 'E' => underscore_allowed = true,
            '.' => underscore_allowed = false,
            '+' | '-' => {}
            _ => return Err(bad(word, why_no_float(word))),
        }
        plain.push(char);
    }
    let (Ok(value), Ok(single)) = (plain.parse::<f64>(), plain.parse::<f32>()) else {
        return Err(bad(word, "the digits are incomplete"));
    };
    let value = if suffix == Some(FloatType::F32) { f64::from(single) } else { value };
    if value.is_infinite() {
        return Err(out_of_range(word, if suffix == Some(FloatType::F32) { " of f32" } else { " of f64" }));
    }
    Ok(Number::Float(Float { value, single, suffix, whole: false }))
}
