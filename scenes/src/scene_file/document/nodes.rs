//! What stands in a scene, as its author wrote it: groups, cameras, lights, primitives, files and markers.
//!
//! A little longer than others, since every field has its documentation.

use luminaire_graph::syntax::document::{Entries, Text};
use luminaire_graph::syntax::spanned::Spanned;
use serde::Deserialize;

use super::{AnimationDoc, ControllerDoc, MaterialDoc, Number, PathDoc, Vector};

/// A camera; +Y is up.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraDoc {
    /// Where it stands.
    pub position: Vector,
    /// What it looks at.
    pub target: Vector,
    /// Vertical field of view, degrees; 45 unless said otherwise.
    #[serde(default)]
    pub fov: Option<Number>,
    /// Height of what is seen, metres: makes it orthographic. Not together with `fov`.
    #[serde(default)]
    pub ortho: Option<Number>,
    /// Nothing nearer is seen; 1 cm unless said otherwise.
    #[serde(default)]
    pub near: Option<Number>,
    /// Nothing farther is seen; infinitely far in perspective, and 1000 m orthographic, unless said otherwise.
    #[serde(default)]
    pub far: Option<Number>,
    /// Exposure value at ISO 100; without it radiance is shown as it is.
    #[serde(default)]
    pub ev100: Option<Number>,
    /// Factor on radiance, instead of `ev100`.
    #[serde(default)]
    pub exposure: Option<Number>,
    /// Travels by itself.
    #[serde(default)]
    pub path: Option<PathDoc>,
    /// Obeys commands.
    #[serde(default)]
    pub controller: Option<ControllerDoc>,
    /// The node whose space it stands in; the world unless said otherwise.
    #[serde(default)]
    pub parent: Option<Text>,
}

/// A light.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum LightDoc {
    /// From infinitely far away.
    Directional {
        /// Illuminance of a surface that faces it.
        lux: Number,
        /// Where the light goes; any length.
        direction: Vector,
        /// White unless said otherwise.
        #[serde(default)]
        color: Option<Vector>,
        /// The node whose space it stands in; the world unless said otherwise.
        #[serde(default)]
        parent: Option<Text>,
    },
    /// From a point in all directions.
    Point {
        /// Luminous intensity.
        candela: Number,
        /// Where it stands.
        position: Vector,
        /// White unless said otherwise.
        #[serde(default)]
        color: Option<Vector>,
        /// Where its light ends; inverse square without end unless said otherwise.
        #[serde(default)]
        range: Option<Number>,
        /// The node whose space it stands in; the world unless said otherwise.
        #[serde(default)]
        parent: Option<Text>,
    },
    /// From a point in a cone.
    Spot {
        /// Luminous intensity on the axis.
        candela: Number,
        /// Where it stands.
        position: Vector,
        /// Where the light goes; any length.
        direction: Vector,
        /// Half angle of the cone at full strength, degrees; 0 unless said otherwise.
        #[serde(default)]
        inner: Option<Number>,
        /// Half angle at which light ends, degrees, at most 90.
        outer: Number,
        /// White unless said otherwise.
        #[serde(default)]
        color: Option<Vector>,
        /// Where its light ends; inverse square without end unless said otherwise.
        #[serde(default)]
        range: Option<Number>,
        /// The node whose space it stands in; the world unless said otherwise.
        #[serde(default)]
        parent: Option<Text>,
    },
    /// From a glowing rectangle, which is seen, too.
    Rectangle {
        /// Nits, the same in all directions.
        luminance: Number,
        /// Width and height, metres.
        size: Spanned<(f32, f32)>,
        /// Its middle.
        position: Vector,
        /// Where its front faces; any length.
        direction: Vector,
        /// White unless said otherwise.
        #[serde(default)]
        color: Option<Vector>,
        /// Glows to the back as well; not unless said otherwise.
        #[serde(default)]
        two_sided: bool,
        /// The node whose space it stands in; the world unless said otherwise.
        #[serde(default)]
        parent: Option<Text>,
    },
}

/// A primitive. Exactly one of `material`, `surface` and the repetition's `materials`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectDoc {
    /// Its shape, around the origin.
    pub shape: ShapeDoc,
    /// The name of a material.
    #[serde(default)]
    pub material: Option<Text>,
    /// A material of its own.
    #[serde(default)]
    pub surface: Option<MaterialDoc>,
    /// Stands many times on a grid around its place.
    #[serde(default)]
    pub repeat: Option<RepeatDoc>,
    /// Metres.
    #[serde(default)]
    pub translation: Option<Vector>,
    /// Degrees about x, then y, then z, all fixed axes.
    #[serde(default)]
    pub rotation: Option<Vector>,
    /// Along its own axes, before it is turned.
    #[serde(default)]
    pub scale: Option<Vector>,
    /// The node whose space it stands in; the world unless said otherwise.
    #[serde(default)]
    pub parent: Option<Text>,
}

