//! The plan's words in wgpu's words: formats, dimensions, comparisons, blending, usages.
//!
//! Nothing here can fail: every value that a plan can hold has a counterpart.

use luminaire_graph::expand::types::{ClearValue, Dimension, TextureShape};
use luminaire_graph::format::{Format, SampleKind};
use luminaire_graph::plan::{SampleType, Stages, Usage};
use luminaire_graph::published::VertexFormat;
use luminaire_graph::reflect::interface::{StorageAccess, ViewDimension};
use luminaire_graph::syntax::document::{BlendDoc, CompareDoc};

pub(crate) fn texture_format(format: Format) -> wgpu::TextureFormat {
    use wgpu::TextureFormat as F;
    match format.name() {
        "r8unorm" => F::R8Unorm,
        "r8snorm" => F::R8Snorm,
        "r8uint" => F::R8Uint,
        "r8sint" => F::R8Sint,
        "r16uint" => F::R16Uint,
        "r16sint" => F::R16Sint,
        "r16float" => F::R16Float,
        "rg8unorm" => F::Rg8Unorm,
        "rg8snorm" => F::Rg8Snorm,
        "rg8uint" => F::Rg8Uint,
        "rg8sint" => F::Rg8Sint,
        "r32uint" => F::R32Uint,
        "r32sint" => F::R32Sint,
        "r32float" => F::R32Float,
        "rg16uint" => F::Rg16Uint,
        "rg16sint" => F::Rg16Sint,
        "rg16float" => F::Rg16Float,
        "rgba8unorm-srgb" => F::Rgba8UnormSrgb,
        "rgba8snorm" => F::Rgba8Snorm,
        "rgba8uint" => F::Rgba8Uint,
        "rgba8sint" => F::Rgba8Sint,
        "bgra8unorm" => F::Bgra8Unorm,
        "bgra8unorm-srgb" => F::Bgra8UnormSrgb,
        "rgb10a2uint" => F::Rgb10a2Uint,
        "rgb10a2unorm" => F::Rgb10a2Unorm,
        "rg11b10ufloat" => F::Rg11b10Ufloat,
        "rgb9e5ufloat" => F::Rgb9e5Ufloat,
        "rg32uint" => F::Rg32Uint,
        "rg32sint" => F::Rg32Sint,
        "rg32float" => F::Rg32Float,
        "rgba16uint" => F::Rgba16Uint,
        "rgba16sint" => F::Rgba16Sint,
        "rgba16float" => F::Rgba16Float,
        "rgba32uint" => F::Rgba32Uint,
        "rgba32sint" => F::Rgba32Sint,
        "rgba32float" => F::Rgba32Float,
        "depth16unorm" => F::Depth16Unorm,
        "depth24plus" => F::Depth24Plus,
        "depth32float" => F::Depth32Float,
        // `rgba8unorm`; a test shows that no other name gets here.
        _ => F::Rgba8Unorm,
    }
}

pub(crate) fn texture_dimension(dimension: Dimension) -> wgpu::TextureDimension {
    match dimension {
        Dimension::D1 => wgpu::TextureDimension::D1,
        Dimension::D2 | Dimension::Cube => wgpu::TextureDimension::D2,
        Dimension::D3 => wgpu::TextureDimension::D3,
    }
}

pub(crate) fn view_dimension(dimension: ViewDimension) -> wgpu::TextureViewDimension {
    match dimension {
        ViewDimension::D1 => wgpu::TextureViewDimension::D1,
        ViewDimension::D2 => wgpu::TextureViewDimension::D2,
        ViewDimension::D2Array => wgpu::TextureViewDimension::D2Array,
        ViewDimension::D3 => wgpu::TextureViewDimension::D3,
        ViewDimension::Cube => wgpu::TextureViewDimension::Cube,
        ViewDimension::CubeArray => wgpu::TextureViewDimension::CubeArray,
    }
}

/// The whole of mip 0: depth of volumes, else layers.
pub(crate) fn extent(shape: &TextureShape) -> wgpu::Extent3d {
    let depth_or_array_layers = if shape.dimension == Dimension::D3 { shape.depth } else { shape.layers };
    wgpu::Extent3d { width: shape.width, height: shape.height, depth_or_array_layers }
}

/// Width, height and depth of a mip level; layers are not in it.
pub(crate) fn mip_size(shape: &TextureShape, mip: u32) -> [u32; 3] {
    let at = |size: u32| size.checked_shr(mip).unwrap_or(0).max(1);
    [at(shape.width), at(shape.height), at(shape.depth)]
}

pub(crate) fn texture_usages(usage: Usage) -> wgpu::TextureUsages {
    let flags = [
        (usage.sampled, wgpu::TextureUsages::TEXTURE_BINDING),
        (usage.storage, wgpu::TextureUsages::STORAGE_BINDING),
        (usage.attachment, wgpu::TextureUsages::RENDER_ATTACHMENT),
        (usage.copy_source, wgpu::TextureUsages::COPY_SRC),
    ];
    flags.into_iter().filter(|(used, _)| *used).map(|(_, flag)| flag).collect()
}

pub(crate) fn buffer_usages(usage: Usage) -> wgpu::BufferUsages {
    let flags = [
        (usage.storage, wgpu::BufferUsages::STORAGE),
        (usage.uniform, wgpu::BufferUsages::UNIFORM),
        (usage.copy_source, wgpu::BufferUsages::COPY_SRC),
        (usage.copy_target, wgpu::BufferUsages::COPY_DST),
        (usage.indirect, wgpu::BufferUsages::INDIRECT),
    ];
    flags.into_iter().filter(|(used, _)| *used).map(|(_, flag)| flag).collect()
}

