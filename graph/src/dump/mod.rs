//! Plans as text, JSON and Graphviz.
//!
//! All three are outputs in their own right: the same plan gives the same bytes, and nothing comes out in the order of a hash map.

mod describe;
mod dot;
mod json;
mod steps;
mod text;
pub(crate) mod units;

pub use dot::dot;
pub use json::json;
pub use text::text;
