//! Bind groups: one per step for group 0, one per set of material textures and samplers for group 1.
//!
//! Material groups are shared by all steps whose shaders declare the same material variables, and by all materials that bring
//! the same textures, so that their number follows materials, not draws.

use std::collections::HashMap;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::dirty::StepRun;
use luminaire_graph::plan::{Binding, BindingTarget, BuiltinSampler, Plan, Step};
use luminaire_graph::published::MaterialBinding;

use crate::device::Gpu;
use crate::errors::Subject;
use crate::layouts::{GroupLayouts, LayoutId, Layouts};
use crate::samplers;
use crate::scene_data::SceneData;
use crate::textures::{BufferRange, Memories};

/// What a material brings to a variable, by index in the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum MaterialObject {
    Texture(usize),
    Sampler(usize),
}

/// Bind groups and samplers made so far.
#[derive(Debug, Default)]
pub(crate) struct BindGroups {
    samplers: HashMap<BuiltinSampler, wgpu::Sampler>,
    materials: HashMap<(LayoutId, Vec<(u32, MaterialObject)>), wgpu::BindGroup>,
    created: u64,
}

/// What a step binds.
#[derive(Debug, Clone)]
pub(crate) struct StepGroups {
    /// For the pipeline.
    pub(crate) layouts: GroupLayouts,
    /// Group 0, if the step has any.
    pub(crate) step: Option<wgpu::BindGroup>,
    /// The bindings of group 1.
    material: Vec<Binding>,
    /// The indices of the iterations that run, of a batched step.
    batch: Option<wgpu::Buffer>,
    /// Where the number of the run goes, of an accumulating step.
    accumulated: Option<(wgpu::Buffer, u64)>,
}

impl StepGroups {
    /// Brings in what changes from run to run.
    pub(crate) fn update(&self, queue: &wgpu::Queue, run: &StepRun) {
        if let Some(batch) = &self.batch {
            queue.write_buffer(batch, 0, bytemuck::cast_slice(&run.iterations));
        }
        if let Some((params, offset)) = &self.accumulated {
            queue.write_buffer(params, *offset, &run.accumulated.to_le_bytes());
        }
    }
}

/// An object that a binding holds while its bind group is made.
enum Held {
    Buffer(BufferRange),
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

impl Held {
    fn whole(buffer: &wgpu::Buffer) -> Held {
        Held::Buffer(BufferRange { buffer: buffer.clone(), offset: 0, size: buffer.size() })
    }

    fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Held::Buffer(BufferRange { buffer, offset, size }) => {
                wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: *offset, size: wgpu::BufferSize::new(*size) })
            }
            Held::View(view) => wgpu::BindingResource::TextureView(view),
            Held::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }
}

impl BindGroups {
    /// For a new plan. Groups of materials hold nothing of a plan; `keep` tells whether the scene's objects are the same.
    pub(crate) fn successor(&self, keep: bool) -> BindGroups {
        let materials = if keep { self.materials.clone() } else { HashMap::new() };
        BindGroups { samplers: self.samplers.clone(), materials, created: self.created }
    }

    /// How many bind groups were created.
    pub(crate) fn created(&self) -> u64 {
        self.created
    }

    /// Forgets the groups of materials, whose objects were replaced.
    pub(crate) fn forget_materials(&mut self) {
        self.materials.clear();
    }

