//! From a document to checked parts of a scene: names resolved, numbers in range, angles in radians.

use glam::{Affine3A, Mat3, Vec2, Vec3};
use luminaire_graph::diagnostic::{Diagnostic, did_you_mean, list_names};
use luminaire_graph::source::Span;
use luminaire_graph::syntax::spanned::Spanned;

use super::checks::{FAR, Problems, SMALL};
use super::document::{CameraDoc, LightDoc, MaterialDoc, ObjectDoc, SceneDoc, ShapeDoc};
use crate::asset::{AlphaMode, Material, Projection};
use crate::primitive::MAX_SECTORS;
use crate::world::{Camera, Cone, DirectionalLight, Exposure, LocalLight, look_at};

/// Brightest light or emission, in its unit: ten billion is beyond the sun's disc seen from the ground.
const BRIGHT: f32 = 1e10;

/// A scene file without its glTF files.
#[derive(Debug, Default)]
pub(super) struct Checked {
    pub(super) sky_radiance: Vec3,
    pub(super) materials: Vec<Material>,
    pub(super) cameras: Vec<(String, Camera, Affine3A)>,
    pub(super) lights: Vec<(String, Light, Affine3A)>,
    pub(super) objects: Vec<(String, Object, Affine3A)>,
    pub(super) files: Vec<(String, Spanned<String>, Affine3A)>,
}

/// A light without its place.
#[derive(Debug, Clone, Copy)]
pub(super) enum Light {
    Directional(DirectionalLight),
    Local(LocalLight),
}

/// A primitive without its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Object {
    pub(super) shape: Shape,
    /// Index into [`Checked::materials`].
    pub(super) material: usize,
}

/// The shape of a primitive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    Box(Vec3),
    Sphere { radius: f32, sectors: u32, stacks: u32 },
    Plane(Vec2),
}

/// Checks everything; what is wrong goes to `problems`.
pub(super) fn check(document: &SceneDoc, problems: &mut Problems) -> Checked {
    check_names(document, problems);
    let mut checked = Checked {
        sky_radiance: problems.color("`sky_radiance` of the environment", document.environment.sky_radiance.as_ref(), Vec3::ZERO, BRIGHT),
        ..Checked::default()
    };
    for (name, entry) in &document.materials {
        let material = material(&name.value, &format!("material `{}`", name.value), entry, problems);
        checked.materials.push(material);
    }
    for (name, entry) in &document.cameras {
        let (camera, transform) = camera(&name.value, entry, problems);
        checked.cameras.push((name.value.clone(), camera, transform));
    }
    for (name, entry) in &document.lights {
        let (light, transform) = light(&format!("light `{}`", name.value), entry, problems);
        checked.lights.push((name.value.clone(), light, transform));
    }
    for (name, entry) in &document.objects {
        let of = format!("object `{}`", name.value);
        let material = object_material(document, name, entry, &mut checked.materials, problems);
        let shape = shape(&of, &entry.shape, problems);
        let transform = problems.placement(&of, entry.translation.as_ref(), entry.rotation.as_ref(), entry.scale.as_ref());
        checked.objects.push((name.value.clone(), Object { shape, material }, transform));
    }
    for (name, entry) in &document.files {
        let of = format!("file `{}`", name.value);
        let transform = problems.placement(&of, entry.translation.as_ref(), entry.rotation.as_ref(), entry.scale.as_ref());
        checked.files.push((name.value.clone(), entry.path.clone(), transform));
    }
    checked
}

/// A name stands for one thing, whatever its kind, so that it can be moved by name.
fn check_names(document: &SceneDoc, problems: &mut Problems) {
    let mut seen: std::collections::BTreeMap<&str, (&str, Span)> = std::collections::BTreeMap::new();
    let kinds = [
        ("camera", document.cameras.keys().collect::<Vec<_>>()),
        ("light", document.lights.keys().collect()),
        ("object", document.objects.keys().collect()),
        ("file", document.files.keys().collect()),
    ];
    for (kind, names) in kinds {
        for name in names {
            if let Some((other, place)) = seen.insert(&name.value, (kind, name.span)) {
                problems.add(
                    Diagnostic::error("scene::duplicate-name", format!("`{}` is the name of a {other} and of a {kind}", name.value))
                        .at(name.span, format!("the {kind}"))
                        .and(place, format!("the {other}")),
                );
            }
        }
    }
}

