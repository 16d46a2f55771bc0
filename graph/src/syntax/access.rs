//! How serde's visitors walk through lists, maps and structs.
//!
//! Where a visitor asks for a whole entry or element of a map or list, one that fails is reported and the next one is given
//! instead, and so is an unknown field of a struct. Elements of tuples have a position, so that none is passed over.

use std::marker::PhantomData;

use serde::de::value::BorrowedStrDeserializer;
use serde::de::{self, Deserialize, DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use serde::forward_to_deserialize_any;

use crate::diagnostic::nearest;
use crate::source::Span;

use super::deserialize::NodeDeserializer;
use super::fault::{Fault, ReadError};
use super::recover::{Context, Unit, attempt};
use super::spanned::{SPANNED_NAME, visit_spanned};
use super::tree::{Entry, Field, Node, Range};

/// A key and a value: a field of a struct or an entry of a map.
pub(super) trait Pair: Sized {
    fn unit(&self) -> Unit;
    fn value(&self) -> &Node;
    fn read_key<'de, K: DeserializeSeed<'de>>(&'de self, seed: K, context: &Context) -> Result<K::Value, ReadError>;
    /// The fields, if they are such.
    fn as_fields(pairs: &[Self]) -> &[Field];
}

impl Pair for Field {
    fn unit(&self) -> Unit {
        Unit::field(self)
    }

    fn value(&self) -> &Node {
        &self.value
    }

    fn read_key<'de, K: DeserializeSeed<'de>>(&'de self, seed: K, _context: &Context) -> Result<K::Value, ReadError> {
        seed.deserialize(NameDeserializer::new(&self.name.text, self.name.span)).map_err(|error| error.at(self.name.span))
    }

    fn as_fields(pairs: &[Field]) -> &[Field] {
        pairs
    }
}

impl Pair for Entry {
    fn unit(&self) -> Unit {
        Unit::entry(self)
    }

    fn value(&self) -> &Node {
        &self.value
    }

    fn read_key<'de, K: DeserializeSeed<'de>>(&'de self, seed: K, context: &Context) -> Result<K::Value, ReadError> {
        seed.deserialize(NodeDeserializer::new(&self.key, context)).map_err(|error| error.at_node(&self.key))
    }

    fn as_fields(_pairs: &[Entry]) -> &[Field] {
        &[]
    }
}

/// Walks through the fields of a struct or the entries of a map.
pub(super) struct PairAccess<'de, 'c, P> {
    pairs: &'de [P],
    left: std::slice::Iter<'de, P>,
    pending: Option<&'de P>,
    context: &'c Context,
    /// The name of the struct, for messages.
    owner: &'c str,
}

impl<'de, 'c, P: Pair> PairAccess<'de, 'c, P> {
    pub(super) fn new(pairs: &'de [P], context: &'c Context, owner: &'c str) -> PairAccess<'de, 'c, P> {
        PairAccess { pairs, left: pairs.iter(), pending: None, context, owner }
    }

    fn next_pair(&mut self) -> Option<&'de P> {
        let context = self.context;
        self.left.find(|pair| !context.is_left_out(pair.unit()))
    }

    fn key<K: DeserializeSeed<'de>>(&self, pair: &'de P, seed: K) -> Result<K::Value, ReadError> {
        pair.read_key(seed, self.context).map_err(|mut error| {
            if let Fault::UnknownField { owner, .. } = error.fault_mut() {
                self.owner.clone_into(owner);
            }
            error.within(pair.unit())
        })
    }

    /// The next key, with those that fail reported.
    fn next_good_key<K: Deserialize<'de>>(&mut self) -> Option<(K, &'de P)> {
        while let Some(pair) = self.next_pair() {
            match self.key(pair, PhantomData::<K>) {
                Ok(key) => return Some((key, pair)),
                Err(error) => {
                    if let Fault::UnknownField { field, accepted, .. } = error.fault()
                        && let Some(meant) = nearest(field, accepted.iter().copied())
                    {
                        self.context.note_misspelt(P::as_fields(self.pairs), meant);
                    }
                    self.context.report(error);
                    self.context.leave_out(pair.unit());
                }
            }
        }
        None
    }

    fn value<V: DeserializeSeed<'de>>(&self, pair: &'de P, seed: V) -> Result<V::Value, ReadError> {
        let damage = self.context.damage();
        seed.deserialize(NodeDeserializer::new(pair.value(), self.context))
            .map_err(|error| self.context.settle(error, pair.value(), damage).within(pair.unit()))
    }
}

