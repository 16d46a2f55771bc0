//! Meshes made by formula: box, sphere, plane, cylinder, cone, capsule and torus.
//!
//! Guarantees: triangles are counter-clockwise seen from outside, normals and tangents have unit length, texture coordinates run
//! from the top left of the image, and `tangent` points along growing u. The bitangent, `cross(normal, tangent) * w`, follows
//! glTF's convention: it points along growing y of the normal map, which is falling v.

mod cuboid;
mod plane;
mod revolve;
mod sphere;

pub use cuboid::cuboid;
pub use plane::{panel, plane};
pub use revolve::{capsule, cone, cylinder, torus};
pub use sphere::{MAX_SECTORS, sphere};

use glam::{Vec2, Vec3};

use crate::asset::{Mesh, Vertex};

/// A vertex with right-handed tangent space.
fn vertex(position: Vec3, normal: Vec3, tangent: Vec3, uv: Vec2) -> Vertex {
    Vertex {
        position: position.to_array(),
        normal: normal.to_array(),
        tangent: tangent.extend(1.0).to_array(),
        uv0: uv.to_array(),
        uv1: [0.0; 2],
        color: [255; 4],
        padding: 0,
    }
}

/// A rectangle around `center` that spans `right` and `up` (half edges) and faces their cross product.
fn rectangle(mesh: &mut Mesh, center: Vec3, right: Vec3, up: Vec3) {
    let first = mesh.vertices.len() as u32;
    let normal = right.cross(up).normalize_or(Vec3::Y);
    let tangent = right.normalize_or(Vec3::X);
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let uv = Vec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y);
        mesh.vertices.push(vertex(center + right * x + up * y, normal, tangent, uv));
    }
    mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
}

