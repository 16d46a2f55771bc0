//! Passes: loops unrolled, conditions decided, references with numbers.
//!
//! Names are stable: a pass of a loop is `loop[index].pass`, whatever stands beside it. Passes are made in the order of the file.

use std::collections::HashMap;

use super::environment::Environment;
use super::error::ExpandError;
use super::types::{Element, Indices, Located, PartRef, Pass, PassId, PassKind, Resource, Run, Shape, Slot, Spread, Value, Work};
use crate::published::ViewKind;
use crate::validate::types::{Condition, Item, PartExpr, PassDecl, PassKindDecl, PlacedExpr, RunDecl, View, WorkDecl};
use crate::validate::without_indices;

/// Pipelines longer than this are refused.
pub const MAX_PASSES: usize = 100_000;

/// Unrolls everything.
pub(super) fn passes(environment: &mut Environment<'_>, items: &[Item], resources: &[Resource]) -> (Vec<Pass>, Vec<Spread>) {
    let (passes, pending, spreads, elements) = Default::default();
    let mut unroller = Unroller { environment, resources, passes, pending, spreads, elements, iteration: None, count: 0, full: false };
    unroller.items(items, "");
    let spreads = std::mem::take(&mut unroller.spreads);
    (unroller.resolve(), spreads)
}

/// References to passes that are resolved once all names are known.
struct Pending {
    scope: String,
    after: Vec<Located<String>>,
    versions: Vec<(usize, Located<String>)>,
}

pub(super) struct Unroller<'a, 'b> {
    pub environment: &'a mut Environment<'b>,
    pub resources: &'a [Resource],
    pub passes: Vec<Pass>,
    pending: Vec<Pending>,
    pub spreads: Vec<Spread>,
    /// Elements of the loops around, outermost first.
    pub elements: Vec<Element>,
    /// The iteration of a loop around that spreads over frames.
    pub iteration: Option<Run>,
    /// Passes and iterations of batches so far.
    pub count: usize,
    pub full: bool,
}

impl Unroller<'_, '_> {
    pub(super) fn items(&mut self, items: &[Item], scope: &str) {
        for item in items {
            if self.full {
                return;
            }
            match item {
                Item::Pass(decl) => self.pass(decl, scope),
                Item::Repeat(decl) => self.repeat(decl, scope),
            }
        }
    }

    pub(super) fn stands(&mut self, condition: &Condition, name: &str) -> bool {
        let has = condition.has.as_ref().is_none_or(|count| self.environment.counts.get(count).is_some_and(|count| *count > 0));
        let when = match &condition.when {
            None => true,
            Some(when) => self.environment.truth(when, &format!("the condition of `{name}`")).unwrap_or(false),
        };
        has && when
    }

    /// Adds to the length of the pipeline; false if it is too long.
    pub(super) fn grow(&mut self, by: usize, name: &Located<String>) -> bool {
        self.count = self.count.saturating_add(by);
        if self.count > MAX_PASSES && !self.full {
            self.full = true;
            self.environment.report(ExpandError::TooManyPasses { name: name.value.clone(), limit: MAX_PASSES, span: name.span });
        }
        !self.full
    }

    fn pass(&mut self, decl: &PassDecl, scope: &str) {
        let name = format!("{scope}{}", decl.name.value);
        if !self.stands(&decl.condition, &name) {
            return;
        }
        let slots = self.slots(decl, &name);
        self.finish(decl, name, scope, slots);
        self.count += 1;
    }

    /// What the pass reads, writes and modifies at the indices in force. Faulty slots are left out.
    pub(super) fn slots(&mut self, decl: &PassDecl, name: &str) -> [Vec<Slot>; 3] {
        [&decl.reads, &decl.writes, &decl.modifies].map(|slots| {
            let slots = slots.iter();
            slots.filter_map(|(slot, part)| Some(Slot { name: slot.clone(), part: self.part(part, name)? })).collect()
        })
    }

