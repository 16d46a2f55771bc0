//! A serde deserializer over the tree.
//!
//! Which text stands for which type is as in the `ron` crate with `implicit_some` and `unwrap_newtypes`: newtype structs are
//! transparent, any value is `Some` of itself, structs may be named. Numbers are checked against the type that asks, never
//! wrapped; a decimal integer may stand for a float.

use serde::de::{Deserializer, Visitor};

use crate::diagnostic::nearest;

use super::access::{NameDeserializer, PairAccess, RangeAccess, SequenceAccess};
use super::fault::{Fault, ReadError, values};
use super::fit::{fit_f32, fit_f64, fit_integer};
use super::recover::Context;
use super::spanned::{SPANNED_NAME, visit_spanned};
use super::tree::{FloatType, IntegerType, Name, Node, Range, Value};
use super::variant::{ContentAccess, VariantAccess};

/// How often a type may ask again for the same value, as `Option` and newtypes do.
const MAX_WRAPS: u8 = 64;

/// Reads one node.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeDeserializer<'de, 'c> {
    pub(super) node: &'de Node,
    pub(super) context: &'c Context,
    /// Whether the name before the brackets was read already.
    name_taken: bool,
    wraps: u8,
}

impl<'de, 'c> NodeDeserializer<'de, 'c> {
    pub(super) fn new(node: &'de Node, context: &'c Context) -> NodeDeserializer<'de, 'c> {
        context.count_work();
        NodeDeserializer { node, context, name_taken: false, wraps: 0 }
    }

    /// The content of a variant, as a value of its own.
    pub(super) fn without_name(node: &'de Node, context: &'c Context) -> NodeDeserializer<'de, 'c> {
        NodeDeserializer { name_taken: true, ..NodeDeserializer::new(node, context) }
    }

    /// The same value for a type inside of the type that asked.
    fn wrapped(self) -> Result<NodeDeserializer<'de, 'c>, ReadError> {
        if self.wraps >= MAX_WRAPS {
            return Err(ReadError::new(Fault::EndlessType).at_node(self.node));
        }
        Ok(NodeDeserializer { wraps: self.wraps + 1, ..self })
    }

    /// Whether the value is, or starts with, a keyword.
    fn is_keyword(self, keyword: &str) -> bool {
        !self.name_taken && self.node.name().is_some_and(|name| !name.raw && *name.text == *keyword)
    }

    /// Runs a visitor; its own errors get the place of this node.
    fn visit<T>(self, visit: impl FnOnce() -> Result<T, ReadError>) -> Result<T, ReadError> {
        let damage = self.context.damage();
        visit().map_err(|error| self.context.settle(error, self.node, damage))
    }

    fn wrong_type<T>(self, visitor: &dyn serde::de::Expected, hint: Option<String>) -> Result<T, ReadError> {
        Err(ReadError::wrong_type(self.node, visitor, hint))
    }

    fn sequence<V: Visitor<'de>>(self, items: &'de [Node], recovers: bool, visitor: V) -> Result<V::Value, ReadError> {
        self.visit(|| {
            let mut access = SequenceAccess::new(items, self.context, recovers);
            let value = visitor.visit_seq(&mut access)?;
            match access.left() {
                0 => Ok(value),
                left => Err(ReadError::new(Fault::WrongLength {
                    expected: values(items.len().saturating_sub(left)),
                    found: values(items.len()),
                })),
            }
        })
    }

    /// The fields as a struct of the name, which is for messages.
    pub(super) fn fields<V: Visitor<'de>>(self, name: &str, visitor: V) -> Result<V::Value, ReadError> {
        let owner = self.node.name().map_or(name, |name| &name.text);
        let fields = match &self.node.value {
            Value::Unit => &[][..],
            Value::Tuple { items, .. } if items.is_empty() => &[][..],
            Value::Struct { fields, .. } => fields,
            _ => {
                let hint = match self.node.value {
                    Value::Map(_) => Some("structs are written `(name: value)`".to_owned()),
                    Value::Tuple { .. } => Some("its fields are named: `(name: value)`".to_owned()),
                    _ => None,
                };
                return self.wrong_type(&visitor, hint);
            }
        };
        let damage = self.context.damage();
        visitor
            .visit_map(PairAccess::new(fields, self.context, owner))
            .map_err(|error| self.context.settle_struct(error, self.node, fields, owner, damage))
    }

    /// Whether the name before the brackets, if any, is that of the type.
    fn check_name(self, wanted: &'static str) -> Result<(), ReadError> {
        match self.node.name() {
            Some(name) if *name.text != *wanted && !self.name_taken => {
                let fault = Fault::WrongName { expected: wanted, found: name.text.to_string() };
                Err(ReadError::new(fault).at(name.span))
            }
            _ => Ok(()),
        }
    }

    fn range<V: Visitor<'de>>(self, range: &'de Range, visitor: V) -> Result<V::Value, ReadError> {
        self.visit(|| visitor.visit_map(RangeAccess::new(range, self.context)))
    }

    /// The tuple or struct behind a name, with the name left out.
    fn any_content<V: Visitor<'de>>(self, name: Option<&'de Name>, visitor: V) -> Result<V::Value, ReadError> {
        // serde buffers the value of an untagged enum and needs to find variants in it, as in JSON.
        match (name, &self.node.value) {
            (Some(name), _) if buffers_for_serde::<V::Value>() && !self.name_taken => {
                self.visit(|| visitor.visit_map(ContentAccess::new(name, self.node, self.context)))
            }
            (_, Value::Tuple { items, .. }) => self.sequence(items, false, visitor),
            _ => self.fields("", visitor),
        }
    }
}

