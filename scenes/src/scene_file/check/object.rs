//! Primitives: their shapes, which share meshes, their materials and their repetition.

use std::collections::BTreeMap;

use glam::{UVec3, Vec2, Vec3};
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::source::Span;
use luminaire_graph::syntax::document::Text;
use luminaire_graph::syntax::spanned::Spanned;

use super::{Kind, material, size_of};
use crate::asset::{Material, Mesh};
use crate::primitive::{self, MAX_SECTORS};
use crate::scene_file::checks::{FAR, Problems, SMALL};
use crate::scene_file::document::{Number, ObjectDoc, RepeatDoc, SceneDoc, ShapeDoc};

/// Most triangles that the different primitives of a scene have together, before repetition.
const MAX_TRIANGLES: u64 = 1 << 23;

/// The shape of a primitive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    Box(Vec3),
    Sphere { radius: f32, sectors: u32, stacks: u32 },
    Plane(Vec2),
    Panel(Vec2),
    Cylinder { radius: f32, height: f32, sectors: u32 },
    Cone { radius: f32, height: f32, sectors: u32 },
    Capsule { radius: f32, height: f32, sectors: u32, stacks: u32 },
    Torus { radius: f32, tube: f32, sectors: u32, stacks: u32 },
}

/// Copies on a grid.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Repeat {
    pub(crate) count: UVec3,
    pub(crate) spacing: Vec3,
    /// Rows of materials; empty where all copies have the object's.
    pub(crate) materials: Vec<usize>,
}

/// The different shapes of a scene, and their meshes in the order of the world.
#[derive(Debug, Default)]
pub(in crate::scene_file) struct Primitives {
    pub(in crate::scene_file) meshes: Vec<Mesh>,
    known: BTreeMap<[u32; 5], usize>,
    triangles: u64,
}

impl Primitives {
    /// The index of a shape's mesh. Nothing is made of a shape that is too much.
    pub(super) fn mesh(&mut self, name: &str, shape: Shape, material: usize) -> usize {
        let next = self.meshes.len();
        let index = *self.known.entry(key(shape)).or_insert(next);
        if index == next {
            self.triangles += triangles(shape);
            let mesh =
                if self.triangles > MAX_TRIANGLES { primitive::plane(name, Vec2::ONE, material) } else { build(name, shape, material) };
            self.meshes.push(mesh);
        }
        index
    }

    /// Says that there is too much.
    pub(super) fn check(&self, span: Span, problems: &mut Problems) {
        if self.is_too_much() {
            let message =
                format!("the scene has {} triangles in different primitives; at most {MAX_TRIANGLES} are allowed", self.triangles);
            problems.add(
                Diagnostic::error("scene::too-much", message)
                    .at(span, "the object that is too much")
                    .hint("give fewer sectors and stacks, or shapes that are the same"),
            );
        }
    }

    /// Whether a limit is passed.
    pub(super) fn is_too_much(&self) -> bool {
        self.triangles > MAX_TRIANGLES
    }
}

/// An object without its place.
pub(super) fn object(
    document: &SceneDoc,
    name: &Text,
    entry: &ObjectDoc,
    primitives: &mut Primitives,
    materials: &mut Vec<Material>,
    problems: &mut Problems,
) -> Kind {
    let of = format!("object `{}`", name.value);
    let repeated = entry.repeat.as_ref().map(|entry| repeat(document, &of, entry, problems));
    let own = match repeated.as_ref().and_then(|repeat| repeat.materials.first()) {
        Some(first) if entry.material.is_none() && entry.surface.is_none() => *first,
        first => object_material(document, name, entry, first.is_some(), materials, problems),
    };
    let shape = shape(&of, &entry.shape, problems);
    Kind::Object { mesh: primitives.mesh(&name.value, shape, own), material: own, repeat: repeated }
}

