//! `luminaire plan`: what a pipeline compiles to, without a GPU.

use std::path::Path;

use luminaire_graph::compile::{Compilation, CompileInput};
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::dump;
use luminaire_graph::published::SceneCounts;
use luminaire_graph::source::SourceMap;

use super::arguments::{PlanArguments, PlanFormat};
use super::{print, report};
use crate::files::DiskFiles;
use crate::session::{LoadedScene, compile_pipeline, load_scene};

pub(super) fn run(arguments: &PlanArguments) -> bool {
    let Some(counts) = counts_of(arguments.scene.as_deref()) else {
        // What is wrong with the pipeline is said at once, too.
        let compilation = compile_for(arguments, &one_of_everything());
        report(&compilation.diagnostics, &compilation.sources);
        return false;
    };
    let compilation = compile_for(arguments, &counts);
    let fine = report(&compilation.diagnostics, &compilation.sources);
    match compilation.plan {
        None => false,
        Some(plan) => {
            let sources: &SourceMap = &compilation.sources;
            let text = match arguments.format {
                PlanFormat::Text => dump::text(&plan, sources),
                PlanFormat::Json => format!("{:#}\n", dump::json(&plan, sources)),
                PlanFormat::Dot => dump::dot(&plan),
                PlanFormat::Html => dump::html(&plan, sources),
            };
            print(&text) && fine
        }
    }
}

fn compile_for(arguments: &PlanArguments, counts: &SceneCounts) -> Compilation {
    compile_pipeline(&CompileInput {
        pipeline: &arguments.pipeline,
        files: &DiskFiles::for_pipeline(Path::new(&arguments.pipeline)),
        published: &luminaire_scenes::publish::schema(),
        counts,
        device: &DeviceFacts::webgpu_defaults(),
        output: arguments.size,
        sets: &arguments.sets,
        outputs: (!arguments.output.is_empty()).then_some(&arguments.output),
    })
}

/// What a scene has; without one, one of everything. `None` after reporting what is wrong with it.
pub(super) fn counts_of(scene: Option<&str>) -> Option<SceneCounts> {
    match scene.map(|path| load_scene(path, None)) {
        None => Some(one_of_everything()),
        Some(Ok(LoadedScene { world, diagnostics, sources })) => {
            report(&diagnostics, &sources);
            Some(luminaire_scenes::publish::counts(&world))
        }
        Some(Err((diagnostics, sources))) => {
            report(&diagnostics, &sources);
            None
        }
    }
}

/// Counts under which every `has` stands, for plans without a scene.
pub(super) fn one_of_everything() -> SceneCounts {
    luminaire_scenes::publish::schema().counts.into_iter().map(|name| (name, 1)).collect()
}