impl<'de, P: Pair> MapAccess<'de> for PairAccess<'de, '_, P> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, ReadError> {
        let Some(pair) = self.next_pair() else { return Ok(None) };
        self.pending = Some(pair);
        self.key(pair, seed).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, ReadError> {
        match self.pending.take() {
            Some(pair) => self.value(pair, seed),
            None => Err(de::Error::custom("a value was asked for without its key")),
        }
    }

    fn next_key<K: Deserialize<'de>>(&mut self) -> Result<Option<K>, ReadError> {
        if !self.context.is_recovering() {
            return self.next_key_seed(PhantomData);
        }
        let next = self.next_good_key();
        self.pending = next.as_ref().map(|(_, pair)| *pair);
        Ok(next.map(|(key, _)| key))
    }

    fn next_entry<K: Deserialize<'de>, V: Deserialize<'de>>(&mut self) -> Result<Option<(K, V)>, ReadError> {
        if !self.context.is_recovering() {
            return self.next_entry_seed(PhantomData, PhantomData);
        }
        while let Some((key, pair)) = self.next_good_key() {
            match attempt(pair.value(), self.context) {
                Some(value) => return Ok(Some((key, value))),
                None => {
                    self.context.leave_out(pair.unit());
                }
            }
        }
        Ok(None)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.left.len())
    }
}

/// Walks through the elements of a list or tuple.
pub(super) struct SequenceAccess<'de, 'c> {
    left: std::slice::Iter<'de, Node>,
    context: &'c Context,
    recovers: bool,
}

impl<'de, 'c> SequenceAccess<'de, 'c> {
    pub(super) fn new(items: &'de [Node], context: &'c Context, recovers: bool) -> SequenceAccess<'de, 'c> {
        SequenceAccess { left: items.iter(), context, recovers: recovers && context.is_recovering() }
    }

    /// How many elements the visitor did not take.
    pub(super) fn left(&self) -> usize {
        self.left.len()
    }
}

impl<'de> SeqAccess<'de> for &mut SequenceAccess<'de, '_> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, ReadError> {
        let Some(node) = self.left.next() else { return Ok(None) };
        let damage = self.context.damage();
        match seed.deserialize(NodeDeserializer::new(node, self.context)) {
            Ok(value) => Ok(Some(value)),
            Err(error) => Err(self.context.settle(error, node, damage)),
        }
    }

    fn next_element<T: Deserialize<'de>>(&mut self) -> Result<Option<T>, ReadError> {
        if !self.recovers {
            return self.next_element_seed(PhantomData);
        }
        let context = self.context;
        while let Some(node) = self.left.find(|node| !context.is_left_out(Unit::element(node))) {
            match attempt(node, context) {
                Some(value) => return Ok(Some(value)),
                None => {
                    context.leave_out(Unit::element(node));
                }
            }
        }
        Ok(None)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.left.len())
    }
}

/// The bounds of a range, as the fields `start` and `end`.
pub(super) struct RangeAccess<'de, 'c> {
    left: [Option<(&'static str, &'de Node)>; 2],
    pending: Option<&'de Node>,
    context: &'c Context,
}

impl<'de, 'c> RangeAccess<'de, 'c> {
    pub(super) fn new(range: &'de Range, context: &'c Context) -> RangeAccess<'de, 'c> {
        let bound = |name, node: &'de Option<Node>| node.as_ref().map(|node| (name, node));
        RangeAccess { left: [bound("start", &range.start), bound("end", &range.end)], pending: None, context }
    }
}

impl<'de> MapAccess<'de> for RangeAccess<'de, '_> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, ReadError> {
        let Some((name, node)) = self.left.iter_mut().find_map(Option::take) else { return Ok(None) };
        self.pending = Some(node);
        seed.deserialize(NameDeserializer::new(name, node.span)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, ReadError> {
        match self.pending.take() {
            Some(node) => seed.deserialize(NodeDeserializer::new(node, self.context)).map_err(|error| error.at_node(node)),
            None => Err(de::Error::custom("a value was asked for without its key")),
        }
    }
}

/// Reads the name of a field or variant.
#[derive(Debug, Clone, Copy)]
pub(super) struct NameDeserializer<'de> {
    pub(super) text: &'de str,
    pub(super) span: Span,
}

impl<'de> NameDeserializer<'de> {
    pub(super) fn new(text: &'de str, span: Span) -> NameDeserializer<'de> {
        NameDeserializer { text, span }
    }
}

impl<'de> Deserializer<'de> for NameDeserializer<'de> {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_borrowed_str(self.text)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Result<V::Value, ReadError> {
        if name == SPANNED_NAME { visit_spanned(visitor, self.span, self) } else { visitor.visit_newtype_struct(self) }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_some(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        visitor.visit_enum(BorrowedStrDeserializer::new(self.text))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map struct identifier ignored_any
    }
}
