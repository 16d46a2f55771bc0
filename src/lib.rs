//! Luminaire renders global illumination from pipelines written as RON text.
//!
//! This crate is the facade and the command line: it joins the planner ([`graph`]), the executor ([`passes`]) and the scenes
//! ([`scenes`]), finds files, and writes images.

pub mod cli;
pub mod files;
pub mod image_file;
pub mod ron_kind;
pub mod session;
pub mod watch;

pub use luminaire_graph as graph;
pub use luminaire_passes as passes;
pub use luminaire_scenes as scenes;
