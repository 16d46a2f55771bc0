//! Scene files: RON that names glTF files, primitives, materials, lights, cameras and the sky.
//!
//! ```ron
//! (
//!     doc: "A red ball on a floor under the sun.",
//!     environment: (sky_radiance: (900.0, 1200.0, 1700.0)),
//!     materials: { "red": (base_color: (0.7, 0.05, 0.05), roughness: 0.3) },
//!     cameras: { "main": (position: (0, 1.5, 4), target: (0, 0.5, 0), fov: 40, ev100: 14) },
//!     lights: { "sun": Directional(lux: 100000, direction: (-1, -2, -1)) },
//!     objects: {
//!         "ball": (shape: Sphere(radius: 0.5), material: "red", translation: (0, 0.5, 0)),
//!         "floor": (shape: Plane(size: (10, 10)), surface: (base_color: (0.5, 0.5, 0.5))),
//!     },
//!     files: { "chair": (path: "chair/chair.gltf", translation: (1, 0, 0), rotation: (0, 30, 0)) },
//! )
//! ```
//!
//! Guarantees: everything wrong with a file is reported at once, with its place; what is accepted is finite and in range. Cameras of
//! the scene file come before those of its glTF files. A glTF file by itself is a scene, too.
//! Accepted downside: materials of a scene file have no textures.

mod assets;
mod check;
mod checks;
mod default_light;
mod document;
mod events;
mod load;
mod names;
mod spawn;

#[cfg(test)]
mod tests;

pub(crate) use check::{Declaration, Kind, glow};
pub(crate) use checks::rotation_of;
pub use document::{
    ActionDoc, CameraDoc, EaseDoc, EnvironmentDoc, EventDoc, FileDoc, GroupDoc, LightDoc, MarkerDoc, MaterialDoc, Number, ObjectDoc,
    RepeatDoc, SceneDoc, Seconds, ShapeDoc, Vector,
};
pub use load::{LoadedScene, load_scene, load_scene_text};
pub(crate) use spawn::{Spawned, spawn};