fn material(name: &str, of: &str, entry: &MaterialDoc, problems: &mut Problems) -> Material {
    let white = Vec3::ONE;
    let base_color = problems.color(&format!("`base_color` of {of}"), entry.base_color.as_ref(), Vec3::splat(0.8), 1.0);
    let alpha = problems.number(&format!("`alpha` of {of}"), entry.alpha.as_ref(), 1.0, 0.0..=1.0);
    Material {
        name: name.to_owned(),
        base_color: base_color.extend(alpha).to_array(),
        metallic: problems.number(&format!("`metallic` of {of}"), entry.metallic.as_ref(), 0.0, 0.0..=1.0),
        roughness: problems.number(&format!("`roughness` of {of}"), entry.roughness.as_ref(), 1.0, 0.0..=1.0),
        emissive: problems.color(&format!("`emissive` of {of}"), entry.emissive.as_ref(), Vec3::ZERO, BRIGHT).to_array(),
        specular: problems.number(&format!("`specular` of {of}"), entry.specular.as_ref(), 1.0, 0.0..=1.0),
        specular_color: problems.color(&format!("`specular_color` of {of}"), entry.specular_color.as_ref(), white, 100.0).to_array(),
        ior: problems.number(&format!("`ior` of {of}"), entry.ior.as_ref(), 1.5, 1.0..=10.0),
        alpha_mode: if alpha < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque },
        double_sided: entry.double_sided,
        unlit: entry.unlit,
        ..Material::default()
    }
}

/// The index of the object's material; its own one is added.
fn object_material(
    document: &SceneDoc,
    name: &Spanned<String>,
    entry: &ObjectDoc,
    materials: &mut Vec<Material>,
    problems: &mut Problems,
) -> usize {
    let name_text = &name.value;
    match (&entry.material, &entry.surface) {
        (Some(wanted), None) => document.materials.get_index_of(wanted).unwrap_or_else(|| {
            let known = || document.materials.keys().map(|known| known.value.as_str());
            problems.add(
                Diagnostic::error(
                    "scene::unknown-material",
                    format!("object `{name_text}` has the material `{}`, which is not defined", wanted.value),
                )
                .at(wanted.span, "no such material")
                .note(format!("materials of the scene: {}", list_names(known())))
                .maybe_hint(did_you_mean(&wanted.value, known())),
            );
            0
        }),
        (None, Some(surface)) => {
            materials.push(material(name_text, &format!("object `{name_text}`"), surface, problems));
            materials.len() - 1
        }
        (named, _) => {
            let message = match named {
                Some(_) => format!("object `{name_text}` has both a `material` and a `surface`"),
                None => format!("object `{name_text}` has neither a `material` nor a `surface`"),
            };
            problems.add(
                Diagnostic::error("scene::which-material", message)
                    .at(named.as_ref().map_or(name.span, |named| named.span), "here")
                    .hint("`material` names an entry of `materials`, `surface` is a material of the object's own; give one of them"),
            );
            0
        }
    }
}

fn shape(of: &str, entry: &ShapeDoc, problems: &mut Problems) -> Shape {
    match entry {
        ShapeDoc::Box { size } => Shape::Box(problems.vector(&format!("`size` of {of}"), Some(size), Vec3::ONE, SMALL..=FAR)),
        ShapeDoc::Sphere { radius, sectors, stacks } => {
            let mut count = |field: &str, value: &Option<Spanned<u32>>, default: u32, least: u32| {
                let Some(value) = value else { return default };
                if !(least..=MAX_SECTORS).contains(&value.value) {
                    problems.add(
                        Diagnostic::error("scene::bad-number", format!("`{field}` of {of} is {}", value.value))
                            .at(value.span, format!("must lie between {least} and {MAX_SECTORS}")),
                    );
                }
                value.value
            };
            let (sectors, stacks) = (count("sectors", sectors, 64, 3), count("stacks", stacks, 32, 2));
            Shape::Sphere { radius: problems.number(&format!("`radius` of {of}"), Some(radius), 1.0, SMALL..=FAR), sectors, stacks }
        }
        ShapeDoc::Plane { size } => {
            let (x, z) = size.value;
            let volume = Spanned { value: (x, z, 1.0), span: size.span };
            let size = problems.vector(&format!("`size` of {of}"), Some(&volume), Vec3::ONE, SMALL..=FAR);
            Shape::Plane(size.truncate())
        }
    }
}

