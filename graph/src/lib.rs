//! From RON text to an executable plan of GPU passes, without a GPU.
pub mod bind;
pub mod device;
pub mod diagnostic;
pub mod execute;
pub mod expand;
pub mod format;
pub mod plan;
pub mod published;
pub mod reflect;
pub mod source;
pub mod syntax;
