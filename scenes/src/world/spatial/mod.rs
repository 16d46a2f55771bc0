//! What stands where: an R*-tree over the bounds of objects, the places of lights and cameras, and the boxes of probes and volumes.
//!
//! Guarantees: answers are exact for the axis-aligned bounds of objects and for the boxes of markers at whatever angle they stand. They
//! come in the order of entities, or of distance, and depend on nothing but what stands where; what is hidden stands there, too. The tree
//! is brought up to date when somebody asks, so that things which move while nobody does cost next to nothing.
//! Accepted downside: an axis-aligned box around a slanted object holds more than the object.

mod oriented;

use std::collections::BTreeMap;

use bevy_ecs::prelude::{Added, Changed, Component, Entity, Or, Resource, With, World};
use glam::{DVec3, Vec3};
use rstar::{AABB, PointDistance, RTree, RTreeObject};

pub use oriented::OrientedBox;

use super::slots::order;
use super::{Aabb, Camera, GlobalTransform, LocalLight, ProbeVolume, ReflectionProbe, Volume, WorldBounds};

/// What kind of thing is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Something that is drawn, by its bounds.
    Object,
    /// A point or spot light, by its place.
    Light,
    /// A camera, by its place.
    Camera,
    /// A grid of probes, by the box around its probes.
    ProbeVolume,
    /// A probe for reflections, by the box in which it counts.
    ReflectionProbe,
    /// A box, by itself.
    Volume,
}

/// Markers fill boxes.
trait Marker: Component {
    const KIND: Kind;

    /// Edges around the entity's origin, along its axes, metres.
    fn size(&self) -> Vec3;
}

impl Marker for ProbeVolume {
    const KIND: Kind = Kind::ProbeVolume;

    fn size(&self) -> Vec3 {
        (self.counts.as_vec3() - 1.0).max(Vec3::ZERO) * self.spacing
    }
}

impl Marker for ReflectionProbe {
    const KIND: Kind = Kind::ReflectionProbe;

    fn size(&self) -> Vec3 {
        self.size
    }
}

impl Marker for Volume {
    const KIND: Kind = Kind::Volume;

    fn size(&self) -> Vec3 {
        self.size
    }
}

/// What belongs to a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Holds {
    /// Whatever has a point in common with it.
    Meeting,
    /// Only what lies in it as a whole.
    Enclosed,
}

/// A thing of the index.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Entry {
    entity: Entity,
    kind: Kind,
    bounds: Aabb,
    /// Of a marker.
    shape: Option<OrientedBox>,
}

impl Entry {
    fn distance_squared(&self, point: DVec3) -> f64 {
        self.shape.as_ref().map_or_else(|| self.bounds.distance_squared(point), |shape| shape.distance_squared(point))
    }

    fn shape(&self) -> OrientedBox {
        self.shape.unwrap_or_else(|| OrientedBox::of_bounds(self.bounds))
    }
}

impl RTreeObject for Entry {
    type Envelope = AABB<[f32; 3]>;

    fn envelope(&self) -> Self::Envelope {
        envelope(self.bounds)
    }
}

/// The tree multiplies extents: beyond this, metres, everything counts as equally far.
const FAR: f32 = 1e9;

fn envelope(bounds: Aabb) -> AABB<[f32; 3]> {
    let [min, max] = [bounds.min, bounds.max].map(|corner| corner.clamp(Vec3::splat(-FAR), Vec3::splat(FAR)).to_array());
    AABB::from_corners(min, max)
}

impl PointDistance for Entry {
    fn distance_2(&self, point: &[f32; 3]) -> f32 {
        self.distance_squared(Vec3::from_array(*point).as_dvec3()) as f32
    }
}

