//! Cameras.

use glam::Affine3A;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::syntax::document::Text;

use super::{Kind, facing, motion};
use crate::asset::Projection;
use crate::scene_file::checks::{BRIGHT, FAR, Problems, SMALL};
use crate::scene_file::document::CameraDoc;
use crate::world::{Camera, Exposure};

/// Where an orthographic camera's view ends unless it says so, metres.
const ORTHO_FAR: f32 = 1000.0;

/// A camera and its place.
pub(super) fn camera(name: &Text, entry: &CameraDoc, problems: &mut Problems) -> (Kind, Affine3A) {
    let of = format!("camera `{name}`");
    let position = problems.position(&format!("`position` of {of}"), &entry.position);
    let target = problems.position(&format!("`target` of {of}"), &entry.target);
    if position == target {
        let message = format!("{of} stands where it looks at");
        problems.add(Diagnostic::error("scene::no-direction", message).at(entry.target.span, "must differ from `position`"));
    }
    let projection = projection(&of, entry, problems);
    let exposure = exposure(&of, entry, problems);
    let camera = Camera { name: name.value.clone(), projection, exposure };
    let local = facing(position, target - position);
    let path = entry.path.as_ref().and_then(|path| motion::path(&of, name.span, path, problems));
    let controller = entry.controller.as_ref().map(|entry| motion::controller(&of, entry, local, target.as_dvec3(), problems));
    if entry.path.is_some() && controller.is_some() {
        problems.add(
            Diagnostic::error("scene::which-motion", format!("{of} has both a `path` and a `controller`"))
                .at(name.span, "this camera")
                .hint("a camera either travels by itself or obeys; give one of them"),
        );
    }
    (Kind::Camera { camera, path, controller }, local)
}

fn exposure(of: &str, entry: &CameraDoc, problems: &mut Problems) -> Exposure {
    match (&entry.ev100, &entry.exposure) {
        (None, None) => Exposure::Unchanged,
        (Some(ev100), None) => Exposure::Ev100(problems.number(&format!("`ev100` of {of}"), Some(ev100), 0.0, -40.0..=40.0)),
        (None, Some(factor)) => Exposure::Factor(problems.number(&format!("`exposure` of {of}"), Some(factor), 1.0, 0.0..=BRIGHT)),
        (Some(ev100), Some(factor)) => {
            problems.add(
                Diagnostic::error("scene::which-exposure", format!("{of} has both an `ev100` and an `exposure`"))
                    .at(factor.span, "a factor")
                    .and(ev100.span, "an exposure value")
                    .hint("`ev100` exposes as a real camera does, `exposure` by a factor; give one of them"),
            );
            Exposure::Unchanged
        }
    }
}

fn projection(of: &str, entry: &CameraDoc, problems: &mut Problems) -> Projection {
    if let (Some(fov), Some(ortho)) = (&entry.fov, &entry.ortho) {
        problems.add(
            Diagnostic::error("scene::which-projection", format!("{of} has both a `fov` and an `ortho`"))
                .at(ortho.span, "orthographic")
                .and(fov.span, "perspective")
                .hint("a camera is either perspective, with `fov`, or orthographic, with `ortho`; give one of them"),
        );
    }
    let yfov = problems.number(&format!("`fov` of {of}"), entry.fov.as_ref(), 45.0, 1.0..=170.0).to_radians();
    let near = problems.number(&format!("`near` of {of}"), entry.near.as_ref(), 0.01, SMALL..=FAR);
    let far = entry.far.as_ref().map(|far| (problems.number(&format!("`far` of {of}"), Some(far), FAR, SMALL..=FAR), far.span));
    if let Some((far, span)) = far.filter(|(far, _)| *far <= near) {
        let message = format!("`far` of {of} is {far}, and `near` is {near}");
        problems.add(Diagnostic::error("scene::bad-number", message).at(span, "must be greater than `near`"));
    }
    let far = far.map(|(far, _)| far);
    match &entry.ortho {
        None => Projection::Perspective { yfov, near, far },
        Some(height) => {
            let ymag = 0.5 * problems.number(&format!("`ortho` of {of}"), Some(height), 1.0, SMALL..=FAR);
            // Images decide the width; a square is what a file would say.
            Projection::Orthographic { ymag, xmag: ymag, near, far: far.unwrap_or(ORTHO_FAR.max(2.0 * near)) }
        }
    }
}