fn empty(name: &str, material: usize) -> Mesh {
    Mesh { name: name.to_owned(), vertices: Vec::new(), indices: Vec::new(), material }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(mesh: &Mesh) -> impl Iterator<Item = [Vertex; 3]> + '_ {
        mesh.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|corner| mesh.vertices[corners[corner] as usize]))
    }

    fn area_normal([a, b, c]: [Vertex; 3]) -> Vec3 {
        let [a, b, c] = [a, b, c].map(|vertex| Vec3::from(vertex.position));
        (b - a).cross(c - a) * 0.5
    }

    fn all() -> [Mesh; 9] {
        [
            cuboid("box", Vec3::new(1.0, 2.0, 3.0), 0),
            sphere("ball", 1.5, 16, 9, 0),
            plane("floor", Vec2::new(2.0, 4.0), 0),
            sphere("few", 1.0, 3, 2, 0),
            panel("panel", Vec2::new(2.0, 4.0), 0),
            cylinder("cylinder", 0.5, 2.0, 12, 0),
            cone("cone", 0.5, 2.0, 12, 0),
            capsule("capsule", 0.5, 1.0, 12, 7, 0),
            torus("torus", 1.0, 0.25, 12, 8, 0),
        ]
    }

    #[test]
    fn winding_agrees_with_the_normals() {
        for mesh in all() {
            assert!(!mesh.indices.is_empty() && mesh.indices.len() % 3 == 0);
            for triangle in corners(&mesh) {
                let normal = area_normal(triangle);
                assert!(normal.length() > 1e-6, "{}: a triangle without area", mesh.name);
                for vertex in triangle {
                    assert!(normal.normalize().dot(Vec3::from(vertex.normal)) > 0.0, "{}", mesh.name);
                }
            }
        }
    }

    #[test]
    fn tangent_frames_are_orthonormal_and_follow_the_texture() {
        for mesh in all() {
            for vertex in &mesh.vertices {
                let [x, y, z, w] = vertex.tangent;
                let (normal, tangent) = (Vec3::from(vertex.normal), Vec3::new(x, y, z));
                assert!((normal.length() - 1.0).abs() < 1e-5 && (tangent.length() - 1.0).abs() < 1e-5, "{}", mesh.name);
                assert!(normal.dot(tangent).abs() < 1e-5 && w == 1.0);
            }
            for [a, b, c] in corners(&mesh) {
                let edge = |to: Vertex| (Vec3::from(to.position) - Vec3::from(a.position), Vec2::from(to.uv0) - Vec2::from(a.uv0));
                let ((p1, t1), (p2, t2)) = (edge(b), edge(c));
                let determinant = t1.x * t2.y - t2.x * t1.y;
                assert!(determinant.abs() > 1e-9, "{}: degenerate texture coordinates", mesh.name);
                let along_u = (p1 * t2.y - p2 * t1.y) / determinant;
                let along_v = (p2 * t1.x - p1 * t2.x) / determinant;
                for vertex in [a, b, c] {
                    let tangent = Vec3::from_slice(&vertex.tangent[..3]);
                    let bitangent = Vec3::from(vertex.normal).cross(tangent);
                    assert!(along_u.dot(tangent) > 0.0, "{}", mesh.name);
                    assert!(along_v.dot(bitangent) < 0.0, "{}: v grows downwards", mesh.name);
                }
            }
        }
    }

    #[test]
    fn areas_and_extents_are_right() {
        let area = |mesh: &Mesh| corners(mesh).map(|triangle| area_normal(triangle).length()).sum::<f32>();
        let [cube, _, floor, ..] = all();
        assert_eq!(cube.vertices.len(), 24);
        assert!((area(&cube) - 22.0).abs() < 1e-4);
        assert!((area(&floor) - 8.0).abs() < 1e-5 && floor.vertices.iter().all(|vertex| vertex.position[1] == 0.0));
        let ball = sphere("ball", 1.5, 128, 64, 0);
        assert!((area(&ball) / (4.0 * std::f32::consts::PI * 2.25) - 1.0).abs() < 2e-3);
        assert!(ball.vertices.iter().all(|vertex| (Vec3::from(vertex.position).length() - 1.5).abs() < 1e-5));
        // A closed surface: its area normals cancel.
        let sum: Vec3 = corners(&ball).map(area_normal).sum();
        assert!(sum.length() < 1e-4);
    }

    #[test]
    fn surfaces_of_revolution_have_their_volumes() {
        use std::f32::consts::PI;
        // The divergence theorem: a third of the sum of corner . area normal, each triangle.
        let volume =
            |mesh: &Mesh| corners(mesh).map(|triangle| Vec3::from(triangle[0].position).dot(area_normal(triangle)) / 3.0).sum::<f32>();
        let cases = [
            (cylinder("cylinder", 0.5, 2.0, 256, 0), PI * 0.25 * 2.0),
            (cone("cone", 0.5, 2.0, 256, 0), PI * 0.25 * 2.0 / 3.0),
            (capsule("capsule", 0.5, 1.0, 256, 128, 0), PI * 0.25 + PI / 6.0),
            (torus("torus", 1.0, 0.25, 256, 128, 0), 2.0 * PI * PI * 0.0625),
        ];
        for (mesh, expected) in cases {
            assert!((volume(&mesh) / expected - 1.0).abs() < 2e-3, "{}: {} and not {expected}", mesh.name, volume(&mesh));
            let sum: Vec3 = corners(&mesh).map(area_normal).sum();
            assert!(sum.length() < 1e-4, "{} is open", mesh.name);
        }
        assert!(panel("panel", Vec2::ONE, 0).vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, -1.0]));
    }

    #[test]
    fn no_size_gives_nan() {
        let meshes = [
            cuboid("box", Vec3::ZERO, 0),
            sphere("ball", 0.0, 0, 0, 0),
            plane("floor", Vec2::ZERO, 0),
            cylinder("cylinder", 0.0, 0.0, 0, 0),
            cone("cone", 0.0, 0.0, 0, 0),
            capsule("capsule", 0.0, 0.0, 0, 0, 0),
            torus("torus", 0.0, 0.0, 0, 0, 0),
        ];
        for mesh in meshes {
            assert!(
                mesh.vertices.iter().all(|vertex| Vec3::from(vertex.normal).is_finite() && vertex.tangent.iter().all(|x| x.is_finite()))
            );
        }
    }
}
