//! Axis-aligned bounds of what stands in the world.

use bevy_ecs::prelude::{Changed, Component, DetectChanges, DetectChangesMut, Entity, Or, Without, World};
use glam::{Affine3A, DVec3, Mat3A, Vec3, Vec3A};

use super::{GlobalTransform, MeshInstance, Meshes, Shown};

/// A finite axis-aligned box, world space, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The bounds of all finite points; `None` if there are none.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Option<Aabb> {
        points.into_iter().filter(|point| point.is_finite()).fold(None, |bounds, point| {
            let bounds = bounds.unwrap_or(Aabb { min: point, max: point });
            Some(Aabb { min: bounds.min.min(point), max: bounds.max.max(point) })
        })
    }

    /// The bounds of both.
    pub fn union(self, other: Aabb) -> Aabb {
        Aabb { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The middle.
    pub fn center(self) -> Vec3 {
        // Halved before the sum, which could overflow.
        self.min * 0.5 + self.max * 0.5
    }

    /// Radius of the sphere around all corners, metres; finite.
    pub fn radius(self) -> f32 {
        let half = (self.max.as_dvec3() - self.min.as_dvec3()) * 0.5;
        (half.length() as f32).min(f32::MAX)
    }

    /// Whether they have a point in common.
    pub fn meets(self, other: Aabb) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// How far a point is from the box; 0 inside. In the point's unit, squared.
    pub fn distance_squared(self, point: DVec3) -> f64 {
        point.distance_squared(point.clamp(self.min.as_dvec3(), self.max.as_dvec3()))
    }

    /// How far the farthest corner is from a point.
    pub fn farthest(self, point: DVec3) -> f64 {
        self.corners().map(|corner| corner.as_dvec3().distance(point)).into_iter().fold(0.0, f64::max)
    }

    /// The eight corners.
    pub fn corners(self) -> [Vec3; 8] {
        std::array::from_fn(|corner| {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] };
            Vec3::new(pick(0), pick(1), pick(2))
        })
    }
}

/// The bounds of a [`MeshInstance`]; `None` if no vertex is finite.
#[derive(Component, Debug, Clone, Copy, PartialEq)]
pub struct WorldBounds {
    /// World space.
    pub bounds: Option<Aabb>,
}

/// Writes the [`WorldBounds`] of every mesh instance that moved or changed its mesh since the world's trackers were cleared. Exact:
/// every vertex counts, for a transformed box would be loose. Needs propagated transforms.
pub fn update_bounds(world: &mut World) {
    type Stale = Or<(Changed<MeshInstance>, Changed<GlobalTransform>, Without<WorldBounds>)>;
    let Some(meshes) = world.get_resource_ref::<Meshes>() else { return };
    // An instance may name a mesh that comes later.
    let more = meshes.is_changed();
    let mut fresh = Vec::new();
    let mut last = LastShape::default();
    let mut bounds =
        |instance: &MeshInstance, transform: &GlobalTransform, meshes: &Meshes| last.bounds(instance.mesh, transform.0, meshes);
    let mut stale = world.query_filtered::<(Entity, &MeshInstance, &GlobalTransform), Stale>();
    let mut empty = world.query::<(Entity, &MeshInstance, &GlobalTransform, &WorldBounds)>();
    let Some(meshes) = world.get_resource::<Meshes>() else { return };
    fresh.extend(stale.iter(world).map(|(entity, instance, transform)| (entity, bounds(instance, transform, meshes))));
    if more {
        let empty = empty.iter(world).filter(|(.., known)| known.bounds.is_none());
        fresh.extend(empty.map(|(entity, instance, transform, _)| (entity, bounds(instance, transform, meshes))));
    }
    for (entity, bounds) in fresh {
        match world.get_mut::<WorldBounds>(entity) {
            Some(mut known) => _ = known.set_if_neq(WorldBounds { bounds }),
            None => _ = world.entity_mut(entity).insert(WorldBounds { bounds }),
        }
    }
}

