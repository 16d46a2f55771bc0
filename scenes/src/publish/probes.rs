//! Reflection probes, in the order of their slots. A slot that nobody holds, or something hidden, is a probe without a far plane that
//! captures nothing, so that those after it keep their index.

use bevy_ecs::prelude::World;
use glam::DMat4;

use super::casters::Center;
use super::layout::ProbeRow;
use super::lights::place;
use super::projection::{columns, vector};
use crate::world::{GlobalTransform, OrientedBox, ProbeSlot, ReflectionProbe, Shown};

/// The table `reflection_probes`. A probe whose place or box is not finite, or whose box is flat, captures nothing.
pub(super) fn rows(world: &mut World) -> Vec<ProbeRow> {
    let mut probes: Vec<Option<ProbeRow>> = Vec::new();
    for (probe, slot, transform, shown) in world.query::<(&ReflectionProbe, &ProbeSlot, &GlobalTransform, &Shown)>().iter(world) {
        place(&mut probes, slot.0, row(probe, transform).filter(|_| shown.0));
    }
    probes.into_iter().map(|row| row.unwrap_or_else(bytemuck::Zeroable::zeroed)).collect()
}

/// From where the cube of a probe is drawn. `None` if it captures nothing.
pub(super) fn center(rows: &[ProbeRow], slot: u32) -> Option<Center> {
    let row = rows.get(slot as usize).filter(|row| row.far > 0.0)?;
    let [near, far] = [row.near, row.far].map(f64::from);
    // The corners of a far plane are farther away than its middle.
    let reach = far * 3.0_f64.sqrt();
    Some(Center { position: glam::Vec3::from(row.position).as_dvec3(), radius: 0.0, planes: [near, far], reach })
}

fn row(probe: &ReflectionProbe, transform: &GlobalTransform) -> Option<ProbeRow> {
    let shape = OrientedBox::new(probe.size, transform.0)?;
    let [x, y, z] = shape.halves;
    let world_from_box = DMat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), shape.center.extend(1.0));
    let box_from_world = columns(world_from_box.inverse());
    let finite = box_from_world.as_flattened().iter().all(|number| number.is_finite());
    let (near, far) = (probe.near, probe.far);
    let row = ProbeRow { position: vector(shape.center), near, box_from_world, far, pad: [0.0; 3] };
    (finite && near > 0.0 && near < far && far.is_finite()).then_some(row)
}

#[cfg(test)]
mod tests {
    use glam::{Affine3A, Mat4, Quat, Vec3};

    use super::*;

    const PROBE: ReflectionProbe = ReflectionProbe { size: Vec3::new(4.0, 2.0, 6.0), near: 0.1, far: 50.0 };

    #[test]
    fn corners_of_the_box_are_ones() {
        let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.7, -0.3, 1.1);
        let place = Affine3A::from_scale_rotation_translation(Vec3::new(1.0, -2.0, 0.5), turn, Vec3::new(3.0, -1.0, 2.0));
        let row = row(&PROBE, &GlobalTransform(place)).unwrap();
        let box_from_world = Mat4::from_cols_array_2d(&row.box_from_world);
        for corner in [Vec3::ONE, Vec3::NEG_ONE, Vec3::new(1.0, -1.0, 1.0)] {
            let found = box_from_world.transform_point3(place.transform_point3(corner * PROBE.size * 0.5));
            assert!((found - corner).length() < 1e-5, "{found}");
        }
        assert_eq!((row.position, row.near, row.far), ([3.0, -1.0, 2.0], 0.1, 50.0));
        assert_eq!(box_from_world.row(3).to_array(), [0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn what_can_capture_nothing_is_no_probe() {
        for place in [Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0)), Affine3A::from_translation(Vec3::splat(f32::NAN))] {
            assert_eq!(row(&PROBE, &GlobalTransform(place)), None, "{place:?}");
        }
        for (near, far) in [(0.0, 1.0), (2.0, 1.0), (0.1, f32::INFINITY), (f32::NAN, 1.0)] {
            let probe = ReflectionProbe { near, far, ..PROBE };
            assert_eq!(row(&probe, &GlobalTransform(Affine3A::IDENTITY)), None, "{near} {far}");
        }
    }
}
