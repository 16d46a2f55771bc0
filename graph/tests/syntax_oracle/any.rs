//! A value of any type, as both readers see it.

use std::fmt;

use serde::de::{self, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// Any value; numbers of all widths are alike.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Any {
    Unit,
    Bool(bool),
    Integer(i128),
    Float(u64),
    Char(char),
    Text(String),
    Bytes(Vec<u8>),
    Nothing,
    Something(Box<Any>),
    List(Vec<Any>),
    Map(Vec<(Any, Any)>),
}

impl Any {
    fn float(value: f64) -> Any {
        Any::Float(if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() })
    }
}

impl<'de> Deserialize<'de> for Any {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Any, D::Error> {
        struct AnyVisitor;
        macro_rules! visit {
            ($($method:ident($type:ty) $make:expr;)*) => {
                $(fn $method<E: de::Error>(self, value: $type) -> Result<Any, E> {
                    Ok($make(value))
                })*
            };
        }
        impl<'de> Visitor<'de> for AnyVisitor {
            type Value = Any;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("anything")
            }
            visit! {
                visit_bool(bool) Any::Bool;
                visit_i8(i8) |value| Any::Integer(i128::from(value));
                visit_i16(i16) |value| Any::Integer(i128::from(value));
                visit_i32(i32) |value| Any::Integer(i128::from(value));
                visit_i64(i64) |value| Any::Integer(i128::from(value));
                visit_u8(u8) |value| Any::Integer(i128::from(value));
                visit_u16(u16) |value| Any::Integer(i128::from(value));
                visit_u32(u32) |value| Any::Integer(i128::from(value));
                visit_u64(u64) |value| Any::Integer(i128::from(value));
                visit_f32(f32) |value| Any::float(f64::from(value));
                visit_f64(f64) Any::float;
                visit_char(char) Any::Char;
                visit_str(&str) |value: &str| Any::Text(value.to_owned());
                visit_bytes(&[u8]) |value: &[u8]| Any::Bytes(value.to_vec());
            }
            fn visit_unit<E: de::Error>(self) -> Result<Any, E> {
                Ok(Any::Unit)
            }
            fn visit_none<E: de::Error>(self) -> Result<Any, E> {
                Ok(Any::Nothing)
            }
            fn visit_some<D: Deserializer<'de>>(self, inner: D) -> Result<Any, D::Error> {
                Any::deserialize(inner).map(|value| Any::Something(Box::new(value)))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Any, A::Error> {
                let mut items = Vec::new();
                while let Some(item) = access.next_element()? {
                    items.push(item);
                }
                Ok(Any::List(items))
            }
            fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Any, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = access.next_entry()? {
                    entries.push(entry);
                }
                Ok(Any::Map(entries))
            }
        }
        deserializer.deserialize_any(AnyVisitor)
    }
}
