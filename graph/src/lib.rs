//! From RON text to an executable plan of GPU passes, without a GPU.
//!
//! [`compile`] lists the steps; each stands in its own module with its own output type:
//! [`syntax`] -> [`validate`] -> [`expand`] -> [`reflect`] and [`bind`] -> [`schedule`] -> [`lifetime`] -> [`allocate`] ->
//! [`assemble`] -> [`plan`], which [`dump`] prints and an executor runs.
//!
//! Guarantees: the same text gives the same plan, byte for byte; everything wrong is reported at once, with its place; no input
//! can cause a panic. This crate depends on no GPU crate.

pub mod allocate;
pub mod assemble;
pub mod bind;
pub mod compile;
pub mod device;
pub mod diagnostic;
pub mod dirty;
pub mod dump;
pub mod execute;
pub mod expand;
pub mod expression;
pub mod format;
pub mod harness;
pub mod lifetime;
mod lists;
pub mod load;
mod mixer;
pub mod place;
pub mod plan;
pub mod published;
pub mod reflect;
pub mod schedule;
mod self_check;
pub mod source;
pub mod syntax;
pub mod validate;
