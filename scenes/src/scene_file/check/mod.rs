//! From a document to checked parts of a scene: numbers in range, angles in radians, materials and meshes as rows of the world.
//! Names of nodes are resolved later, by [`super::names`], for they may lie in glTF files.

mod camera;
mod light;
pub(super) mod marker;
pub(super) mod material;
pub(super) mod motion;
mod object;

pub(crate) use light::glow;
pub(crate) use motion::{Controller, Play};
pub(crate) use object::Repeat;

use std::ops::Range;

use glam::{Affine3A, Mat3, Vec2, Vec3};
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::syntax::document::{Entries, Text};
use luminaire_graph::syntax::spanned::Spanned;

use super::checks::{BRIGHT, FAR, LATE, Problems, SMALL};
use super::document::{ActionDoc, AnimationDoc, EnvironmentDoc, FileDoc, GroupDoc, LightDoc, MaterialDoc, ObjectDoc, SceneDoc};
use crate::asset::Material;
use crate::world::{
    Camera, CameraPath, DirectionalLight, Environment, LocalLight, ProbeVolume, RectangleLight, ReflectionProbe, Volume, look_at,
};

/// Most events of a timeline.
const MAX_EVENTS: usize = 100_000;

/// A scene file without its glTF files.
#[derive(Debug, Default)]
pub(super) struct Checked {
    pub(super) sky_radiance: Vec3,
    pub(super) sky_image: Option<SkyUse>,
    /// Lux.
    pub(super) least_illuminance: f32,
    /// The named ones first, in their order.
    pub(super) materials: Vec<Material>,
    pub(super) primitives: object::Primitives,
    /// What is there from the beginning, then what the timeline spawns.
    pub(super) declarations: Vec<Declaration>,
    /// Which declarations are there from the beginning.
    pub(super) initial: Range<usize>,
    /// For each event, the declarations that it spawns.
    pub(super) spawned: Vec<Range<usize>>,
    pub(super) files: Vec<FileUse>,
}

/// An image of the sky.
#[derive(Debug)]
pub(super) struct SkyUse {
    /// One equirectangular image, or six faces.
    pub(super) files: Vec<Text>,
    /// Radians.
    pub(super) rotation: f32,
    pub(super) strength: f32,
}

/// Something that stands, or will stand, in a scene.
#[derive(Debug)]
pub(crate) struct Declaration {
    pub(crate) name: Text,
    pub(crate) kind: Kind,
    pub(crate) parent: Option<Text>,
    pub(crate) local: Affine3A,
}

/// What it is.
#[derive(Debug)]
pub(crate) enum Kind {
    Group,
    Camera {
        camera: Camera,
        path: Option<CameraPath>,
        controller: Option<Controller>,
    },
    Directional(DirectionalLight),
    Local(LocalLight),
    Rectangle {
        light: RectangleLight,
        mesh: usize,
        material: usize,
    },
    Object {
        mesh: usize,
        material: usize,
        repeat: Option<Repeat>,
    },
    /// Index into [`Checked::files`].
    File(usize),
    ProbeVolume(ProbeVolume),
    ReflectionProbe(ReflectionProbe),
    Volume(Volume),
}

impl Kind {
    /// For messages.
    pub(crate) fn what(&self) -> &'static str {
        match self {
            Kind::Group => "group",
            Kind::Camera { .. } => "camera",
            Kind::Directional(_) | Kind::Local(_) | Kind::Rectangle { .. } => "light",
            Kind::Object { .. } => "object",
            Kind::File(_) => "file",
            Kind::ProbeVolume(_) | Kind::ReflectionProbe(_) | Kind::Volume(_) => "marker",
        }
    }
}

/// A use of a glTF file.
#[derive(Debug)]
pub(super) struct FileUse {
    /// The entry's name.
    pub(super) name: String,
    pub(super) path: Text,
    pub(super) materials: Entries<MaterialDoc>,
    pub(super) animation: Option<AnimationDoc>,
    /// When it appears, seconds.
    pub(super) appears: f64,
}

fn sky_image(environment: &EnvironmentDoc, problems: &mut Problems) -> Option<SkyUse> {
    let rotation = problems.number("`rotation` of the environment", environment.rotation.as_ref(), 0.0, -360.0..=360.0);
    let strength = problems.number("`strength` of the environment", environment.strength.as_ref(), 1.0, 0.0..=BRIGHT);
    let files: Vec<Text> = environment.image.iter().chain(&environment.faces).cloned().collect();
    if let (Some(image), Some(face)) = (&environment.image, environment.faces.first()) {
        let problem = Diagnostic::error("scene::two-skies", "the environment has `image` and `faces`").at(face.span, "six files");
        problems.add(problem.and(image.span, "and one").hint("leave one of both out"));
        return None;
    }
    if let (Some(first), false) = (environment.faces.first(), matches!(environment.faces.len(), 0 | 6)) {
        let message = format!("the environment has {} `faces`, and a cube has six", environment.faces.len());
        problems.add(Diagnostic::error("scene::sky-faces", message).at(first.span, "the first").hint("in this order: +X -X +Y -Y +Z -Z"));
        return None;
    }
    if files.is_empty() {
        for (name, number) in [("rotation", &environment.rotation), ("strength", &environment.strength)] {
            if let Some(number) = number {
                let message = format!("`{name}` of the environment turns nothing: there is neither `image` nor `faces`");
                let message = if name == "strength" { message.replace("turns", "brightens") } else { message };
                problems.add(Diagnostic::error("scene::no-sky-image", message).at(number.span, "of which image?"));
            }
        }
        return None;
    }
    Some(SkyUse { files, rotation: rotation.to_radians(), strength })
}

