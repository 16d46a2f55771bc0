//! The shadow view of a directional light: orthographic, fitted to what the camera sees, stable under its movement.
//!
//! The square covers the smaller of two things: the sphere around the camera's frustum, cut off behind the scene's bounds, or the
//! scene itself as the light sees it. The sphere's radius is rounded up to a quarter of an octave, and the square's middle
//! to whole texels, so that a moving camera shifts the map by whole texels and shadow edges stand still; only where the
//! rounded radius steps does the map change its scale. Depth covers the whole scene along the light, so every caster is in it.
//! A cascade is the same for a part of the frustum ([`super::cascades`]). Accepted downside: a sphere wastes a good part of the map.

use glam::{DMat4, DVec3, DVec4};
use luminaire_graph::published::CascadeView;

use super::cascades::{self, Depths};
use super::frustum::Frustum;
use super::layout::ViewTable;
use super::projection::{CameraView, columns, single, vector};
use super::reach::round_up;
use crate::world::{Aabb, look_at};

/// Texels around a cascade's content, on each side: half of one for the rounding of its middle, three and a half for filters, so that what
/// stands in a part of the frustum is filtered within the map of that part.
const CASCADE_MARGIN: f64 = 4.0;

/// A fitted view.
#[derive(Debug, Clone)]
pub(super) struct SunView {
    pub(super) table: ViewTable,
    /// Metres along a texel (the larger one, should the map not be square).
    pub(super) texel_size: f64,
    /// Metres from depth 0 to depth 1.
    pub(super) depth_range: f64,
    /// What can throw a shadow into it.
    pub(super) casters: Frustum,
}

/// Fits a map of so many texels to all that the camera sees. `to_light` has unit length.
pub(super) fn fit(to_light: DVec3, camera: &CameraView, bounds: Option<Aabb>, texels: [u32; 2]) -> SunView {
    let seen = bounds.and_then(|bounds| cascades::seen(camera, bounds));
    // Rounding moves the middle by up to half a texel.
    fit_part(to_light, bounds, seen.map(|seen| frustum_sphere(camera, seen)), texels, 1.0, true)
}

/// Fits a map of so many texels to all of the scene, whatever the camera sees.
pub(super) fn fit_whole(to_light: DVec3, bounds: Option<Aabb>, texels: [u32; 2]) -> SunView {
    fit_part(to_light, bounds, None, texels, 1.0, false)
}

/// Fits a map of so many texels to a part of what the camera sees.
pub(super) fn fit_cascade(to_light: DVec3, camera: &CameraView, bounds: Option<Aabb>, cascade: CascadeView, texels: [u32; 2]) -> SunView {
    let part = bounds.and_then(|bounds| cascades::part(camera, bounds, cascade));
    fit_part(to_light, bounds, part.map(|part| frustum_sphere(camera, part)), texels, CASCADE_MARGIN, cascade.split.snap)
}

/// Fits a map to a sphere. Without one, or where that is larger, all of the scene is in the map. `margin` is in texels.
fn fit_part(to_light: DVec3, bounds: Option<Aabb>, part: Option<(DVec3, f64)>, texels: [u32; 2], margin: f64, snap: bool) -> SunView {
    let (right, up, back) = look_at(-to_light);
    let scene = LightBounds::of(bounds, right, up, back);
    let (mut middle, mut half) = (scene.middle, scene.half);
    if let Some((center, radius)) = part {
        let radius = round_up(radius);
        if radius < half {
            (middle, half) = ([center.dot(right), center.dot(up)], radius);
        }
    }
    let texels = texels.map(|count| f64::from(count.max(4)));
    let size = texels.map(|count| 2.0 * half / (count - 2.0 * margin.min(count * 0.25)));
    let half = [0, 1].map(|axis| size[axis] * texels[axis] * 0.5);
    let middle = if snap { [0, 1].map(|axis| (middle[axis] / size[axis]).round() * size[axis]) } else { middle };

    let range = scene.nearest - scene.farthest;
    let projection_from_world = DMat4::from_cols(
        (right / half[0]).extend(-middle[0] / half[0]),
        (up / half[1]).extend(-middle[1] / half[1]),
        (-back / range).extend(scene.nearest / range),
        DVec4::W,
    )
    .transpose();
    let table = ViewTable {
        projection_from_world: columns(projection_from_world),
        position: vector(right * middle[0] + up * middle[1] + back * scene.nearest),
        near: 0.0,
        forward: vector(-back),
        far: single(range),
    };
    SunView { table, texel_size: size[0].max(size[1]), depth_range: range, casters: Frustum::along([right, up], middle, half) }
}

