//! Scene files: RON that names glTF files, primitives, materials, lights, cameras, markers, the sky, and what changes in time.
//! `scenes/README.md` is the reference of the language.
//!
//! `load` takes the steps: a text becomes a [`SceneDoc`], `check` makes declarations of it, `assets` loads the files that it names,
//! `names` and `events` find the nodes that are meant, `spawn` puts them into the world.
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
mod size;
mod sky;
mod spawn;

#[cfg(test)]
mod tests;

pub(crate) use assets::UsedFile;
pub(crate) use check::{Declaration, Kind, Play, glow};
pub(crate) use checks::rotation_of;
pub use document::{
    ActionDoc, AgainDoc, AnimationDoc, CameraDoc, ControllerDoc, EaseDoc, EnvironmentDoc, EventDoc, FileDoc, GroupDoc, KeyDoc, LightDoc,
    MarkerDoc, MaterialDoc, Number, ObjectDoc, PathDoc, RepeatDoc, SceneDoc, Seconds, ShapeDoc, Vector,
};
pub use load::{LoadedScene, load_scene, load_scene_text};
pub(crate) use spawn::{Spawned, play_clip, spawn};
