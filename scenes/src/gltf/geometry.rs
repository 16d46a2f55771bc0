//! The vertices and triangles of one primitive: gathered, morphed, skinned, completed.
//!
//! Guarantees: every number of a [`Vertex`] is finite, normals and tangents have unit length, and only vertices that a triangle
//! uses are there. Positions that are not finite are an error; other attributes are mended, with a warning.
//! A primitive without normals gets flat ones, and each triangle its own vertices.

use glam::{Affine3A, DVec3, Vec2, Vec3};

use super::material::MaterialSource;
use super::mesh::Primitive;
use super::node::LARGEST;
use super::report::Report;
use super::topology::{self, Budget};
use super::{skin, tangents};
use crate::asset::Vertex;

/// What a mesh's node adds to it.
#[derive(Clone, Copy)]
pub(super) struct Shape<'s> {
    /// Morph weights; missing ones are 0.
    pub(super) weights: &'s [f32],
    /// Joint matrices of a skinned mesh.
    pub(super) joints: Option<&'s [Affine3A]>,
}

/// Vertices and a triangle list.
pub(super) struct Geometry {
    pub(super) vertices: Vec<Vertex>,
    pub(super) indices: Vec<u32>,
}

/// Builds a primitive. `None` where nothing is left, which the report explains.
pub(super) fn build(
    primitive: &Primitive<'_>,
    material: &MaterialSource,
    shape: Shape<'_>,
    budget: &mut Budget,
    report: &Report,
) -> Option<Geometry> {
    let mut indices = topology::triangles(primitive, budget, report)?;
    let used = compact(&mut indices, primitive.position.count);
    let flat = primitive.normal.is_none();
    budget.take_vertices(if flat { indices.len() } else { used.len() }, &primitive.place, report)?;

    let layers = primitive.targets.len().saturating_add(primitive.influences.len());
    budget.take_deformed(used.len().saturating_mul(layers), &primitive.place, report)?;

    let mut positions = read_positions(primitive, &used, report)?;
    let mut normals: Option<Vec<Vec3>> =
        primitive.normal.map(|accessor| used.iter().map(|index| Vec3::from_array(accessor.floats(*index as usize))).collect());
    morph(primitive, shape.weights, &used, &mut positions, normals.as_mut());
    if let Some(joints) = shape.joints
        && !primitive.influences.is_empty()
    {
        skin::apply(primitive, joints, &used, &mut positions, normals.as_mut(), report)?;
    }
    check_positions(primitive, &used, &positions, "morphed or skinned position", report)?;

    let mut vertices: Vec<Vertex> =
        used.iter().zip(&positions).map(|(index, position)| start(primitive, *index as usize, *position)).collect();
    read_uvs(primitive, material, &used, &mut vertices, report);
    match normals {
        Some(normals) => set_normals(primitive, &normals, &indices, &mut vertices, report),
        None => {
            vertices = unshare(&vertices, &indices);
            indices = (0..vertices.len() as u32).collect();
            flat_normals(&mut vertices);
        }
    }
    let mut geometry = Geometry { vertices, indices };
    match primitive.tangent.filter(|_| !flat) {
        Some(accessor) => tangents::from_file(&mut geometry.vertices, |vertex| {
            used.get(vertex).map_or([0.0; 4], |index| accessor.floats(*index as usize))
        }),
        None => derive_tangents(primitive, material, &mut geometry, budget, report)?,
    }
    Some(geometry)
}

/// Renumbers the corners so that only used vertices are left, and returns the file's index of each.
fn compact(indices: &mut [u32], vertices: usize) -> Vec<u32> {
    let mut used = indices.to_vec();
    used.sort_unstable();
    used.dedup();
    if used.len() != vertices {
        for index in indices {
            // Every index is in the list that was made from them.
            *index = used.binary_search(index).unwrap_or(0) as u32;
        }
    }
    used
}

fn read_positions(primitive: &Primitive<'_>, used: &[u32], report: &Report) -> Option<Vec<Vec3>> {
    let positions: Vec<Vec3> = used.iter().map(|index| Vec3::from_array(primitive.position.floats(*index as usize))).collect();
    check_positions(primitive, used, &positions, "position", report)?;
    Some(positions)
}

