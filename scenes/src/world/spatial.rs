//! What stands where: an R*-tree over the bounds of objects and the places of lights and cameras.
//!
//! Guarantees: answers are exact for axis-aligned bounds and come in the order of entities, or of distance. The tree is brought up to date
//! when somebody asks, so that things which move while nobody does cost next to nothing. Accepted downside: a box around a slanted thing
//! holds more than the thing.

use std::collections::BTreeMap;

use bevy_ecs::prelude::{Added, Changed, Component, Entity, Or, Resource, With, World};
use glam::{DVec3, Vec3};
use rstar::{AABB, PointDistance, RTree, RTreeObject};

use super::slots::order;
use super::{Aabb, Camera, GlobalTransform, LocalLight, WorldBounds};

/// What kind of thing is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Something that is drawn, by its bounds.
    Object,
    /// A point or spot light, by its place.
    Light,
    /// A camera, by its place.
    Camera,
}

/// A thing of the index.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Entry {
    entity: Entity,
    kind: Kind,
    bounds: Aabb,
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
        let at = Vec3::from_array(*point);
        at.distance_squared(at.clamp(self.bounds.min, self.bounds.max))
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
    /// The things of a kind whose bounds meet a box, by entity.
    pub fn in_box(&mut self, kind: Kind, bounds: Aabb) -> Vec<Entity> {
        let meets = |entry: &&Entry| entry.kind == kind && entry.bounds.meets(bounds);
        let found = self.settled().locate_in_envelope_intersecting(envelope(bounds)).filter(meets);
        sorted(found.map(|entry| entry.entity))
    }

    /// The things of a kind whose bounds come as near to a point as `radius`, metres, by entity.
    pub fn in_sphere(&mut self, kind: Kind, center: DVec3, radius: f64) -> Vec<Entity> {
        // A little larger, since the box is rounded.
        let reach = Vec3::splat((radius * (1.0 + 1e-6)) as f32);
        let middle = center.as_vec3();
        let slack = Vec3::splat(middle.abs().max_element() * 1e-6);
        let (min, max) = (middle - reach - slack, middle + reach + slack);
        let around = envelope(Aabb { min, max });
        let near = |entry: &&Entry| entry.kind == kind && entry.bounds.distance_squared(center) <= radius * radius;
        sorted(self.settled().locate_in_envelope_intersecting(around).filter(near).map(|entry| entry.entity))
    }

    /// The nearest things of a kind, at most `count`, nearest first, with their distances in metres.
    pub fn nearest(&mut self, kind: Kind, point: DVec3, count: usize) -> Vec<(Entity, f64)> {
        let of_kind = self.settled().nearest_neighbor_iter(point.as_vec3().to_array()).filter(|entry| entry.kind == kind);
        let mut found: Vec<(Entity, f64)> =
            of_kind.take(count).map(|entry| (entry.entity, entry.bounds.distance_squared(point).sqrt())).collect();
        found.sort_by(|a, b| a.1.total_cmp(&b.1).then(order(a.0).cmp(&order(b.0))));
        found
    }

    /// Takes what changed over.
    pub(super) fn update(world: &mut World) {
        let mut index = world.remove_resource::<SpatialIndex>().unwrap_or_default();
        let mut fresh: Vec<((Entity, Kind), Option<Aabb>)> = Vec::new();
        let objects = world
            .query_filtered::<(Entity, &WorldBounds), Changed<WorldBounds>>()
            .iter(world)
            .map(|(entity, bounds)| ((entity, Kind::Object), bounds.bounds))
            .collect::<Vec<_>>();
        fresh.extend(objects);
        places::<LocalLight>(world, Kind::Light, &mut fresh);
        places::<Camera>(world, Kind::Camera, &mut fresh);
        let gone = world.removed::<WorldBounds>().map(|entity| (entity, Kind::Object));
        let gone = gone.chain(world.removed::<LocalLight>().map(|entity| (entity, Kind::Light)));
        let gone: Vec<_> = gone.chain(world.removed::<Camera>().map(|entity| (entity, Kind::Camera))).collect();
        for key in gone.into_iter().filter(|key| !index.stands(world, *key)) {
            fresh.push((key, None));
        }
        index.take(fresh);
        world.insert_resource(index);
    }

    fn stands(&self, world: &World, (entity, kind): (Entity, Kind)) -> bool {
        match kind {
            Kind::Object => world.get::<WorldBounds>(entity).is_some(),
            Kind::Light => world.get::<LocalLight>(entity).is_some(),
            Kind::Camera => world.get::<Camera>(entity).is_some(),
        }
    }

    fn take(&mut self, fresh: Vec<((Entity, Kind), Option<Aabb>)>) {
        for (key, bounds) in fresh {
            let entry = bounds.map(|bounds| Entry { entity: key.0, kind: key.1, bounds });
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

fn places<Of: Component>(world: &mut World, kind: Kind, fresh: &mut Vec<((Entity, Kind), Option<Aabb>)>) {
    type Moved<Of> = Or<(Changed<GlobalTransform>, Added<Of>)>;
    let mut query = world.query_filtered::<(Entity, &GlobalTransform), (With<Of>, Moved<Of>)>();
    for (entity, transform) in query.iter(world) {
        let place = Vec3::from(transform.0.translation);
        fresh.push(((entity, kind), place.is_finite().then_some(Aabb { min: place, max: place })));
    }
}

fn sorted(found: impl Iterator<Item = Entity>) -> Vec<Entity> {
    let mut found: Vec<Entity> = found.collect();
    found.sort_unstable_by_key(|entity| order(*entity));
    found
}

#[cfg(test)]
mod tests {
    use glam::Affine3A;
    use proptest::prelude::*;

    use super::*;
    use crate::primitive::cuboid;
    use crate::world::{MeshInstance, Meshes, Transform, new_world, update};

    fn box_at(world: &mut World, at: Vec3) -> Entity {
        world.spawn((Transform(Affine3A::from_translation(at)), MeshInstance { mesh: 0, material: 0 })).id()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

        /// Spawns, moves and removals against a look at everything.
        #[test]
        fn answers_are_those_of_a_look_at_everything(
            steps in prop::collection::vec((0_u8..4, 0_usize..40, prop::array::uniform3(-9.0_f32..9.0)), 1..120),
            center in prop::array::uniform3(-9.0_f64..9.0),
            radius in 0.0_f64..8.0,
        ) {
            let mut world = new_world();
            world.resource_mut::<Meshes>().0.push(cuboid("box", Vec3::ONE, 0));
            // Enough that few changes are made in the tree that stands.
            let grid = (0..3 * FEW).map(|index| Vec3::new((index % 20) as f32 - 10.0, 0.0, (index / 20) as f32 - 10.0));
            let mut boxes: Vec<Entity> = grid.map(|at| box_at(&mut world, at)).collect();
            let center = DVec3::from_array(center);
            for (what, which, at) in steps {
                let at = Vec3::from_array(at);
                let which = (!boxes.is_empty()).then(|| which % boxes.len().max(1));
                match (what, which) {
                    (0, Some(which)) => _ = world.despawn(boxes.remove(which)),
                    (1, Some(which)) => world.get_mut::<Transform>(boxes[which]).unwrap().0.translation = at.into(),
                    _ => boxes.push(box_at(&mut world, at)),
                }
                if what > 0 {
                    update(&mut world);
                }
                if what > 1 {
                    world.resource_mut::<SpatialIndex>().in_sphere(Kind::Object, center, radius);
                }
            }
            update(&mut world);
            let bounds: Vec<(Entity, Aabb)> =
                world.query::<(Entity, &WorldBounds)>().iter(&world).map(|(entity, bounds)| (entity, bounds.bounds.unwrap())).collect();
            let mut index = world.resource_mut::<SpatialIndex>();
            let near = bounds.iter().filter(|(_, bounds)| bounds.distance_squared(center) <= radius * radius);
            prop_assert_eq!(index.in_sphere(Kind::Object, center, radius), sorted(near.map(|(entity, _)| *entity)));
            let nearest = bounds.iter().map(|(_, bounds)| bounds.distance_squared(center).sqrt()).fold(f64::INFINITY, f64::min);
            let found = index.nearest(Kind::Object, center, 1);
            prop_assert_eq!(found.is_empty(), bounds.is_empty());
            prop_assert!(found.iter().all(|(_, distance)| (distance - nearest).abs() < 1e-4));
        }
    }
}
