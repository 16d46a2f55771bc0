//! The space that a view sees, as planes.

use glam::DVec3;

use super::projection::CameraView;
use crate::world::Aabb;

/// A convex space between planes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Frustum {
    /// Inwards normal and offset: a point is inside where `normal . point + offset` is not negative.
    planes: Vec<(DVec3, f64)>,
}

impl Frustum {
    /// What a camera sees. In perspective it has no far end.
    pub(super) fn of_camera(camera: &CameraView) -> Frustum {
        let (eye, forward) = (camera.pose.position, camera.forward());
        let sides = [(camera.pose.right, camera.half[0]), (camera.pose.up, camera.half[1])];
        let through = |normal: DVec3, point: DVec3| (normal, -normal.dot(point));
        let mut planes = vec![through(forward, eye + forward * camera.near)];
        for (axis, half) in sides {
            match camera.far() {
                None => planes.extend([axis, -axis].map(|axis| through(forward * half + axis, eye))),
                Some(_) => planes.extend([axis, -axis].map(|axis| through(axis, eye - axis * half))),
            }
        }
        planes.extend(camera.far().map(|far| through(-forward, eye + forward * far)));
        Frustum { planes }
    }

    /// What a square pyramid holds up to a distance along its axis: `half` is the tangent of its half angle, `axes` are of unit length.
    pub(super) fn pyramid(apex: DVec3, axes: [DVec3; 2], forward: DVec3, half: f64, far: f64) -> Frustum {
        let through = |normal: DVec3, point: DVec3| (normal, -normal.dot(point));
        let mut planes = vec![through(forward, apex), through(-forward, apex + forward * far)];
        for axis in axes {
            planes.extend([axis, -axis].map(|axis| through(forward * half + axis, apex)));
        }
        Frustum { planes }
    }

    /// Everything along the third axis of a frame, above and below a rectangle of the first two: `middle` and `half` along each.
    pub(super) fn along(axes: [DVec3; 2], middle: [f64; 2], half: [f64; 2]) -> Frustum {
        let sides = |index: usize| [(axes[index], half[index] - middle[index]), (-axes[index], half[index] + middle[index])];
        Frustum { planes: [sides(0), sides(1)].concat() }
    }

    /// Whether a box may be seen. One that is not stands beyond one of the planes, rounding considered; one that stands beyond an edge may
    /// be taken for seen.
    pub(super) fn sees(&self, bounds: Aabb) -> bool {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let (middle, half) = ((min + max) * 0.5, (max - min) * 0.5);
        let beyond = |&(normal, offset): &(DVec3, f64)| {
            let reach = normal.abs().dot(half);
            let slack = 1e-6 * (normal.abs().dot(middle.abs()) + reach + offset.abs());
            normal.dot(middle) + offset + reach + slack < 0.0
        };
        !self.planes.iter().any(beyond)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::asset::Projection;
    use crate::world::{CameraPose, Exposure, look_at};

    fn camera(position: DVec3, forward: DVec3, projection: Projection) -> CameraView {
        let (right, up, back) = look_at(forward);
        CameraView::new(CameraPose { position, right, up, back, projection, exposure: Exposure::Unchanged }, 1.5)
    }

    fn cube(center: Vec3, half: f32) -> Aabb {
        Aabb { min: center - half, max: center + half }
    }

    #[test]
    fn what_stands_beside_or_behind_is_not_seen() {
        let perspective = Projection::Perspective { yfov: std::f32::consts::FRAC_PI_2, near: 0.1, far: None };
        let orthographic = Projection::Orthographic { xmag: 3.0, ymag: 2.0, near: 0.0, far: 20.0 };
        for (projection, center, seen) in [
            (perspective, Vec3::new(0.0, 0.0, -1e4), true),
            (perspective, Vec3::new(0.0, 9.0, -10.0), true),
            (perspective, Vec3::new(0.0, 11.5, -10.0), false),
            (perspective, Vec3::new(14.0, 0.0, -10.0), true),
            (perspective, Vec3::new(17.5, 0.0, -10.0), false),
            (perspective, Vec3::new(0.0, 0.0, 2.0), false),
            (orthographic, Vec3::new(0.0, 2.4, -10.0), true),
            (orthographic, Vec3::new(0.0, 2.6, -10.0), false),
            (orthographic, Vec3::new(3.4, 0.0, -10.0), true),
            (orthographic, Vec3::new(0.0, 0.0, -20.6), false),
        ] {
            let frustum = Frustum::of_camera(&camera(DVec3::ZERO, DVec3::NEG_Z, projection));
            assert_eq!(frustum.sees(cube(center, 0.5)), seen, "{projection:?} {center}");
        }
        let column = Frustum::along([DVec3::X, DVec3::Z], [1.0, -2.0], [3.0, 4.0]);
        assert!(column.sees(cube(Vec3::new(4.4, 1e6, -6.4), 0.5)) && !column.sees(cube(Vec3::new(4.6, 0.0, 0.0), 0.5)));
        assert!(!column.sees(cube(Vec3::new(-2.6, 0.0, 0.0), 0.5)) && !column.sees(cube(Vec3::new(0.0, 0.0, 2.6), 0.5)));
        let pyramid = Frustum::pyramid(DVec3::Y, [DVec3::X, DVec3::Y], DVec3::Z, 0.5, 10.0);
        for (center, seen) in [
            (Vec3::new(0.0, 1.0, 5.0), true),
            (Vec3::new(2.9, 1.0, 5.0), true),
            (Vec3::new(3.4, 1.0, 5.0), false),
            (Vec3::new(0.0, 4.4, 5.0), false),
            (Vec3::new(0.0, 1.0, -1.5), false),
            (Vec3::new(0.0, 1.0, 10.6), false),
        ] {
            assert_eq!(pyramid.sees(cube(center, 0.5)), seen, "{center}");
        }
    }

    proptest! {
        /// A point in the image is enough.
        #[test]
        fn nothing_that_shows_a_point_is_left_out(
            position in prop::array::uniform3(-50.0..50.0), forward in prop::array::uniform3(-1.0..1.0), u in -1.0..1.0_f64, v in -1.0..1.0_f64,
            depth in 0.1..200.0_f64, half in 0.001_f32..5.0, at in prop::array::uniform3(-1.0_f32..1.0), perspective: bool,
        ) {
            let forward = DVec3::from_array(forward).try_normalize().unwrap_or(DVec3::X);
            let projection = if perspective {
                Projection::Perspective { yfov: 0.9, near: 0.1, far: None }
            } else {
                Projection::Orthographic { xmag: 7.5, ymag: 5.0, near: 0.1, far: 200.0 }
            };
            let camera = camera(DVec3::from_array(position), forward, projection);
            let side = if perspective { depth } else { 1.0 };
            let point = camera.pose.position
                + forward * depth
                + camera.pose.right * (u * camera.half[0] * side)
                + camera.pose.up * (v * camera.half[1] * side);
            let center = point.as_vec3() - Vec3::from_array(at) * half;
            prop_assert!(Frustum::of_camera(&camera).sees(cube(center, half)));
        }
    }
}
