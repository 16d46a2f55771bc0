//! Which node a name means, and at what time: names stand for what is declared, and `file/node` for nodes inside of glTF files.
//!
//! A name stands for one thing at a time, whatever its kind. Times go forward only: what is declared first is asked for first.

use std::collections::BTreeMap;
use std::ops::Range;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::source::Span;
use luminaire_graph::syntax::document::Text;

use super::assets::UsedFile;
use super::check::{Declaration, Kind};
use super::checks::Problems;
use super::document::{ActionDoc, EventDoc};
use crate::timeline::NodeRef;
use crate::world::StoredAsset;

/// Most nodes above one another.
pub(super) const MAX_DEPTH: u32 = 256;

/// What is known of names at a moment.
pub(super) struct Names<'a> {
    declarations: &'a [Declaration],
    /// Per use of a file; `None` where it could not be loaded.
    files: &'a [Option<UsedFile>],
    by_name: BTreeMap<&'a str, usize>,
    /// Per declaration, the parent that it has now.
    parents: Vec<Option<NodeRef>>,
    /// Per declaration, the parent that it was declared with.
    pub(super) declared: Vec<Option<NodeRef>>,
    /// Nodes inside of files that have another parent than the file gave them.
    moved: BTreeMap<NodeRef, Option<NodeRef>>,
    gone: BTreeMap<NodeRef, (f64, Span)>,
    /// Nodes that were scaled: when that ends, and whether some factor is zero then.
    scaled: BTreeMap<NodeRef, (f64, bool)>,
    /// Names that are spawned some time.
    future: BTreeMap<&'a str, (f64, Span)>,
}

impl<'a> Names<'a> {
    /// Nothing is known yet but what the timeline will spawn.
    pub(super) fn new(declarations: &'a [Declaration], files: &'a [Option<UsedFile>], timeline: &'a [EventDoc]) -> Names<'a> {
        let mut future = BTreeMap::new();
        for event in timeline {
            if let ActionDoc::Spawn { groups, lights, objects, files } = &event.action {
                let names = groups.keys().chain(lights.keys()).chain(objects.keys()).chain(files.keys());
                for name in names {
                    future.entry(name.value.as_str()).or_insert((event.at.value, name.span));
                }
            }
        }
        let parents = vec![None; declarations.len()];
        let declared = parents.clone();
        Names {
            declarations,
            files,
            by_name: BTreeMap::new(),
            parents,
            declared,
            moved: BTreeMap::new(),
            gone: BTreeMap::new(),
            scaled: BTreeMap::new(),
            future,
        }
    }

    /// These exist from now on. Parents may be named before they are declared.
    pub(super) fn declare(&mut self, range: Range<usize>, now: f64, problems: &mut Problems) {
        for index in range.clone() {
            let Some(new) = self.declarations.get(index) else { continue };
            if let Some(old) = self.by_name.insert(&new.name.value, index)
                && self.removal(NodeRef::of(old)).is_none()
                && let Some(old) = self.declarations.get(old)
            {
                let (name, kind, other) = (&new.name.value, new.kind.what(), old.kind.what());
                problems.add(
                    Diagnostic::error("scene::duplicate-name", format!("`{name}` is the name of a {other} and of a {kind}"))
                        .at(new.name.span, format!("the {kind}"))
                        .and(old.name.span, format!("the {other}")),
                );
            }
        }
        // All are looked up before any is set: until cycles are cut, a walk upwards might not end.
        let named = self.declarations.get(range.clone()).unwrap_or_default().iter();
        let parents: Vec<_> = named.map(|new| new.parent.as_ref().and_then(|parent| self.find(parent, now, problems))).collect();
        for (slot, parent) in self.parents.get_mut(range.clone()).unwrap_or_default().iter_mut().zip(parents) {
            *slot = parent;
        }
        self.check_ancestors(range.clone(), problems);
        if let (Some(declared), Some(now)) = (self.declared.get_mut(range.clone()), self.parents.get(range)) {
            declared.copy_from_slice(now);
        }
    }

    /// The node of a name. Errors: it is unknown, ambiguous, not there yet, or not there any more.
    pub(super) fn find(&self, name: &Text, now: f64, problems: &mut Problems) -> Option<NodeRef> {
        let found = self.look_up(name, problems)?;
        let Some((at, span)) = self.removal(found) else { return Some(found) };
        problems.add(
            Diagnostic::error("scene::removed-node", format!("`{}` is used at {now} s, but removed at {at} s", name.value))
                .at(name.span, "is not there any more")
                .and(span, "removed here"),
        );
        None
    }

    fn look_up(&self, name: &Text, problems: &mut Problems) -> Option<NodeRef> {
        let text = name.value.as_str();
        if let Some(index) = self.by_name.get(text) {
            return Some(NodeRef::of(*index));
        }
        for (slash, _) in text.match_indices('/') {
            let (Some(file), Some(inner)) = (text.get(..slash), text.get(slash + 1..)) else { continue };
            let Some(index) = self.by_name.get(file) else { continue };
            if let Some(Kind::File(used)) = self.declarations.get(*index).map(|declaration| &declaration.kind) {
                // A file that was not loaded has been reported.
                let asset = &self.files.get(*used)?.as_ref()?.asset;
                return inside(asset, name, inner, problems).map(|inner| NodeRef { declaration: *index, inside: Some(inner) });
            }
        }
        let at = |problem: Diagnostic, label: &str| problem.at(name.span, label);
        match self.future.get(text) {
            Some((seconds, span)) => {
                let message = format!("`{text}` is used before it is spawned, at {seconds} s");
                problems.add(at(Diagnostic::error("scene::later-node", message), "is not there yet").and(*span, "spawned here"));
            }
            None => {
                let problem = at(Diagnostic::error("scene::unknown-node", format!("the scene has no node `{text}`")), "no such node");
                problems.add_unknown(problem, "nodes of the scene", Some(text), || self.by_name.keys().copied());
            }
        }
        None
    }

    /// What was declared last under a name.
    pub(super) fn named(&self, name: &str) -> Option<&'a Declaration> {
        self.declarations.get(*self.by_name.get(name)?)
    }

