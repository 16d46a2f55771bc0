//! Surfaces of revolution around the y axis: cylinder, cone, capsule and torus.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Vec2, Vec3};

use super::sphere::MAX_SECTORS;
use super::{empty, vertex};
use crate::asset::Mesh;

/// A point of an outline: distance from the axis, height, unit normal in the same plane, and texture row.
#[derive(Debug, Clone, Copy)]
struct Outline {
    radius: f32,
    height: f32,
    normal: Vec2,
    v: f32,
}

/// Appends the surface that an outline sweeps. The outline runs so that the outside lies to its left, seen with the axis up and
/// to the left of it: down along an outer wall. A point on the axis becomes one vertex per sector, so that no triangle is
/// degenerate; u grows eastward from -Z.
fn revolve(mesh: &mut Mesh, outline: &[Outline], sectors: u32) {
    let first = mesh.vertices.len() as u32;
    for point in outline {
        let pole = point.radius == 0.0;
        for sector in 0..=sectors {
            let u = (sector as f32 + if pole { 0.5 } else { 0.0 }) / sectors as f32;
            // The last column repeats the first with u = 1.
            let angle = if sector == sectors && !pole { 0.0 } else { u * TAU };
            let (sin, cos) = angle.sin_cos();
            let around = |radius: f32, y: f32| Vec3::new(-radius * sin, y, -radius * cos);
            let normal = around(point.normal.x, point.normal.y).normalize_or(Vec3::Y);
            let east = Vec3::new(-cos, 0.0, sin);
            mesh.vertices.push(vertex(around(point.radius, point.height), normal, east, Vec2::new(u, point.v)));
        }
    }
    for (row, pair) in (0_u32..).zip(outline.windows(2)) {
        let is_pole = [pair[0].radius == 0.0, pair[1].radius == 0.0];
        for sector in 0..sectors {
            let above = first + row * (sectors + 1) + sector;
            let below = above + sectors + 1;
            match is_pole {
                [true, true] => {}
                [true, false] => mesh.indices.extend([above, below, below + 1]),
                [false, true] => mesh.indices.extend([above, below, above + 1]),
                [false, false] => mesh.indices.extend([above, below, above + 1, above + 1, below, below + 1]),
            }
        }
    }
}

/// A flat lid: from the axis to the rim, facing up, or from the rim to the axis, facing down.
fn lid(mesh: &mut Mesh, radius: f32, height: f32, up: bool, sectors: u32) {
    let point = |radius, v| Outline { radius, height, normal: if up { Vec2::Y } else { Vec2::NEG_Y }, v };
    let outline = if up { [point(0.0, 0.0), point(radius, 1.0)] } else { [point(radius, 0.0), point(0.0, 1.0)] };
    revolve(mesh, &outline, sectors);
}

/// A closed cylinder around the origin and the y axis. `sectors` run around the axis (3 to [`MAX_SECTORS`], else clamped).
/// Side and lids have the whole of texture space each, the lids in polar coordinates.
pub fn cylinder(name: &str, radius: f32, height: f32, sectors: u32, material: usize) -> Mesh {
    let sectors = sectors.clamp(3, MAX_SECTORS);
    let mut mesh = empty(name, material);
    lid(&mut mesh, radius, height * 0.5, true, sectors);
    let side = [(0.5, 0.0), (-0.5, 1.0)].map(|(y, v)| Outline { radius, height: height * y, normal: Vec2::X, v });
    revolve(&mut mesh, &side, sectors);
    lid(&mut mesh, radius, height * -0.5, false, sectors);
    mesh
}

/// A closed cone around the origin and the y axis, its tip at +Y. `sectors` as for the cylinder.
pub fn cone(name: &str, radius: f32, height: f32, sectors: u32, material: usize) -> Mesh {
    let sectors = sectors.clamp(3, MAX_SECTORS);
    let mut mesh = empty(name, material);
    let normal = Vec2::new(height, radius).normalize_or(Vec2::X);
    let side = [(0.0, 0.5, 0.0), (radius, -0.5, 1.0)].map(|(radius, y, v)| Outline { radius, height: height * y, normal, v });
    revolve(&mut mesh, &side, sectors);
    lid(&mut mesh, radius, height * -0.5, false, sectors);
    mesh
}

/// A cylinder of `height` between two half spheres, around the origin and the y axis. `stacks` run from pole to pole over the half
/// spheres alone (2 to [`MAX_SECTORS`], rounded up to an even number).
pub fn capsule(name: &str, radius: f32, height: f32, sectors: u32, stacks: u32, material: usize) -> Mesh {
    let (sectors, half) = (sectors.clamp(3, MAX_SECTORS), stacks.clamp(2, MAX_SECTORS).div_ceil(2));
    let mut mesh = empty(name, material);
    let length = PI * radius + height;
    let mut outline = Vec::with_capacity(2 * half as usize + 2);
    for (middle, start, passed) in [(0.5 * height, 0.0, 0.0), (-0.5 * height, FRAC_PI_2, height)] {
        for step in 0..=half {
            let angle = start + FRAC_PI_2 * step as f32 / half as f32;
            let (sin, cos) = angle.sin_cos();
            let pole = (start == 0.0 && step == 0) || (start != 0.0 && step == half);
            let normal = if pole { Vec2::new(0.0, cos.signum()) } else { Vec2::new(sin, cos) };
            let v = if length > 0.0 { (angle * radius + passed) / length } else { 0.0 };
            outline.push(Outline { radius: radius * normal.x, height: middle + radius * normal.y, normal, v });
        }
    }
    revolve(&mut mesh, &outline, sectors);
    mesh
}

/// A ring around the origin and the y axis: `radius` to the middle of the tube, `tube` the radius of the tube, which is smaller.
/// `stacks` run around the tube (3 to [`MAX_SECTORS`]), from the top outwards.
pub fn torus(name: &str, radius: f32, tube: f32, sectors: u32, stacks: u32, material: usize) -> Mesh {
    let (sectors, stacks) = (sectors.clamp(3, MAX_SECTORS), stacks.clamp(3, MAX_SECTORS));
    let mut mesh = empty(name, material);
    let outline: Vec<Outline> = (0..=stacks)
        .map(|stack| {
            let v = stack as f32 / stacks as f32;
            let (sin, cos) = if stack == stacks { (0.0, 1.0) } else { (v * TAU).sin_cos() };
            Outline { radius: radius + tube * sin, height: tube * cos, normal: Vec2::new(sin, cos), v }
        })
        .collect();
    revolve(&mut mesh, &outline, sectors);
    mesh
}
