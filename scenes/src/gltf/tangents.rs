//! Tangents: those of the file, MikkTSpace's, or any that are perpendicular to the normal.
//!
//! Guarantees: `xyz` has unit length, `w` is 1 or -1. The derivation takes time in proportion to the mesh: MikkTSpace recurses
//! and compares around a vertex, so a mesh in which too many triangles meet in one is not given to it.
//! Downside: MikkTSpace splits vertices whose triangles disagree, so that the vertex order changes.

use std::collections::HashMap;

use bevy_mikktspace::{Geometry as Faces, TangentSpace};
use glam::{Vec2, Vec3};

use super::geometry::Geometry;
use crate::asset::Vertex;

/// Most triangles around one vertex.
const MOST_AROUND: u32 = 1024;
/// Most comparisons around all vertices: the sum of the squares of the triangles around each.
const MOST_COMPARED: u64 = 1 << 28;

/// Takes tangents from the file, by the vertex's index.
pub(super) fn from_file(vertices: &mut [Vertex], tangent: impl Fn(usize) -> [f32; 4]) {
    for (index, vertex) in vertices.iter_mut().enumerate() {
        let [x, y, z, w] = tangent(index);
        vertex.tangent = complete(Some([x, y, z, if w < 0.0 { -1.0 } else { 1.0 }]), vertex.normal);
    }
}

/// Any tangents, for materials that need none.
pub(super) fn perpendicular(vertices: &mut [Vertex]) {
    for vertex in vertices {
        vertex.tangent = complete(None, vertex.normal);
    }
}

/// MikkTSpace's tangents for one coordinate per vertex. `false` where the mesh is unfit, and the tangents are only perpendicular.
pub(super) fn from_coordinates(geometry: &mut Geometry, coordinates: &[Vec2]) -> bool {
    let corners: Vec<Corner> = geometry
        .indices
        .iter()
        .filter_map(|index| Some(Corner { vertex: *geometry.vertices.get(*index as usize)?, uv: *coordinates.get(*index as usize)? }))
        .collect();
    // Triangles without area or without coordinates have no tangents of their own.
    let faces: Vec<usize> = corners.chunks_exact(3).enumerate().filter(|(_, face)| is_usable(face)).map(|(face, _)| face).collect();
    if !is_fit(&corners, &faces) {
        perpendicular(&mut geometry.vertices);
        return false;
    }
    let mut mesh = Mesh { tangents: vec![None; corners.len()], corners, faces };
    if bevy_mikktspace::generate_tangents(&mut mesh).is_err() {
        perpendicular(&mut geometry.vertices);
        return false;
    }
    weld(geometry, &mesh.tangents);
    true
}

/// Splits vertices whose corners got different tangents.
fn weld(geometry: &mut Geometry, tangents: &[Option<[f32; 4]>]) {
    // A corner without a tangent takes that of another corner of its vertex.
    let mut of_vertex: Vec<Option<[f32; 4]>> = vec![None; geometry.vertices.len()];
    for (index, tangent) in geometry.indices.iter().zip(tangents) {
        if let Some(slot) = of_vertex.get_mut(*index as usize) {
            *slot = slot.or(*tangent);
        }
    }
    let mut vertices = Vec::with_capacity(geometry.vertices.len());
    let mut known: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    for (index, tangent) in geometry.indices.iter_mut().zip(tangents) {
        let Some(vertex) = geometry.vertices.get(*index as usize) else { continue };
        let tangent = complete(tangent.or(of_vertex.get(*index as usize).copied().flatten()), vertex.normal);
        *index = *known.entry((*index, tangent.map(f32::to_bits))).or_insert_with(|| {
            vertices.push(Vertex { tangent, ..*vertex });
            vertices.len() as u32 - 1
        });
    }
    geometry.vertices = vertices;
}

/// A usable tangent as it is, at unit length; else one that is perpendicular to the normal.
fn complete(tangent: Option<[f32; 4]>, normal: [f32; 3]) -> [f32; 4] {
    let given = tangent.and_then(|[x, y, z, w]| {
        let direction = Vec3::new(x, y, z).try_normalize()?;
        Some((direction, w))
    });
    let (direction, w) = given.unwrap_or_else(|| (Vec3::from_array(normal).any_orthonormal_vector(), 1.0));
    [direction.x, direction.y, direction.z, w]
}

struct Corner {
    vertex: Vertex,
    uv: Vec2,
}

impl Corner {
    /// What MikkTSpace compares when it welds; negative zero equals zero.
    fn key(&self) -> [u32; 8] {
        let [px, py, pz] = self.vertex.position;
        let [nx, ny, nz] = self.vertex.normal;
        [px, py, pz, nx, ny, nz, self.uv.x, self.uv.y].map(|value| (value + 0.0).to_bits())
    }
}

fn is_usable(face: &[Corner]) -> bool {
    let [a, b, c] = face else { return false };
    let distinct = |a: &Corner, b: &Corner| a.vertex.position != b.vertex.position;
    face.iter().all(|corner| corner.uv.is_finite()) && distinct(a, b) && distinct(b, c) && distinct(c, a)
}

/// Whether few enough triangles meet in each vertex.
fn is_fit(corners: &[Corner], faces: &[usize]) -> bool {
    let mut around: HashMap<[u32; 8], u32> = HashMap::new();
    let mut compared = 0_u64;
    for corner in faces.iter().flat_map(|face| corners.iter().skip(face * 3).take(3)) {
        let count = around.entry(corner.key()).or_insert(0);
        // Squares are sums of odd numbers.
        compared += u64::from(*count) * 2 + 1;
        *count += 1;
        if *count > MOST_AROUND || compared > MOST_COMPARED {
            return false;
        }
    }
    true
}

/// The mesh as MikkTSpace sees it.
struct Mesh {
    corners: Vec<Corner>,
    faces: Vec<usize>,
    tangents: Vec<Option<[f32; 4]>>,
}

impl Mesh {
    fn index(&self, face: usize, corner: usize) -> usize {
        self.faces.get(face).map_or(usize::MAX, |face| face * 3 + corner)
    }

    fn corner(&self, face: usize, corner: usize) -> Option<&Corner> {
        self.corners.get(self.index(face, corner))
    }
}

impl Faces for Mesh {
    fn num_faces(&self) -> usize {
        self.faces.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vert: usize) -> [f32; 3] {
        self.corner(face, vert).map_or([0.0; 3], |corner| corner.vertex.position)
    }

    fn normal(&self, face: usize, vert: usize) -> [f32; 3] {
        self.corner(face, vert).map_or([0.0; 3], |corner| corner.vertex.normal)
    }

    fn tex_coord(&self, face: usize, vert: usize) -> [f32; 2] {
        // glTF's v points down in the image, and the green channel of its normal textures up.
        self.corner(face, vert).map_or([0.0; 2], |corner| [corner.uv.x, 1.0 - corner.uv.y])
    }

    fn set_tangent(&mut self, tangent_space: Option<TangentSpace>, face: usize, vert: usize) {
        let index = self.index(face, vert);
        if let (Some(slot), Some(space)) = (self.tangents.get_mut(index), tangent_space) {
            *slot = Some(space.tangent_encoded());
        }
    }
}