fn check_positions(primitive: &Primitive<'_>, used: &[u32], positions: &[Vec3], what: &str, report: &Report) -> Option<()> {
    // Written so that NaN counts as bad.
    let bad = |position: &Vec3| !position.to_array().iter().all(|coordinate| coordinate.abs() <= LARGEST);
    let Some(first) = positions.iter().position(bad) else { return Some(()) };
    let count = positions.iter().filter(|position| bad(position)).count();
    let (vertex, position) = (used.get(first)?, positions.get(first)?);
    let total = positions.len();
    let problem =
        format!("the {what} of {count} of {total} vertices is not finite or beyond {LARGEST:e}; vertex {vertex} is at {position}");
    report.error("gltf::position", format_args!("{}.attributes.POSITION", primitive.place), problem, "repair the mesh and export it again");
    None
}

fn morph(primitive: &Primitive<'_>, weights: &[f32], used: &[u32], positions: &mut [Vec3], mut normals: Option<&mut Vec<Vec3>>) {
    for (target, weight) in primitive.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        if let Some(accessor) = target.position {
            for (position, index) in positions.iter_mut().zip(used) {
                *position += *weight * Vec3::from_array(accessor.floats(*index as usize));
            }
        }
        if let (Some(accessor), Some(normals)) = (target.normal, normals.as_deref_mut()) {
            for (normal, index) in normals.iter_mut().zip(used) {
                *normal += *weight * Vec3::from_array(accessor.floats(*index as usize));
            }
        }
    }
}

/// A vertex with all that needs no other vertex.
fn start(primitive: &Primitive<'_>, index: usize, position: Vec3) -> Vertex {
    let color = primitive.color.map_or([1.0; 4], |accessor| {
        let [r, g, b, a] = accessor.floats(index);
        [r, g, b, if accessor.kind.components() == 4 { a } else { 1.0 }]
    });
    Vertex {
        position: position.to_array(),
        normal: [0.0, 1.0, 0.0],
        tangent: [1.0, 0.0, 0.0, 1.0],
        uv0: [0.0; 2],
        uv1: [0.0; 2],
        // NaN becomes 0 in the cast.
        color: color.map(|channel: f32| (channel.clamp(0.0, 1.0) * 255.0).round() as u8),
        padding: 0,
    }
}

fn read_uvs(primitive: &Primitive<'_>, material: &MaterialSource, used: &[u32], vertices: &mut [Vertex], report: &Report) {
    let mut textures = material.material.clone();
    let needed =
        super::material::textures_mut(&mut textures).into_iter().flatten().map(|texture| texture.uv_set).fold(0, |all, set| all | 1 << set);
    let mut broken = 0_usize;
    for (slot, set) in material.uv_sets.iter().enumerate() {
        let Some(accessor) = primitive.uvs.get(set) else {
            if needed & (1_u32 << slot) != 0 {
                let problem = format!("has no TEXCOORD_{set}, which its material uses; zero is taken");
                report.warning("gltf::no-texcoord", format_args!("{}.attributes", primitive.place), problem, "");
            }
            continue;
        };
        for (vertex, index) in vertices.iter_mut().zip(used) {
            let mut uv: [f32; 2] = accessor.floats(*index as usize);
            if !uv.iter().all(|coordinate| coordinate.is_finite()) {
                broken += 1;
                uv = [0.0; 2];
            }
            *(if slot == 0 { &mut vertex.uv0 } else { &mut vertex.uv1 }) = uv;
        }
    }
    if broken > 0 {
        let problem = format!("{broken} texture coordinates are not finite, and taken as zero");
        report.warning("gltf::texcoord", format_args!("{}.attributes", primitive.place), problem, "");
    }
}

/// The normal of a triangle times twice its area, in 64 bits so that tiny triangles keep theirs.
fn face_normal(corners: [&Vertex; 3]) -> DVec3 {
    let [a, b, c] = corners.map(|vertex| Vec3::from_array(vertex.position).as_dvec3());
    (b - a).cross(c - a)
}