/// Whether a value is only kept for serde's own use. Type names have no promise; where they change, variants inside of untagged
/// enums are no longer found, and nothing else happens.
fn buffers_for_serde<T>() -> bool {
    let name = std::any::type_name::<T>();
    name.starts_with("serde") && (name.contains("::Content") || name.contains("::TagOrContent"))
}

macro_rules! integers {
    ($($method:ident $visit:ident $wanted:ident $type:ty)*) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
            let value = fit_integer(self.node, IntegerType::$wanted, &visitor)?;
            // The range was checked, so that the default is never used.
            self.visit(|| visitor.$visit(<$type>::try_from(value).unwrap_or_default()))
        })*
    };
}

impl<'de> Deserializer<'de> for NodeDeserializer<'de, '_> {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Unit => self.visit(|| visitor.visit_unit()),
            Value::Bool(value) => self.visit(|| visitor.visit_bool(*value)),
            Value::Integer(integer) => self.visit(|| match i64::try_from(integer.value()) {
                Ok(value) if integer.negative => visitor.visit_i64(value),
                _ => visitor.visit_u64(integer.magnitude),
            }),
            Value::Float(float) => self.visit(|| match float.suffix {
                Some(FloatType::F32) => visitor.visit_f32(float.single),
                _ => visitor.visit_f64(float.value),
            }),
            Value::Char(char) => self.visit(|| visitor.visit_char(*char)),
            Value::Str(text) => self.visit(|| visitor.visit_borrowed_str(text)),
            Value::Bytes(bytes) => self.visit(|| visitor.visit_borrowed_bytes(bytes)),
            Value::List(_) => self.deserialize_seq(visitor),
            Value::Map(_) => self.deserialize_map(visitor),
            _ if self.is_keyword("Some") || self.is_keyword("None") => self.deserialize_option(visitor),
            Value::Word(name) if buffers_for_serde::<V::Value>() => self.visit(|| visitor.visit_borrowed_str(&name.text)),
            Value::Word(_) => self.visit(|| visitor.visit_unit()),
            Value::Tuple { name, .. } | Value::Struct { name, .. } => self.any_content(name.as_deref(), visitor),
            Value::Range(range) if range.start.is_none() && range.end.is_none() => self.visit(|| visitor.visit_unit()),
            Value::Range(range) => self.range(range, visitor),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Bool(value) => self.visit(|| visitor.visit_bool(*value)),
            Value::Word(name) => {
                let hint = nearest(&name.text, ["true", "false"]).map(|word| format!("did you mean `{word}`?"));
                self.wrong_type(&visitor, hint)
            }
            _ => self.wrong_type(&visitor, None),
        }
    }

    integers! {
        deserialize_i8 visit_i8 I8 i8
        deserialize_i16 visit_i16 I16 i16
        deserialize_i32 visit_i32 I32 i32
        deserialize_i64 visit_i64 I64 i64
        deserialize_u8 visit_u8 U8 u8
        deserialize_u16 visit_u16 U16 u16
        deserialize_u32 visit_u32 U32 u32
        deserialize_u64 visit_u64 U64 u64
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        let value = fit_f32(self.node, &visitor)?;
        self.visit(|| visitor.visit_f32(value))
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        let value = fit_f64(self.node, &visitor)?;
        self.visit(|| visitor.visit_f64(value))
    }

    fn deserialize_char<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Char(char) => self.visit(|| visitor.visit_char(*char)),
            Value::Str(_) => self.wrong_type(&visitor, Some("a character has single quotes: `'a'`".to_owned())),
            _ => self.wrong_type(&visitor, None),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Str(text) => self.visit(|| visitor.visit_borrowed_str(text)),
            Value::Word(name) => self.wrong_type(&visitor, Some(format!("strings have quotes: `\"{}\"`", name.text))),
            Value::Char(_) => self.wrong_type(&visitor, Some("strings have double quotes".to_owned())),
            _ => self.wrong_type(&visitor, None),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_bytes<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Bytes(bytes) => self.visit(|| visitor.visit_borrowed_bytes(bytes)),
            Value::List(items) => {
                let byte = |item| fit_integer(item, IntegerType::U8, &"a byte").map(|byte| u8::try_from(byte).unwrap_or_default());
                let bytes = items.iter().map(byte);
                let bytes = bytes.collect::<Result<Vec<u8>, ReadError>>()?;
                self.visit(|| visitor.visit_byte_buf(bytes))
            }
            Value::Str(_) => self.wrong_type(&visitor, Some("byte strings are written `b\"..\"`".to_owned())),
            _ => self.wrong_type(&visitor, None),
        }
    }

    fn deserialize_byte_buf<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.deserialize_bytes(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Word(_) if self.is_keyword("None") => self.visit(|| visitor.visit_none()),
            Value::Tuple { items, .. }
                if self.is_keyword("Some")
                    && let [item] = items.as_slice() =>
            {
                self.visit(|| visitor.visit_some(NodeDeserializer::new(item, self.context)))
            }
            _ if self.is_keyword("Some") || self.is_keyword("None") => self.wrong_type(&"`None` or `Some(..)` with one value", None),
            _ => {
                let inner = self.wrapped()?;
                self.visit(|| visitor.visit_some(inner))
            }
        }
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Unit => self.visit(|| visitor.visit_unit()),
            _ => self.wrong_type(&visitor, None),
        }
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Word(_) => {
                self.check_name(name)?;
                self.visit(|| visitor.visit_unit())
            }
            Value::Range(range) if name == "RangeFull" && range.start.is_none() && range.end.is_none() => {
                self.visit(|| visitor.visit_unit())
            }
            _ => self.deserialize_unit(visitor),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Result<V::Value, ReadError> {
        let inner = self.wrapped()?;
        if name == SPANNED_NAME {
            return self.visit(|| visit_spanned(visitor, self.node.span, inner));
        }
        self.visit(|| visitor.visit_newtype_struct(inner))
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::List(items) => self.sequence(items, true, visitor),
            Value::Unit | Value::Tuple { name: None, .. } => self.wrong_type(&visitor, Some("write `[..]` instead of `(..)`".to_owned())),
            _ => self.wrong_type(&visitor, None),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _length: usize, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Unit => self.sequence(&[], false, visitor),
            Value::Tuple { name, items } if name.is_none() || self.name_taken => self.sequence(items, false, visitor),
            Value::List(_) => self.wrong_type(&visitor, Some("a fixed number of values is written `(..)`".to_owned())),
            _ => self.wrong_type(&visitor, None),
        }
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(self, name: &'static str, length: usize, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Tuple { items, .. } => {
                self.check_name(name)?;
                self.sequence(items, false, visitor)
            }
            _ => self.deserialize_tuple(length, visitor),
        }
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Map(entries) => self.visit(|| visitor.visit_map(PairAccess::new(entries, self.context, ""))),
            Value::Unit | Value::Struct { .. } => self.wrong_type(&visitor, Some("maps are written `{\"key\": value}`".to_owned())),
            _ => self.wrong_type(&visitor, None),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        accepted: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        if let Value::Range(range) = &self.node.value {
            let fits = match (name, accepted) {
                ("Range", ["start", "end"]) => range.start.is_some() && range.end.is_some() && !range.inclusive,
                ("RangeInclusive", ["start", "end"]) => range.start.is_some() && range.end.is_some() && range.inclusive,
                ("RangeFrom", ["start"]) => range.start.is_some() && range.end.is_none(),
                ("RangeTo", ["end"]) => range.start.is_none() && range.end.is_some() && !range.inclusive,
                ("RangeToInclusive", ["end"]) => range.start.is_none() && range.end.is_some() && range.inclusive,
                _ => false,
            };
            return if fits { self.range(range, visitor) } else { self.wrong_type(&visitor, None) };
        }
        if matches!(self.node.value, Value::Struct { .. } | Value::Tuple { .. }) {
            self.check_name(name)?;
        }
        self.fields(name, visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        let (variant, span) = match (&self.node.value, self.node.name()) {
            (_, Some(name)) => (&*name.text, name.span),
            (Value::Bool(true), _) => ("true", self.node.span),
            (Value::Bool(false), _) => ("false", self.node.span),
            (Value::Str(text), _) => {
                let known = variants.iter().find(|variant| ***variant == **text);
                return self.wrong_type(&visitor, known.map(|variant| format!("variants have no quotes: `{variant}`")));
            }
            _ => return self.wrong_type(&visitor, None),
        };
        let access = VariantAccess::new(self.node, NameDeserializer::new(variant, span), self.context, name);
        self.visit(|| visitor.visit_enum(access))
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Word(name) => self.visit(|| visitor.visit_borrowed_str(&name.text)),
            _ => self.deserialize_str(visitor),
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_unit()
    }
}
