//! The objects of the world, and the table `instances`.
//!
//! Kept from frame to frame: an update looks at every object's ticks, and works on those alone that changed.

use bevy_ecs::change_detection::Tick;
use bevy_ecs::prelude::{DetectChanges, Ref, World};
use bytemuck::Zeroable;
use glam::{Affine3A, DVec3, Mat4, Vec3};
use luminaire_graph::published::Table;

use super::layout::InstanceRow;
use crate::asset::{AlphaMode, Material};
use crate::world::{Aabb, GlobalTransform, MeshInstance, ObjectSlot, Shown, WorldBounds, solid_meshes};

/// How an object's surface covers what is behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Coverage {
    Opaque,
    Masked,
    Blended,
}

impl Coverage {
    pub(super) fn of(material: &Material) -> Coverage {
        match material.alpha_mode {
            AlphaMode::Opaque => Coverage::Opaque,
            AlphaMode::Mask { .. } => Coverage::Masked,
            AlphaMode::Blend => Coverage::Blended,
        }
    }
}

/// An object that can be drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Object {
    pub(super) slot: u32,
    pub(super) mesh: usize,
    pub(super) material: usize,
    pub(super) mirrored: bool,
    /// Drawn from both sides.
    pub(super) double_sided: bool,
    pub(super) coverage: Coverage,
    pub(super) bounds: Aabb,
    world_from_object: Affine3A,
}

impl Object {
    /// The middle of its bounds.
    pub(super) fn center(&self) -> DVec3 {
        self.bounds.center().as_dvec3()
    }

    /// By what draw calls are formed: objects that agree in all but the slot share one.
    pub(super) fn key(&self) -> Key {
        (self.coverage, self.material, self.mesh, self.mirrored, self.slot)
    }

    fn row(&self) -> InstanceRow {
        let [n0, n1, n2] = normal_columns(self.world_from_object);
        let sign = if self.mirrored { -1.0 } else { 1.0 };
        InstanceRow {
            world_from_object: Mat4::from(self.world_from_object).to_cols_array_2d(),
            normal_from_object_0: n0.extend(sign).to_array(),
            normal_from_object_1: n1.extend(0.0).to_array(),
            normal_from_object_2: n2.extend(0.0).to_array(),
            material: self.material as u32,
            object: self.slot,
            pad0: 0,
            pad1: 0,
        }
    }
}

/// See [`Object::key`].
pub(super) type Key = (Coverage, usize, usize, bool, u32);

/// Every object with a finite transform, a mesh and a material that is not hidden.
#[derive(Debug, Default)]
pub(super) struct Objects {
    /// By slot.
    by_slot: Vec<Option<Object>>,
    /// The keys of all, rising.
    order: Vec<Key>,
    table: Table,
    /// Bounds of all, and of those that are not blended.
    pub(super) bounds: Option<Aabb>,
    pub(super) solid_bounds: Option<Aabb>,
}

/// So many changes are few.
const MANY: usize = 64;

/// What an update changed.
#[derive(Debug, Default)]
pub(super) struct Changed {
    /// Slots whose object is another, or gone, or new.
    pub(super) slots: Vec<u32>,
    /// Whether what stands in draw lists is other than before: keys, not places.
    pub(super) keys: bool,
    /// Whether any of them is or was blended.
    pub(super) blended: bool,
}