    /// The declaration of a node, unless it lies inside of a file.
    pub(super) fn declaration(&self, node: NodeRef) -> Option<&'a Declaration> {
        self.declarations.get(node.declaration).filter(|_| node.inside.is_none())
    }

    /// The file that a node is, or lies inside of.
    pub(super) fn file(&self, node: NodeRef) -> Option<&'a StoredAsset> {
        match self.declarations.get(node.declaration)?.kind {
            Kind::File(used) => Some(&*self.files.get(used)?.as_ref()?.asset),
            _ => None,
        }
    }

    fn parent(&self, node: NodeRef) -> Option<NodeRef> {
        let Some(inner) = node.inside else { return self.parents.get(node.declaration).copied().flatten() };
        self.moved.get(&node).copied().unwrap_or_else(|| {
            let parent = self.file(node).and_then(|asset| asset.nodes().get(inner)?.parent);
            Some(NodeRef { inside: parent, ..node })
        })
    }

    /// Whether the node, or one above it, has been removed: when and where.
    fn removal(&self, node: NodeRef) -> Option<(f64, Span)> {
        std::iter::successors(Some(node), |node| self.parent(*node)).find_map(|node| self.gone.get(&node).copied())
    }

    /// The node and all below it are not there any more.
    pub(super) fn remove(&mut self, node: NodeRef, now: f64, span: Span) {
        self.gone.insert(node, (now, span));
    }

    /// The node has another scale from some time on.
    pub(super) fn scale(&mut self, node: NodeRef, ends: f64, is_flat: bool) {
        self.scaled.insert(node, (ends, is_flat));
    }

    /// Whether the node is known to have no extent along some direction, itself or by one above it. What a file or a running change
    /// does is not known here.
    pub(super) fn is_flat(&self, node: NodeRef, now: f64) -> bool {
        std::iter::successors(Some(node), |node| self.parent(*node)).take(4 * MAX_DEPTH as usize).any(|node| match self.scaled.get(&node) {
            Some((ends, is_flat)) => *is_flat && *ends <= now,
            None => self.declaration(node).is_some_and(|declaration| declaration.local.matrix3.determinant() == 0.0),
        })
    }

    /// Gives a node another parent. Errors: it would stand below itself, or too deep.
    pub(super) fn reparent(&mut self, node: NodeRef, parent: Option<NodeRef>, name: &Text, problems: &mut Problems) {
        let mut above = std::iter::successors(parent, |node| self.parent(*node)).take(4 * MAX_DEPTH as usize);
        if above.any(|ancestor| ancestor == node) {
            let message = format!("`{}` would stand below itself", name.value);
            problems.add(Diagnostic::error("scene::cycle", message).at(name.span, "stands above its new parent"));
        } else if std::iter::successors(parent, |node| self.parent(*node)).nth(MAX_DEPTH as usize).is_some() {
            problems.add(too_deep(&name.value, name.span));
        } else if node.inside.is_some() {
            self.moved.insert(node, parent);
        } else if let Some(slot) = self.parents.get_mut(node.declaration) {
            *slot = parent;
        }
    }

    /// Finds cycles of parents, each once, and hierarchies that are too deep, the first one. Parents in cycles are cut.
    fn check_ancestors(&mut self, range: Range<usize>, problems: &mut Problems) {
        // Depths of those that were walked; 0 marks the present walk.
        let mut depths: BTreeMap<usize, u32> = BTreeMap::new();
        let mut said = false;
        for start in range {
            let mut trail = Vec::new();
            let mut next = Some(start);
            let (mut depth, mut step) = (0, 1);
            while let Some(index) = next {
                match depths.get(&index) {
                    Some(0) => {
                        self.report_cycle(&trail, index, problems);
                        // Where parents go round, depth says nothing.
                        step = 0;
                        break;
                    }
                    Some(known) => {
                        depth = *known;
                        break;
                    }
                    None => {}
                }
                depths.insert(index, 0);
                trail.push(index);
                next = self.parents.get(index).copied().flatten().map(|parent| parent.declaration);
            }
            for index in trail.into_iter().rev() {
                depth += step;
                depths.insert(index, depth.max(1));
                if let Some(declaration) = self.declarations.get(index).filter(|_| depth > MAX_DEPTH && !said) {
                    said = true;
                    problems.add(too_deep(&declaration.name.value, declaration.name.span));
                }
            }
        }
    }

    fn report_cycle(&mut self, trail: &[usize], entry: usize, problems: &mut Problems) {
        let ring: Vec<usize> = trail.iter().copied().skip_while(|index| *index != entry).collect();
        let names =
            ring.iter().filter_map(|index| self.declarations.get(*index)).map(|declaration| format!("`{}`", declaration.name.value));
        let chain = names.take(12).collect::<Vec<_>>().join(" below ");
        let message = match ring.len() {
            1 => format!("{chain} is its own parent"),
            2..=12 => format!("parents go round in a circle: {chain} below the first"),
            all => format!("parents go round in a circle of {all}: {chain} and so on"),
        };
        let mut problem = Diagnostic::error("scene::cycle", message);
        let spans = ring.iter().filter_map(|index| self.declarations.get(*index)?.parent.as_ref());
        for (place, parent) in spans.take(12).enumerate() {
            problem = if place == 0 { problem.at(parent.span, "goes round") } else { problem.and(parent.span, "by way of this parent") };
        }
        problems.add(problem);
        for index in ring {
            if let Some(slot) = self.parents.get_mut(index) {
                *slot = None;
            }
        }
    }
}

/// The node of a name inside of a file.
fn inside(asset: &StoredAsset, name: &Text, inner: &str, problems: &mut Problems) -> Option<usize> {
    let known = || asset.nodes().iter().map(|node| node.name.as_str());
    match *asset.named(inner) {
        [index] => return Some(index),
        [_, ..] => problems.add(
            Diagnostic::error("scene::ambiguous-node", format!("the file has several nodes `{inner}`"))
                .at(name.span, "could be any of them")
                .hint("give the node a name of its own in the file"),
        ),
        [] => problems.add_unknown(
            Diagnostic::error("scene::unknown-node", format!("the file has no node `{inner}`")).at(name.span, "no such node"),
            "nodes of the file",
            Some(inner),
            known,
        ),
    }
    None
}

fn too_deep(name: &str, span: Span) -> Diagnostic {
    Diagnostic::error("scene::too-deep", format!("`{name}` stands more than {MAX_DEPTH} levels deep"))
        .at(span, "too deep")
        .hint("give it a parent nearer to the root")
}
