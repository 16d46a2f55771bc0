//! placeholder
pub mod asset;
pub mod gltf;
