//! Scenes: the world, its loaders, and what it publishes to passes.
//!
//! A file becomes an [`asset::Asset`] or a scene document; both are spawned into a `bevy_ecs` [`world`]; [`publish`] turns the
//! world into the tables, textures and draw lists that shaders ask for by name. Nothing here knows a GPU or a pipeline.

pub mod asset;
pub mod describe;
pub mod gltf;
pub mod linear_image;
pub mod primitive;
pub mod publish;
pub mod scene_file;
mod timeline;
pub mod world;

pub use scene_file::{LoadedScene, load_scene, load_scene_text};
pub use world::{World, set_translation};
