//! What moves by itself: clips of files, camera paths and controllers.

use glam::{Affine3A, DVec3};
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::source::Span;
use luminaire_graph::syntax::document::Text;

use crate::scene_file::checks::{FAR, Problems, SMALL};
use crate::scene_file::document::{AgainDoc, AnimationDoc, ControllerDoc, Number, PathDoc};
use crate::world::{CameraPath, Facing, Fly, Orbit, PathInterpolation, PathKey, Repeat, StoredAsset};

/// How the clip of a file plays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Play {
    /// Index of the clip.
    pub(crate) clip: usize,
    /// Seconds of the clip in a second.
    pub(crate) speed: f64,
    /// Seconds.
    pub(crate) start: f64,
    pub(crate) repeat: Repeat,
}

/// How a camera obeys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Controller {
    Fly(Fly),
    Orbit(Orbit),
}

/// How often something plays.
fn again(entry: AgainDoc) -> Repeat {
    match entry {
        AgainDoc::Once => Repeat::Once,
        AgainDoc::Loop => Repeat::Loop,
        AgainDoc::PingPong => Repeat::PingPong,
    }
}

/// How a file's clip plays that appears at `now`. `of` and `place` are for messages. Errors: a clip that the file does not have.
pub(in crate::scene_file) fn play(
    asset: &StoredAsset,
    of: &str,
    place: Span,
    entry: &AnimationDoc,
    now: f64,
    problems: &mut Problems,
) -> Option<Play> {
    let speed = problems.number(&format!("`speed` of {of}"), entry.speed.as_ref(), 1.0, -1000.0..=1000.0);
    let start = entry.start.as_ref().map_or(now, |start| problems.seconds(&format!("`start` of {of}"), Some(start)));
    let clip = clip(asset, of, place, entry.clip.as_ref(), problems)?;
    Some(Play { clip, speed: f64::from(speed), start, repeat: again(entry.again) })
}

fn clip(asset: &StoredAsset, of: &str, place: Span, wanted: Option<&Text>, problems: &mut Problems) -> Option<usize> {
    let names = || asset.animations().iter().map(|clip| clip.name.as_str());
    let found = match wanted {
        None => (names().count() > 0).then_some(0),
        Some(wanted) => {
            let by_name = names().position(|name| name == wanted.value);
            by_name.or_else(|| wanted.value.parse().ok().filter(|index| *index < names().count()))
        }
    };
    if found.is_none() {
        let message = match wanted {
            None => format!("{of} has nothing to play"),
            Some(wanted) => format!("{of} has no clip `{}`", wanted.value),
        };
        problems.add_unknown(
            Diagnostic::error("scene::unknown-clip", message).at(wanted.map_or(place, |wanted| wanted.span), "no such clip"),
            "clips of the file",
            wanted.map(|wanted| wanted.value.as_str()),
            names,
        );
    }
    found
}

/// A camera's path.
pub(super) fn path(of: &str, place: Span, entry: &PathDoc, problems: &mut Problems) -> Option<CameraPath> {
    let before = problems.0.len();
    let keys = entry
        .keys
        .iter()
        .enumerate()
        .map(|(index, key)| {
            let of = format!("key {index} of the path of {of}");
            PathKey {
                time: problems.seconds(&format!("`at` of {of}"), Some(&key.at)),
                position: problems.position(&format!("`position` of {of}"), &key.position),
                facing: Facing::Target(problems.position(&format!("`target` of {of}"), &key.target)),
                yfov: key.fov.as_ref().map(|fov| problems.number(&format!("`fov` of {of}"), Some(fov), 45.0, 1.0..=170.0).to_radians()),
                ev100: key.ev100.as_ref().map(|ev100| problems.number(&format!("`ev100` of {of}"), Some(ev100), 0.0, -40.0..=40.0)),
            }
        })
        .collect();
    // Values that were wrong have been replaced by harmless ones, which may be wrong together.
    if problems.0.len() > before {
        return None;
    }
    let interpolation = if entry.straight { PathInterpolation::Linear } else { PathInterpolation::Smooth };
    match CameraPath::new(keys, interpolation, again(entry.again)) {
        Ok(path) => Some(path),
        Err(errors) => {
            for error in errors {
                problems.add(Diagnostic::error("scene::camera-path", format!("{of}: {}", error.message)).at(place, "of this camera"));
            }
            None
        }
    }
}

/// A camera's controller, which begins where the camera stands.
pub(super) fn controller(of: &str, entry: &ControllerDoc, local: Affine3A, target: DVec3, problems: &mut Problems) -> Controller {
    let mut rate = |field: &str, value: &Option<Number>, default: f64, range: std::ops::RangeInclusive<f32>| match value {
        None => default,
        Some(value) => f64::from(problems.number(&format!("`{field}` of the controller of {of}"), Some(value), *range.start(), range)),
    };
    match entry {
        ControllerDoc::Fly { speed, turn } => {
            let mut fly = Fly::at(local);
            fly.speed = rate("speed", speed, fly.speed, 0.1..=30.0);
            fly.turn = rate("turn", turn, fly.turn.to_degrees(), 0.0..=36000.0).to_radians();
            Controller::Fly(fly)
        }
        ControllerDoc::Orbit { turn, nearest, farthest } => {
            let mut orbit = Orbit::around(target, local);
            orbit.turn = rate("turn", turn, orbit.turn.to_degrees(), 0.0..=36000.0).to_radians();
            orbit.nearest = rate("nearest", nearest, orbit.nearest, SMALL..=FAR);
            orbit.farthest = rate("farthest", farthest, orbit.farthest, SMALL..=FAR);
            if orbit.nearest > orbit.farthest {
                let span = nearest.as_ref().or(farthest.as_ref()).map_or(Span::NOWHERE, |value| value.span);
                let message = format!("`nearest` of the controller of {of} is greater than its `farthest`");
                problems.add(Diagnostic::error("scene::bad-number", message).at(span, "must be at most `farthest`"));
            }
            Controller::Orbit(orbit)
        }
    }
}
