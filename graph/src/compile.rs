//! The one function that lists the steps from text to plan.
//!
//! Each step has its own output type; a step whose input has errors does not run, so that later messages never follow from
//! earlier mistakes. Everything that one step finds is reported at once.

use crate::allocate::allocate;
use crate::assemble::assemble;
use crate::bind::{BindInput, bind};
use crate::device::DeviceFacts;
use crate::diagnostic::Diagnostic;
use crate::dirty::retention;
use crate::expand::{ExpandInput, expand};
use crate::lifetime::lifetimes;
use crate::load::load;
use crate::plan::Plan;
use crate::published::{PublishedSchema, SceneCounts};
use crate::schedule::schedule;
use crate::source::{Files, SourceMap};
use crate::validate::validate;

/// Everything that a plan depends on.
pub struct CompileInput<'a> {
    /// The pipeline's path.
    pub pipeline: &'a str,
    /// Where pipelines and shaders come from.
    pub files: &'a dyn Files,
    /// What the scene publishes.
    pub published: &'a PublishedSchema,
    /// How many of each thing the scene has.
    pub counts: &'a SceneCounts,
    /// Limits and features of the adapter.
    pub device: &'a DeviceFacts,
    /// Width and height of the rendered image.
    pub output: [u32; 2],
    /// Parameters that are set, as texts.
    pub sets: &'a [(String, String)],
    /// The outputs asked for; `None` asks for all.
    pub outputs: Option<&'a [String]>,
}

/// A plan, if there were no errors, and every problem with the texts that it points into.
#[derive(Debug, Clone)]
pub struct Compilation {
    /// What runs.
    pub plan: Option<Plan>,
    /// Errors and warnings, in the order of the steps.
    pub diagnostics: Vec<Diagnostic>,
    /// Every text that was read.
    pub sources: SourceMap,
}

/// Compiles a pipeline.
pub fn compile(input: &CompileInput<'_>) -> Compilation {
    let mut sources = SourceMap::default();
    let mut diagnostics = Vec::new();
    let plan = match steps(input, &mut sources, &mut diagnostics) {
        Ok(plan) => Some(plan),
        Err(problems) => {
            diagnostics.extend(problems);
            None
        }
    };
    Compilation { plan, diagnostics, sources }
}

/// load (with syntax) -> validate -> expand -> (reflect and) bind -> retention -> schedule -> lifetime -> allocate -> plan
fn steps(input: &CompileInput<'_>, sources: &mut SourceMap, warnings: &mut Vec<Diagnostic>) -> Result<Plan, Vec<Diagnostic>> {
    let loaded = load(input.files, input.pipeline, sources)?;
    let validated = validate(&loaded, input.published)?;
    let expand_input =
        ExpandInput { output: input.output, counts: input.counts, sets: input.sets, outputs: input.outputs, device: input.device };
    let expanded = expand(&validated, &expand_input)?;
    let bind_input = BindInput { files: input.files, published: input.published, device: input.device, output: input.output };
    let bound = bind(expanded, &bind_input, sources)?;
    let retention = retention(&bound);
    let schedule = schedule(&bound, &retention.retained)?;
    warnings.extend(schedule.warnings(&bound));
    let lifetimes = lifetimes(&bound, &schedule, retention.retained);
    let allocation = allocate(&bound, &schedule, &lifetimes, input.device)?;
    Ok(assemble(bound, schedule, lifetimes, allocation, retention.for_inputs, input.pipeline, input.output))
}
