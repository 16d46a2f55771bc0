//! Matrices of cameras and views, in f64 until they are published.
//!
//! Clip space is WebGPU's: x to the right, y up, depth 0 to 1. Cameras have reversed depth and, in perspective, no far plane.

use glam::{DMat4, DVec3, DVec4};

use super::layout::{CameraTable, Columns, ViewTable};
use crate::asset::Projection;
use crate::world::{CameraPose, Exposure};

/// A camera with its matrices.
#[derive(Debug, Clone, Copy)]
pub(super) struct CameraView {
    pub(super) pose: CameraPose,
    /// Half extents of the image plane: tangents in perspective, metres in orthographic projection.
    pub(super) half: [f64; 2],
    pub(super) near: f64,
    projection_from_view: DMat4,
}

impl CameraView {
    /// `aspect` is width over height; the vertical extent is the camera's, the horizontal one follows.
    pub(super) fn new(pose: CameraPose, aspect: f64) -> CameraView {
        match pose.projection {
            Projection::Perspective { yfov, near, .. } => {
                let near = positive(near, 0.01);
                let half_y = (f64::from(yfov).clamp(1e-3, 3.1) * 0.5).tan();
                let half = [half_y * aspect, half_y];
                // Depth is near / distance.
                let projection_from_view = DMat4::from_cols(
                    DVec4::new(1.0 / half[0], 0.0, 0.0, 0.0),
                    DVec4::new(0.0, 1.0 / half[1], 0.0, 0.0),
                    DVec4::new(0.0, 0.0, 0.0, -1.0),
                    DVec4::new(0.0, 0.0, near, 0.0),
                );
                CameraView { pose, half, near, projection_from_view }
            }
            Projection::Orthographic { ymag, near, far, .. } => {
                let half_y = positive(ymag.abs(), 1.0);
                let half = [half_y * aspect, half_y];
                let near = if near.is_finite() { f64::from(near) } else { 0.0 };
                let far = far_of(near, far);
                // Depth is (far - distance) / (far - near).
                let projection_from_view = DMat4::from_cols(
                    DVec4::new(1.0 / half[0], 0.0, 0.0, 0.0),
                    DVec4::new(0.0, 1.0 / half[1], 0.0, 0.0),
                    DVec4::new(0.0, 0.0, 1.0 / (far - near), 0.0),
                    DVec4::new(0.0, 0.0, far / (far - near), 1.0),
                );
                CameraView { pose, half, near, projection_from_view }
            }
        }
    }

    pub(super) fn forward(&self) -> DVec3 {
        -self.pose.back
    }

    /// Of orthographic cameras.
    pub(super) fn far(&self) -> Option<f64> {
        match self.pose.projection {
            Projection::Perspective { .. } => None,
            Projection::Orthographic { far, .. } => Some(far_of(self.near, far)),
        }
    }

    fn world_from_view(&self) -> DMat4 {
        let pose = &self.pose;
        DMat4::from_cols(pose.right.extend(0.0), pose.up.extend(0.0), pose.back.extend(0.0), pose.position.extend(1.0))
    }

    pub(super) fn table(&self) -> CameraTable {
        let world_from_view = self.world_from_view();
        let view_from_world = view_from_world(self.pose.right, self.pose.up, self.pose.back, self.pose.position);
        CameraTable {
            projection_from_world: columns(self.projection_from_view * view_from_world),
            world_from_projection: columns(world_from_view * self.projection_from_view.inverse()),
            view_from_world: columns(view_from_world),
            world_from_view: columns(world_from_view),
            position: vector(self.pose.position),
            exposure: factor(self.pose.exposure),
            forward: vector(self.forward()),
            near: self.near as f32,
        }
    }

    pub(super) fn view(&self) -> ViewTable {
        let table = self.table();
        ViewTable {
            projection_from_world: table.projection_from_world,
            position: table.position,
            near: table.near,
            forward: table.forward,
            far: self.far().map_or(0.0, single),
        }
    }
}

/// Factor on radiance. For an exposure value at ISO 100 the luminance that saturates is `1.2 * 2^EV100` nits (Lagarde and
/// de Rousiers, "Moving Frostbite to Physically Based Rendering", 2014).
pub(super) fn factor(exposure: Exposure) -> f32 {
    match exposure {
        Exposure::Ev100(value) if value.is_finite() => (1.0 / (1.2 * f64::from(value.clamp(-60.0, 60.0)).exp2())) as f32,
        Exposure::Factor(factor) if factor.is_finite() => factor.max(0.0),
        Exposure::Unchanged | Exposure::Ev100(_) | Exposure::Factor(_) => 1.0,
    }
}

/// The inverse of a rigid frame.
pub(super) fn view_from_world(right: DVec3, up: DVec3, back: DVec3, position: DVec3) -> DMat4 {
    let rows = [right, up, back].map(|axis| axis.extend(-axis.dot(position)));
    DMat4::from_cols(rows[0], rows[1], rows[2], DVec4::W).transpose()
}

