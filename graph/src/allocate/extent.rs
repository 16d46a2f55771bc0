//! What a resource costs: tight bytes, in checked arithmetic.
//!
//! The numbers are those of the format table, not a driver's: nothing is ever placed inside of a texture by them.

use crate::bind::types::Bound;
use crate::expand::types::{Resource, ResourceId, Shape, TextureShape};
use crate::format::Format;

/// Offsets in arenas are multiples of this: WebGPU's default `minUniformBufferOffsetAlignment` and its storage counterpart.
pub const ARENA_ALIGNMENT: u64 = 256;

/// Bytes of all mips, layers and samples, without padding. `None` where the sum does not fit, or mips are more than extents
/// of 32 bits can have.
pub fn texture_bytes(shape: &TextureShape, format: Format) -> Option<u64> {
    let mut texels: u64 = 0;
    if shape.mips > u32::BITS {
        return None;
    }
    for mip in 0..shape.mips {
        let edge = |texels: u32| u64::from(texels.checked_shr(mip).unwrap_or(0).max(1));
        let level = edge(shape.width).checked_mul(edge(shape.height))?.checked_mul(edge(shape.depth))?;
        texels = texels.checked_add(level)?;
    }
    let per_texel = u64::from(shape.layers).checked_mul(u64::from(shape.samples))?.checked_mul(u64::from(format.info().texel_bytes))?;
    texels.checked_mul(per_texel)
}

/// Bytes of a resource; buffers are rounded up to 4, as WebGPU wants them. `None` where they do not fit in 64 bits.
pub fn resource_bytes(resource: &Resource, format: Option<Format>) -> Option<u64> {
    match &resource.shape {
        Shape::Buffer { bytes } => round_up(*bytes, 4),
        Shape::Texture(shape) => texture_bytes(shape, format?),
    }
}

/// What a resource of so many bytes is charged for: tight bytes of a texture, whole units of an arena for a buffer.
pub(crate) fn charged_bytes(resource: &Resource, bytes: u64) -> Option<u64> {
    if matches!(resource.shape, Shape::Buffer { .. }) { round_up(bytes, ARENA_ALIGNMENT) } else { Some(bytes) }
}

/// The chosen format of a texture: binding's choice, else the first in the author's list.
pub(crate) fn format_of(bound: &Bound, resource: ResourceId) -> Option<Format> {
    let chosen = bound.formats.get(resource.index()).copied().flatten();
    chosen.or_else(|| match &bound.expanded.resources.get(resource.index())?.shape {
        Shape::Texture(shape) => shape.formats.first().copied(),
        Shape::Buffer { .. } => None,
    })
}

/// The next multiple of `unit`.
pub(crate) fn round_up(bytes: u64, unit: u64) -> Option<u64> {
    bytes.checked_next_multiple_of(unit)
}
