//! Samplers: the built-in ones by name, and those of materials.

use luminaire_graph::plan::BuiltinSampler;
use luminaire_graph::published::{PublishedSampler, PublishedWrap};

/// One of the samplers that every shader may declare.
pub(crate) fn builtin(device: &wgpu::Device, sampler: BuiltinSampler) -> wgpu::Sampler {
    let address = match sampler {
        BuiltinSampler::LinearRepeat | BuiltinSampler::NearestRepeat => wgpu::AddressMode::Repeat,
        _ => wgpu::AddressMode::ClampToEdge,
    };
    let compare = match sampler {
        BuiltinSampler::CompareLess => Some(wgpu::CompareFunction::LessEqual),
        BuiltinSampler::CompareGreater => Some(wgpu::CompareFunction::GreaterEqual),
        _ => None,
    };
    let linear = sampler.is_filtering();
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some(sampler.name()),
        address_mode_u: address,
        address_mode_v: address,
        address_mode_w: address,
        mag_filter: filter(linear),
        min_filter: filter(linear),
        mipmap_filter: mip_filter(linear && !sampler.is_comparison()),
        compare,
        ..wgpu::SamplerDescriptor::default()
    })
}

/// How a builtin sampler stands in a layout.
pub(crate) fn builtin_type(sampler: BuiltinSampler) -> wgpu::SamplerBindingType {
    if sampler.is_comparison() {
        wgpu::SamplerBindingType::Comparison
    } else if sampler.is_filtering() {
        wgpu::SamplerBindingType::Filtering
    } else {
        wgpu::SamplerBindingType::NonFiltering
    }
}

/// A material's sampler.
pub(crate) fn published(device: &wgpu::Device, sampler: &PublishedSampler) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("material"),
        address_mode_u: wrap(sampler.wrap_u),
        address_mode_v: wrap(sampler.wrap_v),
        mag_filter: filter(sampler.mag_linear),
        min_filter: filter(sampler.min_linear),
        mipmap_filter: mip_filter(sampler.mip_linear && !sampler.no_mips),
        // Up to a quarter of a level the nearest level is level 0, which is what OpenGL's samplers without mips come to.
        lod_max_clamp: if sampler.no_mips { 0.25 } else { 32.0 },
        ..wgpu::SamplerDescriptor::default()
    })
}

fn wrap(wrap: PublishedWrap) -> wgpu::AddressMode {
    match wrap {
        PublishedWrap::ClampToEdge => wgpu::AddressMode::ClampToEdge,
        PublishedWrap::MirroredRepeat => wgpu::AddressMode::MirrorRepeat,
        PublishedWrap::Repeat => wgpu::AddressMode::Repeat,
    }
}

fn filter(linear: bool) -> wgpu::FilterMode {
    if linear { wgpu::FilterMode::Linear } else { wgpu::FilterMode::Nearest }
}

fn mip_filter(linear: bool) -> wgpu::MipmapFilterMode {
    if linear { wgpu::MipmapFilterMode::Linear } else { wgpu::MipmapFilterMode::Nearest }
}
