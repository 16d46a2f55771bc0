//! What a scene file says, as its author wrote it, with places.
//!
//! Angles are in degrees, lengths in metres, colors linear Rec.709. Names are not resolved and numbers not checked here.

use luminaire_graph::syntax::document::{Entries, Text};
use luminaire_graph::syntax::spanned::Spanned;
use serde::Deserialize;

/// A number with its place.
pub type Number = Spanned<f32>;
/// Three numbers with their place.
pub type Vector = Spanned<(f32, f32, f32)>;

/// A whole scene file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneDoc {
    /// What it shows.
    #[serde(default)]
    pub doc: String,
    /// What surrounds it.
    #[serde(default)]
    pub environment: EnvironmentDoc,
    /// Materials that objects name.
    #[serde(default)]
    pub materials: Entries<MaterialDoc>,
    /// Cameras; the first is the default one.
    #[serde(default)]
    pub cameras: Entries<CameraDoc>,
    /// Lights.
    #[serde(default)]
    pub lights: Entries<LightDoc>,
    /// Boxes, spheres and planes.
    #[serde(default)]
    pub objects: Entries<ObjectDoc>,
    /// glTF files.
    #[serde(default)]
    pub files: Entries<FileDoc>,
}

/// What surrounds a scene.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnvironmentDoc {
    /// Radiance from all directions, nits; black unless said otherwise.
    #[serde(default)]
    pub sky_radiance: Option<Vector>,
}

/// A metallic-roughness material without textures.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialDoc {
    /// 0 to 1; (0.8, 0.8, 0.8) unless said otherwise.
    #[serde(default)]
    pub base_color: Option<Vector>,
    /// 0 to 1; below 1 the surface blends. 1 unless said otherwise.
    #[serde(default)]
    pub alpha: Option<Number>,
    /// 0 to 1; 0 unless said otherwise.
    #[serde(default)]
    pub metallic: Option<Number>,
    /// Perceptual, 0 to 1; 1 unless said otherwise.
    #[serde(default)]
    pub roughness: Option<Number>,
    /// Nits; black unless said otherwise.
    #[serde(default)]
    pub emissive: Option<Vector>,
    /// Strength of the dielectric reflection, 0 to 1; 1 unless said otherwise, 0 is purely diffuse.
    #[serde(default)]
    pub specular: Option<Number>,
    /// Tint of the dielectric reflection; white unless said otherwise.
    #[serde(default)]
    pub specular_color: Option<Vector>,
    /// Index of refraction; 1.5 unless said otherwise.
    #[serde(default)]
    pub ior: Option<Number>,
    /// Seen from both sides.
    #[serde(default)]
    pub double_sided: bool,
    /// Shown as its base color, takes no light.
    #[serde(default)]
    pub unlit: bool,
}

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
    /// Nothing nearer is seen; 1 cm unless said otherwise.
    #[serde(default)]
    pub near: Option<Number>,
    /// Exposure value at ISO 100; without it radiance is shown as it is.
    #[serde(default)]
    pub ev100: Option<Number>,
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
    },
}

/// A primitive. Exactly one of `material` and `surface`.
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
    /// Metres.
    #[serde(default)]
    pub translation: Option<Vector>,
    /// Degrees about x, then y, then z, all fixed axes.
    #[serde(default)]
    pub rotation: Option<Vector>,
    /// Along its own axes, before it is turned.
    #[serde(default)]
    pub scale: Option<Vector>,
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
}
