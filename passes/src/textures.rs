//! Memories as wgpu textures and buffers, and views of their parts.
//!
//! A view is created once per part and dimension and shared by every step that names it. Usages are the plan's, plus what
//! clears and reading results need.

use std::collections::HashMap;
use std::ops::Range;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::expand::types::{Dimension, ResourceId, TextureShape};
use luminaire_graph::format::Format;
use luminaire_graph::plan::{Memory, MemoryId, MemoryKind, PartView, Placement, Plan, PlannedShape, StepKind};
use luminaire_graph::reflect::interface::ViewDimension;

use crate::convert;
use crate::device::Gpu;
use crate::errors::{Subject, catch};

/// A memory on the device.
#[derive(Debug, Clone)]
enum GpuMemory {
    Texture(wgpu::Texture),
    Arena(wgpu::Buffer),
}

/// All memories of a plan, by [`MemoryId`], and the views made so far.
#[derive(Debug, Default)]
pub(crate) struct Memories {
    memories: Vec<Option<GpuMemory>>,
    created: u64,
    views: HashMap<(MemoryId, Range<u32>, Range<u32>, ViewDimension), wgpu::TextureView>,
}

/// A sub-range of an arena.
#[derive(Debug, Clone)]
pub(crate) struct BufferRange {
    pub(crate) buffer: wgpu::Buffer,
    pub(crate) offset: u64,
    pub(crate) size: u64,
}

impl Memories {
    /// For a new plan: what it takes over stands, everything else is to be created.
    pub(crate) fn successor(&self, taken: &[Option<MemoryId>]) -> Memories {
        let mut next = Memories { created: self.created, ..Memories::default() };
        let old = |id: &MemoryId| self.memories.get(id.index()).cloned().flatten();
        next.memories = taken.iter().map(|id| id.as_ref().and_then(old)).collect();
        for ((memory, mips, layers, dimension), view) in &self.views {
            if let Some(new) = taken.iter().position(|id| id.as_ref() == Some(memory)) {
                next.views.insert((MemoryId(new as u32), mips.clone(), layers.clone(), *dimension), view.clone());
            }
        }
        next
    }

    /// How many textures, buffers and views were created.
    pub(crate) fn created(&self) -> u64 {
        self.created
    }

    /// Creates a memory.
    pub(crate) fn create(&mut self, gpu: &Gpu, plan: &Plan, memory: MemoryId) -> Result<(), Diagnostic> {
        let planned = &plan.memories[memory.index()];
        let label = holder_names(plan, planned);
        let (created, errors) = catch(&gpu.device, || match &planned.kind {
            MemoryKind::Texture(shape, format) => GpuMemory::Texture(gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(&label),
                size: convert::extent(shape),
                mip_level_count: shape.mips,
                sample_count: shape.samples,
                dimension: convert::texture_dimension(shape.dimension),
                format: convert::texture_format(*format),
                usage: texture_usages(plan, planned, shape, *format, gpu.poison),
                view_formats: &[],
            })),
            MemoryKind::Arena => GpuMemory::Arena(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(&label),
                size: planned.bytes.max(4),
                usage: buffer_usages(plan, planned, gpu.poison),
                mapped_at_creation: false,
            })),
        });
        if self.memories.len() <= memory.index() {
            self.memories.resize(memory.index() + 1, None);
        }
        self.memories[memory.index()] = Some(created);
        self.created += 1;
        let span = planned.holders.first().map_or_else(Default::default, |holder| plan.resources[holder.index()].span);
        Subject { what: format!("resource {label}"), span, label: "lives in this memory" }.check(&errors)
    }

    /// The texture behind a resource, with its shape; `None` for buffers and resources that live nowhere.
    pub(crate) fn texture<'a>(&'a self, plan: &'a Plan, resource: ResourceId) -> Option<(&'a wgpu::Texture, &'a TextureShape, Format)> {
        let PlannedShape::Texture(shape, format) = &plan.resources[resource.index()].shape else { return None };
        match self.memories.get(placement(plan, resource)?.memory.index())?.as_ref()? {
            GpuMemory::Texture(texture) => Some((texture, shape, *format)),
            GpuMemory::Arena(_) => None,
        }
    }

    /// The bytes behind a buffer resource; `None` for textures and resources that live nowhere.
    pub(crate) fn buffer(&self, plan: &Plan, resource: ResourceId) -> Option<BufferRange> {
        let PlannedShape::Buffer(size) = plan.resources[resource.index()].shape else { return None };
        let Placement { memory, offset } = placement(plan, resource)?;
        match self.memories.get(memory.index())?.as_ref()? {
            GpuMemory::Arena(buffer) => Some(BufferRange { buffer: buffer.clone(), offset, size }),
            GpuMemory::Texture(_) => None,
        }
    }

    /// The view of a texture's part. Runs in the caller's error scope.
    pub(crate) fn view(&mut self, plan: &Plan, part: &PartView) -> Option<wgpu::TextureView> {
        let memory = placement(plan, part.resource)?.memory;
        let key = (memory, part.mips.clone(), part.layers.clone(), part.dimension);
        if let Some(view) = self.views.get(&key) {
            return Some(view.clone());
        }
        let (texture, _, _) = self.texture(plan, part.resource)?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            label: Some(&plan.resources[part.resource.index()].name),
            dimension: Some(convert::view_dimension(part.dimension)),
            base_mip_level: part.mips.start,
            mip_level_count: Some(part.mips.end.saturating_sub(part.mips.start)),
            base_array_layer: part.layers.start,
            array_layer_count: Some(part.layers.end.saturating_sub(part.layers.start)),
            ..wgpu::TextureViewDescriptor::default()
        });
        self.created += 1;
        self.views.insert(key, view.clone());
        Some(view)
    }
}

