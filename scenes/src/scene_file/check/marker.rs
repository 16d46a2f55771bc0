//! Markers: places that techniques use.

use glam::{Affine3A, UVec3, Vec3};
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::syntax::document::Text;

use super::Kind;
use crate::scene_file::checks::{FAR, Problems, SMALL};
use crate::scene_file::document::MarkerDoc;
use crate::world::{ProbeVolume, ReflectionProbe, Volume};

/// A marker, its place, and its parent's name.
pub(super) fn marker(name: &str, entry: &MarkerDoc, problems: &mut Problems) -> (Kind, Affine3A, Option<Text>) {
    let of = format!("marker `{name}`");
    let size = |size, problems: &mut Problems| problems.vector(&format!("`size` of {of}"), Some(size), Vec3::ONE, SMALL..=FAR);
    match entry {
        MarkerDoc::ProbeVolume { center, counts, spacing, parent } => {
            let (x, y, z) = counts.value;
            if [x, y, z].contains(&0) {
                let message = format!("`counts` of {of} is ({x}, {y}, {z}), which is no probe at all");
                problems.add(Diagnostic::error("scene::bad-number", message).at(counts.span, "must be at least 1 along each axis"));
            }
            let spacing = problems.vector(&format!("`spacing` of {of}"), Some(spacing), Vec3::ONE, SMALL..=FAR);
            let center = problems.position(&format!("`center` of {of}"), center);
            let volume = ProbeVolume { counts: UVec3::new(x, y, z), spacing };
            (Kind::ProbeVolume(volume), Affine3A::from_translation(center), parent.clone())
        }
        MarkerDoc::ReflectionProbe { position, size: edges, near, far, parent } => {
            let position = problems.position(&format!("`position` of {of}"), position);
            let size = size(edges, problems);
            let near = problems.number(&format!("`near` of {of}"), near.as_ref(), 0.1, SMALL..=FAR);
            let far_end = problems.number(&format!("`far` of {of}"), far.as_ref(), (2.0 * near).max(100.0), SMALL..=FAR);
            if let Some(far) = far.as_ref().filter(|_| far_end <= near) {
                let message = format!("`far` of {of} is {far_end}, and `near` is {near}");
                problems.add(Diagnostic::error("scene::bad-number", message).at(far.span, "must be greater than `near`"));
            }
            let probe = ReflectionProbe { size, near, far: far_end };
            (Kind::ReflectionProbe(probe), Affine3A::from_translation(position), parent.clone())
        }
        MarkerDoc::BoxVolume { center, size: edges, parent } => {
            let center = problems.position(&format!("`center` of {of}"), center);
            let size = size(edges, problems);
            (Kind::Volume(Volume { size }), Affine3A::from_translation(center), parent.clone())
        }
    }
}
