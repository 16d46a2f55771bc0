//! `luminaire render`: a scene into an image file.

use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use luminaire_graph::compile::CompileInput;
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::source::SourceMap;
use luminaire_passes::FrameStats;
use serde_json::{Value, json};

use super::arguments::RenderArguments;
use super::plan::one_of_everything;
use super::report;
use crate::files::DiskFiles;
use crate::image_file::{ImageFormat, check_writable, write_file, write_image};
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
    let output = output_name(arguments)?;
    let progress = Progress::new();
    progress.say("loading the scene");
    let loaded = load_scene(&arguments.scene, arguments.asset_root.as_deref());
    let LoadedScene { mut world, diagnostics, sources } = loaded.inspect_err(|_| report_pipeline(&progress, arguments))?;
    progress.report(&diagnostics, &sources);

    progress.say("compiling the pipeline and preparing the GPU");
    let outputs = [output.clone()];
    let request = RenderRequest {
        pipeline: &arguments.pipeline,
        size: arguments.size,
        camera: arguments.camera.as_deref(),
        sets: &arguments.sets,
        outputs: Some(&outputs),
        timing: arguments.stats.is_some(),
        memory_budget: Some(arguments.memory_budget.saturating_mul(1 << 20)),
    };
    let mut session = Session::new(&mut world, &request)?;
    if arguments.frames.is_none() && session.never_settles() {
        let message = format!("`{}` has a pass that runs in every frame, so that the image never settles", arguments.pipeline);
        return Err((vec![Diagnostic::error("render::every-frame", message).hint("say how many: --frames 64")], SourceMap::default()));
    }
    progress.report(&session.warnings.0, &session.warnings.1);

    let started = Instant::now();
    let mut last = FrameStats::default();
    let mut frames = 0;
    while frames < arguments.frames.unwrap_or(SETTLED_AFTER) {
        progress.frame(frames, arguments.frames);
        let frame = session.render_frame()?;
        if frame.settled && arguments.frames.is_none() {
            break;
        }
        // What a frame without work cost says nothing of the image.
        if !frame.settled {
            last = frame;
        }
        frames += 1;
    }
    let image = session.read_output(&output)?;
    let elapsed = started.elapsed();
    progress.say("writing the image");
    let nowhere = |problem: Diagnostic| (vec![problem], SourceMap::default());
    write_image(&arguments.file, &image).map_err(nowhere)?;
    if let Some(path) = &arguments.stats {
        let text = format!("{:#}\n", stats(&session, &last, frames, arguments, elapsed));
        write_file(path, text.as_bytes()).map_err(nowhere)?;
    }
    progress.done();
    Ok(())
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

/// The output to write: asked for, or what the file's format holds. Paths are checked before anything is loaded.
fn output_name(arguments: &RenderArguments) -> Result<String, Problems> {
    let mut problems = Vec::new();
    let format = ImageFormat::of_path(&arguments.file);
    problems.extend(check_writable(&arguments.file).err());
    problems.extend(arguments.stats.as_deref().and_then(|path| check_writable(path).err()));
    if arguments.stats.as_ref() == Some(&arguments.file) {
        let message = format!("`{}` is the image's path and that of the statistics", arguments.file.display());
        problems.push(Diagnostic::error("output::same-path", message).hint("name two files: -o picture.png --stats picture.json"));
    }
    match format {
        Ok(format) if problems.is_empty() => Ok(arguments.output.clone().unwrap_or_else(|| match format {
            ImageFormat::Png => "color".to_owned(),
            ImageFormat::Exr => "radiance".to_owned(),
        })),
        format => {
            problems.extend(format.err());
            Err((problems, SourceMap::default()))
        }
    }
}

fn stats(session: &Session, frame: &FrameStats, frames: u32, arguments: &RenderArguments, elapsed: Duration) -> Value {
    let figures = session.plan.figures;
    let placed = session.plan.placed();
    let passes: Vec<Value> = match &frame.times {
        Some(times) => times.iter().map(|time| json!({ "pass": time.name, "gpu_ms": time.milliseconds })).collect(),
        None => session.plan.steps.iter().map(|step| json!({ "pass": step.name, "gpu_ms": null })).collect(),
    };
    json!({
        "pipeline": session.plan.name,
        "scene": arguments.scene,
        "adapter": session.adapter.name(),
        "size": session.plan.extent,
        "frames": frames,
        "seconds": elapsed.as_secs_f64(),
        "passes": passes,
        "memory_bytes": {
            "without_sharing": figures.without_sharing,
            "reached": figures.reached,
            "bound": figures.bound,
            "declared_bound": session.plan.declared_bound(),
            "placed": placed.bytes,
            "placed_bound": placed.bound,
            "retained": figures.retained,
        },
        "counts": {
            "steps": frame.counts.steps,
            "culled": session.plan.culled.len(),
            "draw_calls": frame.counts.draw_calls,
            "triangles": frame.counts.triangles,
            "dispatches": frame.counts.dispatches,
            "pipelines": frame.pipelines_created,
            "bind_groups": frame.bind_groups_created,
        },
    })
}

/// What is going on, on a terminal; nothing elsewhere.
struct Progress {
    bar: ProgressBar,
}

impl Progress {
    fn new() -> Progress {
        let bar = ProgressBar::new_spinner();
        bar.enable_steady_tick(Duration::from_millis(120));
        Progress { bar }
    }

    fn say(&self, what: &'static str) {
        self.bar.set_message(what);
    }

    fn frame(&self, frame: u32, frames: Option<u32>) {
        if let Some(frames) = frames
            && frame == 0
            && frames > 1
            && let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {pos}/{len} {eta}")
        {
            self.bar.set_style(style);
            self.bar.set_length(u64::from(frames));
        }
        self.bar.set_message("rendering");
        self.bar.set_position(u64::from(frame));
    }

    /// Warnings go above the bar.
    fn report(&self, diagnostics: &[Diagnostic], sources: &SourceMap) {
        self.bar.suspend(|| report(diagnostics, sources));
    }

    fn done(&self) {
        self.bar.finish_and_clear();
    }
}
