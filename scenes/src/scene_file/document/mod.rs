//! What a scene file says, as its author wrote it, with places.
//!
//! Angles are in degrees, lengths in metres, colors linear Rec.709. Names are not resolved and numbers not checked here.

mod motion;
mod nodes;
mod timeline;

pub use motion::*;
pub use nodes::*;
pub use timeline::*;

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
    /// Nodes that hold others and show nothing themselves.
    #[serde(default)]
    pub groups: Entries<GroupDoc>,
    /// Cameras; the first is the default one.
    #[serde(default)]
    pub cameras: Entries<CameraDoc>,
    /// Lights.
    #[serde(default)]
    pub lights: Entries<LightDoc>,
    /// Primitives.
    #[serde(default)]
    pub objects: Entries<ObjectDoc>,
    /// glTF files.
    #[serde(default)]
    pub files: Entries<FileDoc>,
    /// Places that techniques use: grids of probes, reflection probes, boxes.
    #[serde(default)]
    pub markers: Entries<MarkerDoc>,
    /// What changes, and when.
    #[serde(default)]
    pub timeline: Vec<EventDoc>,
}

/// What surrounds a scene.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnvironmentDoc {
    /// Radiance from all directions, nits; black unless said otherwise.
    #[serde(default)]
    pub sky_radiance: Option<Vector>,
    /// An equirectangular file (.hdr, .exr, .png or .jpg) whose radiance is added to that.
    #[serde(default)]
    pub image: Option<Text>,
    /// Six files instead of one, for the faces of a cube: +X -X +Y -Y +Z -Z.
    #[serde(default)]
    pub faces: Vec<Text>,
    /// Degrees by which the image is turned about +Y; 0 unless said otherwise.
    #[serde(default)]
    pub rotation: Option<Number>,
    /// Factor on the image's radiance; 1 unless said otherwise.
    #[serde(default)]
    pub strength: Option<Number>,
    /// Lux: a point or spot light without a range ends where it gives less; a thousandth unless said otherwise, 0 is never.
    #[serde(default)]
    pub least_illuminance: Option<Number>,
}

/// A metallic-roughness material without textures, or changes of one that a file brings.
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
    /// Seen from both sides; not unless said otherwise.
    #[serde(default)]
    pub double_sided: Option<bool>,
    /// Shown as its base color, takes no light; not unless said otherwise.
    #[serde(default)]
    pub unlit: Option<bool>,
}
