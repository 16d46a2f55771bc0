//! The generated kind Remember: what a resource held at the end of the frame before, into its history.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::expand::types::{Dimension, ResourceId, TextureShape};
use luminaire_graph::plan::{PartView, Plan, Step};

use crate::convert;
use crate::copy::CopyStep;
use crate::store::Store;
use crate::textures::{BufferRange, Memories};

/// A Remember that is ready to run.
#[derive(Debug)]
pub(crate) struct RememberStep {
    /// From the resource's own memory.
    copy: CopyStep,
}

/// Content of a plan before, until a frame is submitted.
#[derive(Debug, Clone)]
pub(crate) enum Carried {
    Texture(wgpu::Texture, TextureShape),
    Buffer(BufferRange),
}

impl Carried {
    /// What a resource holds; `None` if it lives nowhere.
    pub(crate) fn of(memories: &Memories, plan: &Plan, resource: ResourceId) -> Option<Carried> {
        match memories.texture(plan, resource) {
            Some((texture, shape, _)) => Some(Carried::Texture(texture.clone(), shape.clone())),
            None => memories.buffer(plan, resource).map(Carried::Buffer),
        }
    }

    /// Copies what both extents have.
    pub(crate) fn encode(&self, encoder: &mut wgpu::CommandEncoder, memories: &Memories, plan: &Plan, target: ResourceId) {
        match self {
            Carried::Texture(texture, shape) => {
                let Some((to, target_shape, _)) = memories.texture(plan, target) else { return };
                for mip in 0..shape.mips.min(target_shape.mips) {
                    let (a, b) = (convert::mip_size(shape, mip), convert::mip_size(target_shape, mip));
                    let depth = if shape.dimension == Dimension::D3 { a[2].min(b[2]) } else { shape.layers.min(target_shape.layers) };
                    let size = wgpu::Extent3d { width: a[0].min(b[0]), height: a[1].min(b[1]), depth_or_array_layers: depth };
                    let at = |texture| wgpu::TexelCopyTextureInfo {
                        texture,
                        mip_level: mip,
                        origin: wgpu::Origin3d::ZERO,
                        aspect: wgpu::TextureAspect::All,
                    };
                    encoder.copy_texture_to_texture(at(texture), at(to), size);
                }
            }
            Carried::Buffer(source) => {
                let Some(to) = memories.buffer(plan, target) else { return };
                encoder.copy_buffer_to_buffer(&source.buffer, source.offset, &to.buffer, to.offset, source.size.min(to.size));
            }
        }
    }
}

impl RememberStep {
    pub(crate) fn prepare(
        store: &Store,
        plan: &Plan,
        step: &Step,
        source: &PartView,
        target: &PartView,
    ) -> Result<RememberStep, Diagnostic> {
        Ok(RememberStep { copy: CopyStep::prepare(store, plan, step, source, target)? })
    }

    pub(crate) fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
        self.copy.encode(encoder);
    }
}
