//! One vertex buffer and one index buffer for all meshes.

use std::sync::Arc;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::published::PublishedGeometry;

use crate::asset::Mesh;

/// All meshes behind each other, in the order of the world.
#[derive(Debug, Default)]
pub(super) struct Geometry {
    pub(super) published: Arc<PublishedGeometry>,
    /// By mesh.
    pub(super) ranges: Vec<MeshRange>,
}

/// Where a mesh lies in the buffers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct MeshRange {
    pub(super) first_index: u32,
    pub(super) index_count: u32,
    pub(super) base_vertex: i32,
}

/// Errors: `publish::too-much-geometry`.
pub(super) fn build(meshes: &[Mesh]) -> Result<Geometry, Diagnostic> {
    let vertex_count: usize = meshes.iter().map(|mesh| mesh.vertices.len()).sum();
    let index_count: usize = meshes.iter().map(|mesh| mesh.indices.len()).sum();
    if i32::try_from(vertex_count).is_err() || u32::try_from(index_count).is_err() {
        return Err(Diagnostic::error(
            "publish::too-much-geometry",
            format!("the scene has {vertex_count} vertices and {index_count} indices; draws can address 2^31 - 1 and 2^32 - 1"),
        ));
    }
    let mut geometry = PublishedGeometry {
        vertices: Vec::with_capacity(vertex_count * size_of::<crate::asset::Vertex>()),
        indices: Vec::with_capacity(index_count),
    };
    let mut ranges = Vec::with_capacity(meshes.len());
    let mut base_vertex = 0;
    for mesh in meshes {
        let first_index = geometry.indices.len() as u32;
        ranges.push(MeshRange { first_index, index_count: mesh.indices.len() as u32, base_vertex });
        geometry.vertices.extend_from_slice(bytemuck::cast_slice(&mesh.vertices));
        geometry.indices.extend_from_slice(&mesh.indices);
        base_vertex += mesh.vertices.len() as i32;
    }
    Ok(Geometry { published: Arc::new(geometry), ranges })
}