/// Where everything stands, as of the last [`super::update`].
#[derive(Resource, Debug, Default)]
pub struct SpatialIndex {
    known: BTreeMap<(Entity, Kind), Entry>,
    tree: RTree<Entry>,
    /// What stands in the tree otherwise than it is known, or not at all, with how it stands there.
    pending: BTreeMap<(Entity, Kind), Option<Entry>>,
}

/// A new tree of all things costs about as much as changing one in so many of them in the old one.
const FEW: usize = 128;

impl SpatialIndex {
    /// The things of a kind that meet an axis-aligned box, by entity.
    pub fn in_box(&mut self, kind: Kind, bounds: Aabb) -> Vec<Entity> {
        self.held(kind, &OrientedBox::of_bounds(bounds), Holds::Meeting)
    }

    /// The things of a kind that a box at whatever angle holds, by entity. Objects count by their axis-aligned bounds.
    pub fn held(&mut self, kind: Kind, by: &OrientedBox, holds: Holds) -> Vec<Entity> {
        let held = |entry: &&Entry| {
            entry.kind == kind
                && match holds {
                    Holds::Meeting => by.meets(&entry.shape()),
                    Holds::Enclosed => by.encloses(&entry.shape()),
                }
        };
        sorted(self.settled().locate_in_envelope_intersecting(envelope(by.bounds())).filter(held).map(|entry| entry.entity))
    }

    /// The things of a kind that a marker holds; `None` if the entity is no probe and no volume, or its box is not finite.
    pub fn held_by(&mut self, kind: Kind, marker: Entity, holds: Holds) -> Option<Vec<Entity>> {
        let by = self.shape(marker)?;
        Some(self.held(kind, &by, holds))
    }

    /// The box of a marker.
    pub fn shape(&self, marker: Entity) -> Option<OrientedBox> {
        let kinds = [Kind::Volume, Kind::ReflectionProbe, Kind::ProbeVolume];
        kinds.into_iter().find_map(|kind| self.known.get(&(marker, kind))?.shape)
    }

    /// The things of a kind that come as near to a point as `radius`, metres, by entity. With 0 these are the ones around it.
    pub fn in_sphere(&mut self, kind: Kind, center: DVec3, radius: f64) -> Vec<Entity> {
        // A little larger, since the box is rounded.
        let reach = Vec3::splat((radius * (1.0 + 1e-6)) as f32);
        let middle = center.as_vec3();
        let slack = Vec3::splat(middle.abs().max_element() * 1e-6);
        let (min, max) = (middle - reach - slack, middle + reach + slack);
        let around = envelope(Aabb { min, max });
        let near = |entry: &&Entry| entry.kind == kind && entry.distance_squared(center) <= radius * radius;
        sorted(self.settled().locate_in_envelope_intersecting(around).filter(near).map(|entry| entry.entity))
    }

