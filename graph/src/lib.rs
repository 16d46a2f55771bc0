//! From RON text to an executable plan of GPU passes, without a GPU.
pub mod allocate;
pub mod assemble;
pub mod bind;
pub mod device;
pub mod diagnostic;
pub mod dump;
pub mod expand;
pub mod expression;
pub mod format;
pub mod lifetime;
pub mod plan;
pub mod published;
pub mod reflect;
pub mod schedule;
mod self_check;
pub mod source;
pub mod syntax;
pub mod validate;