fn camera(name: &str, entry: &CameraDoc, problems: &mut Problems) -> (Camera, Affine3A) {
    let of = format!("camera `{name}`");
    let position = problems.position(&format!("`position` of {of}"), &entry.position);
    let target = problems.position(&format!("`target` of {of}"), &entry.target);
    if position == target {
        let message = format!("{of} stands where it looks at");
        problems.add(Diagnostic::error("scene::no-direction", message).at(entry.target.span, "must differ from `position`"));
    }
    let yfov = problems.number(&format!("`fov` of {of}"), entry.fov.as_ref(), 45.0, 1.0..=170.0).to_radians();
    let near = problems.number(&format!("`near` of {of}"), entry.near.as_ref(), 0.01, SMALL..=FAR);
    let exposure = entry
        .ev100
        .as_ref()
        .map_or(Exposure::Unchanged, |value| Exposure::Ev100(problems.number(&format!("`ev100` of {of}"), Some(value), 0.0, -40.0..=40.0)));
    let camera = Camera { name: name.to_owned(), projection: Projection::Perspective { yfov, near, far: None }, exposure };
    (camera, facing(position, target - position))
}

fn light(of: &str, entry: &LightDoc, problems: &mut Problems) -> (Light, Affine3A) {
    match entry {
        LightDoc::Directional { lux, direction, color } => {
            let illuminance = problems.number(&format!("`lux` of {of}"), Some(lux), 0.0, 0.0..=BRIGHT);
            let color = problems.color(&format!("`color` of {of}"), color.as_ref(), Vec3::ONE, 1e3);
            let direction = problems.direction(&format!("`direction` of {of}"), direction);
            (Light::Directional(DirectionalLight { color, illuminance }), facing(Vec3::ZERO, direction))
        }
        LightDoc::Point { candela, position, color, range } => {
            let intensity = problems.number(&format!("`candela` of {of}"), Some(candela), 0.0, 0.0..=BRIGHT);
            let color = problems.color(&format!("`color` of {of}"), color.as_ref(), Vec3::ONE, 1e3);
            let range = range.as_ref().map(|range| problems.number(&format!("`range` of {of}"), Some(range), 1.0, SMALL..=FAR));
            let position = problems.position(&format!("`position` of {of}"), position);
            (Light::Local(LocalLight { color, intensity, range, cone: None }), Affine3A::from_translation(position))
        }
        LightDoc::Spot { candela, position, direction, inner, outer, color, range } => {
            let intensity = problems.number(&format!("`candela` of {of}"), Some(candela), 0.0, 0.0..=BRIGHT);
            let color = problems.color(&format!("`color` of {of}"), color.as_ref(), Vec3::ONE, 1e3);
            let range = range.as_ref().map(|range| problems.number(&format!("`range` of {of}"), Some(range), 1.0, SMALL..=FAR));
            let position = problems.position(&format!("`position` of {of}"), position);
            let direction = problems.direction(&format!("`direction` of {of}"), direction);
            let outer_angle = problems.number(&format!("`outer` of {of}"), Some(outer), 90.0, 0.01..=90.0);
            let inner_angle = problems.number(&format!("`inner` of {of}"), inner.as_ref(), 0.0, 0.0..=90.0);
            if inner_angle >= outer_angle {
                let span = inner.as_ref().map_or(outer.span, |inner| inner.span);
                let message = format!("`inner` of {of} is {inner_angle}, and `outer` is {outer_angle}");
                problems.add(Diagnostic::error("scene::bad-cone", message).at(span, "must be less than `outer`"));
            }
            let cone = Some(Cone { inner: inner_angle.to_radians(), outer: outer_angle.to_radians() });
            (Light::Local(LocalLight { color, intensity, range, cone }), facing(position, direction))
        }
    }
}

/// The transform of something at `position` that looks along `forward`.
fn facing(position: Vec3, forward: Vec3) -> Affine3A {
    let (right, up, back) = look_at(forward.as_dvec3());
    Affine3A::from_mat3_translation(Mat3::from_cols(right.as_vec3(), up.as_vec3(), back.as_vec3()), position)
}