/// The mesh that was measured last: copies of a thing stand behind one another, and differ in their place alone.
#[derive(Default)]
struct LastShape {
    mesh: usize,
    axes: Mat3A,
    /// Without the place.
    bounds: Option<Aabb>,
}

impl LastShape {
    /// Bit for bit what all vertices give: a sum is rounded alike whether it is taken of all or of the extreme ones.
    fn bounds(&mut self, mesh: usize, place: Affine3A, meshes: &Meshes) -> Option<Aabb> {
        let vertices = meshes.0.get(mesh).map_or(&[][..], |mesh| &mesh.vertices);
        if self.bounds.is_none() || self.mesh != mesh || self.axes != place.matrix3 {
            let points = vertices.iter().map(|vertex| Vec3::from(place.matrix3 * Vec3A::from(vertex.position)));
            *self = LastShape { mesh, axes: place.matrix3, bounds: Aabb::of(points) };
        }
        let [min, max] = self.bounds.map(|bounds| [bounds.min, bounds.max])?.map(|corner| corner + Vec3::from(place.translation));
        if min.is_finite() && max.is_finite() {
            return Some(Aabb { min, max });
        }
        Aabb::of(vertices.iter().map(|vertex| place.transform_point3(Vec3::from(vertex.position))))
    }
}

/// The bounds of all mesh instances that are not hidden, as of the last [`update_bounds`]; `None` if there is nothing.
pub fn scene_bounds(world: &mut World) -> Option<Aabb> {
    let mut query = world.query::<(&WorldBounds, &Shown)>();
    query.iter(world).filter(|(_, shown)| shown.0).filter_map(|(known, _)| known.bounds).reduce(Aabb::union)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::asset::{Mesh, Vertex};
    use crate::primitive::cuboid;

    #[test]
    fn points_that_are_not_finite_are_left_out() {
        let points = [Vec3::new(f32::NAN, 0.0, 0.0), Vec3::ONE, Vec3::new(-1.0, 2.0, 0.5), Vec3::splat(f32::INFINITY)];
        assert_eq!(Aabb::of(points), Some(Aabb { min: Vec3::new(-1.0, 1.0, 0.5), max: Vec3::new(1.0, 2.0, 1.0) }));
        assert_eq!(Aabb::of([Vec3::NAN]), None);
    }

    proptest! {
        #[test]
        fn copies_have_the_bounds_of_all_their_vertices(
            points in prop::collection::vec(prop::array::uniform3(-3.0_f32..3.0), 1..20),
            places in prop::collection::vec((prop::array::uniform3(-9.0_f32..9.0), 0_usize..3), 1..12),
            size in prop_oneof![Just(1.0_f32), Just(1e-3), Just(3e38), Just(f32::NAN)],
        ) {
            let vertex = |position| Vertex { position, ..bytemuck::Zeroable::zeroed() };
            let mesh = Mesh { vertices: points.iter().copied().map(vertex).collect(), ..cuboid("box", Vec3::ONE, 0) };
            let meshes = Meshes(vec![mesh]);
            let mut last = LastShape::default();
            for (at, axes) in places {
                let axes = [Mat3A::IDENTITY, Mat3A::from_rotation_x(0.7), Mat3A::from_diagonal(Vec3::new(size, 1.0, -2.0))][axes];
                let place = Affine3A { matrix3: axes, translation: (Vec3::from(at) * size.max(1.0)).into() };
                let expected = Aabb::of(points.iter().map(|point| place.transform_point3(Vec3::from(*point))));
                prop_assert_eq!(last.bounds(0, place, &meshes), expected);
            }
        }
    }

    #[test]
    fn huge_bounds_stay_finite() {
        let bounds = Aabb { min: Vec3::splat(f32::MIN), max: Vec3::splat(f32::MAX) };
        assert!(bounds.center().is_finite() && bounds.radius().is_finite());
    }
}