/// The shape of a primitive.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ShapeDoc {
    /// A box.
    Box {
        /// Edges along x, y and z.
        size: Vector,
    },
    /// A sphere.
    Sphere {
        /// Metres.
        radius: Number,
        /// Around the y axis; 64 unless said otherwise.
        #[serde(default)]
        sectors: Option<Spanned<u32>>,
        /// From pole to pole; 32 unless said otherwise.
        #[serde(default)]
        stacks: Option<Spanned<u32>>,
    },
    /// A rectangle that faces +Y.
    Plane {
        /// Edges along x and z.
        size: Spanned<(f32, f32)>,
    },
    /// A closed cylinder along the y axis.
    Cylinder {
        /// Metres.
        radius: Number,
        /// Metres.
        height: Number,
        /// Around the y axis; 64 unless said otherwise.
        #[serde(default)]
        sectors: Option<Spanned<u32>>,
    },
    /// A closed cone along the y axis, its tip at the top.
    Cone {
        /// Of its base, metres.
        radius: Number,
        /// Metres.
        height: Number,
        /// Around the y axis; 64 unless said otherwise.
        #[serde(default)]
        sectors: Option<Spanned<u32>>,
    },
    /// A cylinder along the y axis between two half spheres.
    Capsule {
        /// Metres.
        radius: Number,
        /// Between the middles of the half spheres, metres.
        height: Number,
        /// Around the y axis; 64 unless said otherwise.
        #[serde(default)]
        sectors: Option<Spanned<u32>>,
        /// From pole to pole; 32 unless said otherwise.
        #[serde(default)]
        stacks: Option<Spanned<u32>>,
    },
    /// A ring around the y axis.
    Torus {
        /// From the middle of the ring to the middle of its tube, metres.
        radius: Number,
        /// Radius of the tube, metres; less than `radius`.
        tube: Number,
        /// Around the y axis; 64 unless said otherwise.
        #[serde(default)]
        sectors: Option<Spanned<u32>>,
        /// Around the tube; 32 unless said otherwise.
        #[serde(default)]
        stacks: Option<Spanned<u32>>,
    },
}

/// Copies on a grid whose middle is the object's place.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RepeatDoc {
    /// Copies along x, y and z.
    pub count: Spanned<(u32, u32, u32)>,
    /// From copy to copy along x, y and z, metres.
    pub spacing: Vector,
    /// Names of materials, one after the other along each axis.
    #[serde(default)]
    pub materials: Vec<Text>,
}

/// A node that holds others and shows nothing itself.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroupDoc {
    /// Metres.
    #[serde(default)]
    pub translation: Option<Vector>,
    /// Degrees about x, then y, then z, all fixed axes.
    #[serde(default)]
    pub rotation: Option<Vector>,
    /// Along its own axes, before it is turned.
    #[serde(default)]
    pub scale: Option<Vector>,
    /// The node whose space it stands in; the world unless said otherwise.
    #[serde(default)]
    pub parent: Option<Text>,
}

/// A glTF file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileDoc {
    /// Relative to the scene file, with `/`.
    pub path: Text,
    /// Metres.
    #[serde(default)]
    pub translation: Option<Vector>,
    /// Degrees about x, then y, then z, all fixed axes.
    #[serde(default)]
    pub rotation: Option<Vector>,
    /// Along its own axes, before it is turned.
    #[serde(default)]
    pub scale: Option<Vector>,
    /// The node whose space it stands in; the world unless said otherwise.
    #[serde(default)]
    pub parent: Option<Text>,
    /// Changes of materials that the file brings, by their names in the file. What is not named stays.
    #[serde(default)]
    pub materials: Entries<MaterialDoc>,
    /// How its animations play; the first one in a loop unless said otherwise.
    #[serde(default)]
    pub animation: Option<AnimationDoc>,
}

/// A place that techniques use. It shows nothing.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum MarkerDoc {
    /// Probes for diffuse light on a grid.
    ProbeVolume {
        /// The middle of the grid.
        center: Vector,
        /// Probes along x, y and z.
        counts: Spanned<(u32, u32, u32)>,
        /// From probe to probe along x, y and z, metres.
        spacing: Vector,
        /// The node whose space it stands in; the world unless said otherwise.
        #[serde(default)]
        parent: Option<Text>,
    },
    /// A probe for reflections.
    ReflectionProbe {
        /// Where it is captured.
        position: Vector,
        /// Edges of the box around it in which it counts, metres.
        size: Vector,
        /// Nothing nearer is captured; 10 cm unless said otherwise.
        #[serde(default)]
        near: Option<Number>,
        /// Nothing farther is captured; 100 m unless said otherwise.
        #[serde(default)]
        far: Option<Number>,
        /// The node whose space it stands in; the world unless said otherwise.
        #[serde(default)]
        parent: Option<Text>,
    },
    /// A box.
    BoxVolume {
        /// Its middle.
        center: Vector,
        /// Edges, metres.
        size: Vector,
        /// The node whose space it stands in; the world unless said otherwise.
        #[serde(default)]
        parent: Option<Text>,
    },
}
