//! What a scene publishes for one frame.
//!
//! A copy shares what is large: a publisher that keeps what did not change lets an executor see at a pointer's cost that it did not.

use std::sync::Arc;

use indexmap::IndexMap;

use super::{DrawFilter, Table, ViewKind};

/// What a scene publishes for one frame.
#[derive(Debug, Clone, Default)]
pub struct PublishedScene {
    /// Tables by name. Those of kind [`super::TableKind::View`] stand in `views`.
    pub tables: IndexMap<String, Table>,
    /// For each requested view, the bytes of the view table.
    pub views: Vec<Vec<u8>>,
    /// Vertices and indices of all meshes.
    pub geometry: Arc<PublishedGeometry>,
    /// Textures of the whole scene, by name.
    pub textures: IndexMap<String, Arc<PublishedTexture>>,
    /// What materials bind.
    pub materials: Arc<PublishedMaterials>,
    /// For each requested draw list, its batches.
    pub draw_lists: Vec<DrawList>,
}

/// One vertex buffer and one index buffer.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PublishedGeometry {
    /// Laid out as [`super::PublishedSchema::vertex`] says.
    pub vertices: Vec<u8>,
    /// Three per triangle.
    pub indices: Vec<u32>,
}

/// Textures and samplers, and which of them each material binds.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PublishedMaterials {
    /// Textures of all materials.
    pub textures: Vec<Arc<PublishedTexture>>,
    /// Samplers of all materials.
    pub samplers: Vec<PublishedSampler>,
    /// Per material, what its draws bind.
    pub bindings: Vec<MaterialBinding>,
}

/// What is drawn from a view.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DrawList {
    /// Which surfaces.
    pub filter: DrawFilter,
    /// From where.
    pub view: ViewKind,
    /// Draw calls, in order.
    pub batches: Arc<Vec<DrawBatch>>,
}

impl PublishedScene {
    /// The batches of a draw list.
    pub fn draw_list(&self, filter: DrawFilter, view: ViewKind) -> Option<&Arc<Vec<DrawBatch>>> {
        self.draw_lists.iter().find(|list| (list.filter, list.view) == (filter, view)).map(|list| &list.batches)
    }
}

/// An image with its mips: RGBA.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PublishedTexture {
    /// For messages.
    pub name: String,
    /// How a texel lies in memory.
    pub texels: PublishedTexels,
    /// Of level 0.
    pub width: u32,
    /// Of level 0.
    pub height: u32,
    /// Level by level, tightly packed rows. Level 0 may be shared with whoever has the image.
    pub mips: Vec<Arc<[u8]>>,
}

/// How texels of a published texture lie in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PublishedTexels {
    /// 8 bits a channel, 0 to 1.
    Unorm8,
    /// 8 bits a channel; sampled values are decoded from sRGB.
    Srgb8,
    /// 32-bit floats, which shaders read with `textureLoad`.
    Float,
}

impl PublishedTexels {
    /// Bytes of a texel.
    pub fn bytes(self) -> u32 {
        match self {
            PublishedTexels::Unorm8 | PublishedTexels::Srgb8 => 4,
            PublishedTexels::Float => 16,
        }
    }
}

/// Filtering and addressing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub struct PublishedSampler {
    pub mag_linear: bool,
    pub min_linear: bool,
    pub mip_linear: bool,
    /// Uses level 0 alone.
    pub no_mips: bool,
    pub wrap_u: PublishedWrap,
    pub wrap_v: PublishedWrap,
}

/// What happens outside of 0..1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum PublishedWrap {
    ClampToEdge,
    MirroredRepeat,
    Repeat,
}

/// Indices into [`PublishedMaterials::textures`] and [`PublishedMaterials::samplers`], in the schema's order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MaterialBinding {
    /// One per [`super::PublishedSchema::material_textures`].
    pub textures: Vec<usize>,
    /// One per [`super::PublishedSchema::material_samplers`].
    pub samplers: Vec<usize>,
}

/// One instanced draw call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DrawBatch {
    /// Index into [`PublishedMaterials::bindings`].
    pub material: usize,
    /// First index in the index buffer.
    pub first_index: u32,
    /// Three per triangle.
    pub index_count: u32,
    /// Added to every index.
    pub base_vertex: i32,
    /// First position in the `instance_slots` table.
    pub first_instance: u32,
    /// How many.
    pub instance_count: u32,
    /// The transform turns the winding.
    pub mirrored: bool,
    /// Never culled.
    pub double_sided: bool,
}
