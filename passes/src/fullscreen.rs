//! The pass kind Fullscreen: a fragment shader once per texel.
//!
//! The vertex stage is ours: one triangle that covers the target, with `@location(0) uv`, whose (0, 0) is the top left corner.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::plan::{Plan, Step, Targets};

use crate::bind_groups::StepGroups;
use crate::pipelines::{RenderKey, VertexStage};
use crate::store::Store;
use crate::targets::Attachments;
use crate::timing::{FrameCounts, Stamps};

/// The entry point of [`vertex_module`].
pub(crate) const VERTEX_ENTRY: &str = "fullscreen_vertex";

/// Corners (-1, 1), (3, 1), (-1, -3) in clip space: the square in the triangle's right angle is the target. Counter-clockwise
/// corners would be as good, since nothing is culled.
const VERTEX_SHADER: &str = "
struct Fullscreen {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn fullscreen_vertex(@builtin(vertex_index) index: u32) -> Fullscreen {
    let uv = vec2<f32>(f32((index & 1u) * 2u), f32((index >> 1u) * 2u));
    return Fullscreen(vec4<f32>(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0, 1.0), uv);
}
";

/// Compiles the vertex stage.
pub(crate) fn vertex_module(device: &wgpu::Device) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("fullscreen"),
        source: wgpu::ShaderSource::Wgsl(VERTEX_SHADER.into()),
    })
}

/// A Fullscreen that is ready to run.
#[derive(Debug)]
pub(crate) struct FullscreenStep {
    pipeline: wgpu::RenderPipeline,
    groups: StepGroups,
    attachments: Attachments,
}

impl FullscreenStep {
    /// Runs in the caller's error scope.
    pub(crate) fn prepare(
        store: &mut Store,
        plan: &Plan,
        step: &Step,
        fragment: &str,
        targets: &Targets,
    ) -> Result<FullscreenStep, Diagnostic> {
        let groups = store.groups(plan, step)?;
        let key = RenderKey::new(plan, step, groups.layouts, VertexStage::Fullscreen, Some(fragment), targets);
        let pipeline = store.render_pipeline(plan, step, &key)?;
        let attachments = store.attachments(plan, step, targets)?;
        Ok(FullscreenStep { pipeline, groups, attachments })
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
        pass.draw(0..3, 0..1);
        counts.draw_calls += 1;
        counts.triangles += 1;
    }
}