/// Checks everything but names of nodes and what the timeline changes; what is wrong goes to `problems`.
pub(super) fn check(document: &SceneDoc, problems: &mut Problems) -> Checked {
    let mut checked = Checked {
        sky_radiance: problems.color("`sky_radiance` of the environment", document.environment.sky_radiance.as_ref(), Vec3::ZERO, BRIGHT),
        sky_image: sky_image(&document.environment, problems),
        least_illuminance: problems.number(
            "`least_illuminance` of the environment",
            document.environment.least_illuminance.as_ref(),
            Environment::default().least_illuminance,
            0.0..=BRIGHT,
        ),
        ..Checked::default()
    };
    for (name, entry) in &document.materials {
        let of = format!("material `{}`", name.value);
        checked.materials.push(material::changed(material::plain(&name.value), &of, entry, problems));
    }
    checked.groups(&document.groups, problems);
    for (name, entry) in &document.cameras {
        let (kind, local) = camera::camera(name, entry, problems);
        checked.declare(name, kind, entry.parent.clone(), local);
    }
    checked.lights(&document.lights, problems);
    for (name, entry) in &document.markers {
        let (kind, local, parent) = marker::marker(&name.value, entry, problems);
        checked.declare(name, kind, parent, local);
    }
    checked.objects(document, &document.objects, problems);
    checked.files(&document.files, 0.0, problems);
    checked.initial = 0..checked.declarations.len();
    if let Some(event) = document.timeline.get(MAX_EVENTS) {
        problems.add(
            Diagnostic::error("scene::too-much", format!("the timeline has {} events", document.timeline.len()))
                .at(event.at.span, format!("at most {MAX_EVENTS} are allowed")),
        );
    }
    for event in document.timeline.iter().take(MAX_EVENTS) {
        let first = checked.declarations.len();
        if let ActionDoc::Spawn { groups, lights, objects, files } = &event.action {
            checked.groups(groups, problems);
            checked.lights(lights, problems);
            checked.objects(document, objects, problems);
            // What is wrong with the time is said where events are put in order.
            let appears = if (0.0..=LATE).contains(&event.at.value) { event.at.value } else { 0.0 };
            checked.files(files, appears, problems);
        }
        checked.spawned.push(first..checked.declarations.len());
    }
    checked
}

impl Checked {
    fn declare(&mut self, name: &Text, kind: Kind, parent: Option<Text>, local: Affine3A) {
        self.declarations.push(Declaration { name: name.clone(), kind, parent, local });
    }

    fn groups(&mut self, groups: &Entries<GroupDoc>, problems: &mut Problems) {
        for (name, entry) in groups {
            let of = format!("group `{}`", name.value);
            let local = problems.placement(&of, entry.translation.as_ref(), entry.rotation.as_ref(), entry.scale.as_ref());
            self.declare(name, Kind::Group, entry.parent.clone(), local);
        }
    }

    fn lights(&mut self, lights: &Entries<LightDoc>, problems: &mut Problems) {
        for (name, entry) in lights {
            let (kind, local, parent) = light::light(&name.value, entry, &mut self.primitives, &mut self.materials, problems);
            self.declare(name, kind, parent, local);
        }
    }

    fn objects(&mut self, document: &SceneDoc, objects: &Entries<ObjectDoc>, problems: &mut Problems) {
        for (name, entry) in objects {
            let was_too_much = self.primitives.is_too_much();
            let kind = object::object(document, name, entry, &mut self.primitives, &mut self.materials, problems);
            if !was_too_much {
                self.primitives.check(name.span, problems);
            }
            let of = format!("object `{}`", name.value);
            let local = problems.placement(&of, entry.translation.as_ref(), entry.rotation.as_ref(), entry.scale.as_ref());
            self.declare(name, kind, entry.parent.clone(), local);
        }
    }

    fn files(&mut self, files: &Entries<FileDoc>, appears: f64, problems: &mut Problems) {
        for (name, entry) in files {
            let of = format!("file `{}`", name.value);
            let local = problems.placement(&of, entry.translation.as_ref(), entry.rotation.as_ref(), entry.scale.as_ref());
            let kind = Kind::File(self.files.len());
            self.files.push(FileUse {
                name: name.value.clone(),
                path: entry.path.clone(),
                materials: entry.materials.clone(),
                animation: entry.animation.clone(),
                appears,
            });
            self.declare(name, kind, entry.parent.clone(), local);
        }
    }
}

/// The size of something flat.
fn size_of(of: &str, size: &Spanned<(f32, f32)>, problems: &mut Problems) -> Vec2 {
    let (x, y) = size.value;
    let volume = Spanned { value: (x, y, 1.0), span: size.span };
    problems.vector(&format!("`size` of {of}"), Some(&volume), Vec3::ONE, SMALL..=FAR).truncate()
}

/// The transform of something at `position` that looks along `forward`.
fn facing(position: Vec3, forward: Vec3) -> Affine3A {
    let (right, up, back) = look_at(forward.as_dvec3());
    Affine3A::from_mat3_translation(Mat3::from_cols(right.as_vec3(), up.as_vec3(), back.as_vec3()), position)
}
