//! `luminaire explain`: what each change makes run, and why, without a GPU.

use std::path::Path;

use luminaire_graph::compile::CompileInput;
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::{Diagnostic, did_you_mean};
use luminaire_graph::harness::Harness;
use luminaire_graph::source::SourceMap;

use super::arguments::{ExplainArguments, ExplainFormat};
use super::plan::{counts_of, one_of_everything};
use super::{print, report};
use crate::files::DiskFiles;
use crate::session::compile_pipeline;

/// Frames after which a pipeline that still runs is one that always does.
const SETTLED_AFTER: usize = 100_000;

pub(super) fn run(arguments: &ExplainArguments) -> bool {
    let counts = counts_of(arguments.scene.as_deref());
    let files = DiskFiles::for_pipeline(Path::new(&arguments.pipeline));
    let (schema, device) = (luminaire_scenes::publish::schema(), DeviceFacts::webgpu_defaults());
    let any = one_of_everything();
    let compilation = compile_pipeline(&CompileInput {
        pipeline: &arguments.pipeline,
        files: &files,
        published: &schema,
        counts: counts.as_ref().unwrap_or(&any),
        device: &device,
        output: arguments.size,
        sets: &arguments.sets,
        outputs: (!arguments.output.is_empty()).then_some(&arguments.output),
    });
    let fine = report(&compilation.diagnostics, &compilation.sources) && counts.is_some();
    let Some(plan) = compilation.plan else { return false };
    if let Some(name) = &arguments.pass {
        let known = || plan.steps.iter().map(|step| &*step.name).chain(plan.culled.iter().map(|culled| &*culled.name));
        if !known().any(|other| other == name) {
            let problem = Diagnostic::error("explain::unknown-pass", format!("`{}` has no pass `{name}`", arguments.pipeline))
                .maybe_hint(did_you_mean(name, known()));
            return report(&[problem], &SourceMap::default());
        }
    }
    let mut harness = Harness::of(plan);
    harness.settle(SETTLED_AFTER);
    let known = harness.inputs();
    let mut text = String::new();
    if arguments.change.is_empty() {
        if arguments.pass.is_none() && arguments.format == ExplainFormat::Text {
            text += "what runs when an input changes\n";
            for (input, passes) in harness.reach() {
                let passes = if passes.is_empty() { "nothing".to_owned() } else { passes.join(", ") };
                text += &format!("  {input}: {passes}\n");
            }
            text += "\nafter that, with no change\n\n";
        }
        harness.frame();
    } else {
        for name in &arguments.change {
            if harness.change_named(name) == 0 {
                let hint = did_you_mean(name, known.iter().map(String::as_str));
                let hint = hint.unwrap_or_else(|| format!("inputs: {}", known.join(", ")));
                let message = format!("`{}` has no input `{name}`", arguments.pipeline);
                return report(&[Diagnostic::error("explain::unknown-input", message).hint(hint)], &SourceMap::default());
            }
        }
        harness.frame();
    }
    text += &match arguments.format {
        ExplainFormat::Text => harness.explain(arguments.pass.as_deref()),
        ExplainFormat::Json => format!("{:#}\n", harness.explain_json()),
    };
    print(&text) && fine
}