/// The vertices of the corners of a triangle.
fn corners<'v>(vertices: &'v [Vertex], triangle: &[u32]) -> Option<[&'v Vertex; 3]> {
    let [a, b, c] = triangle else { return None };
    Some([vertices.get(*a as usize)?, vertices.get(*b as usize)?, vertices.get(*c as usize)?])
}

/// Normals of the file, at unit length. Those without a direction become the mean of the triangles around them.
fn set_normals(primitive: &Primitive<'_>, normals: &[Vec3], indices: &[u32], vertices: &mut [Vertex], report: &Report) {
    let mut missing = Vec::new();
    for (index, (vertex, normal)) in vertices.iter_mut().zip(normals).enumerate() {
        match unit(normal.as_dvec3()) {
            Some(unit) => vertex.normal = unit.to_array(),
            None => missing.push(index),
        }
    }
    if missing.is_empty() {
        return;
    }
    let total = normals.len();
    let problem = format!("{} of {total} normals have no direction; those of the triangles around them are taken", missing.len());
    report.warning("gltf::normal", format_args!("{}.attributes.NORMAL", primitive.place), problem, "");
    let mut sums = vec![DVec3::ZERO; vertices.len()];
    for triangle in indices.chunks_exact(3) {
        let Some(corners) = corners(vertices, triangle) else { continue };
        let normal = face_normal(corners);
        for index in triangle {
            if let Some(sum) = sums.get_mut(*index as usize) {
                *sum += normal;
            }
        }
    }
    for index in missing {
        if let (Some(vertex), Some(sum)) = (vertices.get_mut(index), sums.get(index)) {
            vertex.normal = unit(*sum).unwrap_or(Vec3::Y).to_array();
        }
    }
}

/// Unit length, or `None` where there is no direction.
fn unit(vector: DVec3) -> Option<Vec3> {
    // Scaled first: the square of a denormal length is zero, that of a huge one infinite.
    let largest = vector.abs().max_element();
    if !(largest > 0.0 && largest.is_finite() && vector.is_finite()) {
        return None;
    }
    (vector / largest).try_normalize().map(|unit| unit.as_vec3())
}

/// Gives every corner its own vertex.
fn unshare(vertices: &[Vertex], indices: &[u32]) -> Vec<Vertex> {
    indices.iter().filter_map(|index| vertices.get(*index as usize).copied()).collect()
}

/// One normal for each triangle of unshared vertices; up where a triangle has no area.
fn flat_normals(vertices: &mut [Vertex]) {
    for triangle in vertices.chunks_exact_mut(3) {
        if let [a, b, c] = triangle {
            let normal = unit(face_normal([a, b, c])).unwrap_or(Vec3::Y).to_array();
            for vertex in [a, b, c] {
                vertex.normal = normal;
            }
        }
    }
}

/// Tangents from the texture coordinates of the normal texture, or any perpendicular ones where there is none.
fn derive_tangents(
    primitive: &Primitive<'_>,
    material: &MaterialSource,
    geometry: &mut Geometry,
    budget: &mut Budget,
    report: &Report,
) -> Option<()> {
    let normal_texture = material.material.normal_texture;
    let has_uvs = |set: u32| material.uv_sets.get(set as usize).is_some_and(|set| primitive.uvs.contains_key(set));
    let Some(texture) = normal_texture.filter(|texture| has_uvs(texture.uv_set)) else {
        tangents::perpendicular(&mut geometry.vertices);
        return Some(());
    };
    let coordinates: Vec<Vec2> = geometry
        .vertices
        .iter()
        .map(|vertex| texture.transformed(Vec2::from_array(if texture.uv_set == 0 { vertex.uv0 } else { vertex.uv1 })))
        .collect();
    let before = geometry.vertices.len();
    if !tangents::from_coordinates(geometry, &coordinates) {
        let problem = "too many triangles meet in one vertex to derive tangents; the normal texture may look wrong";
        report.warning("gltf::tangents", &primitive.place, problem, "export the mesh with tangents");
    }
    budget.take_vertices(geometry.vertices.len().saturating_sub(before), &primitive.place, report)
}
