//! The pass kind Copy: a part onto another of the same extent and format.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::expand::types::Dimension;
use luminaire_graph::plan::{PartView, Plan, Step};

use crate::convert;
use crate::errors::Subject;
use crate::store::Store;
use crate::textures::BufferRange;

/// A Copy that is ready to run.
#[derive(Debug)]
pub(crate) enum CopyStep {
    /// Textures, and what is copied level by level.
    Texture { source: wgpu::Texture, target: wgpu::Texture, regions: Vec<Region> },
    /// Bytes.
    Buffer { source: BufferRange, target: BufferRange },
}

/// One mip level of some layers.
#[derive(Debug)]
pub(crate) struct Region {
    source: (u32, u32),
    target: (u32, u32),
    size: wgpu::Extent3d,
}

impl CopyStep {
    pub(crate) fn prepare(store: &Store, plan: &Plan, step: &Step, source: &PartView, target: &PartView) -> Result<CopyStep, Diagnostic> {
        let memories = &store.memories;
        if let (Some((from, shape, _)), Some((to, _, _))) =
            (memories.texture(plan, source.resource), memories.texture(plan, target.resource))
        {
            let regions = source.mips.clone().zip(target.mips.clone()).map(|(mip, target_mip)| {
                let [width, height, depth] = convert::mip_size(shape, mip);
                let layers = source.layers.end.saturating_sub(source.layers.start);
                let depth_or_array_layers = if shape.dimension == Dimension::D3 { depth } else { layers };
                Region {
                    source: (mip, source.layers.start),
                    target: (target_mip, target.layers.start),
                    size: wgpu::Extent3d { width, height, depth_or_array_layers },
                }
            });
            return Ok(CopyStep::Texture { source: from.clone(), target: to.clone(), regions: regions.collect() });
        }
        match (memories.buffer(plan, source.resource), memories.buffer(plan, target.resource)) {
            (Some(source), Some(target)) => Ok(CopyStep::Buffer { source, target }),
            _ => Err(Subject::step(plan, step).error("execute::copy", "it copies between a texture and a buffer")),
        }
    }

    pub(crate) fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
        match self {
            CopyStep::Texture { source, target, regions } => {
                for region in regions {
                    encoder.copy_texture_to_texture(at(source, region.source), at(target, region.target), region.size);
                }
            }
            CopyStep::Buffer { source, target } => {
                let size = source.size.min(target.size);
                encoder.copy_buffer_to_buffer(&source.buffer, source.offset, &target.buffer, target.offset, size);
            }
        }
    }
}

/// A mip level, from a layer on.
fn at(texture: &wgpu::Texture, (mip_level, layer): (u32, u32)) -> wgpu::TexelCopyTextureInfo<'_> {
    let origin = wgpu::Origin3d { x: 0, y: 0, z: layer };
    wgpu::TexelCopyTextureInfo { texture, mip_level, origin, aspect: wgpu::TextureAspect::All }
}
