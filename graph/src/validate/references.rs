//! What references stand for: resources and their parts, inputs and outputs of blocks, slots of passes, the past, and passes.
//!
//! A name is looked up in its own file. An input of a block leads to the file that uses the block, an output into the block; both
//! may stand for a part, and an output for something else while the block does not stand.

use super::error::ValidateError;
use super::instances::Declared;
use super::scope::{Scope, inside, is_name};
use super::types::{Otherwise, PartExpr, PlacedExpr};
use crate::expand::types::{Located, ResourceId};
use crate::source::Span;
use crate::syntax::document::{Entries, PassDoc, Text};

/// Begins a reference to what a resource held at the end of the frame before.
const PREVIOUS: &str = "previous(";
/// A reference may stand for so many parts, depending on which blocks stand.
const MAX_MEANINGS: usize = 64;
/// References that lead to others through more files than this are refused.
const MAX_STEPS: usize = 128;
/// Why something can't be done with the past.
const ONLY_READ: (&str, &str) = ("it is the past, which can only be read", "a Copy can keep it: `Copy(read: \"previous(x)\", write: ..)`");

impl<'a> Scope<'a> {
    /// A reference such as `radiance.mip(m - 1)`, to be written, shown or measured.
    pub fn part(&mut self, text: &Text) -> Option<PartExpr> {
        let part = self.readable(text)?;
        if self.is_past(part.resource) {
            let (reason, hint) = ONLY_READ;
            self.report(ValidateError::BadPrevious { text: text.value.clone(), reason, hint, span: text.span });
            return None;
        }
        Some(part)
    }

    /// Whether an id is that of a history.
    pub fn is_past(&self, resource: ResourceId) -> bool {
        resource.index() >= self.declared.len()
    }

    /// The resource itself, if it is a history.
    pub fn source_of(&self, resource: ResourceId) -> ResourceId {
        let history = resource.index().checked_sub(self.declared.len()).and_then(|index| self.histories.get(index));
        history.map_or(resource, |history| history.value)
    }

    /// The same part of the resource itself, where it is one of its past.
    pub fn present(&self, mut part: PartExpr) -> PartExpr {
        part.resource = self.source_of(part.resource);
        for otherwise in &mut part.otherwise {
            otherwise.part = self.present(otherwise.part.clone());
        }
        part
    }

