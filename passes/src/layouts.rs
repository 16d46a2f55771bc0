//! Bind group layouts and pipeline layouts, from the plan's bindings.
//!
//! Layouts are explicit, never inferred by wgpu, and equal ones are one object: steps whose shaders declare the same things
//! share pipelines and material bind groups.

use std::collections::HashMap;

use luminaire_graph::plan::{Binding, BindingTarget};

use crate::{convert, samplers};

/// A layout of [`Layouts`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct LayoutId(usize);

/// The groups of a pipeline. Group 0 is bound once per pass, group 1 once per material; either may be absent.
pub(crate) type GroupLayouts = [Option<LayoutId>; 2];

/// Every layout made so far.
#[derive(Debug, Default, Clone)]
pub(crate) struct Layouts {
    ids: HashMap<Vec<wgpu::BindGroupLayoutEntry>, LayoutId>,
    groups: Vec<wgpu::BindGroupLayout>,
    pipelines: HashMap<GroupLayouts, wgpu::PipelineLayout>,
}

impl Layouts {
    /// The layout of some bindings of one group. Runs in the caller's error scope.
    pub(crate) fn group(&mut self, device: &wgpu::Device, bindings: &[&Binding]) -> LayoutId {
        let entries: Vec<wgpu::BindGroupLayoutEntry> = bindings.iter().map(|binding| entry(binding)).collect();
        if let Some(id) = self.ids.get(&entries) {
            return *id;
        }
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
        let id = LayoutId(self.groups.len());
        self.groups.push(layout);
        self.ids.insert(entries, id);
        id
    }

    /// The object behind an id.
    pub(crate) fn get(&self, id: LayoutId) -> &wgpu::BindGroupLayout {
        &self.groups[id.0]
    }

    /// The layout of a pipeline. Runs in the caller's error scope.
    pub(crate) fn pipeline(&mut self, device: &wgpu::Device, groups: GroupLayouts) -> wgpu::PipelineLayout {
        if let Some(layout) = self.pipelines.get(&groups) {
            return layout.clone();
        }
        let used = groups.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        let layouts: Vec<Option<&wgpu::BindGroupLayout>> = groups[..used].iter().map(|id| id.map(|id| self.get(id))).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &layouts,
            ..wgpu::PipelineLayoutDescriptor::default()
        });
        self.pipelines.insert(groups, layout.clone());
        layout
    }
}

fn entry(binding: &Binding) -> wgpu::BindGroupLayoutEntry {
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let storage = |writable: bool| wgpu::BufferBindingType::Storage { read_only: !writable };
    let ty = match &binding.target {
        BindingTarget::UniformTable(_) | BindingTarget::TableRow(..) | BindingTarget::View(_) | BindingTarget::Params { .. } => {
            buffer(wgpu::BufferBindingType::Uniform)
        }
        BindingTarget::StorageTable(_) | BindingTarget::Batch => buffer(storage(false)),
        BindingTarget::Buffer { uniform: true, .. } => buffer(wgpu::BufferBindingType::Uniform),
        BindingTarget::Buffer { writable, .. } => buffer(storage(*writable)),
        target @ (BindingTarget::MaterialTexture(_) | BindingTarget::SceneTexture(_)) => wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: matches!(target, BindingTarget::MaterialTexture(_)) },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        BindingTarget::MaterialSampler(_) => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        BindingTarget::Sampler(sampler) => wgpu::BindingType::Sampler(samplers::builtin_type(*sampler)),
        BindingTarget::Texture { view, sample, multisampled } => wgpu::BindingType::Texture {
            sample_type: convert::sample_type(*sample, *multisampled),
            view_dimension: convert::view_dimension(view.dimension),
            multisampled: *multisampled,
        },
        BindingTarget::StorageTexture { view, format, access } => wgpu::BindingType::StorageTexture {
            access: convert::storage_access(*access),
            format: convert::texture_format(*format),
            view_dimension: convert::view_dimension(view.dimension),
        },
    };
    wgpu::BindGroupLayoutEntry { binding: binding.binding, visibility: convert::shader_stages(binding.stages), ty, count: None }
}
