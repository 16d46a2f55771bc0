//! What `render` writes and where: one image, or the images of a sequence. Checked before anything is loaded.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use luminaire_graph::diagnostic::Diagnostic;

use super::arguments::RenderArguments;
use super::frames::FrameSelection;
use super::pattern::{FramePattern, has_field};
use crate::image_file::{ImageFormat, check_creatable, check_writable};

/// Frames a second, unless said otherwise.
const FRAMES_PER_SECOND: f64 = 30.0;

/// What is written.
pub(super) struct Target {
    /// The pipeline's output: asked for, or what the file's format holds.
    pub(super) output: String,
    /// Where.
    pub(super) images: Images,
}

/// Where images go.
pub(super) enum Images {
    /// One image, after so many frames or when it has settled.
    One {
        /// How many frames.
        frames: Option<u32>,
    },
    /// One for each frame.
    Sequence(Sequence),
}

/// A range of frames, each of which becomes an image.
pub(super) struct Sequence {
    /// The images' paths.
    pub(super) pattern: FramePattern,
    /// Never empty.
    pub(super) frames: RangeInclusive<u32>,
    /// Frames a second, finite and greater than zero.
    pub(super) fps: f64,
    /// Frames whose image is to be written, rising.
    pub(super) due: Vec<u32>,
    /// Frames that run before the first.
    pub(super) warm_up: u32,
}

impl Sequence {
    /// The scene's time in a frame, seconds.
    pub(super) fn time(&self, frame: u32) -> f64 {
        f64::from(frame) / self.fps
    }
}

impl Target {
    /// Checks the paths and what belongs together. Errors: everything that is wrong, `output::...` and `render::...`.
    pub(super) fn of(arguments: &RenderArguments) -> Result<Target, Vec<Diagnostic>> {
        let mut problems = Vec::new();
        let format = ImageFormat::of_path(&arguments.file).map_err(|problem| problems.push(problem));
        let images = match &arguments.frames {
            Some(FrameSelection::Range(frames)) => sequence(arguments, frames, &mut problems).map(Images::Sequence),
            Some(FrameSelection::Count(count)) => Some(one(arguments, Some(*count), &mut problems)),
            None => Some(one(arguments, None, &mut problems)),
        };
        if let Some(stats) = &arguments.stats {
            problems.extend(check_writable(stats).err());
            let is_image = match &images {
                Some(Images::Sequence(sequence)) => sequence.frames.clone().any(|frame| sequence.pattern.path(frame) == *stats),
                _ => *stats == arguments.file,
            };
            if is_image {
                let message = format!("`{}` is the image's path and that of the statistics", stats.display());
                problems.push(Diagnostic::error("output::same-path", message).hint("name two files: -o picture.png --stats picture.json"));
            }
        }
        match (format, images) {
            (Ok(format), Some(images)) if problems.is_empty() => {
                let usual = match format {
                    ImageFormat::Png => "color",
                    ImageFormat::Exr => "radiance",
                };
                Ok(Target { output: arguments.output.clone().unwrap_or_else(|| usual.to_owned()), images })
            }
            _ => Err(problems),
        }
    }
}

fn one(arguments: &RenderArguments, frames: Option<u32>, problems: &mut Vec<Diagnostic>) -> Images {
    let range = "say which frames: --frames 0..120";
    let of_sequences =
        [("--fps", arguments.fps.is_some()), ("--overwrite", arguments.overwrite), ("--warm-up", arguments.warm_up.is_some())];
    for (flag, _) in of_sequences.iter().filter(|(_, given)| *given) {
        let message = format!("`{flag}` belongs to a sequence, and this is one image");
        problems.push(Diagnostic::error("render::no-sequence", message).hint(range));
    }
    if arguments.file.file_name().is_some_and(|name| has_field(&name.to_string_lossy())) {
        let message = format!("`{}` has a field for the frame's number, and this is one image", arguments.file.display());
        problems.push(Diagnostic::error("output::field-without-range", message).hint(range));
    }
    problems.extend(check_writable(&arguments.file).err());
    Images::One { frames }
}

fn sequence(arguments: &RenderArguments, frames: &RangeInclusive<u32>, problems: &mut Vec<Diagnostic>) -> Option<Sequence> {
    if arguments.time.is_some() {
        let message = "`--time` is the time of one image; frame n of a sequence is n / fps seconds after the scene began";
        problems.push(Diagnostic::error("render::time-of-sequence", message).hint("leave it out, or begin later: --frames 60..120"));
    }
    let pattern = FramePattern::parse(&arguments.file).map_err(|problem| problems.push(problem)).ok()?;
    problems.extend(check_creatable(&pattern.path(*frames.start())).err());
    let exists = |path: PathBuf| path.try_exists().unwrap_or(true);
    let mut due = Vec::new();
    for frame in frames.clone() {
        let path = pattern.path(frame);
        if path.is_dir() {
            problems.extend(check_writable(&path).err());
        } else if arguments.overwrite || !exists(path) {
            due.push(frame);
        }
    }
    let (fps, warm_up) = (arguments.fps.unwrap_or(FRAMES_PER_SECOND), arguments.warm_up.unwrap_or(0));
    Some(Sequence { pattern, frames: frames.clone(), fps, due, warm_up })
}
