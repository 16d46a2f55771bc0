//! What the planner must know of an adapter: limits and features, as plain numbers.

use std::collections::BTreeSet;

/// Limits and features that a plan is checked against before anything is created.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceFacts {
    /// For messages: the adapter's name, or `WebGPU's default limits`.
    pub name: String,
    /// Texels along a 1D texture.
    pub max_texture_1d: u32,
    /// Texels along an edge of a 2D or cube texture.
    pub max_texture_2d: u32,
    /// Texels along an edge of a 3D texture.
    pub max_texture_3d: u32,
    /// Layers of an array, six per cube.
    pub max_layers: u32,
    /// Bytes of a buffer.
    pub max_buffer_bytes: u64,
    /// Bytes of a storage binding.
    pub max_storage_binding_bytes: u64,
    /// Bytes of a uniform binding.
    pub max_uniform_binding_bytes: u64,
    /// Workgroups of a dispatch along an axis.
    pub max_workgroups: u32,
    /// Invocations in a workgroup.
    pub max_workgroup_invocations: u32,
    /// Invocations in a workgroup along x, y, z.
    pub max_workgroup_size: [u32; 3],
    /// Color attachments of a pass.
    pub max_color_attachments: u32,
    /// Bytes of all color attachments of a pass, see [`crate::format::FormatInfo::attachment_bytes`].
    pub max_attachment_bytes: u32,
    /// Sampled textures of a shader stage.
    pub max_sampled_textures: u32,
    /// Samplers of a shader stage.
    pub max_samplers: u32,
    /// Storage textures of a shader stage.
    pub max_storage_textures: u32,
    /// Storage buffers of a shader stage.
    pub max_storage_buffers: u32,
    /// Uniform buffers of a shader stage.
    pub max_uniform_buffers: u32,
    /// Optional abilities.
    pub features: BTreeSet<Feature>,
    /// Bytes that a plan may allocate.
    pub memory_budget: u64,
}

/// Optional abilities of adapters that pipelines can need.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// Linear filtering of 32-bit float textures.
    Float32Filterable,
    /// Blending into 32-bit float textures.
    Float32Blendable,
    /// Rendering into `rg11b10ufloat`.
    Rg11b10UfloatRenderable,
    /// 16-bit floats in shaders.
    ShaderF16,
    /// Reading the primitive's index in a fragment shader.
    PrimitiveIndex,
    /// Subgroup operations.
    Subgroups,
}

impl Feature {
    /// WebGPU's name.
    pub fn name(self) -> &'static str {
        match self {
            Feature::Float32Filterable => "float32-filterable",
            Feature::Float32Blendable => "float32-blendable",
            Feature::Rg11b10UfloatRenderable => "rg11b10ufloat-renderable",
            Feature::ShaderF16 => "shader-f16",
            Feature::PrimitiveIndex => "primitive-index",
            Feature::Subgroups => "subgroups",
        }
    }
}

impl DeviceFacts {
    /// WebGPU's default limits without features: what every adapter offers.
    pub fn webgpu_defaults() -> DeviceFacts {
        DeviceFacts {
            name: "WebGPU's default limits".to_owned(),
            max_texture_1d: 8192,
            max_texture_2d: 8192,
            max_texture_3d: 2048,
            max_layers: 256,
            max_buffer_bytes: 256 << 20,
            max_storage_binding_bytes: 128 << 20,
            max_uniform_binding_bytes: 64 << 10,
            max_workgroups: 65535,
            max_workgroup_invocations: 256,
            max_workgroup_size: [256, 256, 64],
            max_color_attachments: 8,
            max_attachment_bytes: 32,
            max_sampled_textures: 16,
            max_samplers: 16,
            max_storage_textures: 4,
            max_storage_buffers: 8,
            max_uniform_buffers: 12,
            features: BTreeSet::new(),
            memory_budget: 4 << 30,
        }
    }
}
