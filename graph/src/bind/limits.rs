//! How much a shader stage may bind.

use super::error::BindError;
use crate::device::DeviceFacts;
use crate::expand::types::Pass;
use crate::plan::{Binding, BindingTarget, Stages};

type InStage = fn(&Stages) -> bool;
type IsKind = fn(&BindingTarget) -> bool;

/// Checks the bindings of a pass against what each stage may have.
pub(super) fn check(pass: &Pass, bindings: &[Binding], device: &DeviceFacts, problems: &mut Vec<BindError>) {
    let stages: [(&str, InStage); 3] =
        [("vertex", |stages| stages.vertex), ("fragment", |stages| stages.fragment), ("compute", |stages| stages.compute)];
    let kinds: [(&str, u32, IsKind); 5] = [
        ("sampled textures", device.max_sampled_textures, |target| {
            matches!(target, BindingTarget::Texture { .. } | BindingTarget::MaterialTexture(_))
        }),
        ("samplers", device.max_samplers, |target| matches!(target, BindingTarget::Sampler(_) | BindingTarget::MaterialSampler(_))),
        ("storage textures", device.max_storage_textures, |target| matches!(target, BindingTarget::StorageTexture { .. })),
        ("storage buffers", device.max_storage_buffers, |target| {
            matches!(target, BindingTarget::StorageTable(_) | BindingTarget::Batch | BindingTarget::Buffer { uniform: false, .. })
        }),
        ("uniform buffers", device.max_uniform_buffers, |target| {
            matches!(
                target,
                BindingTarget::UniformTable(_)
                    | BindingTarget::View(_)
                    | BindingTarget::TableRow(..)
                    | BindingTarget::Params { .. }
                    | BindingTarget::Buffer { uniform: true, .. }
            )
        }),
    ];
    for (stage, in_stage) in stages {
        for (what, limit, is_kind) in kinds {
            let count = bindings.iter().filter(|binding| in_stage(&binding.stages) && is_kind(&binding.target)).count();
            if count > limit as usize {
                let reason = format!("its {stage} stage uses {count} {what}, and the limit is {limit} ({})", device.name);
                problems.push(BindError::OverLimit { pass: pass.name.clone(), reason, span: pass.span });
            }
        }
    }
}
