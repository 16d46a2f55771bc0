//! What is asked of [`super::publish`], and what it gives.

use glam::DVec3;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::published::{DrawFilter, PublishedScene, ViewKind, ViewRequest};

use super::cube;
use super::layout::ViewTable;
use super::lights::Lights;
use super::projection::CameraView;
use super::sun::{self, SunView};
use crate::world::Aabb;

/// Everything that a plan needs of a scene.
#[derive(Debug, Clone, Copy)]
pub struct PublishRequest<'a> {
    /// The camera's name; the first one if there is none.
    pub camera: Option<&'a str>,
    /// Width and height of the rendered image.
    pub extent: [u32; 2],
    /// Views of the plan, in its order.
    pub views: &'a [ViewRequest],
    /// Draw lists of the plan, in its order.
    pub draw_lists: &'a [(DrawFilter, ViewKind)],
    /// Longest edge of a texture that the device takes.
    pub max_texture_2d: u32,
}

impl PublishRequest<'_> {
    /// Width over height of the image.
    pub(super) fn aspect(&self) -> f64 {
        f64::from(self.extent[0].max(1)) / f64::from(self.extent[1].max(1))
    }
}

/// A published scene, and what was not as it should be.
#[derive(Debug, Clone, Default)]
pub struct Published {
    /// For the executor.
    pub scene: PublishedScene,
    /// For the user: `publish::image-reduced`.
    pub warnings: Vec<Diagnostic>,
}

/// Whether the lights and faces that are asked for exist.
pub(super) fn check(request: &PublishRequest<'_>, lights: &Lights) -> Vec<Diagnostic> {
    let mut kinds: Vec<ViewKind> = request.views.iter().map(|view| view.kind).chain(request.draw_lists.iter().map(|list| list.1)).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let unknown = |kind: &str, index: u32, count: usize| {
        Diagnostic::error("publish::unknown-light", format!("a view asks for {kind} light {index}, and the scene has {count}"))
            .hint("count loops with the scene's counts, or let the pass stand only if the scene `has` such lights")
    };
    kinds
        .into_iter()
        .filter_map(|kind| match kind {
            ViewKind::DirectionalLight(light) if light as usize >= lights.suns.len() => {
                Some(unknown("directional", light, lights.suns.len()))
            }
            ViewKind::LocalLight(light, _) if light as usize >= lights.lamps.len() => Some(unknown("local", light, lights.lamps.len())),
            ViewKind::LocalLight(light, face) if face > 5 => Some(Diagnostic::error(
                "publish::unknown-face",
                format!("a view asks for face {face} of local light {light}; a cube has the faces 0 to 5"),
            )),
            _ => None,
        })
        .collect()
}

/// The view of a directional light, fitted; `None` if it is another one's.
pub(super) fn sun_view(view: &ViewRequest, camera: &CameraView, lights: &Lights, bounds: Option<Aabb>) -> Option<SunView> {
    let ViewKind::DirectionalLight(light) = view.kind else { return None };
    Some(sun::fit(lights.to_sun(light), camera, bounds, [view.width, view.height]))
}

/// The table of a view that is no directional light's. Lights that are not there look down from the origin.
pub(super) fn view_table(view: &ViewRequest, camera: &CameraView, lights: &Lights) -> ViewTable {
    match view.kind {
        ViewKind::Camera | ViewKind::DirectionalLight(_) => camera.view(),
        ViewKind::LocalLight(light, face) => {
            let lamp = lights.lamps.get(light as usize).copied().flatten();
            let (position, planes) = lamp.map_or((DVec3::ZERO, [0.01, 1.0]), |lamp| (lamp.position, lamp.reach.planes));
            cube::face_view(position, planes, face)
        }
    }
}
