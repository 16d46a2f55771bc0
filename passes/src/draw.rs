//! The pass kind Draw: the scene's surfaces, batch by batch.
//!
//! Front faces are counter-clockwise, as in glTF; a mirrored batch turns that, and a double-sided one is never culled. The
//! variants are pipelines of their own, created before the first frame for the classes that the draw list holds.

use std::ops::Range;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::plan::Cull;
use luminaire_graph::plan::{Plan, Step, StepKind};
use luminaire_graph::published::{DrawBatch, MaterialBinding};

use crate::bind_groups::StepGroups;
use crate::errors::Subject;
use crate::pipelines::{RenderKey, VertexStage};
use crate::scene_data::SceneData;
use crate::store::Store;
use crate::targets::Attachments;
use crate::timing::{FrameCounts, Stamps};

/// A Draw that is ready to run.
#[derive(Debug)]
pub(crate) struct DrawStep {
    key: RenderKey,
    cull: Cull,
    list: usize,
    groups: StepGroups,
    attachments: Attachments,
    calls: Vec<Call>,
    has_vertices: bool,
}

/// One draw call.
#[derive(Debug)]
struct Call {
    pipeline: wgpu::RenderPipeline,
    material: Option<wgpu::BindGroup>,
    indices: Range<u32>,
    base_vertex: i32,
    instances: Range<u32>,
}

impl DrawStep {
    /// Runs in the caller's error scope.
    pub(crate) fn prepare(store: &mut Store, plan: &Plan, step: &Step) -> Result<DrawStep, Diagnostic> {
        let subject = Subject::step(plan, step);
        let StepKind::Draw { vertex, fragment, list, cull, attributes, targets, .. } = &step.kind else {
            return Err(subject.error("execute::kind", "it is no Draw"));
        };
        let groups = store.groups(plan, step)?;
        let stage = VertexStage::Own { entry: vertex.clone(), attributes: attributes.clone() };
        let key = RenderKey::new(plan, step, groups.layouts, stage, fragment.as_deref(), targets);
        let attachments = store.attachments(plan, step, targets)?;
        // The usual class is always created, so that a shader that fails does so even where the scene shows nothing.
        store.render_pipeline(plan, step, &variant(&key, *cull, false, false))?;
        let has_vertices = !attributes.is_empty();
        let mut prepared = DrawStep { key, cull: *cull, list: *list, groups, attachments, calls: Vec::new(), has_vertices };
        prepared.refresh(store, plan, step)?;
        Ok(prepared)
    }

    /// Takes the scene's draw list over. Creates something only for classes and materials that the step has not met before.
    /// Runs in the caller's error scope.
    pub(crate) fn refresh(&mut self, store: &mut Store, plan: &Plan, step: &Step) -> Result<(), Diagnostic> {
        let subject = Subject::step(plan, step);
        let scene = store.scene.scene.clone();
        let batches: &[DrawBatch] =
            plan.draw_lists.get(self.list).and_then(|(filter, view)| scene.draw_list(*filter, *view)).map_or(&[], |list| list.as_slice());
        let nothing = MaterialBinding::default();
        let mut calls = Vec::with_capacity(batches.len());
        for batch in batches.iter().filter(|batch| batch.index_count > 0 && batch.instance_count > 0) {
            let key = variant(&self.key, self.cull, batch.mirrored, batch.double_sided);
            let pipeline = store.render_pipeline(plan, step, &key)?;
            let material =
                store.material_group(&subject, &self.groups, scene.materials.bindings.get(batch.material).unwrap_or(&nothing))?;
            // The ends were checked not to overflow when the scene was taken over.
            let indices = batch.first_index..batch.first_index.saturating_add(batch.index_count);
            let instances = batch.first_instance..batch.first_instance.saturating_add(batch.instance_count);
            calls.push(Call { pipeline, material, indices, base_vertex: batch.base_vertex, instances });
        }
        self.calls = calls;
        Ok(())
    }

    /// What changes from run to run.
    pub(crate) fn groups(&self) -> &StepGroups {
        &self.groups
    }

    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneData,
        stamps: Option<Stamps<'_>>,
        counts: &mut FrameCounts,
    ) {
        let mut pass = self.attachments.begin(encoder, stamps);
        let Some((vertices, indices)) = scene.geometry() else { return };
        if self.calls.is_empty() {
            return;
        }
        if self.has_vertices {
            pass.set_vertex_buffer(0, vertices.slice(..));
        }
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        if let Some(group) = &self.groups.step {
            pass.set_bind_group(0, group, &[]);
        }
        let (mut pipeline, mut material) = (None, None);
        for call in &self.calls {
            if pipeline != Some(&call.pipeline) {
                pass.set_pipeline(&call.pipeline);
                pipeline = Some(&call.pipeline);
            }
            if let Some(group) = &call.material
                && material != Some(group)
            {
                pass.set_bind_group(1, group, &[]);
                material = Some(group);
            }
            pass.draw_indexed(call.indices.clone(), call.base_vertex, call.instances.clone());
            counts.draw_calls += 1;
            counts.triangles += (call.indices.len() / 3) as u64 * call.instances.len() as u64;
        }
    }
}

/// The pipeline of a class of batches.
fn variant(key: &RenderKey, cull: Cull, mirrored: bool, double_sided: bool) -> RenderKey {
    let cull = match cull {
        _ if double_sided => None,
        Cull::None => None,
        Cull::Front => Some(wgpu::Face::Front),
        Cull::Back => Some(wgpu::Face::Back),
    };
    let front_face = if mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw };
    key.with_faces(front_face, cull)
}
