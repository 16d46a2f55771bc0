//! Goes on after a fault, so that all of a document's faults are reported at once.
//!
//! serde can't resume a type's visitor after an error. Maps, lists and unknown fields don't need that: their access reads the
//! next entry instead of failing (see [`super::access`]). Where a field of a struct fails, the value around it (the entry of a
//! map, the element of a list, or the document) is read again without that field. What then fails only because something was
//! left out is not reported. The values are thrown away in the end.
//!
//! Without a fault nothing is read twice. With faults, the nodes read are bounded by a multiple of the text's length.

use std::cell::{Cell, RefCell};
use std::collections::HashSet;

use serde::de::Deserialize;

use crate::diagnostic::Diagnostic;

use super::deserialize::NodeDeserializer;
use super::error::{MAX_PROBLEMS, sort_by_place};
use super::fault::{Fault, ReadError};
use super::tree::{Entry, Field, Node};

/// Reading stops being repeated once this many nodes per byte of text were read.
const WORK_PER_BYTE: u64 = 8;
/// A short text may always cost this much.
const LEAST_WORK: u64 = 20_000;

/// A part of the tree that can be left out: its address, which is stable while the tree is borrowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Unit(usize);

impl Unit {
    pub(super) fn field(field: &Field) -> Unit {
        Unit(std::ptr::from_ref(field).addr())
    }

    pub(super) fn entry(entry: &Entry) -> Unit {
        Unit(std::ptr::from_ref(entry).addr())
    }

    pub(super) fn element(node: &Node) -> Unit {
        Unit(std::ptr::from_ref(node).addr())
    }
}

/// What is shared by all layers that read one tree.
#[derive(Debug)]
pub(super) struct Context {
    /// Whether to go on after a fault.
    recovering: bool,
    found: RefCell<Vec<Diagnostic>>,
    left_out: RefCell<HashSet<Unit>>,
    /// The accepted fields that unknown ones were probably meant to be, with the first field of their struct.
    misspelt: RefCell<HashSet<(Unit, String)>>,
    /// Counts whatever was left out or reported, to see whether something inside a value was.
    damage: Cell<u64>,
    work: Cell<u64>,
    most_work: u64,
}

impl Context {
    fn new(root: &Node, recovering: bool) -> Context {
        let length = u64::from(root.span.end.saturating_sub(root.span.start));
        Context {
            recovering,
            found: RefCell::default(),
            left_out: RefCell::default(),
            misspelt: RefCell::default(),
            damage: Cell::new(0),
            work: Cell::new(0),
            most_work: length.saturating_mul(WORK_PER_BYTE).saturating_add(LEAST_WORK),
        }
    }

    /// Whether faults are kept here rather than returned.
    pub(super) fn is_recovering(&self) -> bool {
        self.recovering
    }

    /// Counts a node that is read.
    pub(super) fn count_work(&self) {
        self.work.set(self.work.get() + 1);
    }

    /// See [`Context::settle`].
    pub(super) fn damage(&self) -> u64 {
        self.damage.get()
    }

    fn add_damage(&self) {
        self.damage.set(self.damage.get() + 1);
    }

    /// Whether a unit is to be left out.
    pub(super) fn is_left_out(&self, unit: Unit) -> bool {
        if self.damage.get() == 0 {
            return false;
        }
        let left_out = self.left_out.borrow().contains(&unit);
        if left_out {
            self.add_damage();
        }
        left_out
    }

    /// Leaves a unit out from now on; false if it was already.
    pub(super) fn leave_out(&self, unit: Unit) -> bool {
        self.add_damage();
        self.left_out.borrow_mut().insert(unit)
    }

    /// Gives a fault its place. `damage` is that of before the node was read: complaints about the whole of a node, parts of
    /// which were left out, are not to be trusted.
    pub(super) fn settle(&self, mut error: ReadError, node: &Node, damage: u64) -> ReadError {
        if !error.has_place()
            && damage != self.damage.get()
            && matches!(error.fault(), Fault::Other(_) | Fault::WrongLength { .. } | Fault::InvalidValue { .. })
        {
            error.silence();
        }
        error.at_node(node)
    }

    /// Gives a fault of a struct its place. A field that is missing because it was left out or misspelt was reported already.
    pub(super) fn settle_struct(&self, mut error: ReadError, node: &Node, fields: &[Field], owner: &str, damage: u64) -> ReadError {
        if error.has_place() {
            return error;
        }
        if let Fault::MissingField { field, owner: missing_in } = error.fault_mut() {
            owner.clone_into(missing_in);
            let left_out = self.left_out.borrow();
            let reported = fields.iter().any(|present| *present.name.text == **field && left_out.contains(&Unit::field(present)))
                || fields.first().is_some_and(|first| self.misspelt.borrow().contains(&(Unit::field(first), field.clone())));
            if reported {
                error.silence();
            }
        }
        self.settle(error, node, damage)
    }

    /// Remembers which field an unknown one was probably meant to be.
    pub(super) fn note_misspelt(&self, fields: &[Field], meant: &str) {
        if let Some(first) = fields.first() {
            self.misspelt.borrow_mut().insert((Unit::field(first), meant.to_owned()));
        }
    }

    /// Keeps a fault.
    pub(super) fn report(&self, error: ReadError) {
        self.add_damage();
        let mut found = self.found.borrow_mut();
        if !error.is_silent() && found.len() < MAX_PROBLEMS {
            found.push(error.into_diagnostic());
        }
    }

    fn may_retry(&self) -> bool {
        self.work.get() < self.most_work && self.found.borrow().len() < MAX_PROBLEMS
    }
}

/// Reads a value; where it fails, reports all of its faults and returns `None`.
pub(super) fn attempt<'de, T: Deserialize<'de>>(node: &'de Node, context: &Context) -> Option<T> {
    let mut complete = true;
    loop {
        let damage = context.damage();
        match T::deserialize(NodeDeserializer::new(node, context)) {
            Ok(value) => return complete.then_some(value),
            Err(error) => {
                complete = false;
                let error = context.settle(error, node, damage);
                let unit = error.unit();
                context.report(error);
                match unit {
                    Some(unit) if context.leave_out(unit) && context.may_retry() => {}
                    _ => return None,
                }
            }
        }
    }
}

/// Reads a value of any type from a tree, with all of its faults.
///
/// # Errors
/// Wrong types, unknown and missing fields, unknown variants, numbers out of range, and what the types themselves check: each
/// with the place of the innermost value at which it happened, in the order of the text.
pub fn deserialize_document<'de, T: Deserialize<'de>>(node: &'de Node) -> Result<T, Vec<Diagnostic>> {
    let context = Context::new(node, true);
    let value = attempt(node, &context);
    let mut found = context.found.into_inner();
    match value {
        Some(value) if found.is_empty() => Ok(value),
        _ => {
            if found.is_empty() {
                // Only a type that hides its errors gets here.
                found.push(ReadError::new(Fault::Other("the value can't be read".to_owned())).at_node(node).into_diagnostic());
            }
            sort_by_place(&mut found);
            Err(found)
        }
    }
}

/// Reads a value of any type from a tree up to its first fault, for who only needs to know whether it fits.
///
/// # Errors
/// The first fault.
pub fn from_tree<'de, T: Deserialize<'de>>(node: &'de Node) -> Result<T, Box<Diagnostic>> {
    let context = Context::new(node, false);
    T::deserialize(NodeDeserializer::new(node, &context)).map_err(|error| Box::new(error.at_node(node).into_diagnostic()))
}