    /// Adds a pass whose slots are known; `None` if something is wrong with it.
    pub(super) fn finish(
        &mut self,
        decl: &PassDecl,
        name: String,
        scope: &str,
        [reads, writes, modifies]: [Vec<Slot>; 3],
    ) -> Option<&mut Pass> {
        let mut constants = Vec::new();
        for (constant, value) in &decl.constants {
            if let Some(value) = self.environment.number(value, &format!("the constant `{}` of `{name}`", constant.value)) {
                constants.push((constant.clone(), value));
            }
        }
        let run = self.run(&decl.run, &name)?;
        let kind = self.kind(&decl.kind, &name)?;
        let versions = decl.reads.iter().enumerate();
        let versions = versions.filter_map(|(index, (_, part))| Some((index, part.version.clone()?))).collect();
        self.pending.push(Pending { scope: scope.to_owned(), after: decl.after.clone(), versions });
        self.passes.push(Pass {
            name,
            span: decl.name.span,
            indices: self.environment.indices.clone(),
            kind,
            shader: decl.shader.clone(),
            constants,
            reads,
            writes,
            modifies,
            after: Vec::new(),
            run,
            batch: None,
            elements: self.elements.clone(),
        });
        self.passes.last_mut()
    }

    fn run(&mut self, run: &RunDecl, name: &str) -> Option<Run> {
        Some(match (self.iteration, run) {
            (Some(iteration), _) => iteration,
            (None, RunDecl::OnChange) => Run::OnChange,
            (None, RunDecl::EveryFrame) => Run::EveryFrame,
            (None, RunDecl::Accumulate(count)) => Run::Accumulate(self.at_least_one(count, "the number of runs of", name)?),
        })
    }

    /// A count that may not be 0.
    pub(super) fn at_least_one(&mut self, expr: &PlacedExpr, what: &str, name: &str) -> Option<u32> {
        match self.small(expr, what, name)? {
            0 => self.environment.bad(&format!("{what} `{name}`"), "it is 0, and must be at least 1".to_owned(), expr.span),
            count => Some(count),
        }
    }

    fn kind(&mut self, kind: &PassKindDecl, name: &str) -> Option<PassKind> {
        Some(match kind {
            PassKindDecl::Draw { vertex, fragment, objects, view, depth, cull, blend } => PassKind::Draw {
                vertex: vertex.clone(),
                fragment: fragment.clone(),
                objects: *objects,
                view: match view {
                    View::Camera => ViewKind::Camera,
                    View::DirectionalLight(index) => ViewKind::DirectionalLight(self.small(index, "the light of", name)?),
                    View::LocalLight(index, face) => {
                        let (light, face_index) = (self.small(index, "the light of", name)?, self.small(face, "the face of", name)?);
                        if face_index > 5 {
                            return self.environment.bad(
                                &format!("the face of `{name}`"),
                                format!("a cube has faces 0 to 5, not {face_index}"),
                                face.span,
                            );
                        }
                        ViewKind::LocalLight(light, face_index)
                    }
                },
                depth: *depth,
                cull: *cull,
                blend: blend.clone(),
            },
            PassKindDecl::Fullscreen { entry, blend } => PassKind::Fullscreen { entry: entry.clone(), blend: blend.clone() },
            PassKindDecl::Compute { entry, work } => PassKind::Compute {
                entry: entry.clone(),
                work: match work {
                    WorkDecl::Cover(part) => Work::Cover(self.part(part, name)?),
                    WorkDecl::Count(count) => Work::Count(self.small(count, "the count of", name)?),
                    WorkDecl::Indirect(buffer, offset) => {
                        let buffer = self.part(buffer, name)?;
                        let offset = match offset {
                            None => 0,
                            Some(offset) => {
                                let what = format!("the offset of `{name}`");
                                let bytes = self.environment.count(offset, &what)?;
                                if !bytes.is_multiple_of(4) {
                                    return self.environment.bad(&what, format!("{bytes} is no multiple of 4"), offset.span);
                                }
                                bytes
                            }
                        };
                        Work::Indirect { buffer, offset }
                    }
                    WorkDecl::Groups(x, y, z) => {
                        let what = "the workgroups of";
                        Work::Groups([self.small(x, what, name)?, self.small(y, what, name)?, self.small(z, what, name)?])
                    }
                },
            },
            PassKindDecl::Copy => PassKind::Copy,
            PassKindDecl::Clear { value } => PassKind::Clear { value: *value },
        })
    }

    pub(super) fn small(&mut self, expr: &PlacedExpr, what: &str, name: &str) -> Option<u32> {
        let what = format!("{what} `{name}`");
        let value = self.environment.count(expr, &what)?;
        match u32::try_from(value) {
            Ok(value) => Some(value),
            Err(_) => self.environment.bad(&what, format!("{value} is too large"), expr.span),
        }
    }

    pub(super) fn part(&mut self, part: &PartExpr, pass: &str) -> Option<PartRef> {
        reference(self.environment, self.resources, part, pass)
    }

