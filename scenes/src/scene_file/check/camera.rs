//! Cameras.

use glam::Affine3A;
use luminaire_graph::diagnostic::Diagnostic;

use super::facing;
use crate::asset::Projection;
use crate::scene_file::checks::{FAR, Problems, SMALL};
use crate::scene_file::document::CameraDoc;
use crate::world::{Camera, Exposure};

/// Where an orthographic camera's view ends unless it says so, metres.
const ORTHO_FAR: f32 = 1000.0;

/// A camera and its place.
pub(super) fn camera(name: &str, entry: &CameraDoc, problems: &mut Problems) -> (Camera, Affine3A) {
    let of = format!("camera `{name}`");
    let position = problems.position(&format!("`position` of {of}"), &entry.position);
    let target = problems.position(&format!("`target` of {of}"), &entry.target);
    if position == target {
        let message = format!("{of} stands where it looks at");
        problems.add(Diagnostic::error("scene::no-direction", message).at(entry.target.span, "must differ from `position`"));
    }
    let projection = projection(&of, entry, problems);
    let exposure = entry
        .ev100
        .as_ref()
        .map_or(Exposure::Unchanged, |value| Exposure::Ev100(problems.number(&format!("`ev100` of {of}"), Some(value), 0.0, -40.0..=40.0)));
    (Camera { name: name.to_owned(), projection, exposure }, facing(position, target - position))
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
