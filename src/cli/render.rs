//! `luminaire render`: a scene into an image file, or into one for each frame of a sequence.

use std::path::Path;
use std::time::Instant;

use luminaire_graph::compile::CompileInput;
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::source::SourceMap;
use luminaire_passes::{Adapter, FrameStats};
use luminaire_scenes::world::set_time;
use serde_json::Value;

use super::arguments::RenderArguments;
use super::plan::one_of_everything;
use super::progress::Progress;
use super::report;
use super::sequence::{self, Job};
use super::stats::{self, Executed};
use super::target::{Images, Target};
use crate::files::DiskFiles;
use crate::image_file::{write_file, write_image};
use crate::session::{LoadedScene, Problems, RenderRequest, Session, compile_pipeline, load_scene};

/// Frames after which a pipeline that still changes is rendered no longer.
const SETTLED_AFTER: u32 = 100_000;

pub(super) fn run(arguments: &RenderArguments) -> bool {
    match render(arguments) {
        Ok(()) => true,
        Err((diagnostics, sources)) => report(&diagnostics, &sources),
    }
}

fn render(arguments: &RenderArguments) -> Result<(), Problems> {
    let target = Target::of(arguments).map_err(nowhere)?;
    let progress = Progress::new();
    progress.say("loading the scene");
    let loaded = load_scene(&arguments.scene, arguments.asset_root.as_deref());
    let LoadedScene { mut world, diagnostics, sources } = loaded.inspect_err(|_| report_pipeline(&progress, arguments))?;
    progress.report(&diagnostics, &sources);
    if let Some(seconds) = arguments.time {
        set_time(&mut world, seconds).map_err(|problems| (problems, sources))?;
    }

    progress.say("compiling the pipeline and preparing the GPU");
    let outputs = [target.output];
    let request = RenderRequest {
        pipeline: &arguments.pipeline,
        size: arguments.size,
        camera: arguments.camera.as_deref(),
        sets: &arguments.sets,
        outputs: Some(&outputs),
        timing: arguments.stats.is_some(),
        memory_budget: Some(arguments.memory_budget.saturating_mul(1 << 20)),
    };
    let adapter = Adapter::choose(request.memory_budget).map_err(nowhere)?;
    let stats = match &target.images {
        Images::One { frames } => {
            let mut session = Session::on(&adapter, &mut world, &request)?;
            image(&mut session, *frames, &outputs[0], arguments, &progress)?
        }
        Images::Sequence(sequence) => {
            let request = &request;
            sequence::render(Job { adapter: &adapter, world, request, sequence, output: &outputs[0], arguments, progress: &progress })?
        }
    };
    if let (Some(path), Some(stats)) = (&arguments.stats, stats) {
        write_file(path, format!("{stats:#}\n").as_bytes()).map_err(|problem| nowhere(vec![problem]))?;
    }
    progress.done();
    Ok(())
}

/// Renders and writes one image, and returns its statistics if they are asked for.
fn image(
    session: &mut Session,
    frames: Option<u32>,
    output: &str,
    arguments: &RenderArguments,
    progress: &Progress,
) -> Result<Option<Value>, Problems> {
    if frames.is_none() && session.never_settles() {
        let message = format!("`{}` has a pass that runs in every frame, so that the image never settles", arguments.pipeline);
        return Err(nowhere(vec![Diagnostic::error("render::every-frame", message).hint("say how many: --frames 64")]));
    }
    progress.report(&session.warnings.0, &session.warnings.1);
    progress.say("rendering");
    progress.count(frames.map_or(0, u64::from));
    let started = Instant::now();
    let mut executed = execute(session, frames, |frame| progress.at(frame.into()))?;
    let image = session.read_output(output)?;
    executed.elapsed = started.elapsed();
    progress.say("writing the image");
    write_image(&arguments.file, &image).map_err(|problem| nowhere(vec![problem]))?;
    Ok(arguments.stats.as_ref().map(|_| stats::of_image(session, &arguments.scene, &executed)))
}

/// Runs so many frames, or frames until one has nothing to do. `before` is told how many ran.
pub(super) fn execute(session: &mut Session, frames: Option<u32>, before: impl Fn(u32)) -> Result<Executed, Problems> {
    let started = Instant::now();
    let mut last = FrameStats::default();
    let mut done = 0;
    while done < frames.unwrap_or(SETTLED_AFTER) {
        before(done);
        let frame = session.render_frame()?;
        if frame.settled && frames.is_none() {
            break;
        }
        // What a frame without work cost says nothing of the image.
        if !frame.settled {
            last = frame;
        }
        done += 1;
    }
    Ok(Executed { frames: done, last, elapsed: started.elapsed() })
}

/// Problems that no text shows.
pub(super) fn nowhere(problems: Vec<Diagnostic>) -> Problems {
    (problems, SourceMap::default())
}

/// Where the scene can't be loaded: what is wrong with the pipeline anyway, so that both can be mended at once.
fn report_pipeline(progress: &Progress, arguments: &RenderArguments) {
    let compilation = compile_pipeline(&CompileInput {
        pipeline: &arguments.pipeline,
        files: &DiskFiles::for_pipeline(Path::new(&arguments.pipeline)),
        published: &luminaire_scenes::publish::schema(),
        counts: &one_of_everything(),
        device: &DeviceFacts::webgpu_defaults(),
        // The image's size is left to the adapter's limits, which are not known here.
        output: [1280, 720],
        sets: &arguments.sets,
        outputs: arguments.output.as_ref().map(std::slice::from_ref),
    });
    progress.report(&compilation.diagnostics, &compilation.sources);
}
