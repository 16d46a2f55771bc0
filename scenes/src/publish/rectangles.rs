//! Rectangles that give light, in the order of their slots. A slot that nobody holds, or something hidden, is a rectangle without extent
//! that gives none, so that those after it keep their index.

use bevy_ecs::prelude::World;
use glam::Vec3;

use super::casters::Center;
use super::layout::RectangleRow;
use super::lights::{place, strength};
use super::projection::single;
use super::reach::endless_planes;
use crate::world::{Aabb, GlobalTransform, RectangleLight, RectangleSlot, Shown};

/// The table `rectangle_lights`. What is not finite gives no light. `solid` are the bounds of what throws shadows.
pub(super) fn rows(world: &mut World, solid: Option<Aabb>) -> Vec<RectangleRow> {
    let mut rectangles: Vec<Option<RectangleRow>> = Vec::new();
    for (light, slot, transform, shown) in world.query::<(&RectangleLight, &RectangleSlot, &GlobalTransform, &Shown)>().iter(world) {
        place(&mut rectangles, slot.0, Some(row(light, transform, solid)).filter(|_| shown.0));
    }
    rectangles.into_iter().map(|row| row.unwrap_or_else(bytemuck::Zeroable::zeroed)).collect()
}

/// From where the shadow cube of a rectangle is drawn: from its middle, or from any other point of it. `None` if it gives no light.
pub(super) fn center(rows: &[RectangleRow], slot: u32) -> Option<Center> {
    let row = rows.get(slot as usize).filter(|row| row.area > 0.0)?;
    let [near, far] = [row.near, row.far].map(f64::from);
    let radius = f64::from(row.radius);
    Some(Center { position: Vec3::from(row.position).as_dvec3(), radius, planes: [near, far], reach: far + radius })
}

/// A rectangle is stretched as its mesh is, and keeps its luminance. One that a transform mirrors faces where its mesh does.
fn row(light: &RectangleLight, transform: &GlobalTransform, solid: Option<Aabb>) -> RectangleRow {
    let none = <RectangleRow as bytemuck::Zeroable>::zeroed();
    let axes = transform.0.matrix3;
    let turn = if axes.determinant() < 0.0 { 1.0 } else { -1.0 };
    let half_width = Vec3::from(axes.x_axis) * (0.5 * turn * light.size.x);
    let half_height = Vec3::from(axes.y_axis) * (0.5 * light.size.y);
    let radius = (half_width + half_height).length().max((half_width - half_height).length());
    let position = Vec3::from(transform.0.translation);
    let area = 4.0 * half_width.cross(half_height).length();
    if !position.is_finite() || !radius.is_finite() || !area.is_normal() {
        return none;
    }
    let [near, far] = endless_planes(position.as_dvec3(), f64::from(radius), solid).map(single);
    RectangleRow {
        position: position.to_array(),
        two_sided: u32::from(light.two_sided),
        half_width: half_width.to_array(),
        radius,
        half_height: half_height.to_array(),
        area,
        radiance: strength(light.color, light.luminance).to_array(),
        near,
        far,
        ..none
    }
}

#[cfg(test)]
mod tests {
    use glam::{Affine3A, Mat3, Vec2};

    use super::*;

    const LIGHT: RectangleLight =
        RectangleLight { color: Vec3::new(1.0, 0.5, 0.25), luminance: 8.0, size: Vec2::new(4.0, 2.0), two_sided: false };

    fn row_at(axes: Mat3) -> RectangleRow {
        row(&LIGHT, &GlobalTransform(Affine3A::from_mat3_translation(axes, Vec3::new(1.0, 2.0, 3.0))), None)
    }

    fn front(row: &RectangleRow) -> Vec3 {
        Vec3::from(row.half_width).cross(Vec3::from(row.half_height)).normalize()
    }

    #[test]
    fn a_rectangle_faces_along_minus_z_and_is_stretched_with_its_mesh() {
        let plain = row_at(Mat3::IDENTITY);
        assert_eq!((front(&plain), plain.area, plain.radius, plain.radiance), (Vec3::NEG_Z, 8.0, 5.0_f32.sqrt(), [8.0, 4.0, 2.0]));
        let stretched = row_at(Mat3::from_diagonal(Vec3::new(3.0, 0.5, 7.0)));
        assert_eq!((front(&stretched), stretched.area, stretched.radiance), (Vec3::NEG_Z, 12.0, plain.radiance));
        // A mirror's image of a mesh faces where the mirror shows it: a mirror along x leaves it, one along z turns it.
        assert_eq!(front(&row_at(Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 1.0)))), Vec3::NEG_Z);
        assert_eq!(front(&row_at(Mat3::from_diagonal(Vec3::new(1.0, 1.0, -1.0)))), Vec3::Z);
    }

    #[test]
    fn what_has_no_extent_or_is_no_number_gives_no_light() {
        for axes in
            [Mat3::ZERO, Mat3::from_diagonal(Vec3::new(1.0, 0.0, 1.0)), Mat3::from_diagonal(Vec3::splat(f32::NAN)), Mat3::IDENTITY * 1e30]
        {
            let row = row_at(axes);
            assert_eq!((row.area, row.radiance), (0.0, [0.0; 3]), "{axes}");
        }
        let dim = row(&RectangleLight { luminance: f32::NAN, ..LIGHT }, &GlobalTransform(Affine3A::IDENTITY), None);
        assert_eq!((dim.area, dim.radiance), (8.0, [0.0; 3]));
    }
}