impl Objects {
    /// Takes over what changed since the tick; everything without one, or where materials are others. Needs an updated world.
    pub(super) fn update(&mut self, world: &mut World, since: Option<Tick>, mesh_count: usize, materials: &[Material]) -> Changed {
        let solid = solid_meshes(world);
        let now = world.change_tick();
        let is_new = |tick: Tick| since.is_none_or(|since| tick.is_newer_than(since, now));
        type Looked<'a> = (Ref<'a, MeshInstance>, Ref<'a, ObjectSlot>, Ref<'a, GlobalTransform>, Ref<'a, WorldBounds>, Ref<'a, Shown>);
        let mut query = world.query::<Looked<'_>>();
        let mut present = vec![false; self.by_slot.len()];
        let mut changed = Changed::default();
        let mut fresh = Vec::new();
        for (instance, slot, transform, bounds, shown) in query.iter(world) {
            let place = slot.0 as usize;
            if present.len() <= place {
                present.resize(place + 1, false);
            }
            present[place] = true;
            let ticks =
                [instance.last_changed(), slot.last_changed(), transform.last_changed(), bounds.last_changed(), shown.last_changed()];
            if ticks.into_iter().any(is_new) {
                let bounds = bounds.bounds.filter(|_| shown.0);
                fresh.push((slot.0, object(&instance, slot.0, &transform, bounds, mesh_count, materials, &solid)));
            }
        }
        let gone = self.by_slot.iter().enumerate().filter(|(slot, object)| object.is_some() && !present[*slot]);
        fresh.extend(gone.map(|(slot, _)| (slot as u32, None)));
        self.by_slot.resize(present.len(), None);
        // Each change moves what stands behind it in the order; many are put in order at once.
        let many = fresh.len() > MANY.max(self.order.len() / MANY);
        for (slot, object) in fresh {
            self.set(slot, object, !many, &mut changed);
        }
        if many {
            self.order = self.by_slot.iter().flatten().map(Object::key).collect();
            self.order.sort_unstable();
        }
        let rows = self.by_slot.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        self.by_slot.truncate(rows);
        if self.table.is_empty() {
            self.table = Table::new(size_of::<InstanceRow>(), &[0; size_of::<InstanceRow>()]);
        }
        self.table.resize(rows.max(1));
        for slot in &changed.slots {
            let row = self.get(*slot).map_or_else(InstanceRow::zeroed, Object::row);
            self.table.set_row(*slot as usize, bytemuck::bytes_of(&row));
        }
        if !changed.slots.is_empty() {
            self.measure();
        }
        changed
    }

    /// Without `in_order`, the order is made anew afterwards.
    fn set(&mut self, slot: u32, object: Option<Object>, in_order: bool, changed: &mut Changed) {
        let Some(entry) = self.by_slot.get_mut(slot as usize) else { return };
        let before = std::mem::replace(entry, object);
        if before == object {
            return;
        }
        changed.slots.push(slot);
        changed.blended |= before.iter().chain(&object).any(|object| object.coverage == Coverage::Blended);
        let (old, new) = (before.map(|object| object.key()), object.map(|object| object.key()));
        if old == new {
            changed.keys |= before.map(|object| object.double_sided) != object.map(|object| object.double_sided);
            return;
        }
        changed.keys = true;
        if !in_order {
            return;
        }
        if let Some(Ok(place)) = old.map(|key| self.order.binary_search(&key)) {
            self.order.remove(place);
        }
        if let Some(key) = new
            && let Err(place) = self.order.binary_search(&key)
        {
            self.order.insert(place, key);
        }
    }

    fn measure(&mut self) {
        let all = || self.by_slot.iter().flatten();
        self.bounds = all().map(|object| object.bounds).reduce(Aabb::union);
        let solid = all().filter(|object| object.coverage != Coverage::Blended);
        self.solid_bounds = solid.map(|object| object.bounds).reduce(Aabb::union);
    }

    /// The object of a slot.
    pub(super) fn get(&self, slot: u32) -> Option<&Object> {
        self.by_slot.get(slot as usize)?.as_ref()
    }

    /// All, by key.
    pub(super) fn in_order(&self) -> impl Iterator<Item = &Object> {
        self.order.iter().filter_map(|key| self.get(key.4))
    }

    /// How many slots there are, held or not.
    pub(super) fn slots(&self) -> usize {
        self.by_slot.len()
    }

    /// The table `instances`: a row per slot, never empty.
    pub(super) fn table(&self) -> &Table {
        &self.table
    }
}

