//! The sphere, by latitude and longitude.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::{empty, vertex};
use crate::asset::Mesh;

/// Most sectors, and most stacks, of a sphere: half a million triangles.
pub const MAX_SECTORS: u32 = 512;

/// A sphere around the origin. `sectors` run around the y axis (3 to [`MAX_SECTORS`]), `stacks` from pole to pole (2 to
/// [`MAX_SECTORS`]); other values are clamped. Texture row 0 is the pole at +Y, and u grows eastward from -Z.
/// Each sector has a pole vertex of its own, with u in the sector's middle, so that no triangle is degenerate.
pub fn sphere(name: &str, radius: f32, sectors: u32, stacks: u32, material: usize) -> Mesh {
    let (sectors, stacks) = (sectors.clamp(3, MAX_SECTORS), stacks.clamp(2, MAX_SECTORS));
    let mut mesh = empty(name, material);
    for stack in 0..=stacks {
        let pole = stack == 0 || stack == stacks;
        let v = stack as f32 / stacks as f32;
        let (ring, y) = match stack {
            0 => (0.0, 1.0),
            _ if stack == stacks => (0.0, -1.0),
            _ => (PI * v).sin_cos(),
        };
        // The last column repeats the first with u = 1.
        for sector in 0..=sectors {
            let offset = if pole { 0.5 } else { 0.0 };
            let u = (sector as f32 + offset) / sectors as f32;
            let angle = if sector == sectors && !pole { 0.0 } else { u * TAU };
            let (sin, cos) = angle.sin_cos();
            // East is the derivative of position by u, seen from outside with +Y up to the right.
            let normal = Vec3::new(-ring * sin, y, -ring * cos);
            let east = Vec3::new(-cos, 0.0, sin);
            mesh.vertices.push(vertex(normal * radius, normal, east, Vec2::new(u, v)));
        }
    }
    let columns = sectors + 1;
    for stack in 0..stacks {
        for sector in 0..sectors {
            let above = stack * columns + sector;
            let below = above + columns;
            match stack {
                0 => mesh.indices.extend([above, below, below + 1]),
                _ if stack + 1 == stacks => mesh.indices.extend([above, below, above + 1]),
                _ => mesh.indices.extend([above, below, above + 1, above + 1, below, below + 1]),
            }
        }
    }
    mesh
}
