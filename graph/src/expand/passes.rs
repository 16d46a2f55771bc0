//! Passes: loops unrolled, conditions decided, references with numbers.
//!
//! Names are stable: a pass of a loop is `loop[index].pass`, whatever stands beside it. Passes are made in the order of the file.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use super::environment::Environment;
use super::error::ExpandError;
use super::types::{Element, Indices, Located, Output, PartRef, Pass, PassId, PassKind, Resource, Run, Shape, Slot, Spread, Value, Work};
use crate::source::FileId;
use crate::validate::types::{BlockDecl, Item, PartExpr, PassDecl, PassKindDecl, PlacedExpr, RunDecl, Validated, WorkDecl};
use crate::validate::without_indices;

/// Pipelines longer than this are refused.
pub const MAX_PASSES: usize = 100_000;

/// What a pipeline comes to when everything is unrolled.
pub(super) struct Unrolled {
    pub passes: Vec<Pass>,
    pub spreads: Vec<Spread>,
    pub outputs: Vec<Output>,
}

/// Pipelines in which more passes wait for passes under `after`, pair by pair, are refused.
const MAX_AFTER: usize = 1_000_000;

/// Unrolls everything. `asked` says which outputs are wanted.
pub(super) fn passes(
    environment: &mut Environment<'_>,
    validated: &Validated,
    resources: &[Resource],
    asked: impl Fn(&str) -> bool,
) -> Unrolled {
    let (passes, pending, spreads, elements, after, lists, block) = Default::default();
    let mut unroller = Unroller {
        environment,
        resources,
        blocks: &validated.blocks,
        passes,
        pending,
        spreads,
        elements,
        after,
        lists,
        block,
        iteration: None,
        count: 0,
        full: false,
    };
    unroller.items(&validated.items, "");
    let (mut outputs, mut versions) = (Vec::new(), Vec::new());
    for (name, part) in validated.outputs.iter().filter(|(name, _)| asked(&name.value)) {
        if let Some(found) = unroller.part(part, "outputs") {
            versions.extend(part.version.as_ref().map(|version| (outputs.len(), unroller.seen(version, ""))));
            outputs.push(Output { name: name.value.clone(), part: found });
        }
    }
    let spreads = std::mem::take(&mut unroller.spreads);
    let passes = unroller.resolve(&mut outputs, versions);
    Unrolled { passes, spreads, outputs }
}

/// A path of a pass, and where it is seen from.
#[derive(Clone)]
pub(super) struct Seen {
    /// The path of the loop iterations around.
    pub scope: String,
    /// The part of `scope` that is a block's: names outside are not seen.
    pub block: usize,
    pub path: Located<String>,
}

/// References to passes that are resolved once all names are known.
struct Pending {
    after: Vec<Seen>,
    versions: Vec<(usize, Seen)>,
}

