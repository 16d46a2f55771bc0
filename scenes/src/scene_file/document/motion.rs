//! What moves by itself, as its author wrote it: animations of files, camera paths and controllers.

use luminaire_graph::syntax::document::Text;
use serde::Deserialize;

use super::{Number, Seconds, Vector};

/// How a glTF file's animations play.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AnimationDoc {
    /// By its name in the file, or its number from 0; the first unless said otherwise.
    #[serde(default)]
    pub clip: Option<Text>,
    /// Seconds of the clip in a second; negative plays backwards. 1 unless said otherwise.
    #[serde(default)]
    pub speed: Option<Number>,
    /// When it begins, seconds; when the file appears unless said otherwise.
    #[serde(default)]
    pub start: Option<Seconds>,
    /// What comes after its end.
    #[serde(default)]
    pub again: AgainDoc,
}

/// What comes after the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
pub enum AgainDoc {
    /// Nothing: it stays at its end.
    Once,
    /// The beginning.
    #[default]
    Loop,
    /// The same backwards, and so on.
    PingPong,
}

/// How a camera travels.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathDoc {
    /// Where it is when.
    pub keys: Vec<KeyDoc>,
    /// Straight from key to key; else on a smooth curve.
    #[serde(default)]
    pub straight: bool,
    /// What comes after the last key.
    #[serde(default)]
    pub again: AgainDoc,
}

/// Where a camera is at a time.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeyDoc {
    /// Seconds, later than the key before.
    pub at: Seconds,
    /// Where it stands.
    pub position: Vector,
    /// What it looks at.
    pub target: Vector,
    /// Vertical field of view, degrees; the camera's own if no key has one.
    #[serde(default)]
    pub fov: Option<Number>,
    /// Exposure value; the camera's own if no key has one.
    #[serde(default)]
    pub ev100: Option<Number>,
}

/// How a camera obeys commands of keys and a mouse.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ControllerDoc {
    /// It goes where it looks.
    Fly {
        /// Metres per second; 3 unless said otherwise.
        #[serde(default)]
        speed: Option<Number>,
        /// Degrees per second; 57.3 unless said otherwise.
        #[serde(default)]
        turn: Option<Number>,
    },
    /// It goes around its target.
    Orbit {
        /// Degrees per second; 57.3 unless said otherwise.
        #[serde(default)]
        turn: Option<Number>,
        /// Smallest distance to the target, metres; 1 cm unless said otherwise.
        #[serde(default)]
        nearest: Option<Number>,
        /// Largest distance to the target, metres; 10 km unless said otherwise.
        #[serde(default)]
        farthest: Option<Number>,
    },
}
