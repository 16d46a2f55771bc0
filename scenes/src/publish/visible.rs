//! Which objects each view sees: the camera, directional lights and spots by their frusta, the faces of
//! cubes as their [`Casters`].
//!
//! Kept from frame to frame: a view that stands still tests objects that changed, one that moves tests all.

use std::collections::{BTreeMap, BTreeSet};

use bevy_ecs::prelude::World;
use luminaire_graph::published::ViewKind;

use super::casters::{Casters, Center, Cube};
use super::frustum::Frustum;
use super::objects::{Changed, Objects};

/// What all views see that draw lists ask for.
#[derive(Debug, Default)]
pub(super) struct Visible {
    casters: Casters,
    in_view: BTreeMap<ViewKind, InView>,
}

/// What a camera, a directional light or a spot sees.
#[derive(Debug, Default)]
struct InView {
    /// Of a light whose maps have several sizes there are several: it sees what any of them holds.
    frusta: Vec<Frustum>,
    /// By slot.
    seen: Vec<bool>,
}

impl Visible {
    /// Takes changed views, lamps and objects over; returns the views that see others than before.
    pub(super) fn update(
        &mut self,
        world: &mut World,
        wanted: &BTreeSet<ViewKind>,
        frusta: impl Fn(ViewKind) -> Vec<Frustum>,
        center: impl Fn(Cube) -> Option<Center>,
        objects: &Objects,
        changed: &Changed,
    ) -> BTreeSet<ViewKind> {
        let mut others = self.casters.update(world, wanted.iter().copied(), center, objects, changed);
        self.in_view.retain(|view, _| wanted.contains(view));
        for view in wanted.iter().filter(|view| Cube::of(**view).is_none()) {
            let frusta = frusta(*view);
            let known = self.in_view.entry(*view).or_default();
            let different = if known.frusta == frusta {
                known.test(objects, changed.slots.iter().copied())
            } else {
                known.frusta = frusta;
                known.test(objects, 0..known.seen.len().max(objects.slots()) as u32)
            };
            others.extend(different.then_some(*view));
        }
        others
    }

    /// Whether a view sees the object of a slot.
    pub(super) fn sees(&self, view: ViewKind, slot: u32) -> bool {
        match Cube::of(view) {
            Some((cube, face)) => self.casters.sees(cube, face, slot),
            None => self.in_view.get(&view).and_then(|known| known.seen.get(slot as usize)).copied().unwrap_or(false),
        }
    }
}

impl InView {
    /// Tests the objects of slots again; whether any is seen that was not, or the other way round.
    fn test(&mut self, objects: &Objects, slots: impl Iterator<Item = u32>) -> bool {
        self.seen.resize(objects.slots().max(self.seen.len()), false);
        let mut different = false;
        for slot in slots {
            let now = objects.get(slot).is_some_and(|object| self.frusta.iter().any(|frustum| frustum.sees(object.bounds)));
            if let Some(known) = self.seen.get_mut(slot as usize) {
                different |= *known != now;
                *known = now;
            }
        }
        different
    }
}