    /// The nearest things of a kind, at most `count`, nearest first, with their distances in metres, which are 0 inside. Equally near
    /// ones come by their middle, then by entity.
    pub fn nearest(&mut self, kind: Kind, point: DVec3, count: usize) -> Vec<(Entity, f64)> {
        let of_kind = self.settled().nearest_neighbor_iter(point.as_vec3().to_array()).filter(|entry| entry.kind == kind);
        let slack = (point.abs().max_element() + 1.0) * 1e-5;
        let mut found: Vec<(Entity, f64, f64)> = Vec::new();
        for entry in of_kind {
            let distance = entry.distance_squared(point).sqrt();
            // The tree rounds: what comes a little later may be as near.
            let enough = count.checked_sub(1).map_or(f64::NEG_INFINITY, |last| found.get(last).map_or(f64::INFINITY, |last| last.1));
            if distance > enough * (1.0 + 1e-5) + slack {
                break;
            }
            found.push((entry.entity, distance, entry.shape().center.distance_squared(point)));
        }
        found.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)).then(order(a.0).cmp(&order(b.0))));
        found.into_iter().take(count).map(|(entity, distance, _)| (entity, distance)).collect()
    }

    /// Takes what changed over.
    pub(super) fn update(world: &mut World) {
        let mut index = world.remove_resource::<SpatialIndex>().unwrap_or_default();
        let mut fresh: Vec<Fresh> = Vec::new();
        let mut moved = world.query_filtered::<(Entity, &WorldBounds), Changed<WorldBounds>>();
        let objects = moved.iter(world).map(|(entity, known)| {
            let entry = known.bounds.map(|bounds| Entry { entity, kind: Kind::Object, bounds, shape: None });
            ((entity, Kind::Object), entry)
        });
        fresh.extend(objects);
        gone::<WorldBounds>(world, Kind::Object, &mut fresh);
        places::<LocalLight>(world, Kind::Light, &mut fresh);
        places::<Camera>(world, Kind::Camera, &mut fresh);
        boxes::<ProbeVolume>(world, &mut fresh);
        boxes::<ReflectionProbe>(world, &mut fresh);
        boxes::<Volume>(world, &mut fresh);
        index.take(fresh);
        world.insert_resource(index);
    }

    fn take(&mut self, fresh: Vec<Fresh>) {
        for (key, entry) in fresh {
            let before = match entry {
                Some(entry) => self.known.insert(key, entry),
                None => self.known.remove(&key),
            };
            if before != entry {
                self.pending.entry(key).or_insert(before);
            }
        }
    }

    /// The tree, up to date.
    fn settled(&mut self) -> &RTree<Entry> {
        let pending = std::mem::take(&mut self.pending);
        if pending.len() > self.known.len() / FEW {
            self.tree = RTree::bulk_load(self.known.values().copied().collect());
            return &self.tree;
        }
        for (key, before) in pending {
            if let Some(before) = before {
                self.tree.remove(&before);
            }
            if let Some(now) = self.known.get(&key) {
                self.tree.insert(*now);
            }
        }
        &self.tree
    }
}

/// A thing as it stands now; without an entry it stands nowhere.
type Fresh = ((Entity, Kind), Option<Entry>);

fn places<Of: Component>(world: &mut World, kind: Kind, fresh: &mut Vec<Fresh>) {
    type Moved<Of> = Or<(Changed<GlobalTransform>, Added<Of>)>;
    let mut query = world.query_filtered::<(Entity, &GlobalTransform), (With<Of>, Moved<Of>)>();
    for (entity, transform) in query.iter(world) {
        let place = Vec3::from(transform.0.translation);
        let entry = Entry { entity, kind, bounds: Aabb { min: place, max: place }, shape: None };
        fresh.push(((entity, kind), place.is_finite().then_some(entry)));
    }
    gone::<Of>(world, kind, fresh);
}

fn boxes<Of: Marker>(world: &mut World, fresh: &mut Vec<Fresh>) {
    type Moved<Of> = Or<(Changed<GlobalTransform>, Changed<Of>)>;
    let mut query = world.query_filtered::<(Entity, &Of, &GlobalTransform), Moved<Of>>();
    for (entity, marker, transform) in query.iter(world) {
        let shape = OrientedBox::new(marker.size(), transform.0);
        let entry = shape.map(|shape| Entry { entity, kind: Of::KIND, bounds: shape.bounds(), shape: Some(shape) });
        fresh.push(((entity, Of::KIND), entry));
    }
    gone::<Of>(world, Of::KIND, fresh);
}

fn gone<Of: Component>(world: &World, kind: Kind, fresh: &mut Vec<Fresh>) {
    let gone = world.removed::<Of>().filter(|entity| world.get::<Of>(*entity).is_none());
    fresh.extend(gone.map(|entity| ((entity, kind), None)));
}

fn sorted(found: impl Iterator<Item = Entity>) -> Vec<Entity> {
    let mut found: Vec<Entity> = found.collect();
    found.sort_unstable_by_key(|entity| order(*entity));
    found
}

#[cfg(test)]
mod tests;