fn object(
    instance: &MeshInstance,
    slot: u32,
    transform: &GlobalTransform,
    bounds: Option<Aabb>,
    mesh_count: usize,
    materials: &[Material],
    solid: &[bool],
) -> Option<Object> {
    let material = materials.get(instance.material)?;
    if instance.mesh >= mesh_count || !transform.0.is_finite() {
        return None;
    }
    let coverage = Coverage::of(material);
    Some(Object {
        slot,
        mesh: instance.mesh,
        material: instance.material,
        mirrored: determinant(transform.0) < 0.0,
        double_sided: material.double_sided || (coverage == Coverage::Opaque && solid.get(instance.mesh) == Some(&true)),
        coverage,
        bounds: bounds?,
        world_from_object: transform.0,
    })
}

fn columns(transform: Affine3A) -> [DVec3; 3] {
    let matrix = transform.matrix3;
    [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|column| Vec3::from(column).as_dvec3())
}

fn determinant(transform: Affine3A) -> f64 {
    let [a, b, c] = columns(transform);
    a.dot(b.cross(c))
}

/// Columns of the inverse transpose. It is the cofactor matrix over the determinant; where that is too large or too small for a
/// shader to normalise, the cofactor matrix scaled to 1 (for a transform that flattens to a plane, the plane's normal); where that is
/// zero, too, since everything collapses to a line or a point, the identity.
pub(super) fn normal_columns(transform: Affine3A) -> [Vec3; 3] {
    let [a, b, c] = columns(transform);
    let cofactors = [b.cross(c), c.cross(a), a.cross(b)];
    let determinant = a.dot(cofactors[0]);
    let largest = |columns: [DVec3; 3]| columns.map(|column| column.abs().max_element()).into_iter().fold(0.0, f64::max);
    let exact = cofactors.map(|column| column / determinant);
    if exact.iter().all(|column| column.is_finite()) && (1e-15..=1e15).contains(&largest(exact)) {
        return exact.map(|column| column.as_vec3());
    }
    let size = largest(cofactors);
    let scaled = cofactors.map(|column| column / if determinant < 0.0 { -size } else { size });
    if size > 0.0 && scaled.iter().all(|column| column.is_finite()) {
        scaled.map(|column| column.as_vec3())
    } else {
        [Vec3::X, Vec3::Y, Vec3::Z]
    }
}

#[cfg(test)]
mod tests {
    use glam::{Mat3, Quat};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn normals_stay_orthogonal_to_transformed_tangents(
            sx in 0.1_f32..4.0, sy in -4.0_f32..-0.1, sz in 0.1_f32..4.0, angle in 0.0_f32..6.0, u in 0.0_f32..6.0,
        ) {
            let transform = Affine3A::from_scale_rotation_translation(Vec3::new(sx, sy, sz), Quat::from_rotation_x(angle), Vec3::ONE)
                * Affine3A::from_rotation_z(u);
            let normals = Mat3::from_cols_array_2d(&normal_columns(transform).map(|column| column.to_array()));
            let (normal, tangent) = (Vec3::new(1.0, 2.0, 0.5), Vec3::new(2.0, -1.0, 0.0));
            let cosine = (normals * normal).normalize().dot(transform.transform_vector3(tangent).normalize());
            prop_assert!(cosine.abs() < 1e-4);
            let exact = transform.matrix3.inverse().transpose() * glam::Vec3A::from(normal);
            prop_assert!((normals * normal - Vec3::from(exact)).length() < 1e-3 * exact.length());
        }
    }

    #[test]
    fn singular_transforms_give_finite_normals() {
        let flat = normal_columns(Affine3A::from_scale(Vec3::new(2.0, 0.0, 3.0)));
        assert_eq!(flat[1], Vec3::Y, "the normal of the plane");
        assert_eq!(flat[0], Vec3::ZERO);
        for scale in [Vec3::ZERO, Vec3::new(1.0, 0.0, 0.0), Vec3::splat(1e-30), Vec3::splat(1e30), Vec3::new(1e-38, 1.0, -1e38)] {
            let columns = normal_columns(Affine3A::from_scale(scale));
            assert!(columns.iter().all(|column| column.is_finite()), "{scale}: {columns:?}");
            assert!(columns.iter().any(|column| column.length_squared() > 0.0));
        }
    }
}