    /// What is known of a resource or of the past of one.
    pub fn declaration(&self, resource: ResourceId) -> Option<&'a Declared> {
        self.declared.get(self.source_of(resource).index())
    }

    /// A reference under `read`, where the past may stand: `previous(radiance).mip(0)`.
    pub fn readable(&mut self, text: &Text) -> Option<PartExpr> {
        let value = text.value.as_str();
        let Some(rest) = value.trim_start().strip_prefix(PREVIOUS) else { return self.reference(text) };
        let bad = |reason, hint| ValidateError::BadPrevious { text: value.to_owned(), reason, hint, span: text.span };
        if rest.trim_start().starts_with(PREVIOUS) {
            self.report(bad("the past of the past is not kept", "copy the past to a resource of its own, and read the past of that one"));
            return None;
        }
        if value.contains('@') {
            self.report(bad("the past is the value at the end of the frame before", "leave `@` and the pass out"));
            return None;
        }
        let Some((inner, selectors)) = rest.split_once(')') else {
            self.report(bad("it has no closing `)`", "write `previous(name)`, and parts behind it: `previous(name).mip(0)`"));
            return None;
        };
        let start = value.len() - rest.len();
        if inner.contains('(') {
            self.report(bad("a part stands inside of the brackets", "write parts behind them: `previous(name).mip(0)`"));
            return None;
        }
        let mut part = self.name(inner.trim(), text, start..start + inner.len())?;
        self.past(&mut part, text)?;
        self.selectors(text, part, value.len() - selectors.len(), value)
    }

    /// Turns a part into that of its past.
    fn past(&mut self, part: &mut PartExpr, text: &Text) -> Option<()> {
        if self.is_past(part.resource) || part.version.is_some() {
            let (reason, hint) = ("what it names is the past, or an earlier value, already", "name the resource itself");
            self.report(ValidateError::BadPrevious { text: text.value.clone(), reason, hint, span: text.span });
            return None;
        }
        let known = self.histories.iter().position(|history| history.value == part.resource);
        let index = known.unwrap_or_else(|| {
            self.histories.push(Located { value: part.resource, span: text.span });
            self.histories.len() - 1
        });
        part.resource = ResourceId((self.declared.len() + index) as u32);
        part.otherwise.iter_mut().try_for_each(|otherwise| self.past(&mut otherwise.part, text))
    }

    /// What the name in a range of a reference stands for.
    fn name(&mut self, name: &str, text: &Text, range: std::ops::Range<usize>) -> Option<PartExpr> {
        if !name.split('.').all(is_name) {
            let reason = format!("`{name}` is not a name");
            self.report(ValidateError::BadReference { text: text.value.clone(), reason, span: text.span });
            return None;
        }
        let part = self.resolve(name, inside(text.span, &range, text.value.len()))?;
        Some(placed(part, text.span))
    }

    fn reference(&mut self, text: &Text) -> Option<PartExpr> {
        let value = text.value.as_str();
        let (reference, version) = match value.split_once('@') {
            Some((reference, version)) => (reference, Some(version.trim())),
            None => (value, None),
        };
        let name_end = name_end(reference);
        let part = self.name(reference[..name_end].trim(), text, 0..name_end)?;
        let mut part = self.selectors(text, part, name_end, reference)?;
        if let Some(version) = version {
            let place = inside(text.span, &(reference.len() + 1..value.len()), value.len());
            if part.version.is_some() || self.is_past(part.resource) || !part.otherwise.is_empty() {
                let reason = "what it names has a version, or stands for something else at times".to_owned();
                self.report(ValidateError::BadReference { text: value.to_owned(), reason, span: place });
                return None;
            }
            part.version = Some(self.pass_path(version, place)?);
        }
        Some(part)
    }

    /// What a name stands for in the current file: `radiance`, `shadows.maps`, `display.color`.
    pub fn resolve(&mut self, name: &str, span: Span) -> Option<PartExpr> {
        let instance = self.instance();
        match name.split_once('.') {
            None => self.own(name, span),
            Some((first, rest)) => match instance.children.get(first) {
                Some(child) => self.within(*child, |scope| scope.offered(rest, span)),
                None => self.slot(name, span),
            },
        }
    }

    /// A resource or an input.
    fn own(&mut self, name: &str, span: Span) -> Option<PartExpr> {
        let instance = self.instance();
        let document = instance.document();
        let whole = |index: usize| whole(ResourceId(instance.first_resource + index as u32), span);
        if let Some(index) = document.resources.get_index_of(name) {
            return Some(whole(index));
        }
        if let Some(index) = document.inputs.get_index_of(name) {
            return match instance.block {
                None => Some(whole(document.resources.len() + index)),
                // One that is not given is reported where the block stands.
                Some((_, block)) => block.inputs.get(name).and_then(|text| self.follow(instance.parent, text, span)),
            };
        }
        if let Some(child) = instance.children.get(name) {
            let outputs: Vec<&str> = self.instances[*child].document().outputs.keys().map(|name| name.value.as_str()).collect();
            let reason = format!("`{name}` is a block; its outputs are {}", crate::diagnostic::list_names(outputs));
            self.report(ValidateError::BadReference { text: name.to_owned(), reason, span });
            return None;
        }
        self.unknown_resource(name, span)
    }

    /// What a block, the current file, shows to the one that uses it.
    fn offered(&mut self, name: &str, span: Span) -> Option<PartExpr> {
        let instance = self.instance();
        let Some((_, block)) = instance.block.filter(|_| !name.contains('.')) else { return self.resolve(name, span) };
        if let Some(text) = instance.document().outputs.get(name) {
            let mut part = self.follow(self.current, text, span)?;
            if let Some(instead) = block.otherwise.get(name) {
                let instead = self.follow(instance.parent, instead, span)?;
                // Blocks around come first: where they don't stand, neither does this one.
                part.otherwise.insert(0, Otherwise { block: self.current, part: instead });
                if meanings(&part) > MAX_MEANINGS {
                    let reason = format!("it stands for more than {MAX_MEANINGS} things, depending on which blocks stand");
                    self.report(ValidateError::BadReference { text: name.to_owned(), reason, span });
                    return None;
                }
            }
            return Some(part);
        }
        if let Some(index) = instance.document().resources.get_index_of(name) {
            return Some(whole(ResourceId(instance.first_resource + index as u32), span));
        }
        let document = instance.document();
        let resources = document.resources.keys().filter(|name| !document.outputs.contains_key(*name));
        let known = document.outputs.keys().chain(resources).map(|name| name.value.clone()).collect();
        self.report(ValidateError::Unknown { what: "output or resource of the block", name: name.to_owned(), known, span });
        None
    }

    /// What a slot of a pass names: `display.color`.
    fn slot(&mut self, name: &str, span: Span) -> Option<PartExpr> {
        let found = name.rsplit_once('.').and_then(|(path, slot)| Some((find(&self.document().passes, path)?, slot)));
        let Some(((pass, in_loop), slot)) = found else { return self.unknown_resource(name, span) };
        let slots = pass.slots();
        let Some((_, text)) = slots.iter().find(|(known, _)| *known == slot) else {
            let known = slots.iter().map(|(name, _)| (*name).to_owned()).collect();
            self.report(ValidateError::Unknown { what: "slot", name: slot.to_owned(), known, span });
            return None;
        };
        if in_loop {
            let reason = "a pass of a loop names other parts each time: name the resource".to_owned();
            self.report(ValidateError::BadReference { text: name.to_owned(), reason, span });
            return None;
        }
        self.follow(self.current, text, span)
    }

    /// What a reference of another file, or place, stands for.
    fn follow(&mut self, instance: usize, text: &Text, span: Span) -> Option<PartExpr> {
        let step = (instance, text.value.clone());
        if self.following.contains(&step) {
            let reason = "following it leads back to itself".to_owned();
            self.report(ValidateError::BadReference { text: text.value.clone(), reason, span: text.span });
            return None;
        }
        if self.following.len() >= MAX_STEPS {
            let reason = format!("it leads through more than {MAX_STEPS} inputs and outputs of blocks");
            self.report(ValidateError::BadReference { text: text.value.clone(), reason, span: text.span });
            return None;
        }
        self.following.push(step);
        let part = self.within(instance, |scope| scope.readable(text));
        self.following.pop();
        part.map(|part| placed(part, span))
    }

    fn unknown_resource(&mut self, name: &str, span: Span) -> Option<PartExpr> {
        let instance = self.instance();
        let document = instance.document();
        let mut known: Vec<String> = document.resources.keys().chain(document.inputs.keys()).map(|name| name.value.clone()).collect();
        for (block, child) in &instance.children {
            known.extend(self.instances[*child].document().outputs.keys().map(|output| format!("{block}.{output}")));
        }
        self.report(ValidateError::Unknown { what: "resource", name: name.to_owned(), known, span });
        None
    }

    /// `.mip(m).face(f)`, from a byte of a reference to its end.
    fn selectors(&mut self, text: &Text, mut part: PartExpr, start: usize, reference: &str) -> Option<PartExpr> {
        let value = text.value.as_str();
        let bad = |reason: String| ValidateError::BadReference { text: value.to_owned(), reason, span: text.span };
        let mut seen = Vec::new();
        let mut at = start;
        while at < reference.len() {
            let rest = &reference[at..];
            let Some((selector, index)) = rest.strip_prefix('.').and_then(|rest| rest.split_once('(')) else {
                self.report(bad(format!("expected `.mip(i)`, `.layer(i)` or `.face(i)`, found `{rest}`")));
                return None;
            };
            let Some(length) = closing(index) else {
                self.report(bad(format!("`.{selector}(` has no closing `)`")));
                return None;
            };
            let start = at + 1 + selector.len() + 1;
            let expression = self.parse(&index[..length], text.span, start, value.len())?;
            let kind = match selector {
                "mip" => Selector::Mip,
                "layer" | "face" => Selector::Layer,
                other => {
                    self.report(bad(format!("there is no `.{other}(i)`")));
                    return None;
                }
            };
            if seen.contains(&kind) {
                self.report(bad(format!("`.{selector}(i)` stands twice")));
                return None;
            }
            seen.push(kind);
            if !select(&mut part, kind, &PlacedExpr { expression, span: text.span }) {
                self.report(bad(format!("what it names is one {selector} already")));
                return None;
            }
            at = start + length + 1;
        }
        Some(part)
    }

    /// Checks that a path names a pass: `shade`, `faces.draw`, `faces[3].draw`, `shadows.draw`; under `after` also loops and blocks.
    pub fn pass_path(&mut self, path: &str, span: Span) -> Option<Located<String>> {
        let plain = without_indices(path);
        let instance = self.instance();
        let own = |known: &String| *known == plain || known.strip_suffix(&plain).is_some_and(|outer| outer.ends_with('.'));
        if instance.passes.iter().any(own) || instance.block_passes.contains(&plain) {
            return Some(Located { value: path.to_owned(), span });
        }
        let known = instance.passes.iter().chain(&instance.block_passes).cloned().collect();
        self.report(ValidateError::Unknown { what: "pass", name: path.to_owned(), known, span });
        None
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Selector {
    Mip,
    Layer,
}

/// Narrows a part and what stands in for it; false if it is narrowed already.
fn select(part: &mut PartExpr, kind: Selector, index: &PlacedExpr) -> bool {
    let target = match kind {
        Selector::Mip => &mut part.mip,
        Selector::Layer => &mut part.layer,
    };
    let free = target.is_none();
    *target = Some(index.clone());
    free && part.otherwise.iter_mut().all(|otherwise| select(&mut otherwise.part, kind, index))
}

/// How many parts a reference may stand for.
fn meanings(part: &PartExpr) -> usize {
    1 + part.otherwise.iter().map(|otherwise| meanings(&otherwise.part)).sum::<usize>()
}

/// All of a resource.
fn whole(resource: ResourceId, span: Span) -> PartExpr {
    PartExpr { resource, mip: None, layer: None, version: None, otherwise: Vec::new(), span }
}

/// The same part, named at another place.
fn placed(mut part: PartExpr, span: Span) -> PartExpr {
    part.span = span;
    for otherwise in &mut part.otherwise {
        otherwise.part = placed(otherwise.part.clone(), span);
    }
    part
}

/// A pass by its path, and whether it stands in a loop.
fn find<'a>(passes: &'a Entries<PassDoc>, path: &str) -> Option<(&'a PassDoc, bool)> {
    let (first, rest) = path.split_once('.').map_or((path, None), |(first, rest)| (first, Some(rest)));
    match (passes.get(first)?, rest) {
        (PassDoc::Repeat { passes, .. }, Some(rest)) => find(passes, rest).map(|(pass, _)| (pass, true)),
        (pass, None) => Some((pass, false)),
        _ => None,
    }
}

/// Where the name at the start of a reference ends: dotted, up to the first selector.
fn name_end(reference: &str) -> usize {
    let mut end = 0;
    loop {
        let rest = &reference[end..];
        let next = rest.get(1..).and_then(|rest| rest.find(['.', '('])).map(|at| at + 1);
        match next {
            // `.mip(`: the name ended at the dot before.
            Some(at) if rest[at..].starts_with('(') && end > 0 => return end,
            Some(at) if rest[at..].starts_with('.') => end += at,
            _ => return reference.len(),
        }
    }
}

/// `faces[3].draw` without `[3]`.
pub(crate) fn without_indices(path: &str) -> String {
    let mut depth = 0;
    path.chars()
        .filter(|c| {
            depth += i32::from(*c == '[');
            let keep = depth == 0;
            depth -= i32::from(*c == ']');
            keep
        })
        .collect()
}

/// The length of the text before the parenthesis that closes an open one.
fn closing(text: &str) -> Option<usize> {
    let mut depth = 0usize;
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' if depth == 0 => return Some(at),
            ')' => depth -= 1,
            _ => {}
        }
    }
    None
}