    /// Turns names of passes into ids.
    fn resolve(mut self) -> Vec<Pass> {
        // By name without indices, so that a loop's passes are found together. Only built where something refers to passes.
        let mut by_plain_name: HashMap<String, Vec<PassId>> = HashMap::new();
        if self.pending.iter().any(|pending| !pending.after.is_empty() || !pending.versions.is_empty()) {
            for (index, pass) in self.passes.iter().enumerate() {
                by_plain_name.entry(without_indices(&pass.name)).or_default().push(PassId(index as u32));
            }
        }
        let pending = std::mem::take(&mut self.pending);
        for (index, pending) in pending.into_iter().enumerate() {
            for path in pending.after {
                let found = find(&self.passes, &by_plain_name, &pending.scope, &path.value);
                self.passes[index].after.extend(found);
            }
            for (slot, path) in pending.versions {
                let found = find(&self.passes, &by_plain_name, &pending.scope, &path.value);
                match found.as_slice() {
                    [only] => {
                        let pass = &mut self.passes[index];
                        if let Some(slot) = pass.reads.get_mut(slot) {
                            slot.part.version = Some(*only);
                        }
                        for iteration in pass.batch.iter_mut().flat_map(|batch| &mut batch.iterations) {
                            if let Some(part) = iteration.parts.get_mut(slot) {
                                part.version = Some(*only);
                            }
                        }
                    }
                    [] => self.environment.report(ExpandError::AbsentPass { path: path.value, span: path.span }),
                    many => self.environment.report(ExpandError::AmbiguousPass { path: path.value, count: many.len(), span: path.span }),
                }
            }
        }
        self.passes
    }
}

/// The passes that a path names, seen from a loop iteration: first in that iteration, then in those around it.
fn find(passes: &[Pass], by_plain_name: &HashMap<String, Vec<PassId>>, scope: &str, path: &str) -> Vec<PassId> {
    let mut scope = scope;
    loop {
        let full = format!("{scope}{path}");
        if let Some(candidates) = by_plain_name.get(&without_indices(&full)) {
            let found: Vec<PassId> =
                candidates.iter().copied().filter(|id| passes.get(id.index()).is_some_and(|pass| fits(&full, &pass.name))).collect();
            if !found.is_empty() {
                return found;
            }
        }
        match scope.trim_end_matches('.').rfind('.') {
            Some(dot) => scope = &scope[..=dot],
            None if !scope.is_empty() => scope = "",
            None => return Vec::new(),
        }
    }
}

/// Whether a pattern names a pass: segments are equal, and a segment without an index stands for all of them.
fn fits(pattern: &str, name: &str) -> bool {
    pattern.split('.').count() == name.split('.').count()
        && pattern
            .split('.')
            .zip(name.split('.'))
            .all(|(pattern, name)| pattern == name || (!pattern.contains('[') && name.split('[').next() == Some(pattern)))
}

/// Computes the indices of a reference and checks them against its resource.
pub(super) fn reference(environment: &mut Environment<'_>, resources: &[Resource], part: &PartExpr, pass: &str) -> Option<PartRef> {
    let resource = &resources[part.resource.index()];
    let mut index = |expr: &Option<PlacedExpr>, what: &'static str, count: Option<u32>| -> Option<Option<u32>> {
        let Some(expr) = expr else { return Some(None) };
        let Some(count) = count else {
            let resource = resource.name.clone();
            environment.report(ExpandError::PartOfBuffer { pass: pass.to_owned(), resource, what, span: part.span });
            return None;
        };
        let value = environment.value(expr, &format!("the {what} of `{}` in `{pass}`", resource.name))?;
        match value {
            Value::Int(value) if value >= 0 && value < i64::from(count) => Some(Some(value as u32)),
            Value::Int(value) => {
                let resource = resource.name.clone();
                environment.report(ExpandError::PartOutOfRange {
                    pass: pass.to_owned(),
                    resource,
                    what,
                    index: value,
                    count,
                    span: part.span,
                });
                None
            }
            _ => environment.bad(&format!("the {what} of `{}`", resource.name), "it must be a whole number".to_owned(), expr.span),
        }
    };
    let (mips, layers) = match &resource.shape {
        Shape::Texture(shape) => (Some(shape.mips), Some(shape.layers)),
        Shape::Buffer { .. } => (None, None),
    };
    let mip = index(&part.mip, "mip", mips);
    let layer = index(&part.layer, "layer", layers);
    let (mips, layers) = (mip?.map(Indices::one), layer?.map(Indices::one));
    Some(PartRef { resource: part.resource, mips, layers, version: None, span: part.span })
}
