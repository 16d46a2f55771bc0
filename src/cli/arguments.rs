//! The command line's arguments and help.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use super::frames::{FrameSelection, parse_frames};

/// Real-time global illumination from render graphs written in RON.
#[derive(Debug, Parser)]
#[command(
    name = "luminaire",
    version,
    max_term_width = 100,
    after_help = "\
Examples:
  luminaire render pipelines/pbr.ron --scene scenes/cornell.ron -o cornell.png
  luminaire render pipelines/pbr.ron --scene model.glb -o model.exr --size 1920x1080 --set exposure=1
  luminaire render pipelines/pbr.ron --scene scenes/day_night.ron --frames 0..720 -o frames/%04d.png
  luminaire check pipelines/*.ron
  luminaire plan pipelines/pbr.ron --format html > plan.html
  luminaire explain pipelines/pbr.ron --change camera

Pipelines, shaders and scenes that come with the program can be named by the same paths from anywhere; a file on disk wins.
Exit status: 0 done, 1 something was wrong with the input or the machine (said on standard error), 2 wrong usage."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene into an image or a sequence of images, without a window
    Render(RenderArguments),
    /// Report every problem of pipelines, shaders and scenes, with its place
    Check(CheckArguments),
    /// Show what a pipeline compiles to: passes in order, resources, memory
    Plan(PlanArguments),
    /// Show what each change makes run and why, what shares memory and why
    Explain(ExplainArguments),
    /// Show what a scene holds: nodes, meshes, materials, lights, cameras, timeline, bounds, memory
    Scene(SceneArguments),
    /// Put images side by side into one, to see a sequence at a glance
    Sheet(SheetArguments),
    /// Show the adapter, its limits, and what comes with the program
    Info,
}

#[derive(Debug, Args)]
pub(crate) struct RenderArguments {
    /// The pipeline: a .ron file
    pub pipeline: String,
    /// The scene: a .gltf, .glb or scene .ron file
    #[arg(long)]
    pub scene: String,
    /// The folder that the scene's files may come from; the scene file's own if not given
    #[arg(long, value_name = "DIR")]
    pub asset_root: Option<PathBuf>,
    /// The image to write: .png holds the output `color`, .exr the output `radiance`. For a range of frames its name has a field for
    /// the frame's number: %d, or %04d for at least four digits; %% is a percent sign. A folder that is missing is made then
    #[arg(short = 'o', value_name = "FILE")]
    pub file: PathBuf,
    /// Width and height in pixels
    #[arg(long, default_value = "1280x720", value_name = "WxH", value_parser = parse_size)]
    pub size: [u32; 2],
    /// The camera to look through, by name; the file's first, or one that frames the scene, if not given
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Set a parameter of the pipeline; may be given several times
    #[arg(long = "set", value_name = "P=V", value_parser = parse_set)]
    pub sets: Vec<(String, String)>,
    /// The pipeline's output to write, instead of `color` or `radiance`
    #[arg(long, value_name = "NAME")]
    pub output: Option<String>,
    /// How many frames to render before the image is taken; until nothing changes any more, if not given. Or which frames become
    /// images: 0..120 are the frames 0 to 119, 0..=120 ends with frame 120
    #[arg(
        long,
        value_name = "N|A..B",
        value_parser = parse_frames,
        allow_hyphen_values = true,
        long_help = "\
How many frames to render before the image is taken; until nothing changes any more, if not given.

Or which frames become images: 0..120 are the frames 0 to 119, 0..=120 ends with frame 120. Frame n shows the scene n / fps seconds \
after it began. Frames whose file exists are left out, so that a sequence which was interrupted can be completed by the same command.

Where no frame depends on those before it, each is rendered until nothing changes any more, and has the same bytes as the image of its \
time alone. Where one does (the pipeline remembers, gathers or spreads work over frames, or has a pass that runs in every frame), each \
frame of the range is rendered once, and to complete a sequence renders it again from its first frame, without writing what exists"
    )]
    pub frames: Option<FrameSelection>,
    /// Frames a second of a sequence; 30 if not given
    #[arg(long, value_name = "N", value_parser = parse_fps, allow_negative_numbers = true)]
    pub fps: Option<f64>,
    /// Render all frames of a sequence, also those whose file exists
    #[arg(long)]
    pub overwrite: bool,
    /// How many frames to render before the first of a sequence, at its time, where frames depend on those before them
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub warm_up: Option<u32>,
    /// The scene's time in one image, seconds since it began; the scene as it was loaded, if not given
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub time: Option<f64>,
    /// Write times per pass, memory figures and counts as JSON; of a sequence with an array `frames`, which has an object for each frame
    /// that was rendered
    #[arg(long, value_name = "FILE.json")]
    pub stats: Option<PathBuf>,
    /// Refuse plans that allocate more than this
    #[arg(long, value_name = "MIB", default_value_t = 4096)]
    pub memory_budget: u64,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    /// Pipelines and scenes (.ron), shaders (.wgsl), models (.gltf, .glb)
    #[arg(required = true)]
    pub paths: Vec<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct PlanArguments {
    /// The pipeline: a .ron file
    pub pipeline: String,
    /// How to show the plan
    #[arg(long, value_enum, default_value_t = PlanFormat::Text)]
    pub format: PlanFormat,
    /// Width and height in pixels
    #[arg(long, default_value = "1280x720", value_name = "WxH", value_parser = parse_size)]
    pub size: [u32; 2],
    /// The scene whose lights and materials decide what stands; one of everything if not given
    #[arg(long)]
    pub scene: Option<String>,
    /// Set a parameter of the pipeline; may be given several times
    #[arg(long = "set", value_name = "P=V", value_parser = parse_set)]
    pub sets: Vec<(String, String)>,
    /// Plan for these outputs alone; all if not given
    #[arg(long, value_name = "NAME")]
    pub output: Vec<String>,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArguments {
    /// The pipeline: a .ron file
    pub pipeline: String,
    /// The pass of interest; all if not given
    pub pass: Option<String>,
    /// Explain the frame after this input changed; may be given several times
    #[arg(long, value_name = "INPUT")]
    pub change: Vec<String>,
    /// How to show it
    #[arg(long, value_enum, default_value_t = ExplainFormat::Text)]
    pub format: ExplainFormat,
    /// Width and height in pixels
    #[arg(long, default_value = "1280x720", value_name = "WxH", value_parser = parse_size)]
    pub size: [u32; 2],
    /// The scene whose lights and materials decide what stands; one of everything if not given
    #[arg(long)]
    pub scene: Option<String>,
    /// Set a parameter of the pipeline; may be given several times
    #[arg(long = "set", value_name = "P=V", value_parser = parse_set)]
    pub sets: Vec<(String, String)>,
    /// Plan for these outputs alone; all if not given
    #[arg(long, value_name = "NAME")]
    pub output: Vec<String>,
}

#[derive(Debug, Args)]
pub(crate) struct SceneArguments {
    /// The scene: a .gltf, .glb or scene .ron file
    pub scene: String,
    /// How to show it
    #[arg(long, value_enum, default_value_t = SceneFormat::Text)]
    pub format: SceneFormat,
    /// The folder that the scene's files may come from; the scene file's own if not given
    #[arg(long, value_name = "DIR")]
    pub asset_root: Option<PathBuf>,
    /// Show the scene at this time, in seconds; as it was loaded, if not given
    #[arg(long, value_name = "SECONDS")]
    pub time: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct SheetArguments {
    /// The images, row by row: .png files of one size
    #[arg(required = true, value_name = "IMAGE")]
    pub images: Vec<PathBuf>,
    /// The sheet to write, a .png
    #[arg(short = 'o', value_name = "FILE")]
    pub file: PathBuf,
    /// Images in a row; about as many as there are rows, if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub columns: Option<u32>,
    /// Make the images smaller by this factor: each pixel is the mean of N by N
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub shrink: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SceneFormat {
    /// For people
    Text,
    /// For programs
    Json,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExplainFormat {
    /// For people
    Text,
    /// For programs
    Json,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PlanFormat {
    /// For people
    Text,
    /// For programs
    Json,
    /// Graphviz
    Dot,
    /// A page for a browser, with a chart of passes, resources and memory
    Html,
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let (width, height) = text.split_once(['x', 'X']).ok_or("expected WIDTHxHEIGHT, such as 1280x720")?;
    let axis = |text: &str| text.parse::<u32>().map_err(|_| format!("`{text}` is not a whole number of pixels"));
    Ok([axis(width)?, axis(height)?])
}

fn parse_fps(text: &str) -> Result<f64, String> {
    let fps = text.parse::<f64>().ok().filter(|fps| fps.is_finite() && *fps > 0.0);
    fps.ok_or_else(|| "expected a number greater than zero, such as 30 or 23.976".to_owned())
}

fn parse_set(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("expected PARAMETER=VALUE")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}