pub(super) struct Unroller<'a, 'b> {
    pub environment: &'a mut Environment<'b>,
    pub resources: &'a [Resource],
    blocks: &'a [BlockDecl],
    pub passes: Vec<Pass>,
    pending: Vec<Pending>,
    pub spreads: Vec<Spread>,
    /// Elements of the loops around, outermost first.
    pub elements: Vec<Element>,
    /// What the loops and blocks around come after.
    pub after: Vec<Seen>,
    /// Numbers of lists, by block and file.
    lists: BTreeMap<(Arc<str>, FileId), u32>,
    /// The path of the block around.
    block: Arc<str>,
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
                Item::Block(index, items) => self.block(*index, items),
            }
        }
    }

    fn block(&mut self, index: usize, items: &[Item]) {
        let Some(decl) = self.blocks.get(index).filter(|_| self.environment.blocks.get(index) == Some(&true)) else { return };
        let outer = self.after.len();
        let user = self.blocks.get(decl.parent).map_or("", |user| user.path.as_str());
        self.wait_for(&decl.after, user);
        let around = std::mem::replace(&mut self.block, decl.path.as_str().into());
        self.items(items, &decl.path);
        self.block = around;
        self.after.truncate(outer);
    }

    /// What follows comes after these, until `after` is truncated.
    pub(super) fn wait_for(&mut self, paths: &[Located<String>], scope: &str) {
        let seen: Vec<Seen> = paths.iter().map(|path| self.seen(path, scope)).collect();
        self.after.extend(seen);
    }

    fn seen(&self, path: &Located<String>, scope: &str) -> Seen {
        Seen { scope: scope.to_owned(), block: self.block.len(), path: path.clone() }
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
        if !self.environment.stands(&decl.condition, &name) {
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
        let versions = versions.filter_map(|(index, (_, part))| Some((index, self.seen(part.version.as_ref()?, scope)))).collect();
        let after = decl.after.iter().map(|path| self.seen(path, scope)).chain(self.after.iter().cloned()).collect();
        self.pending.push(Pending { after, versions });
        let next = self.lists.len() as u32;
        let list = *self.lists.entry((self.block.clone(), decl.file)).or_insert(next);
        self.passes.push(Pass {
            name: name.into(),
            block: self.block.clone(),
            list,
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
                view: self.view(view, name)?,
                depth: *depth,
                cull: *cull,
                blend: blend.clone(),
            },
            PassKindDecl::Procedural { vertex, fragment, vertices, instances, depth, cull, blend } => PassKind::Procedural {
                vertex: vertex.clone(),
                fragment: fragment.clone(),
                vertices: self.small(vertices, "the vertices of", name)?,
                instances: match instances {
                    None => 1,
                    Some(instances) => self.small(instances, "the instances of", name)?,
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
    fn resolve(mut self, outputs: &mut [Output], versions: Vec<(usize, Seen)>) -> Vec<Pass> {
        // By name without indices, so that a loop's passes are found together, and by the names of all that is around. Only built
        // where something refers to passes.
        let mut by_plain_name: HashMap<String, Vec<PassId>> = HashMap::new();
        let refers = |pending: &Pending| !pending.after.is_empty() || !pending.versions.is_empty();
        if !versions.is_empty() || self.pending.iter().any(refers) {
            for (index, pass) in self.passes.iter().enumerate() {
                let plain = without_indices(&pass.name);
                for (end, _) in plain.match_indices('.').chain([(plain.len(), "")]) {
                    by_plain_name.entry(plain[..end].to_owned()).or_default().push(PassId(index as u32));
                }
            }
        }
        let pending = std::mem::take(&mut self.pending);
        let mut pairs = 0;
        for (index, pending) in pending.into_iter().enumerate() {
            for seen in &pending.after {
                if pairs > MAX_AFTER {
                    break;
                }
                let found = find(&self.passes, &by_plain_name, seen, true);
                pairs += found.len();
                if pairs > MAX_AFTER {
                    let Located { value: path, span } = seen.path.clone();
                    self.environment.report(ExpandError::TooManyAfter { path, limit: MAX_AFTER, span });
                }
                self.passes[index].after.extend(found);
            }
            for (slot, seen) in pending.versions {
                let Some(version) = self.version(&by_plain_name, seen) else { continue };
                let pass = &mut self.passes[index];
                if let Some(slot) = pass.reads.get_mut(slot) {
                    slot.part.version = Some(version);
                }
                for iteration in pass.batch.iter_mut().flat_map(|batch| &mut batch.iterations) {
                    if let Some(part) = iteration.parts.get_mut(slot) {
                        part.version = Some(version);
                    }
                }
            }
        }
        for (output, seen) in versions {
            outputs[output].part.version = self.version(&by_plain_name, seen);
        }
        self.passes
    }

    /// The one pass that a version names.
    fn version(&mut self, by_plain_name: &HashMap<String, Vec<PassId>>, seen: Seen) -> Option<PassId> {
        let found = find(&self.passes, by_plain_name, &seen, false);
        let Located { value: path, span } = seen.path;
        match found.as_slice() {
            [only] => return Some(*only),
            [] => self.environment.report(ExpandError::AbsentPass { path, span }),
            many => self.environment.report(ExpandError::AmbiguousPass { path, count: many.len(), span }),
        }
        None
    }
}

/// The passes that a path names, seen from a loop iteration: first in that iteration, then in those around it. `groups` allows loops
/// and blocks, which stand for all of their passes.
fn find(passes: &[Pass], by_plain_name: &HashMap<String, Vec<PassId>>, seen: &Seen, groups: bool) -> Vec<PassId> {
    let mut scope = seen.scope.as_str();
    loop {
        let full = format!("{scope}{}", seen.path.value);
        if let Some(candidates) = by_plain_name.get(&without_indices(&full)) {
            let fitting = |id: &PassId| passes.get(id.index()).is_some_and(|pass| fits(&full, &pass.name, groups));
            let found: Vec<PassId> = candidates.iter().copied().filter(fitting).collect();
            if !found.is_empty() {
                return found;
            }
        }
        if scope.len() <= seen.block {
            return Vec::new();
        }
        let around = scope.trim_end_matches('.').rfind('.').map_or(0, |dot| dot + 1);
        scope = &scope[..around.max(seen.block)];
    }
}

/// Whether a pattern names a pass: segments are equal, and a segment without an index stands for all of them.
fn fits(pattern: &str, name: &str, groups: bool) -> bool {
    let (wanted, there) = (pattern.split('.').count(), name.split('.').count());
    (wanted == there || groups && wanted < there)
        && pattern
            .split('.')
            .zip(name.split('.'))
            .all(|(pattern, name)| pattern == name || (!pattern.contains('[') && name.split('[').next() == Some(pattern)))
}

/// Computes the indices of a reference and checks them against its resource.
/// Where a block does not stand, what takes its place.
pub(super) fn reference(environment: &mut Environment<'_>, resources: &[Resource], part: &PartExpr, pass: &str) -> Option<PartRef> {
    let part = environment.present(part);
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