/// The scene as the light sees it.
struct LightBounds {
    middle: [f64; 2],
    /// Of the square that holds it.
    half: f64,
    /// Distance along the direction to the light of the plane with depth 0, and of the one with depth 1.
    nearest: f64,
    farthest: f64,
}

impl LightBounds {
    fn of(bounds: Option<Aabb>, right: DVec3, up: DVec3, back: DVec3) -> LightBounds {
        let corners = bounds.map_or([DVec3::ZERO; 8], |bounds| bounds.corners().map(|corner| corner.as_dvec3()));
        let extent = |axis: DVec3| {
            let along = corners.map(|corner| corner.dot(axis));
            (along.iter().copied().fold(f64::INFINITY, f64::min), along.iter().copied().fold(f64::NEG_INFINITY, f64::max))
        };
        let [x, y, z] = [right, up, back].map(extent);
        // Room for rounding, which grows with the distance from the origin, and something to divide by in a flat or empty scene.
        let rounding = |range: (f64, f64)| 1e-6 * range.0.abs().max(range.1.abs());
        let margin = 1e-3 * (z.1 - z.0) + 1e-2 + rounding(z);
        let half = (0.5 * (x.1 - x.0).max(y.1 - y.0) * 1.001).max(1e-3) + rounding(x).max(rounding(y));
        LightBounds { middle: [0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1)], half, nearest: z.1 + margin, farthest: z.0 - margin }
    }
}

