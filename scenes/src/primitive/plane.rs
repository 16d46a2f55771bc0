//! Rectangles: the plane, which lies, and the panel, which stands.

use glam::{Vec2, Vec3};

use super::{empty, rectangle};
use crate::asset::Mesh;

/// A rectangle around the origin in the plane y = 0 that faces +Y: `size.x` metres along x and `size.y` along z. The top of
/// its texture lies at -z.
pub fn plane(name: &str, size: Vec2, material: usize) -> Mesh {
    let mut mesh = empty(name, material);
    rectangle(&mut mesh, Vec3::ZERO, Vec3::X * size.x * 0.5, Vec3::NEG_Z * size.y * 0.5);
    mesh
}

/// A rectangle around the origin in the plane z = 0 that faces -Z, as lights and cameras do: `size.x` metres along x and `size.y`
/// along y. The top of its texture lies at +y.
pub fn panel(name: &str, size: Vec2, material: usize) -> Mesh {
    let mut mesh = empty(name, material);
    rectangle(&mut mesh, Vec3::ZERO, Vec3::NEG_X * size.x * 0.5, Vec3::Y * size.y * 0.5);
    mesh
}
