//! The six views from a point, for cube maps.
//!
//! A lookup with a world direction returns what stands in that direction: WebGPU takes over the face selection of OpenGL and
//! Vulkan ("Cube Map Face Selection"), whose faces are seen from inside in a left-handed frame. So these views mirror: the
//! winding of triangles on screen is turned, which draw lists for them account for.

use glam::{DMat4, DVec3, DVec4};

use super::layout::ViewTable;
use super::projection::{columns, single, vector};

/// Right, up and forward of each face: +X -X +Y -Y +Z -Z. From Vulkan's table: right is `s`, down is `t`.
pub(super) const FACES: [[DVec3; 3]; 6] = [
    [DVec3::NEG_Z, DVec3::Y, DVec3::X],
    [DVec3::Z, DVec3::Y, DVec3::NEG_X],
    [DVec3::X, DVec3::NEG_Z, DVec3::Y],
    [DVec3::X, DVec3::Z, DVec3::NEG_Y],
    [DVec3::X, DVec3::Y, DVec3::Z],
    [DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z],
];

/// The view of a face (0 to 5; others count as 5).
pub(super) fn face_view(position: DVec3, [near, far]: [f64; 2], face: u32) -> ViewTable {
    let [right, up, forward] = FACES[(face as usize).min(5)];
    let row = |axis: DVec3| axis.extend(-axis.dot(position));
    let scale = far / (far - near);
    let projection_from_world =
        DMat4::from_cols(row(right), row(up), row(forward) * scale - DVec4::W * (near * scale), row(forward)).transpose();
    ViewTable {
        projection_from_world: columns(projection_from_world),
        position: vector(position),
        near: single(near),
        forward: vector(forward),
        far: single(far),
    }
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec3};

    use super::*;

    /// Face and texture coordinates of a lookup, from the table of the Vulkan specification ("Cube Map Face Selection" and
    /// "Cube Map Coordinate Transformation").
    fn lookup(direction: Vec3) -> (u32, f32, f32) {
        let Vec3 { x, y, z } = direction;
        let a = direction.abs();
        let (face, sc, tc, ma) = if a.z >= a.x && a.z >= a.y {
            if z > 0.0 { (4, x, -y, z) } else { (5, -x, -y, z) }
        } else if a.y >= a.x {
            if y > 0.0 { (2, x, z, y) } else { (3, x, -z, y) }
        } else if x > 0.0 {
            (0, -z, -y, x)
        } else {
            (1, z, -y, x)
        };
        (face, 0.5 * (sc / ma.abs() + 1.0), 0.5 * (tc / ma.abs() + 1.0))
    }

    #[test]
    fn a_lookup_returns_what_stands_in_its_direction() {
        let position = DVec3::new(1.0, -2.0, 0.5);
        let mut seen = [0; 6];
        for index in 0..500_u32 {
            // Directions spread over the sphere by the golden angle.
            let y = 1.0 - (index as f32 + 0.5) / 250.0;
            let angle = index as f32 * 2.399_963;
            let radius = (1.0 - y * y).max(0.0).sqrt();
            let direction = Vec3::new(radius * angle.cos(), y, radius * angle.sin());
            let (face, u, v) = lookup(direction);
            seen[face as usize] += 1;
            let view = face_view(position, [0.01, 20.0], face);
            let clip = Mat4::from_cols_array_2d(&view.projection_from_world) * (position.as_vec3() + direction * 3.0).extend(1.0);
            assert!(clip.w > 0.0);
            let ndc = clip / clip.w;
            assert!((0.5 + 0.5 * ndc.x - u).abs() < 1e-4 && (0.5 - 0.5 * ndc.y - v).abs() < 1e-4, "{direction} on face {face}");
            assert!(ndc.z > 0.0 && ndc.z < 1.0);
        }
        assert!(seen.iter().all(|count| *count > 40));
    }

    #[test]
    fn depth_runs_from_near_to_far_and_the_views_mirror() {
        for face in 0..6 {
            let view = face_view(DVec3::ZERO, [0.5, 8.0], face);
            let matrix = Mat4::from_cols_array_2d(&view.projection_from_world);
            let depth = |distance: f32| matrix.project_point3(Vec3::from(view.forward) * distance).z;
            assert!(depth(0.5).abs() < 1e-6 && (depth(8.0) - 1.0).abs() < 1e-6);
            let [right, up, forward] = FACES[face as usize];
            assert_eq!(right.cross(up), forward, "a left-handed frame");
        }
    }
}