fn repeat(document: &SceneDoc, of: &str, entry: &RepeatDoc, problems: &mut Problems) -> Repeat {
    let (x, y, z) = entry.count.value;
    if [x, y, z].contains(&0) {
        let message = format!("`count` of {of} is ({x}, {y}, {z}), which is no copy at all");
        problems.add(Diagnostic::error("scene::bad-number", message).at(entry.count.span, "must be at least 1 along each axis"));
    }
    let spacing = problems.vector(&format!("`spacing` of {of}"), Some(&entry.spacing), Vec3::ONE, -FAR..=FAR);
    let materials = entry.materials.iter().map(|wanted| named_material(document, of, wanted, problems)).collect();
    Repeat { count: UVec3::new(x, y, z), spacing, materials }
}

/// The row of the object's material; its own one is added.
fn object_material(
    document: &SceneDoc,
    name: &Text,
    entry: &ObjectDoc,
    has_list: bool,
    materials: &mut Vec<Material>,
    problems: &mut Problems,
) -> usize {
    let of = format!("object `{}`", name.value);
    match (&entry.material, &entry.surface, has_list) {
        (Some(wanted), None, false) => named_material(document, &of, wanted, problems),
        (None, Some(surface), false) => {
            materials.push(material::changed(material::plain(&name.value), &of, surface, problems));
            materials.len() - 1
        }
        (named, surface, _) => {
            let given: Vec<&str> =
                [(named.is_some(), "a `material`"), (surface.is_some(), "a `surface`"), (has_list, "`materials` of its `repeat`")]
                    .into_iter()
                    .filter_map(|(given, what)| given.then_some(what))
                    .collect();
            let message = match given.as_slice() {
                [] => format!("{of} has neither a `material` nor a `surface`"),
                [first, second] => format!("{of} has both {first} and {second}"),
                all => format!("{of} has {}", all.join(", ")),
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

fn named_material(document: &SceneDoc, of: &str, wanted: &Text, problems: &mut Problems) -> usize {
    document.materials.get_index_of(wanted).unwrap_or_else(|| {
        let known = || document.materials.keys().map(|known| known.value.as_str());
        problems.add_unknown(
            Diagnostic::error("scene::unknown-material", format!("{of} has the material `{}`, which is not defined", wanted.value))
                .at(wanted.span, "no such material"),
            "materials of the scene",
            Some(&wanted.value),
            known,
        );
        0
    })
}

fn shape(of: &str, entry: &ShapeDoc, problems: &mut Problems) -> Shape {
    let sectors = |value: &Option<Spanned<u32>>, problems: &mut Problems| count("sectors", of, value.as_ref(), 64, 3, problems);
    let length = |field: &str, value: &Number, problems: &mut Problems| {
        problems.number(&format!("`{field}` of {of}"), Some(value), 1.0, SMALL..=FAR)
    };
    match entry {
        ShapeDoc::Box { size } => Shape::Box(problems.vector(&format!("`size` of {of}"), Some(size), Vec3::ONE, SMALL..=FAR)),
        ShapeDoc::Sphere { radius, sectors: around, stacks } => {
            let (sectors, stacks) = (sectors(around, problems), count("stacks", of, stacks.as_ref(), 32, 2, problems));
            Shape::Sphere { radius: length("radius", radius, problems), sectors, stacks }
        }
        ShapeDoc::Plane { size } => Shape::Plane(size_of(of, size, problems)),
        ShapeDoc::Cylinder { radius, height, sectors: around } => {
            let (radius, height) = (length("radius", radius, problems), length("height", height, problems));
            Shape::Cylinder { radius, height, sectors: sectors(around, problems) }
        }
        ShapeDoc::Cone { radius, height, sectors: around } => {
            let (radius, height) = (length("radius", radius, problems), length("height", height, problems));
            Shape::Cone { radius, height, sectors: sectors(around, problems) }
        }
        ShapeDoc::Capsule { radius, height, sectors: around, stacks } => {
            let (radius, height) = (length("radius", radius, problems), length("height", height, problems));
            let (sectors, stacks) = (sectors(around, problems), count("stacks", of, stacks.as_ref(), 32, 2, problems));
            Shape::Capsule { radius, height, sectors, stacks }
        }
        ShapeDoc::Torus { radius, tube, sectors: around, stacks } => {
            let ring = length("radius", radius, problems);
            let thickness = problems.number(&format!("`tube` of {of}"), Some(tube), 0.5 * ring, SMALL..=FAR);
            if thickness >= ring {
                let message = format!("`tube` of {of} is {thickness}, and `radius` is {ring}");
                problems.add(Diagnostic::error("scene::bad-number", message).at(tube.span, "must be less than `radius`"));
            }
            let (sectors, stacks) = (sectors(around, problems), count("stacks", of, stacks.as_ref(), 32, 3, problems));
            Shape::Torus { radius: ring, tube: thickness, sectors, stacks }
        }
    }
}

fn count(field: &str, of: &str, value: Option<&Spanned<u32>>, default: u32, least: u32, problems: &mut Problems) -> u32 {
    let Some(value) = value else { return default };
    if (least..=MAX_SECTORS).contains(&value.value) {
        return value.value;
    }
    problems.add(
        Diagnostic::error("scene::bad-number", format!("`{field}` of {of} is {}", value.value))
            .at(value.span, format!("must lie between {least} and {MAX_SECTORS}")),
    );
    default
}

/// What tells shapes apart.
fn key(shape: Shape) -> [u32; 5] {
    let bits = f32::to_bits;
    match shape {
        Shape::Box(size) => [0, bits(size.x), bits(size.y), bits(size.z), 0],
        Shape::Sphere { radius, sectors, stacks } => [1, bits(radius), sectors, stacks, 0],
        Shape::Plane(size) => [2, bits(size.x), bits(size.y), 0, 0],
        Shape::Panel(size) => [3, bits(size.x), bits(size.y), 0, 0],
        Shape::Cylinder { radius, height, sectors } => [4, bits(radius), bits(height), sectors, 0],
        Shape::Cone { radius, height, sectors } => [5, bits(radius), bits(height), sectors, 0],
        Shape::Capsule { radius, height, sectors, stacks } => [6, bits(radius), bits(height), sectors, stacks],
        Shape::Torus { radius, tube, sectors, stacks } => [7, bits(radius), bits(tube), sectors, stacks],
    }
}

/// At most how many triangles the shape has.
fn triangles(shape: Shape) -> u64 {
    match shape {
        Shape::Box(_) => 12,
        Shape::Plane(_) | Shape::Panel(_) => 2,
        Shape::Cylinder { sectors, .. } => 4 * u64::from(sectors),
        Shape::Cone { sectors, .. } => 2 * u64::from(sectors),
        Shape::Sphere { sectors, stacks, .. } | Shape::Torus { sectors, stacks, .. } => 2 * u64::from(sectors) * u64::from(stacks),
        Shape::Capsule { sectors, stacks, .. } => 2 * u64::from(sectors) * u64::from(stacks + 2),
    }
}

fn build(name: &str, shape: Shape, material: usize) -> Mesh {
    match shape {
        Shape::Box(size) => primitive::cuboid(name, size, material),
        Shape::Sphere { radius, sectors, stacks } => primitive::sphere(name, radius, sectors, stacks, material),
        Shape::Plane(size) => primitive::plane(name, size, material),
        Shape::Panel(size) => primitive::panel(name, size, material),
        Shape::Cylinder { radius, height, sectors } => primitive::cylinder(name, radius, height, sectors, material),
        Shape::Cone { radius, height, sectors } => primitive::cone(name, radius, height, sectors, material),
        Shape::Capsule { radius, height, sectors, stacks } => primitive::capsule(name, radius, height, sectors, stacks, material),
        Shape::Torus { radius, tube, sectors, stacks } => primitive::torus(name, radius, tube, sectors, stacks, material),
    }
}
