//! How serde's visitors look into a variant of an enum.

use serde::de::{self, DeserializeSeed, Deserializer, EnumAccess, MapAccess, Visitor};

use super::access::NameDeserializer;
use super::deserialize::NodeDeserializer;
use super::fault::{Fault, ReadError, values};
use super::recover::Context;
use super::tree::{Name, Node, Value};

/// A variant inside of an untagged enum: a map from its name to its content.
pub(super) struct ContentAccess<'de, 'c> {
    name: Option<&'de Name>,
    node: &'de Node,
    context: &'c Context,
}

impl<'de, 'c> ContentAccess<'de, 'c> {
    pub(super) fn new(name: &'de Name, node: &'de Node, context: &'c Context) -> ContentAccess<'de, 'c> {
        ContentAccess { name: Some(name), node, context }
    }
}

impl<'de> MapAccess<'de> for ContentAccess<'de, '_> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, ReadError> {
        self.name.take().map(|name| seed.deserialize(NameDeserializer::new(&name.text, name.span))).transpose()
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Tuple { items, .. } if let [item] = items.as_slice() => seed.deserialize(NodeDeserializer::new(item, self.context)),
            _ => seed.deserialize(NodeDeserializer::without_name(self.node, self.context)),
        }
    }
}

/// A variant and its content.
pub(super) struct VariantAccess<'de, 'c> {
    node: &'de Node,
    variant: NameDeserializer<'de>,
    context: &'c Context,
    /// The name of the enum, for messages.
    owner: &'static str,
}

impl<'de, 'c> VariantAccess<'de, 'c> {
    pub(super) fn new(
        node: &'de Node,
        variant: NameDeserializer<'de>,
        context: &'c Context,
        owner: &'static str,
    ) -> VariantAccess<'de, 'c> {
        VariantAccess { node, variant, context, owner }
    }

    fn wrong_content<T>(&self, expected: &str) -> Result<T, ReadError> {
        let name = self.variant.text;
        let found = match &self.node.value {
            Value::Tuple { items, .. } if items.is_empty() => "empty brackets".to_owned(),
            Value::Tuple { items, .. } => values(items.len()),
            Value::Struct { .. } => "named fields".to_owned(),
            _ => "nothing".to_owned(),
        };
        let fault = Fault::WrongType { expected: format!("{expected} behind `{name}`"), found };
        Err(ReadError::new(fault).at(self.variant.span))
    }
}

impl<'de> EnumAccess<'de> for VariantAccess<'de, '_> {
    type Error = ReadError;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), ReadError> {
        match seed.deserialize(self.variant) {
            Ok(value) => Ok((value, self)),
            Err(mut error) => {
                if let Fault::UnknownVariant { owner, .. } = error.fault_mut() {
                    self.owner.clone_into(owner);
                }
                Err(error.at(self.variant.span))
            }
        }
    }
}

impl<'de> de::VariantAccess<'de> for VariantAccess<'de, '_> {
    type Error = ReadError;

    fn unit_variant(self) -> Result<(), ReadError> {
        match self.node.value {
            Value::Word(_) | Value::Bool(_) => Ok(()),
            _ => self.wrong_content("nothing"),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, ReadError> {
        match &self.node.value {
            Value::Tuple { items, .. } if let [item] = items.as_slice() => {
                let damage = self.context.damage();
                seed.deserialize(NodeDeserializer::new(item, self.context)).map_err(|error| self.context.settle(error, item, damage))
            }
            _ => self.wrong_content("one value"),
        }
    }

    fn tuple_variant<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Tuple { .. } => NodeDeserializer::without_name(self.node, self.context).deserialize_tuple(length, visitor),
            _ => self.wrong_content(&values(length)),
        }
    }

    fn struct_variant<V: Visitor<'de>>(self, _fields: &'static [&'static str], visitor: V) -> Result<V::Value, ReadError> {
        match &self.node.value {
            Value::Tuple { items, .. } if !items.is_empty() => self.wrong_content("named fields `(name: value)`"),
            Value::Struct { .. } | Value::Tuple { .. } => {
                NodeDeserializer::without_name(self.node, self.context).fields(self.variant.text, visitor)
            }
            _ => self.wrong_content("named fields `(name: value)`"),
        }
    }
}
