//! What is asked of [`super::publish`], and what it gives.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::published::{DrawFilter, PublishedScene, ViewKind, ViewRequest};

use super::casters::{Center, Cube};
use super::cube;
use super::layout::ViewTable;
use super::lights::Lights;
use super::projection::CameraView;
use super::spot::SpotView;
use super::sun::{self, SunView};
use crate::world::Aabb;

/// What messages call a probe.
const PROBE: &str = "reflection probe";

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

/// Whether the lights, probes and faces that are asked for exist. `rectangles` and `probes` are how many the scene has.
pub(super) fn check(request: &PublishRequest<'_>, lights: &Lights, rectangles: usize, probes: usize) -> Vec<Diagnostic> {
    let mut kinds: Vec<ViewKind> = request.views.iter().map(|view| view.kind).chain(request.draw_lists.iter().map(|list| list.1)).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let unknown = |kind: &str, index: u32, count: usize| {
        let (code, what) = if kind == PROBE { ("publish::unknown-probe", "probes") } else { ("publish::unknown-light", "lights") };
        Diagnostic::error(code, format!("a view asks for {kind} {index}, and the scene has {count}"))
            .hint(format!("count loops with the scene's counts, or let the pass stand only if the scene `has` such {what}"))
    };
    let [cubes, maps] = lights.cubes_and_maps();
    let mut problems: Vec<Diagnostic> = kinds
        .iter()
        .filter_map(|kind| {
            let (name, index, count) = match *kind {
                ViewKind::Camera => return None,
                ViewKind::DirectionalLight(light) | ViewKind::WholeScene(light) => ("directional light", light, lights.suns.len()),
                ViewKind::Cascade(cascade) => ("directional light", cascade.light, lights.suns.len()),
                ViewKind::PointLight(light, _) => ("point light", light, cubes),
                ViewKind::SpotLight(light) => ("spot light", light, maps),
                ViewKind::RectangleLight(light, _) => ("rectangle light", light, rectangles),
                ViewKind::ReflectionProbe(probe, _) => (PROBE, probe, probes),
            };
            match Cube::of(*kind) {
                _ if index as usize >= count => Some(unknown(name, index, count)),
                Some((_, face)) if face > 5 => Some(Diagnostic::error(
                    "publish::unknown-face",
                    format!("a view asks for face {face} of {name} {index}; a cube has the faces 0 to 5"),
                )),
                _ => None,
            }
        })
        .collect();
    let cascade = |view: &ViewRequest| match view.kind {
        ViewKind::Cascade(cascade) => Some((cascade.split, view.width, view.height)),
        _ => None,
    };
    let mut cascades = request.views.iter().filter_map(cascade);
    if let Some(first) = cascades.next()
        && cascades.any(|other| other != first)
    {
        let text = "views ask for cascades that are parted differently, or with maps of different sizes; the table `cascades` has one kind";
        problems.push(Diagnostic::error("publish::mixed-cascades", text).hint("give the cascades of all lights the same numbers"));
    }
    problems
}

/// The view of a directional light, fitted; `None` if it is another one's.
pub(super) fn sun_view(view: &ViewRequest, camera: &CameraView, lights: &Lights, bounds: Option<Aabb>) -> Option<SunView> {
    let texels = [view.width, view.height];
    match view.kind {
        ViewKind::DirectionalLight(light) => Some(sun::fit(lights.to_sun(light), camera, bounds, texels)),
        ViewKind::Cascade(cascade) => Some(sun::fit_cascade(lights.to_sun(cascade.light), camera, bounds, cascade, texels)),
        ViewKind::WholeScene(light) => Some(sun::fit_whole(lights.to_sun(light), bounds, texels)),
        ViewKind::Camera
        | ViewKind::PointLight(..)
        | ViewKind::SpotLight(_)
        | ViewKind::RectangleLight(..)
        | ViewKind::ReflectionProbe(..) => None,
    }
}

/// The table of a view that is no directional light's; zero where a light or probe is not there, since nothing is drawn then.
pub(super) fn view_table(view: &ViewRequest, camera: &CameraView, lights: &Lights, center: impl Fn(Cube) -> Option<Center>) -> ViewTable {
    let table = match (view.kind, Cube::of(view.kind)) {
        (_, Some((cube, face))) => center(cube).map(|center| cube::face_view(center.position, center.planes, face)),
        (ViewKind::SpotLight(light), _) => lights.spot(light).map(|lamp| SpotView::of(&lamp).table),
        _ => Some(camera.view()),
    };
    table.unwrap_or_else(bytemuck::Zeroable::zeroed)
}
