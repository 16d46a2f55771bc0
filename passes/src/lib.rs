//! Runs plans of `luminaire-graph` on wgpu.
//!
//! [`device`] opens a GPU, [`executor`] prepares a plan on it and renders frames. One file per pass kind (`draw`, `fullscreen`,
//! `compute`, `copy`, `clear`) says how a step is prepared and encoded; the files beside them make what steps share.
//!
//! Every error of wgpu comes back as a diagnostic; none panics.

mod backend;
mod bind_groups;
mod check;
mod clear;
mod compute;
mod convert;
mod copy;
pub mod device;
mod draw;
mod errors;
pub mod executor;
pub mod facts;
mod fullscreen;
mod image;
mod kept;
mod layouts;
mod pipelines;
pub mod poison;
mod procedural;
mod readback;
mod remember;
mod revisions;
mod samplers;
mod scene_check;
mod scene_data;
mod store;
mod targets;
mod texel;
mod textures;
pub mod timing;

pub use device::{Adapter, Gpu, GpuOptions};
pub use executor::{Executor, FrameStats};
pub use readback::ReadImage;
