//! What changes in a scene, and when, as its author wrote it.

use luminaire_graph::syntax::document::{Entries, Text};
use luminaire_graph::syntax::spanned::Spanned;
use serde::Deserialize;

use super::{AgainDoc, FileDoc, GroupDoc, LightDoc, Number, ObjectDoc, Vector};

/// Seconds with their place.
pub type Seconds = Spanned<f64>;

/// One change.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EventDoc {
    /// When it begins, seconds.
    pub at: Seconds,
    /// What changes.
    #[serde(rename = "do")]
    pub action: ActionDoc,
}

/// What changes. Values go from what they are to what is written here within `during` seconds; at once unless said otherwise.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ActionDoc {
    /// A node goes to a place.
    Move {
        /// Which.
        node: Text,
        /// In its parent's space, metres.
        to: Vector,
        /// Seconds.
        #[serde(default)]
        during: Option<Seconds>,
        /// How it begins and ends.
        #[serde(default)]
        ease: EaseDoc,
    },
    /// A node turns to an orientation, by the shortest way.
    Rotate {
        /// Which.
        node: Text,
        /// Degrees about x, then y, then z, all fixed axes.
        to: Vector,
        /// Seconds.
        #[serde(default)]
        during: Option<Seconds>,
        /// How it begins and ends.
        #[serde(default)]
        ease: EaseDoc,
    },
    /// A node turns by angles, which may be more than a whole turn.
    Turn {
        /// Which.
        node: Text,
        /// Degrees about x, then y, then z, the axes of its parent.
        by: Vector,
        /// Seconds.
        #[serde(default)]
        during: Option<Seconds>,
        /// How it begins and ends.
        #[serde(default)]
        ease: EaseDoc,
    },
    /// A node gets another size.
    Scale {
        /// Which.
        node: Text,
        /// Along its own axes.
        to: Vector,
        /// Seconds.
        #[serde(default)]
        during: Option<Seconds>,
        /// How it begins and ends.
        #[serde(default)]
        ease: EaseDoc,
    },
    /// A light changes.
    Light {
        /// Which.
        light: Text,
        /// In the light's unit: lux, candela or nits.
        #[serde(default)]
        intensity: Option<Number>,
        /// Its colour.
        #[serde(default)]
        color: Option<Vector>,
        /// Seconds.
        #[serde(default)]
        during: Option<Seconds>,
        /// How it begins and ends.
        #[serde(default)]
        ease: EaseDoc,
    },
    /// A camera changes.
    Camera {
        /// Which.
        camera: Text,
        /// Exposure value at ISO 100, for a camera that has one.
        #[serde(default)]
        ev100: Option<Number>,
        /// Factor on radiance, for a camera that has one.
        #[serde(default)]
        exposure: Option<Number>,
        /// Vertical field of view, degrees, for a perspective camera.
        #[serde(default)]
        fov: Option<Number>,
        /// Seconds.
        #[serde(default)]
        during: Option<Seconds>,
        /// How it begins and ends.
        #[serde(default)]
        ease: EaseDoc,
    },
    /// A file plays an animation, from its beginning.
    Animate {
        /// Which.
        file: Text,
        /// By its name in the file, or its number from 0; the first unless said otherwise.
        #[serde(default)]
        clip: Option<Text>,
        /// Seconds of the clip in a second; 1 unless said otherwise.
        #[serde(default)]
        speed: Option<Number>,
        /// What comes after its end.
        #[serde(default)]
        again: AgainDoc,
    },
    /// The sky changes.
    Sky {
        /// Nits.
        radiance: Vector,
        /// Seconds.
        #[serde(default)]
        during: Option<Seconds>,
        /// How it begins and ends.
        #[serde(default)]
        ease: EaseDoc,
    },
    /// A material changes, wherever it is used.
    Material {
        /// A name in `materials`, an object with a `surface` of its own, or `file/material`.
        material: Text,
        /// 0 to 1.
        #[serde(default)]
        base_color: Option<Vector>,
        /// 0 to 1.
        #[serde(default)]
        metallic: Option<Number>,
        /// 0 to 1.
        #[serde(default)]
        roughness: Option<Number>,
        /// Nits.
        #[serde(default)]
        emissive: Option<Vector>,
        /// 0 to 1.
        #[serde(default)]
        specular: Option<Number>,
        /// Seconds.
        #[serde(default)]
        during: Option<Seconds>,
        /// How it begins and ends.
        #[serde(default)]
        ease: EaseDoc,
    },
    /// New nodes appear. Their names may be those of removed ones.
    Spawn {
        /// As in the scene.
        #[serde(default)]
        groups: Entries<GroupDoc>,
        /// As in the scene.
        #[serde(default)]
        lights: Entries<LightDoc>,
        /// As in the scene.
        #[serde(default)]
        objects: Entries<ObjectDoc>,
        /// As in the scene.
        #[serde(default)]
        files: Entries<FileDoc>,
    },
    /// A node disappears, and all that stands below it.
    Remove {
        /// Which.
        node: Text,
    },
    /// A node is not seen any more, nor anything below it: no shadows, no light. It stays where it is.
    Hide {
        /// Which.
        node: Text,
    },
    /// What was hidden is seen again, unless something above it is hidden.
    Show {
        /// Which.
        node: Text,
    },
    /// A node gets another parent. What moves it ends.
    Reparent {
        /// Which.
        node: Text,
        /// The new parent; the world unless said otherwise.
        #[serde(default)]
        parent: Option<Text>,
        /// It stays where it is in the world (else it keeps its place beside its parent); yes unless said otherwise.
        #[serde(default)]
        keep_place: Option<bool>,
    },
}

/// How a change goes on between its beginning and its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
pub enum EaseDoc {
    /// Evenly.
    #[default]
    Linear,
    /// Slowly at both ends: 3t^2 - 2t^3.
    Smooth,
    /// Slowly at the beginning: t^2.
    In,
    /// Slowly at the end: 1 - (1 - t)^2.
    Out,
    /// Not at all until the end.
    Hold,
}