/// Column-major, as shaders read it.
pub(super) fn columns(matrix: DMat4) -> Columns {
    matrix.as_mat4().to_cols_array_2d()
}

/// In f32, and finite.
pub(super) fn single(value: f64) -> f32 {
    (value as f32).clamp(f32::MIN, f32::MAX)
}

/// In f32.
pub(super) fn vector(vector: DVec3) -> [f32; 3] {
    vector.as_vec3().to_array()
}

fn positive(value: f32, fallback: f64) -> f64 {
    if value.is_finite() && value > 0.0 { f64::from(value) } else { fallback }
}

fn far_of(near: f64, far: f32) -> f64 {
    if far.is_finite() && f64::from(far) > near { f64::from(far) } else { near + 1.0 }
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec3, Vec4};

    use super::*;
    use crate::world::look_at;

    fn pose(projection: Projection) -> CameraPose {
        let (right, up, back) = look_at(DVec3::new(0.3, -0.4, -1.0));
        CameraPose { position: DVec3::new(1.0, 2.0, 3.0), right, up, back, projection, exposure: Exposure::Unchanged }
    }

    fn both() -> [CameraView; 2] {
        let perspective = Projection::Perspective { yfov: 0.8, near: 0.05, far: Some(10.0) };
        let orthographic = Projection::Orthographic { ymag: 2.0, xmag: 9.0, near: 0.5, far: 20.0 };
        [perspective, orthographic].map(|projection| CameraView::new(pose(projection), 1.5))
    }

    #[test]
    fn matrices_round_trip() {
        for camera in both() {
            let table = camera.table();
            let [there, back] = [table.projection_from_world, table.world_from_projection].map(|m| Mat4::from_cols_array_2d(&m));
            let [view, world] = [table.view_from_world, table.world_from_view].map(|m| Mat4::from_cols_array_2d(&m));
            for point in [Vec3::new(1.5, 1.0, -3.0), Vec3::new(2.0, 0.0, 0.0), Vec3::new(-4.0, -7.0, -9.0)] {
                let clip = there * point.extend(1.0);
                let again = back * (clip / clip.w);
                assert!(((again / again.w).truncate() - point).length() < 2e-3, "{point} became {again}");
                assert!((world.transform_point3(view.transform_point3(point)) - point).length() < 1e-5);
            }
        }
    }

    #[test]
    fn depth_is_reversed() {
        for camera in both() {
            let matrix = Mat4::from_cols_array_2d(&camera.table().projection_from_world);
            let depth = |distance: f64| {
                let clip = matrix * (camera.pose.position + camera.forward() * distance).as_vec3().extend(1.0);
                assert!(clip.x.abs() < 1e-4 && clip.y.abs() < 1e-4, "the axis lies in the middle");
                clip.z / clip.w
            };
            assert!((depth(camera.near) - 1.0).abs() < 1e-4);
            assert!(depth(5.0) < depth(2.0) && depth(5.0) > 0.0);
        }
        let [perspective, orthographic] = both();
        let matrix = Mat4::from_cols_array_2d(&perspective.table().projection_from_world);
        assert!((matrix * perspective.forward().as_vec3().extend(0.0)).z.abs() < 1e-6, "infinity has depth 0");
        let far = Mat4::from_cols_array_2d(&orthographic.table().projection_from_world)
            * (orthographic.pose.position + orthographic.forward() * 20.0).as_vec3().extend(1.0);
        assert!(far.z.abs() < 1e-5);
    }

    #[test]
    fn the_vertical_extent_is_the_cameras_and_the_horizontal_one_follows() {
        for camera in both() {
            let table = camera.table();
            let matrix = Mat4::from_cols_array_2d(&table.projection_from_world);
            let at = |x: f64, y: f64| {
                let scale = if camera.far().is_none() { 4.0 } else { 1.0 };
                let point = camera.pose.position + camera.forward() * 4.0 + (camera.pose.right * x + camera.pose.up * y) * scale;
                let clip: Vec4 = matrix * point.as_vec3().extend(1.0);
                (clip / clip.w).truncate().truncate()
            };
            assert!((at(0.0, camera.half[1]).y - 1.0).abs() < 1e-4);
            assert!((at(camera.half[1] * 1.5, 0.0).x - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn exposure_follows_ev100_or_the_hand() {
        assert_eq!(factor(Exposure::Unchanged), 1.0);
        assert!((factor(Exposure::Ev100(0.0)) - 1.0 / 1.2).abs() < 1e-6);
        assert!((factor(Exposure::Ev100(15.0)) * 1.2 * 32768.0 - 1.0).abs() < 1e-5);
        assert_eq!([2.5, 0.0, -1.0, f32::NAN].map(|by_hand| factor(Exposure::Factor(by_hand))), [2.5, 0.0, 0.0, 1.0]);
    }
}
