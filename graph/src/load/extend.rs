//! A pipeline that extends another: what the other has, with entries replaced, removed, inserted and added.
//!
//! What is inserted or replaces something stands at a place of the other's list, as if it had been written there: that decides where
//! several passes modify one part. Passes of blocks are reached by `block.pass`, those of loops by `loop.pass`.

use std::collections::BTreeMap;

use super::Loaded;
use super::error::LoadError;
use crate::diagnostic::Diagnostic;
use crate::source::{FileId, Span};
use crate::syntax::document::{Document, Entries, ExtendDoc, PassDoc, Text};

/// Works `own` into what it extends.
pub(super) fn extend(base: Loaded, own: Loaded, changes: &ExtendDoc, problems: &mut Vec<Diagnostic>) -> Loaded {
    let mut merge = Merge { base: &changes.file.value, problems };
    let Loaded { document: base, blocks: mut base_blocks, mut placed, .. } = base;
    let Loaded { document: own, file, blocks: mut own_blocks, .. } = own;
    let (replace, remove) = (&changes.replace, &changes.remove);
    let blocks = merge.entries("block", base.blocks, own.blocks, &replace.blocks, &remove.blocks);

    let mut edits = Edits::new(changes, &mut merge);
    let mut passes = edits.passes(base.passes, "", &mut placed);
    for (name, block) in base_blocks.iter_mut().filter(|(name, _)| !own_blocks.contains_key(*name)) {
        edits.block(block, &format!("{name}."));
    }
    edits.finish(&mut merge);
    add(&mut merge, "pass", &mut passes, own.passes);

    // In the order of `blocks`; one that could not be read is in neither, and reported.
    let taken = blocks.keys().filter_map(|name| {
        let block = own_blocks.swap_remove(&name.value).or_else(|| base_blocks.swap_remove(&name.value))?;
        Some((name.value.clone(), block))
    });
    let loaded = taken.collect();
    let document = Document {
        doc: own.doc,
        extend: None,
        params: merge.entries("parameter", base.params, own.params, &replace.params, &remove.params),
        inputs: merge.entries("input", base.inputs, own.inputs, &Entries::new(), &[]),
        blocks,
        resources: merge.entries("resource", base.resources, own.resources, &replace.resources, &remove.resources),
        passes,
        outputs: merge.entries("output", base.outputs, own.outputs, &replace.outputs, &remove.outputs),
        retained_budget: own.retained_budget.or(base.retained_budget),
    };
    Loaded { document, file, blocks: loaded, placed }
}

struct Merge<'a> {
    /// The path of what is extended, for messages.
    base: &'a str,
    problems: &'a mut Vec<Diagnostic>,
}

impl Merge<'_> {
    fn report(&mut self, error: LoadError) {
        self.problems.push(error.into());
    }

    fn unknown(&mut self, what: &'static str, name: &Text, known: Vec<String>) {
        self.report(LoadError::Unknown { what, name: name.value.clone(), base: self.base.to_owned(), known, span: name.span });
    }

    /// One section of both documents.
    fn entries<T: Clone>(
        &mut self,
        what: &'static str,
        base: Entries<T>,
        own: Entries<T>,
        replace: &Entries<T>,
        remove: &[Text],
    ) -> Entries<T> {
        for name in replace.keys().chain(remove) {
            if !base.contains_key(name) {
                self.unknown(what, name, base.keys().map(|name| name.value.clone()).collect());
            }
        }
        let mut merged = Entries::new();
        for (name, entry) in base {
            let removed = remove.iter().find(|removed| **removed == name);
            match (removed, replace.get_key_value(&name)) {
                (Some(removed), Some((replaced, _))) => self.changed_twice(what, &name.value, replaced, removed),
                (Some(_), None) => {}
                (None, Some((name, entry))) => drop(merged.insert(name.clone(), entry.clone())),
                (None, None) => drop(merged.insert(name, entry)),
            }
        }
        add(self, what, &mut merged, own);
        merged
    }

    fn changed_twice(&mut self, what: &'static str, name: &str, first: &Text, second: &Text) {
        self.report(LoadError::ChangedTwice { what, name: name.to_owned(), span: first.span, other: second.span });
    }
}

/// Adds entries whose names are new.
fn add<T>(merge: &mut Merge<'_>, what: &'static str, entries: &mut Entries<T>, added: Entries<T>) {
    for (name, entry) in added {
        match entries.get_key_value(&name) {
            Some((there, _)) => {
                let base = there.span;
                merge.report(LoadError::Conflict { what, name: name.value, span: name.span, base });
            }
            None => drop(entries.insert(name, entry)),
        }
    }
}

