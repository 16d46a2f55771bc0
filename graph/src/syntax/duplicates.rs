//! Keys and fields that are there twice. Each time is linear, by hashing.

use std::collections::HashMap;
use std::collections::hash_map::Entry as Slot;
use std::hash::{Hash, Hasher};

use super::error::{Problems, SyntaxError};
use super::tree::{Entry, Field, Name, Node, Value};

/// Up to here, comparing each with each is faster than hashing.
const FEW: usize = 8;

/// Reports every key that equals an earlier one of its map.
pub(super) fn report_duplicate_keys(entries: &[Entry], problems: &mut Problems) {
    each_duplicate(
        entries,
        |entry| Key(&entry.key),
        |again, first| {
            let error = SyntaxError::DuplicateKey { key: describe_key(&again.key), first: first.key.span };
            problems.report(again.key.span, &error);
        },
    );
}

/// Reports every field whose name an earlier one of its struct has.
pub(super) fn report_duplicate_fields(fields: &[Field], problems: &mut Problems) {
    each_duplicate(
        fields,
        |field| &*field.name.text,
        |again, first| {
            let error = SyntaxError::DuplicateField { field: again.name.text.to_string(), first: first.name.span };
            problems.report(again.name.span, &error);
        },
    );
}

/// Calls `found` with every item whose key an earlier one has, and the first that has it.
fn each_duplicate<'a, T, K: Eq + Hash>(items: &'a [T], key: impl Fn(&'a T) -> K, mut found: impl FnMut(&'a T, &'a T)) {
    if items.len() <= FEW {
        for (index, item) in items.iter().enumerate() {
            if let Some(first) = items.iter().take(index).find(|first| key(first) == key(item)) {
                found(item, first);
            }
        }
        return;
    }
    let mut seen = HashMap::with_capacity(items.len());
    for item in items {
        match seen.entry(key(item)) {
            Slot::Vacant(slot) => {
                slot.insert(item);
            }
            Slot::Occupied(slot) => found(item, slot.get()),
        }
    }
}

fn describe_key(key: &Node) -> String {
    match &key.value {
        Value::Str(text) => format!("the key {text:?}"),
        _ => format!("the same key, {},", key.describe()),
    }
}

/// A node compared and hashed as a map key: by value, places left out, numbers without the way in which they were written.
#[derive(Debug, Clone, Copy)]
struct Key<'a>(&'a Node);

impl PartialEq for Key<'_> {
    fn eq(&self, other: &Self) -> bool {
        let names = |a: &Option<Box<Name>>, b: &Option<Box<Name>>| a.as_ref().map(|name| &name.text) == b.as_ref().map(|name| &name.text);
        let nodes = |a: &[Node], b: &[Node]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| Key(a) == Key(b));
        match (&self.0.value, &other.0.value) {
            (Value::Unit, Value::Unit) => true,
            (Value::Bool(a), Value::Bool(b)) => a == b,
            (Value::Integer(a), Value::Integer(b)) => a.value() == b.value(),
            (Value::Float(a), Value::Float(b)) => a.value.to_bits() == b.value.to_bits(),
            (Value::Char(a), Value::Char(b)) => a == b,
            (Value::Str(a), Value::Str(b)) => a == b,
            (Value::Bytes(a), Value::Bytes(b)) => a == b,
            (Value::List(a), Value::List(b)) => nodes(a, b),
            (Value::Map(a), Value::Map(b)) => {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| Key(&a.key) == Key(&b.key) && Key(&a.value) == Key(&b.value))
            }
            (Value::Word(a), Value::Word(b)) => a.text == b.text,
            (Value::Tuple { name: a, items: x }, Value::Tuple { name: b, items: y }) => names(a, b) && nodes(x, y),
            (Value::Struct { name: a, fields: x }, Value::Struct { name: b, fields: y }) => {
                names(a, b)
                    && x.len() == y.len()
                    && x.iter().zip(y).all(|(x, y)| x.name.text == y.name.text && Key(&x.value) == Key(&y.value))
            }
            (Value::Range(a), Value::Range(b)) => {
                a.inclusive == b.inclusive
                    && a.start.as_ref().map(Key) == b.start.as_ref().map(Key)
                    && a.end.as_ref().map(Key) == b.end.as_ref().map(Key)
            }
            _ => false,
        }
    }
}

impl Eq for Key<'_> {}

impl Hash for Key<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        std::mem::discriminant(&self.0.value).hash(state);
        match &self.0.value {
            Value::Unit => {}
            Value::Bool(value) => value.hash(state),
            Value::Integer(integer) => integer.value().hash(state),
            Value::Float(float) => float.value.to_bits().hash(state),
            Value::Char(char) => char.hash(state),
            Value::Str(text) => text.hash(state),
            Value::Bytes(bytes) => bytes.hash(state),
            Value::List(items) => items.iter().for_each(|item| Key(item).hash(state)),
            Value::Map(entries) => entries.iter().for_each(|entry| {
                Key(&entry.key).hash(state);
                Key(&entry.value).hash(state);
            }),
            Value::Word(name) => name.text.hash(state),
            Value::Tuple { name, items } => {
                name.as_ref().map(|name| &name.text).hash(state);
                items.iter().for_each(|item| Key(item).hash(state));
            }
            Value::Struct { name, fields } => {
                name.as_ref().map(|name| &name.text).hash(state);
                fields.iter().for_each(|field| {
                    field.name.text.hash(state);
                    Key(&field.value).hash(state);
                });
            }
            Value::Range(range) => {
                range.start.as_ref().map(Key).hash(state);
                range.end.as_ref().map(Key).hash(state);
            }
        }
    }
}
