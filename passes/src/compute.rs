//! The pass kind Compute.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::plan::{Plan, Step};

use crate::bind_groups::StepGroups;
use crate::pipelines::ComputeKey;
use crate::store::Store;
use crate::timing::{FrameCounts, Stamps};

/// A Compute that is ready to run.
#[derive(Debug)]
pub(crate) struct ComputeStep {
    name: String,
    pipeline: wgpu::ComputePipeline,
    groups: StepGroups,
    workgroups: [u32; 3],
}

impl ComputeStep {
    /// Runs in the caller's error scope.
    pub(crate) fn prepare(
        store: &mut Store,
        plan: &Plan,
        step: &Step,
        entry: &str,
        workgroups: [u32; 3],
    ) -> Result<ComputeStep, Diagnostic> {
        let groups = store.groups(plan, step)?;
        let key = ComputeKey::new(plan, step, groups.layouts, entry);
        let pipeline = store.compute_pipeline(plan, step, &key)?;
        Ok(ComputeStep { name: step.name.clone(), pipeline, groups, workgroups })
    }

    pub(crate) fn encode(&self, encoder: &mut wgpu::CommandEncoder, stamps: Option<Stamps<'_>>, counts: &mut FrameCounts) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(&self.name),
            timestamp_writes: stamps.map(|stamps| wgpu::ComputePassTimestampWrites {
                query_set: stamps.set,
                beginning_of_pass_write_index: Some(stamps.first),
                end_of_pass_write_index: Some(stamps.first + 1),
            }),
        });
        pass.set_pipeline(&self.pipeline);
        if let Some(group) = &self.groups.step {
            pass.set_bind_group(0, group, &[]);
        }
        let [x, y, z] = self.workgroups;
        pass.dispatch_workgroups(x, y, z);
        counts.dispatches += 1;
    }
}
