//! Keys and fields that are there twice. Each time is linear, by hashing.

use std::collections::HashMap;
use std::collections::hash_map::Entry as Slot;

use super::error::{Problems, SyntaxError};
use super::tree::{Entry, Field, Key};

/// Reports every key that equals an earlier one of its map.
pub(super) fn report_duplicate_keys(entries: &[Entry], problems: &mut Problems) {
    if entries.len() < 2 {
        return;
    }
    let mut seen = HashMap::with_capacity(entries.len());
    for entry in entries {
        match seen.entry(Key(&entry.key)) {
            Slot::Vacant(slot) => {
                slot.insert(entry.key.span);
            }
            Slot::Occupied(slot) => {
                problems.report(entry.key.span, &SyntaxError::DuplicateKey { key: entry.key.describe(), first: *slot.get() });
            }
        }
    }
}

/// Reports every field whose name an earlier one of its struct has.
pub(super) fn report_duplicate_fields(fields: &[Field], problems: &mut Problems) {
    /// Up to here, comparing with each is faster than hashing.
    const FEW: usize = 8;
    let mut report = |field: &Field, first: &Field| {
        let error = SyntaxError::DuplicateField { field: field.name.text.to_string(), first: first.name.span };
        problems.report(field.name.span, &error);
    };
    if fields.len() <= FEW {
        for (index, field) in fields.iter().enumerate() {
            if let Some(first) = fields.iter().take(index).find(|first| first.name.text == field.name.text) {
                report(field, first);
            }
        }
        return;
    }
    let mut seen: HashMap<&str, &Field> = HashMap::with_capacity(fields.len());
    for field in fields {
        match seen.entry(&field.name.text) {
            Slot::Vacant(slot) => {
                slot.insert(field);
            }
            Slot::Occupied(slot) => report(field, slot.get()),
        }
    }
}
