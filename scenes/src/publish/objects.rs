//! The objects of the world, and the table `instances`.

use bevy_ecs::prelude::World;
use bytemuck::Zeroable;
use glam::{Affine3A, DVec3, Mat4, Vec3};

use super::layout::InstanceRow;
use crate::asset::{AlphaMode, Material};
use crate::world::{GlobalTransform, MeshInstance, ObjectSlot, WorldBounds, solid_meshes};

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
#[derive(Debug, Clone, Copy)]
pub(super) struct Object {
    pub(super) slot: u32,
    pub(super) mesh: usize,
    pub(super) material: usize,
    pub(super) mirrored: bool,
    /// Drawn from both sides.
    pub(super) double_sided: bool,
    pub(super) coverage: Coverage,
    /// Of its bounds.
    pub(super) center: DVec3,
    world_from_object: Affine3A,
}

/// Every object with a finite transform, a mesh and a material, by slot.
pub(super) fn collect(world: &mut World, mesh_count: usize, materials: &[Material]) -> Vec<Object> {
    let solid = solid_meshes(world);
    let mut query = world.query::<(&MeshInstance, &ObjectSlot, &GlobalTransform, &WorldBounds)>();
    let mut objects: Vec<Object> = query
        .iter(world)
        .filter_map(|(instance, slot, transform, bounds)| {
            let material = materials.get(instance.material)?;
            if instance.mesh >= mesh_count || !transform.0.is_finite() {
                return None;
            }
            let coverage = Coverage::of(material);
            Some(Object {
                slot: slot.0,
                mesh: instance.mesh,
                material: instance.material,
                mirrored: determinant(transform.0) < 0.0,
                double_sided: material.double_sided || (coverage == Coverage::Opaque && solid.get(instance.mesh) == Some(&true)),
                coverage,
                center: bounds.bounds?.center().as_dvec3(),
                world_from_object: transform.0,
            })
        })
        .collect();
    objects.sort_unstable_by_key(|object| object.slot);
    objects
}

/// The table, a row per slot; never empty.
pub(super) fn rows(objects: &[Object]) -> Vec<InstanceRow> {
    let length = objects.last().map_or(1, |object| object.slot as usize + 1);
    let mut rows = vec![InstanceRow::zeroed(); length];
    for object in objects {
        if let Some(row) = rows.get_mut(object.slot as usize) {
            let [n0, n1, n2] = normal_columns(object.world_from_object);
            let sign = if object.mirrored { -1.0 } else { 1.0 };
            *row = InstanceRow {
                world_from_object: Mat4::from(object.world_from_object).to_cols_array_2d(),
                normal_from_object_0: n0.extend(sign).to_array(),
                normal_from_object_1: n1.extend(0.0).to_array(),
                normal_from_object_2: n2.extend(0.0).to_array(),
                material: object.material as u32,
                object: object.slot,
                pad0: 0,
                pad1: 0,
            };
        }
    }
    rows
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
