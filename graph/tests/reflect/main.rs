//! Reflection of WGSL: interfaces of shaders in memory, and exact places of everything that can be wrong with them.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod errors;
mod hostile;
mod imports;
mod interface;
mod reads;
mod stages;
mod support;
