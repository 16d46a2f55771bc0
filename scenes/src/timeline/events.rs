//! A checked timeline, as it lies in the world.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use bevy_ecs::prelude::{Entity, Resource};

use super::segment::{Ease, Goal, Segment};
use crate::scene_file::{Declaration, Kind, Play, Spawned, UsedFile};

/// A node of a scene: something declared, or a node inside of a declared glTF file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct NodeRef {
    /// Index into [`Timeline::declarations`].
    pub(crate) declaration: usize,
    /// Index of a node of the file.
    pub(crate) inside: Option<usize>,
}

impl NodeRef {
    /// What is declared itself.
    pub(crate) fn of(declaration: usize) -> NodeRef {
        NodeRef { declaration, inside: None }
    }
}

/// A field of a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Field {
    BaseColor,
    Metallic,
    Roughness,
    Emissive,
    Specular,
}

/// What a change writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Property {
    Translation(NodeRef),
    Rotation(NodeRef),
    Scale(NodeRef),
    Intensity(NodeRef),
    Color(NodeRef),
    Exposure(NodeRef),
    FieldOfView(NodeRef),
    Sky,
    /// Row of the material.
    Material(usize, Field),
}

/// What happens at an event.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Action {
    Change {
        property: Property,
        goal: Goal,
        during: f64,
        ease: Ease,
    },
    Spawn(Range<usize>),
    Remove(NodeRef),
    /// Or hide.
    Show {
        node: NodeRef,
        shown: bool,
    },
    Animate {
        node: NodeRef,
        play: Play,
    },
    Reparent {
        node: NodeRef,
        parent: Option<NodeRef>,
        keep_place: bool,
    },
}

/// Something that happens at a time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Event {
    /// Seconds.
    pub(crate) at: f64,
    pub(crate) action: Action,
}

/// The timeline of a scene and how far it has come.
#[derive(Resource, Debug)]
pub(crate) struct Timeline {
    /// By time; those of the same time in the order in which they were written.
    pub(crate) events: Vec<Event>,
    pub(crate) declarations: Vec<Declaration>,
    /// Per declaration.
    pub(crate) parents: Vec<Option<NodeRef>>,
    /// Per use of a file.
    pub(crate) files: Vec<UsedFile>,
    /// Per declaration, once it has been spawned.
    pub(crate) spawned: Vec<Option<Spawned>>,
    /// How many events have happened.
    pub(super) happened: usize,
    pub(super) running: BTreeMap<Property, Segment>,
    /// Of what runs, what has not ended.
    pub(super) active: BTreeSet<Property>,
    /// The time of the last evaluation, seconds.
    pub(super) evaluated: f64,
}

impl Timeline {
    /// A timeline of which nothing has happened yet.
    pub(crate) fn new(
        events: Vec<Event>,
        declarations: Vec<Declaration>,
        parents: Vec<Option<NodeRef>>,
        files: Vec<UsedFile>,
        spawned: Vec<Option<Spawned>>,
    ) -> Timeline {
        Timeline {
            events,
            declarations,
            parents,
            files,
            spawned,
            happened: 0,
            running: BTreeMap::new(),
            active: BTreeSet::new(),
            evaluated: 0.0,
        }
    }

    /// The entity of a node; `None` before it is spawned.
    pub(super) fn entity(&self, node: NodeRef) -> Option<Entity> {
        let spawned = self.spawned.get(node.declaration)?.as_ref()?;
        match node.inside {
            None => Some(spawned.root),
            Some(inner) => spawned.inside.get(inner).copied(),
        }
    }

    /// For messages.
    pub(crate) fn name(&self, node: NodeRef) -> String {
        let Some(declaration) = self.declarations.get(node.declaration) else { return String::new() };
        let Kind::File(used) = declaration.kind else { return declaration.name.value.clone() };
        let inner = node.inside.and_then(|inner| self.files.get(used)?.asset.nodes().get(inner));
        inner.map_or_else(|| declaration.name.value.clone(), |inner| format!("{}/{}", declaration.name.value, inner.name))
    }
}