    /// Layouts and group 0 of a step. Runs in the caller's error scope.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        plan: &Plan,
        step: &Step,
        layouts: &mut Layouts,
        memories: &mut Memories,
        scene: &SceneData,
    ) -> Result<StepGroups, Diagnostic> {
        let subject = Subject::step(plan, step);
        let of_group = |group: u32| -> Vec<&Binding> { step.bindings.iter().filter(|binding| binding.group == group).collect() };
        let (fixed, material) = (of_group(0), of_group(1));
        if let Some(wrong) = step.bindings.iter().find(|binding| (binding.group == 1) != is_material(binding) || binding.group > 1) {
            return Err(subject.error("execute::group", format!("the variable `{}` is in the wrong group", wrong.variable)));
        }
        let ids = [&fixed, &material].map(|group| (!group.is_empty()).then(|| layouts.group(&gpu.device, group)));
        let (mut group, mut batch, mut accumulated) = (None, None, None);
        if let Some(id) = ids[0] {
            let mut held = Vec::with_capacity(fixed.len());
            for binding in &fixed {
                match &binding.target {
                    BindingTarget::Batch => {
                        let buffer = batch_buffer(gpu, step.batch.len());
                        held.push((binding.binding, Held::whole(&buffer)));
                        batch = Some(buffer);
                        continue;
                    }
                    BindingTarget::Params { bytes, accumulated: Some(offset) } => {
                        let buffer = params_buffer(gpu, bytes);
                        held.push((binding.binding, Held::whole(&buffer)));
                        accumulated = Some((buffer, *offset as u64));
                        continue;
                    }
                    _ => {}
                }
                let object = self.object(gpu, plan, binding, memories, scene).ok_or_else(|| {
                    subject.error("execute::unbound", format!("there is nothing to bind to the variable `{}`", binding.variable))
                })?;
                held.push((binding.binding, object));
            }
            group = Some(self.create(gpu, layouts.get(id), &step.name, &held));
        }
        Ok(StepGroups { layouts: ids, step: group, material: material.into_iter().cloned().collect(), batch, accumulated })
    }

    /// The group of a material for a step; `None` if the step binds nothing of materials. Runs in the caller's error scope.
    pub(crate) fn material(
        &mut self,
        gpu: &Gpu,
        subject: &Subject,
        layouts: &Layouts,
        scene: &SceneData,
        groups: &StepGroups,
        material: &MaterialBinding,
    ) -> Result<Option<wgpu::BindGroup>, Diagnostic> {
        let Some(id) = groups.layouts[1] else { return Ok(None) };
        let missing = |binding: &Binding| {
            subject.error("execute::unbound", format!("the material brings nothing for the variable `{}`", binding.variable))
        };
        let mut key = Vec::with_capacity(groups.material.len());
        for binding in &groups.material {
            let object = match binding.target {
                BindingTarget::MaterialTexture(index) => material.textures.get(index).map(|index| MaterialObject::Texture(*index)),
                BindingTarget::MaterialSampler(index) => material.samplers.get(index).map(|index| MaterialObject::Sampler(*index)),
                _ => None,
            };
            key.push((binding.binding, object.ok_or_else(|| missing(binding))?));
        }
        let key = (id, key);
        if let Some(group) = self.materials.get(&key) {
            return Ok(Some(group.clone()));
        }
        let mut held = Vec::with_capacity(key.1.len());
        for ((slot, object), binding) in key.1.iter().zip(&groups.material) {
            let object = match object {
                MaterialObject::Texture(index) => scene.texture(*index).cloned().map(Held::View),
                MaterialObject::Sampler(index) => scene.sampler(*index).cloned().map(Held::Sampler),
            };
            held.push((*slot, object.ok_or_else(|| missing(binding))?));
        }
        let group = self.create(gpu, layouts.get(id), "material", &held);
        self.materials.insert(key, group.clone());
        Ok(Some(group))
    }

    fn create(&mut self, gpu: &Gpu, layout: &wgpu::BindGroupLayout, label: &str, held: &[(u32, Held)]) -> wgpu::BindGroup {
        let entries: Vec<wgpu::BindGroupEntry<'_>> =
            held.iter().map(|(binding, object)| wgpu::BindGroupEntry { binding: *binding, resource: object.resource() }).collect();
        self.created += 1;
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
    }

    fn object(&mut self, gpu: &Gpu, plan: &Plan, binding: &Binding, memories: &mut Memories, scene: &SceneData) -> Option<Held> {
        match &binding.target {
            BindingTarget::UniformTable(name) | BindingTarget::StorageTable(name) => scene.table(name).map(Held::whole),
            BindingTarget::SceneTexture(name) => scene.named_texture(name).cloned().map(Held::View),
            BindingTarget::View(index) => scene.view(*index).map(Held::whole),
            BindingTarget::TableRow(table, row) => scene.row(table, *row).map(Held::whole),
            BindingTarget::Batch => None,
            BindingTarget::Params { bytes, .. } => Some(Held::whole(&params_buffer(gpu, bytes))),
            BindingTarget::Sampler(sampler) => {
                let made = self.samplers.entry(*sampler).or_insert_with(|| samplers::builtin(&gpu.device, *sampler));
                Some(Held::Sampler(made.clone()))
            }
            BindingTarget::Texture { view, .. } | BindingTarget::StorageTexture { view, .. } => memories.view(plan, view).map(Held::View),
            BindingTarget::Buffer { resource, .. } => memories.buffer(plan, *resource).map(Held::Buffer),
            BindingTarget::MaterialTexture(_) | BindingTarget::MaterialSampler(_) => None,
        }
    }
}

fn is_material(binding: &Binding) -> bool {
    matches!(binding.target, BindingTarget::MaterialTexture(_) | BindingTarget::MaterialSampler(_))
}

fn batch_buffer(gpu: &Gpu, iterations: usize) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("batch"),
        size: 4 * iterations.max(1) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn params_buffer(gpu: &Gpu, bytes: &[u8]) -> wgpu::Buffer {
    let mut padded = bytes.to_vec();
    padded.resize(bytes.len().max(1).next_multiple_of(16), 0);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("params"),
        size: padded.len() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, &padded);
    buffer
}