pub(crate) fn shader_stages(stages: Stages) -> wgpu::ShaderStages {
    let flags = [
        (stages.vertex, wgpu::ShaderStages::VERTEX),
        (stages.fragment, wgpu::ShaderStages::FRAGMENT),
        (stages.compute, wgpu::ShaderStages::COMPUTE),
    ];
    flags.into_iter().filter(|(used, _)| *used).map(|(_, flag)| flag).collect()
}

pub(crate) fn sample_type(sample: SampleType, multisampled: bool) -> wgpu::TextureSampleType {
    match sample {
        // Nothing filters samples of a texel, and WebGPU wants that said.
        SampleType::FilterableFloat => wgpu::TextureSampleType::Float { filterable: !multisampled },
        SampleType::UnfilterableFloat => wgpu::TextureSampleType::Float { filterable: false },
        SampleType::Depth => wgpu::TextureSampleType::Depth,
        SampleType::Sint => wgpu::TextureSampleType::Sint,
        SampleType::Uint => wgpu::TextureSampleType::Uint,
    }
}

pub(crate) fn storage_access(access: StorageAccess) -> wgpu::StorageTextureAccess {
    match access {
        StorageAccess::Read => wgpu::StorageTextureAccess::ReadOnly,
        StorageAccess::Write => wgpu::StorageTextureAccess::WriteOnly,
        StorageAccess::ReadWrite => wgpu::StorageTextureAccess::ReadWrite,
    }
}

pub(crate) fn vertex_format(format: VertexFormat) -> wgpu::VertexFormat {
    match format {
        VertexFormat::Float32x2 => wgpu::VertexFormat::Float32x2,
        VertexFormat::Float32x3 => wgpu::VertexFormat::Float32x3,
        VertexFormat::Float32x4 => wgpu::VertexFormat::Float32x4,
        VertexFormat::Unorm8x4 => wgpu::VertexFormat::Unorm8x4,
    }
}

pub(crate) fn compare(compare: CompareDoc) -> wgpu::CompareFunction {
    match compare {
        CompareDoc::Never => wgpu::CompareFunction::Never,
        CompareDoc::Less => wgpu::CompareFunction::Less,
        CompareDoc::Equal => wgpu::CompareFunction::Equal,
        CompareDoc::LessEqual => wgpu::CompareFunction::LessEqual,
        CompareDoc::Greater => wgpu::CompareFunction::Greater,
        CompareDoc::NotEqual => wgpu::CompareFunction::NotEqual,
        CompareDoc::GreaterEqual => wgpu::CompareFunction::GreaterEqual,
        CompareDoc::Always => wgpu::CompareFunction::Always,
    }
}

pub(crate) fn blend(blend: BlendDoc) -> wgpu::BlendState {
    use wgpu::{BlendComponent, BlendFactor, BlendOperation};
    let both = |src_factor, dst_factor, operation| {
        let component = BlendComponent { src_factor, dst_factor, operation };
        wgpu::BlendState { color: component, alpha: component }
    };
    match blend {
        BlendDoc::Alpha => wgpu::BlendState::ALPHA_BLENDING,
        BlendDoc::Premultiplied => wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING,
        BlendDoc::Add => both(BlendFactor::One, BlendFactor::One, BlendOperation::Add),
        BlendDoc::Multiply => both(BlendFactor::Dst, BlendFactor::Zero, BlendOperation::Add),
        BlendDoc::Min => both(BlendFactor::One, BlendFactor::One, BlendOperation::Min),
        BlendDoc::Max => both(BlendFactor::One, BlendFactor::One, BlendOperation::Max),
    }
}

/// Four components of a clear value; depth is the first. Signed formats take the bits of `Uint` as they are.
pub(crate) fn clear_components(value: ClearValue, format: Format) -> [f64; 4] {
    let signed = format.info().sample == SampleKind::Sint;
    match value {
        ClearValue::Zero => [0.0; 4],
        ClearValue::Color(color) => color,
        ClearValue::Depth(depth) => [f64::from(depth), 0.0, 0.0, 0.0],
        ClearValue::Uint(bits) => bits.map(|bits| if signed { f64::from(bits.cast_signed()) } else { f64::from(bits) }),
    }
}

pub(crate) fn clear_color(value: ClearValue, format: Format) -> wgpu::Color {
    let [r, g, b, a] = clear_components(value, format);
    wgpu::Color { r, g, b, a }
}

pub(crate) fn clear_depth(value: ClearValue, format: Format) -> f32 {
    clear_components(value, format)[0].clamp(0.0, 1.0) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire_graph::format::FORMATS;

    #[test]
    fn every_format_has_its_own_counterpart() {
        let mut seen = Vec::new();
        for info in FORMATS {
            let format = texture_format(Format::from_name(info.name).unwrap());
            assert!(!seen.contains(&format), "{} is mapped like an earlier format", info.name);
            if info.name != "depth24plus" {
                assert_eq!(format.block_copy_size(None), Some(info.texel_bytes), "{}", info.name);
            }
            seen.push(format);
        }
    }

    #[test]
    fn mips_never_vanish() {
        let format = Format::from_name("rgba8unorm").unwrap();
        let shape = TextureShape {
            dimension: Dimension::D2,
            formats: [format].into_iter().collect(),
            format_span: Default::default(),
            width: 5,
            height: 2,
            depth: 1,
            layers: 1,
            mips: 3,
            samples: 1,
        };
        assert_eq!(mip_size(&shape, 1), [2, 1, 1]);
        assert_eq!(mip_size(&shape, 40), [1, 1, 1]);
    }
}
