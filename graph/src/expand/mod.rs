//! Validated document to a flat list: parameters have values, sizes are numbers, loops are unrolled, conditions are decided.
//!
//! Guarantees: every extent is within the device's limits, every part exists, names of passes are unique and stable, and every
//! pass and reference keeps the place where the author wrote it.

mod environment;
mod error;
mod extents;
mod histories;
mod images;
mod loops;
mod modifiers;
mod params;
mod passes;
mod resources;
mod rules;
pub mod types;
mod views;
mod writers;

pub use error::{BLOCK_ALONE, ExpandError};
pub use passes::MAX_PASSES;

use crate::device::DeviceFacts;
use crate::diagnostic::{Diagnostic, has_errors};
use crate::published::SceneCounts;
use crate::validate::types::Validated;
use environment::Environment;
use passes::Unrolled;
use types::Expanded;

/// What the values of expressions depend on.
#[derive(Debug, Clone, Copy)]
pub struct ExpandInput<'a> {
    /// Width and height of the rendered image.
    pub output: [u32; 2],
    /// How many of each thing the scene has.
    pub counts: &'a SceneCounts,
    /// Parameters that are set, as texts.
    pub sets: &'a [(String, String)],
    /// The outputs asked for; `None` asks for all.
    pub outputs: Option<&'a [String]>,
    /// Limits.
    pub device: &'a DeviceFacts,
}

/// Expands a validated document.
pub fn expand(validated: &Validated, input: &ExpandInput<'_>) -> Result<Expanded, Vec<Diagnostic>> {
    if !validated.inputs.is_empty() {
        return Err(vec![ExpandError::BlockAlone { inputs: validated.inputs.clone() }.into()]);
    }
    let mut environment = Environment::new(validated, input);
    params::values(&mut environment, &validated.params, input.sets);
    environment.decide(&validated.blocks);
    // Sizes name parameters, and parts can only be checked against resources that are all there.
    let Some(mut resources) = resources::resources(&mut environment, validated, input.device) else {
        return Err(environment.problems);
    };
    histories::resources(&validated.histories, &validated.resources, &mut resources);
    let asked = |name: &str| input.outputs.is_none_or(|asked| asked.iter().any(|other| other == name));
    let Unrolled { mut passes, spreads, mut outputs } = passes::passes(&mut environment, validated, &resources, asked);
    images::check(&mut environment, &validated.images, &resources, &passes);
    images::passes(&validated.images, &resources[..validated.resources.len()], &mut passes);
    histories::passes(&validated.histories, &resources, &mut passes);
    for asked in input.outputs.into_iter().flatten() {
        if !validated.outputs.iter().any(|(name, _)| name.value == *asked) {
            let known = validated.outputs.iter().map(|(name, _)| name.value.clone()).collect();
            environment.report(ExpandError::UnknownOutput { name: asked.clone(), known });
        }
    }
    let retained_budget = validated.retained_budget.as_ref().and_then(|budget| environment.mebibytes(budget));
    if !has_errors(&environment.problems) {
        modifiers::order(&mut environment, &resources, &mut passes, &mut outputs);
        rules::check(&mut environment, validated, &resources, &passes);
    }
    let Environment { params, problems, .. } = environment;
    if has_errors(&problems) {
        Err(problems)
    } else {
        let offered = validated.outputs.iter().flat_map(|(_, part)| part.resources()).collect();
        Ok(Expanded { doc: validated.doc.clone(), params, resources, passes, spreads, retained_budget, outputs, offered })
    }
}