/// Whether parts of such textures are cleared by drawing nothing into them; else bytes are copied.
pub(crate) fn clears_by_attachment(shape: &TextureShape, format: Format) -> bool {
    let flat = matches!(shape.dimension, Dimension::D2 | Dimension::Cube);
    flat && (format.info().renderable || format.is_depth())
}

/// Names of a memory's holders, for messages.
pub(crate) fn holder_names(plan: &Plan, memory: &Memory) -> String {
    luminaire_graph::diagnostic::list_names(memory.holders.iter().map(|holder| plan.resources[holder.index()].name.as_str()))
}

fn placement(plan: &Plan, resource: ResourceId) -> Option<Placement> {
    plan.resources[resource.index()].placement
}

/// Whether one of the memory's holders is filled with a value at some time.
fn is_cleared(plan: &Plan, memory: &Memory) -> bool {
    let declares = |holder: &ResourceId| {
        let resource = &plan.resources[holder.index()];
        resource.clear.is_some() || resource.history.is_some()
    };
    if memory.holders.iter().any(declares) {
        return true;
    }
    plan.steps.iter().any(|step| {
        let target = match &step.kind {
            StepKind::Clear { target, .. } => Some(target.resource),
            _ => None,
        };
        target.into_iter().chain(step.clears.iter().map(|(view, _)| view.resource)).any(|cleared| memory.holders.contains(&cleared))
    })
}

fn is_copied_to(plan: &Plan, memory: &Memory) -> bool {
    plan.steps.iter().any(|step| match &step.kind {
        StepKind::Copy { target, .. } | StepKind::Image { target, .. } | StepKind::Remember { target, .. } => {
            memory.holders.contains(&target.resource)
        }
        _ => false,
    })
}

fn is_output(plan: &Plan, memory: &Memory) -> bool {
    plan.outputs.iter().any(|output| memory.holders.contains(&output.view.resource))
}

fn texture_usages(plan: &Plan, memory: &Memory, shape: &TextureShape, format: Format, poison: bool) -> wgpu::TextureUsages {
    let mut usages = convert::texture_usages(memory.usage);
    // The plan's `copy_target` holds clears too, which for many formats are no copies.
    if is_copied_to(plan, memory) {
        usages |= wgpu::TextureUsages::COPY_DST;
    }
    if poison || is_cleared(plan, memory) {
        let by_attachment = clears_by_attachment(shape, format);
        usages |= if by_attachment { wgpu::TextureUsages::RENDER_ATTACHMENT } else { wgpu::TextureUsages::COPY_DST };
    }
    if is_output(plan, memory) || usages.is_empty() {
        usages |= wgpu::TextureUsages::COPY_SRC;
    }
    usages
}

fn buffer_usages(plan: &Plan, memory: &Memory, poison: bool) -> wgpu::BufferUsages {
    let mut usages = convert::buffer_usages(memory.usage);
    if poison || is_cleared(plan, memory) || is_copied_to(plan, memory) {
        usages |= wgpu::BufferUsages::COPY_DST;
    }
    if is_output(plan, memory) || usages.is_empty() {
        usages |= wgpu::BufferUsages::COPY_SRC;
    }
    usages
}
