//! The box.

use glam::Vec3;

use super::{empty, rectangle};
use crate::asset::Mesh;

/// A box around the origin with these edges, metres: 24 vertices, each face with the whole of texture space.
pub fn cuboid(name: &str, size: Vec3, material: usize) -> Mesh {
    let half = size * 0.5;
    let mut mesh = empty(name, material);
    // Outward normal is right x up; sides have +Y up, the lid has -Z up and the bottom +Z.
    let faces = [
        (Vec3::X, Vec3::NEG_Z, Vec3::Y),
        (Vec3::NEG_X, Vec3::Z, Vec3::Y),
        (Vec3::Y, Vec3::X, Vec3::NEG_Z),
        (Vec3::NEG_Y, Vec3::X, Vec3::Z),
        (Vec3::Z, Vec3::X, Vec3::Y),
        (Vec3::NEG_Z, Vec3::NEG_X, Vec3::Y),
    ];
    for (normal, right, up) in faces {
        rectangle(&mut mesh, normal * half, right * half, up * half);
    }
    mesh
}