/// The smallest sphere around a part of the frustum.
fn frustum_sphere(camera: &CameraView, Depths { near, far }: Depths) -> (DVec3, f64) {
    let diagonal = camera.half[0].hypot(camera.half[1]);
    let (along, radius) = match camera.far() {
        // Equally far from the corners of both ends, unless the far end alone decides.
        None => {
            let squared = diagonal * diagonal;
            let along = (0.5 * (near + far) * (1.0 + squared)).min(far);
            (along, (far - along).hypot(far * diagonal))
        }
        Some(_) => (0.5 * (near + far), diagonal.hypot(0.5 * (far - near))),
    };
    (camera.pose.position + camera.forward() * along, radius)
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec3};
    use proptest::prelude::*;

    use super::*;
    use crate::asset::Projection;
    use crate::world::{CameraPose, Exposure};

    fn camera(position: DVec3, forward: DVec3) -> CameraView {
        let (right, up, back) = look_at(forward);
        let projection = Projection::Perspective { yfov: 0.9, near: 0.1, far: None };
        CameraView::new(CameraPose { position, right, up, back, projection, exposure: Exposure::Unchanged }, 1.5)
    }

    fn large() -> Aabb {
        Aabb { min: Vec3::new(-200.0, 0.0, -200.0), max: Vec3::new(200.0, 30.0, 200.0) }
    }

    /// Looking at a wall 12 m away, in a scene far larger to the sides.
    fn corridor() -> Aabb {
        Aabb { min: Vec3::new(-200.0, 0.0, -12.0), max: Vec3::new(200.0, 30.0, 200.0) }
    }

    fn texel(view: &SunView, point: Vec3, texels: f32) -> [f32; 2] {
        let ndc = Mat4::from_cols_array_2d(&view.table.projection_from_world).project_point3(point);
        [(ndc.x * 0.5 + 0.5) * texels, (0.5 - ndc.y * 0.5) * texels]
    }

    #[test]
    fn a_moving_camera_shifts_the_map_by_whole_texels() {
        let to_light = DVec3::new(0.3, 0.8, 0.4).normalize();
        let point = Vec3::new(1.0, 2.0, -3.0);
        let view = |x: f64| fit(to_light, &camera(DVec3::new(x, 2.0, 0.0), DVec3::NEG_Z), Some(corridor()), [1024, 1024]);
        let first = view(0.0);
        assert!(first.texel_size < 0.05, "the frustum decides, not the scene: {}", first.texel_size);
        let start = texel(&first, point, 1024.0);
        let mut moved = false;
        for step in 1..50 {
            let next = view(f64::from(step) * 0.0173);
            assert_eq!(next.texel_size, first.texel_size);
            let now = texel(&next, point, 1024.0);
            for axis in 0..2 {
                let shift = now[axis] - start[axis];
                assert!((shift - shift.round()).abs() < 0.01, "a shift of {shift} texels");
                moved |= shift.abs() > 0.5;
            }
        }
        assert!(moved);
    }

    proptest! {
        #[test]
        fn everything_seen_is_in_the_map(
            x in -50.0..50.0, y in 0.5..20.0, z in -50.0..50.0, fx in -1.0..1.0, fy in -0.9..0.9, fz in -1.0..1.0,
            lx in -1.0..1.0, ly in 0.1..1.0, lz in -1.0..1.0, near_or_far in 0.0..1.0_f64, u in -1.0..1.0_f64, v in -1.0..1.0_f64,
        ) {
            let forward = DVec3::new(fx, fy, fz).try_normalize().unwrap_or(DVec3::X);
            let camera = camera(DVec3::new(x, y, z), forward);
            let view = fit(DVec3::new(lx, ly, lz).normalize(), &camera, Some(large()), [512, 512]);
            let distance: f64 = 0.1 + near_or_far * 300.0;
            let ray = forward + camera.pose.right * (u * camera.half[0]) + camera.pose.up * (v * camera.half[1]);
            let point = (camera.pose.position + ray * distance).as_vec3();
            let inside = point.cmpge(large().min).all() && point.cmple(large().max).all();
            if inside {
                let ndc = Mat4::from_cols_array_2d(&view.table.projection_from_world).project_point3(point);
                prop_assert!(ndc.x.abs() <= 1.0 && ndc.y.abs() <= 1.0 && (0.0..=1.0).contains(&ndc.z), "{point} is at {ndc}");
            }
        }
    }

    #[test]
    fn every_caster_has_a_depth_and_the_one_nearer_to_the_light_a_smaller_one() {
        let view = fit(DVec3::Y, &camera(DVec3::new(0.0, 1.0, 0.0), DVec3::NEG_Z), Some(corridor()), [256, 256]);
        let matrix = Mat4::from_cols_array_2d(&view.table.projection_from_world);
        for corner in corridor().corners() {
            let depth = matrix.project_point3(corner).z;
            assert!((0.0..=1.0).contains(&depth));
            assert_eq!(depth < 0.5, corner.y > 15.0);
        }
        assert!((view.depth_range - 30.0).abs() < 0.1);
    }

    #[test]
    fn nothing_gives_no_nan() {
        let point = Aabb { min: Vec3::ONE, max: Vec3::ONE };
        for bounds in [None, Some(point)] {
            let view = fit(DVec3::Y, &camera(DVec3::ZERO, DVec3::NEG_Z), bounds, [0, 1]);
            assert!(Mat4::from_cols_array_2d(&view.table.projection_from_world).is_finite());
            assert!(view.texel_size > 0.0 && view.depth_range > 0.0);
        }
    }
}
