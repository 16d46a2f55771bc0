//! Everything that preparation makes and steps share.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::plan::{MemoryId, Plan, Step, Targets};
use luminaire_graph::published::{MaterialBinding, PublishedSchema};

use crate::bind_groups::{BindGroups, StepGroups};
use crate::clear::Fills;
use crate::device::Gpu;
use crate::errors::Subject;
use crate::layouts::Layouts;
use crate::pipelines::{ComputeKey, Pipelines, RenderKey};
use crate::scene_data::SceneData;
use crate::targets::Attachments;
use crate::textures::Memories;

/// What the steps of one plan share on one device.
#[derive(Debug)]
pub(crate) struct Store {
    pub(crate) gpu: Gpu,
    pub(crate) schema: PublishedSchema,
    pub(crate) scene: SceneData,
    pub(crate) memories: Memories,
    pub(crate) layouts: Layouts,
    pub(crate) pipelines: Pipelines,
    pub(crate) bind_groups: BindGroups,
    pub(crate) fills: Fills,
}

impl Store {
    pub(crate) fn new(gpu: Gpu, schema: PublishedSchema, scene: SceneData) -> Store {
        Store {
            gpu,
            schema,
            scene,
            memories: Memories::default(),
            layouts: Layouts::default(),
            pipelines: Pipelines::default(),
            bind_groups: BindGroups::default(),
            fills: Fills::default(),
        }
    }

    /// For a new plan: pipelines, layouts and fills serve on where it uses them, and memories that it takes over.
    pub(crate) fn successor(&self, taken: &[Option<MemoryId>], scene: SceneData, same_scene: bool) -> Store {
        Store {
            gpu: self.gpu.clone(),
            schema: self.schema.clone(),
            scene,
            memories: self.memories.successor(taken),
            layouts: self.layouts.clone(),
            pipelines: self.pipelines.successor(),
            bind_groups: self.bind_groups.successor(same_scene),
            fills: self.fills.successor(),
        }
    }

    /// Everything created so far: memories, views, pipelines, bind groups, and what the scene takes.
    pub(crate) fn created(&self) -> u64 {
        self.memories.created() + self.pipelines.created() + self.bind_groups.created() + self.scene.created()
    }

    /// What a step binds. Runs in the caller's error scope, like all that follow.
    pub(crate) fn groups(&mut self, plan: &Plan, step: &Step) -> Result<StepGroups, Diagnostic> {
        self.bind_groups.prepare(&self.gpu, plan, step, &mut self.layouts, &mut self.memories, &self.scene)
    }

    /// The group 1 of a material.
    pub(crate) fn material_group(
        &mut self,
        subject: &Subject,
        groups: &StepGroups,
        material: &MaterialBinding,
    ) -> Result<Option<wgpu::BindGroup>, Diagnostic> {
        self.bind_groups.material(&self.gpu, subject, &self.layouts, &self.scene, groups, material)
    }

    /// The pipeline of a key.
    pub(crate) fn render_pipeline(&mut self, plan: &Plan, step: &Step, key: &RenderKey) -> Result<wgpu::RenderPipeline, Diagnostic> {
        let subject = Subject::step(plan, step);
        self.pipelines.render(&self.gpu.device, plan, &subject, &self.schema.vertex, &mut self.layouts, key)
    }

    /// The pipeline of a key.
    pub(crate) fn compute_pipeline(&mut self, plan: &Plan, step: &Step, key: &ComputeKey) -> Result<wgpu::ComputePipeline, Diagnostic> {
        self.pipelines.compute(&self.gpu.device, plan, &Subject::step(plan, step), &mut self.layouts, key)
    }

    /// The attachments of a step.
    pub(crate) fn attachments(&mut self, plan: &Plan, step: &Step, targets: &Targets) -> Result<Attachments, Diagnostic> {
        Attachments::prepare(plan, &step.name, &Subject::step(plan, step), targets, &mut self.memories)
    }
}
