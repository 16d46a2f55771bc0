//! The pass kind Procedural: triangles that a vertex shader makes from the vertex's and the instance's index.
//!
//! Front faces are counter-clockwise. An instance that is not to be seen gives its vertices all one place.

use std::ops::Range;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::plan::{Cull, Plan, Step, StepKind};

use crate::bind_groups::StepGroups;
use crate::errors::Subject;
use crate::pipelines::{RenderKey, VertexStage};
use crate::store::Store;
use crate::targets::Attachments;
use crate::timing::{FrameCounts, Stamps};

/// A Procedural that is ready to run.
#[derive(Debug)]
pub(crate) struct ProceduralStep {
    pipeline: wgpu::RenderPipeline,
    groups: StepGroups,
    attachments: Attachments,
    vertices: Range<u32>,
    instances: Range<u32>,
}

impl ProceduralStep {
    /// Runs in the caller's error scope.
    pub(crate) fn prepare(store: &mut Store, plan: &Plan, step: &Step) -> Result<ProceduralStep, Diagnostic> {
        let StepKind::Procedural { vertex, fragment, vertices, instances, cull, targets } = &step.kind else {
            return Err(Subject::step(plan, step).error("execute::kind", "it is no Procedural"));
        };
        let groups = store.groups(plan, step)?;
        let stage = VertexStage::Own { entry: vertex.clone(), attributes: Vec::new() };
        let cull = match cull {
            Cull::None => None,
            Cull::Front => Some(wgpu::Face::Front),
            Cull::Back => Some(wgpu::Face::Back),
        };
        let key = RenderKey::new(plan, step, groups.layouts, stage, fragment.as_deref(), targets);
        let pipeline = store.render_pipeline(plan, step, &key.with_faces(wgpu::FrontFace::Ccw, cull))?;
        let attachments = store.attachments(plan, step, targets)?;
        Ok(ProceduralStep { pipeline, groups, attachments, vertices: 0..*vertices, instances: 0..*instances })
    }

    /// What changes from run to run.
    pub(crate) fn groups(&self) -> &StepGroups {
        &self.groups
    }

    pub(crate) fn encode(&self, encoder: &mut wgpu::CommandEncoder, stamps: Option<Stamps<'_>>, counts: &mut FrameCounts) {
        let mut pass = self.attachments.begin(encoder, stamps);
        pass.set_pipeline(&self.pipeline);
        if let Some(group) = &self.groups.step {
            pass.set_bind_group(0, group, &[]);
        }
        pass.draw(self.vertices.clone(), self.instances.clone());
        counts.draw_calls += 1;
        counts.triangles += (self.vertices.len() / 3) as u64 * self.instances.len() as u64;
    }
}
