//! From RON text to an executable plan of GPU passes, without a GPU.
pub mod diagnostic;
pub mod source;
