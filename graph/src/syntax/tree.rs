//! The tree of a RON text: every value, key, field name and variant name with its place.
//!
//! The tree says what was written, before any type is known: whether `Foo(1)` is a variant or a struct is for the reader to
//! decide. It is at most [`MAX_DEPTH`] levels deep where the parser made it, so that walking and dropping it can recurse.
//! Accepted downside: strings are copied out of the text, so that a tree outlives it.

use crate::source::Span;

/// How many brackets may be open at once.
pub const MAX_DEPTH: usize = 128;

/// A value and its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// From its first to its last character, name and brackets included.
    pub span: Span,
    /// What was written.
    pub value: Value,
}

/// What was written.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `()`, without anything between the brackets.
    Unit,
    /// `true`, `false`.
    Bool(bool),
    /// `12`, `0xFF`, `b'a'`.
    Integer(Integer),
    /// `0.5`, `1e3`, `inf`, `NaN`.
    Float(Float),
    /// `'a'`.
    Char(char),
    /// `"a"`, `r"a"`.
    Str(Box<str>),
    /// `b"a"`, `br"a"`.
    Bytes(Box<[u8]>),
    /// `[a, b]`.
    List(Vec<Node>),
    /// `{a: b}`.
    Map(Vec<Entry>),
    /// `Foo`: a variant or a struct without content, or `None`.
    Word(Name),
    /// `(a, b)`, `Foo(a, b)`, `Some(a)`.
    Tuple {
        /// What stands before the bracket. Boxed, since most have none.
        name: Option<Box<Name>>,
        /// The values.
        items: Vec<Node>,
    },
    /// `(a: b)`, `Foo(a: b)`.
    Struct {
        /// What stands before the bracket. Boxed, since most have none.
        name: Option<Box<Name>>,
        /// The fields. Never empty: an empty one is a `Tuple` or `Unit`.
        fields: Vec<Field>,
    },
    /// `a..b`, `a..=b`, `a..`, `..b`, `..=b`, `..`.
    Range(Box<Range>),
}

/// An identifier with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// Without the `r#` of a raw identifier.
    pub text: Box<str>,
    /// Where.
    pub span: Span,
    /// Whether it was written `r#name`, and so is never a keyword.
    pub raw: bool,
}

/// A field of a struct.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Its name.
    pub name: Name,
    /// Its value.
    pub value: Node,
}

/// An entry of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Any value.
    pub key: Node,
    /// Its value.
    pub value: Node,
}

/// The bounds of a range; they are numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Range {
    /// The lower bound.
    pub start: Option<Node>,
    /// The upper bound.
    pub end: Option<Node>,
    /// Whether it was written `..=`.
    pub inclusive: bool,
}

/// A whole number from `i64::MIN` to `u64::MAX`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Integer {
    /// Whether it had a minus sign; `-0` keeps it, since it may stand for a float.
    pub negative: bool,
    /// The absolute value.
    pub magnitude: u64,
    /// Whether it was written in base 10 and may stand for a float (`0x10` and `b'a'` may not).
    pub decimal: bool,
    /// The type that was written behind it.
    pub suffix: Option<IntegerType>,
}

impl Integer {
    /// The value, which every 64-bit type fits in.
    pub fn value(self) -> i128 {
        let magnitude = i128::from(self.magnitude);
        if self.negative { -magnitude } else { magnitude }
    }
}

/// The types that may be written behind an integer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum IntegerType {
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
}

impl IntegerType {
    /// All of them with their names.
    pub const ALL: [(&'static str, IntegerType); 8] = [
        ("i8", IntegerType::I8),
        ("i16", IntegerType::I16),
        ("i32", IntegerType::I32),
        ("i64", IntegerType::I64),
        ("u8", IntegerType::U8),
        ("u16", IntegerType::U16),
        ("u32", IntegerType::U32),
        ("u64", IntegerType::U64),
    ];

    /// As it is written.
    pub fn name(self) -> &'static str {
        IntegerType::ALL.iter().find(|(_, each)| *each == self).map_or("", |(name, _)| name)
    }

    /// Smallest and largest value.
    pub fn limits(self) -> (i128, i128) {
        match self {
            IntegerType::I8 => (i8::MIN.into(), i8::MAX.into()),
            IntegerType::I16 => (i16::MIN.into(), i16::MAX.into()),
            IntegerType::I32 => (i32::MIN.into(), i32::MAX.into()),
            IntegerType::I64 => (i64::MIN.into(), i64::MAX.into()),
            IntegerType::U8 => (0, u8::MAX.into()),
            IntegerType::U16 => (0, u16::MAX.into()),
            IntegerType::U32 => (0, u32::MAX.into()),
            IntegerType::U64 => (0, u64::MAX.into()),
        }
    }
}

/// A number with a point or an exponent, an infinity, NaN, or a whole number beyond 64 bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Float {
    /// The nearest `f64`.
    pub value: f64,
    /// The nearest `f32` of the same digits (rounding twice could miss it).
    pub single: f32,
    /// The type that was written behind it.
    pub suffix: Option<FloatType>,
    /// Whether it was written as a whole number, which 64 bits don't hold.
    pub whole: bool,
}

/// The types that may be written behind a float.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum FloatType {
    F32,
    F64,
}

impl FloatType {
    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            FloatType::F32 => "f32",
            FloatType::F64 => "f64",
        }
    }
}

impl Node {
    /// The name before the brackets, or the bare word.
    pub fn name(&self) -> Option<&Name> {
        match &self.value {
            Value::Word(name) => Some(name),
            Value::Tuple { name, .. } | Value::Struct { name, .. } => name.as_deref(),
            _ => None,
        }
    }

    /// Where to point for the value as a whole: its name, else its first character.
    pub fn head(&self) -> Span {
        match (self.name(), &self.value) {
            (Some(name), _) => name.span,
            (None, Value::Unit | Value::List(_) | Value::Map(_) | Value::Tuple { .. } | Value::Struct { .. }) => {
                Span { end: self.span.end.min(self.span.start.saturating_add(1)), ..self.span }
            }
            _ => self.span,
        }
    }

    /// What it is, for messages: ``the string "a"``, ``a list``.
    pub fn describe(&self) -> String {
        match &self.value {
            Value::Unit => "`()`".to_owned(),
            Value::Bool(value) => format!("`{value}`"),
            Value::Integer(integer) => match integer.suffix {
                Some(suffix) => format!("the integer {} of type {}", integer.value(), suffix.name()),
                None => format!("the integer {}", integer.value()),
            },
            Value::Float(float) => match float.suffix {
                Some(suffix) => format!("the number {} of type {}", float.value, suffix.name()),
                None => format!("the number {}", float.value),
            },
            Value::Char(char) => format!("the character {char:?}"),
            Value::Str(text) => {
                let mut start: String = text.chars().take(32).collect();
                if start.len() < text.len() {
                    start.push_str("...");
                }
                format!("the string {start:?}")
            }
            Value::Bytes(_) => "a byte string".to_owned(),
            Value::List(_) => "a list".to_owned(),
            Value::Map(_) => "a map".to_owned(),
            Value::Word(name) => format!("the word `{}`", name.text),
            Value::Tuple { name: Some(name), .. } | Value::Struct { name: Some(name), .. } => format!("`{}(..)`", name.text),
            Value::Tuple { name: None, .. } => "a tuple".to_owned(),
            Value::Struct { name: None, .. } => "a struct".to_owned(),
            Value::Range(_) => "a range".to_owned(),
        }
    }
}
