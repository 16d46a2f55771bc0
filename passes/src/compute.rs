//! The pass kind Compute.

use std::sync::Arc;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::plan::{Plan, Step, Workgroups};

use crate::bind_groups::StepGroups;
use crate::errors::Subject;
use crate::pipelines::ComputeKey;
use crate::store::Store;
use crate::timing::{FrameCounts, Stamps};

/// A Compute that is ready to run.
#[derive(Debug)]
pub(crate) struct ComputeStep {
    name: Arc<str>,
    pipeline: wgpu::ComputePipeline,
    groups: StepGroups,
    workgroups: Dispatch,
}

/// How many workgroups run.
#[derive(Debug)]
enum Dispatch {
    /// Of a batched step for one iteration.
    Fixed([u32; 3]),
    Indirect(wgpu::Buffer, u64),
}

impl ComputeStep {
    /// Runs in the caller's error scope.
    pub(crate) fn prepare(
        store: &mut Store,
        plan: &Plan,
        step: &Step,
        entry: &str,
        workgroups: Workgroups,
    ) -> Result<ComputeStep, Diagnostic> {
        let groups = store.groups(plan, step)?;
        let key = ComputeKey::new(plan, step, groups.layouts, entry);
        let pipeline = store.compute_pipeline(plan, step, &key)?;
        let workgroups = match workgroups {
            Workgroups::Fixed(groups) => Dispatch::Fixed(groups),
            Workgroups::Indirect { buffer, offset } => match store.memories.buffer(plan, buffer) {
                Some(range) => Dispatch::Indirect(range.buffer, range.offset + offset),
                None => return Err(Subject::step(plan, step).error("execute::unbound", "nothing says how many workgroups run")),
            },
        };
        Ok(ComputeStep { name: step.name.clone(), pipeline, groups, workgroups })
    }

    /// What changes from run to run.
    pub(crate) fn groups(&self) -> &StepGroups {
        &self.groups
    }

    pub(crate) fn encode(&self, encoder: &mut wgpu::CommandEncoder, iterations: u32, stamps: Option<Stamps<'_>>, counts: &mut FrameCounts) {
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
        match &self.workgroups {
            Dispatch::Fixed([x, y, z]) => pass.dispatch_workgroups(*x, *y, z.saturating_mul(iterations)),
            Dispatch::Indirect(buffer, offset) => pass.dispatch_workgroups_indirect(buffer, *offset),
        }
        counts.dispatches += 1;
    }
}