/// What changes about a pass of the other pipeline.
#[derive(Default)]
struct Edit<'a> {
    removed: Option<&'a Text>,
    replaced: Option<(&'a Text, &'a PassDoc)>,
    before: Option<(&'a Text, &'a Entries<PassDoc>)>,
    after: Option<(&'a Text, &'a Entries<PassDoc>)>,
    met: bool,
}

/// What changes about passes, by their paths.
struct Edits<'a> {
    by_path: BTreeMap<&'a str, Edit<'a>>,
    known: Vec<String>,
    conflicts: Vec<LoadError>,
}

impl<'a> Edits<'a> {
    fn new(changes: &'a ExtendDoc, merge: &mut Merge<'_>) -> Edits<'a> {
        let mut by_path: BTreeMap<&str, Edit<'_>> = BTreeMap::new();
        for name in &changes.remove.passes {
            by_path.entry(&name.value).or_default().removed = Some(name);
        }
        for (name, pass) in &changes.replace.passes {
            by_path.entry(&name.value).or_default().replaced = Some((name, pass));
        }
        for (name, passes) in &changes.before {
            by_path.entry(&name.value).or_default().before = Some((name, passes));
        }
        for (name, passes) in &changes.after {
            by_path.entry(&name.value).or_default().after = Some((name, passes));
        }
        for (path, edit) in &by_path {
            let others = [edit.replaced.map(|edit| edit.0), edit.before.map(|edit| edit.0), edit.after.map(|edit| edit.0)];
            if let (Some(removed), Some(other)) = (edit.removed, others.into_iter().flatten().next()) {
                merge.changed_twice("pass", path, removed, other);
            }
        }
        Edits { by_path, known: Vec::new(), conflicts: Vec::new() }
    }

    fn block(&mut self, block: &mut Loaded, prefix: &str) {
        block.document.passes = self.passes(std::mem::take(&mut block.document.passes), prefix, &mut block.placed);
        for (name, inner) in &mut block.blocks {
            self.block(inner, &format!("{prefix}{name}."));
        }
    }

    fn passes(&mut self, base: Entries<PassDoc>, prefix: &str, placed: &mut BTreeMap<Span, FileId>) -> Entries<PassDoc> {
        let mut edited = Entries::new();
        for (name, mut pass) in base {
            let path = format!("{prefix}{}", name.value);
            self.known.push(path.clone());
            let edit = match self.by_path.get_mut(path.as_str()) {
                Some(edit) => std::mem::replace(edit, Edit { met: true, ..Edit::default() }),
                None => Edit::default(),
            };
            if edit.removed.is_some() {
                continue;
            }
            let file = placed.get(&name.span).copied().unwrap_or(name.span.file);
            self.insert(&mut edited, edit.before, file, placed);
            let mut name = name;
            match edit.replaced {
                Some((replaced, replacement)) => {
                    name.span = replaced.span;
                    pass = replacement.clone();
                }
                None => {
                    if let PassDoc::Repeat { passes, .. } = &mut pass {
                        *passes = self.passes(std::mem::take(passes), &format!("{path}."), placed);
                    }
                }
            }
            placed.insert(name.span, file);
            self.put(&mut edited, name, pass);
            self.insert(&mut edited, edit.after, file, placed);
        }
        edited
    }

    /// Puts passes into a list of `file`.
    fn insert(
        &mut self,
        edited: &mut Entries<PassDoc>,
        inserted: Option<(&Text, &Entries<PassDoc>)>,
        file: FileId,
        placed: &mut BTreeMap<Span, FileId>,
    ) {
        for (name, pass) in inserted.into_iter().flat_map(|(_, passes)| passes) {
            placed.insert(name.span, file);
            self.put(edited, name.clone(), pass.clone());
        }
    }

    fn put(&mut self, edited: &mut Entries<PassDoc>, name: Text, pass: PassDoc) {
        match edited.get_key_value(&name) {
            Some((there, _)) => {
                let base = there.span;
                self.conflicts.push(LoadError::Conflict { what: "pass", name: name.value, span: name.span, base });
            }
            None => drop(edited.insert(name, pass)),
        }
    }

    /// Reports what changes nothing.
    fn finish(self, merge: &mut Merge<'_>) {
        for edit in self.by_path.into_values().filter(|edit| !edit.met) {
            let names = [edit.removed, edit.replaced.map(|edit| edit.0), edit.before.map(|edit| edit.0), edit.after.map(|edit| edit.0)];
            for name in names.into_iter().flatten() {
                merge.unknown("pass", name, self.known.clone());
            }
        }
        self.conflicts.into_iter().for_each(|conflict| merge.report(conflict));
    }
}
