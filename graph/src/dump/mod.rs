//! Plans as text, JSON, Graphviz and a page for a browser.
//!
//! All are outputs in their own right: the same plan gives the same bytes, and nothing comes out in the order of a hash map.

mod describe;
mod dot;
mod explain;
mod html;
mod json;
mod steps;
mod text;
pub(crate) mod units;

pub(crate) use describe::sharers;
pub use dot::dot;
pub(crate) use explain::input_name;
pub use explain::{explain_json, explain_text};
pub use html::html;
pub use json::json;
pub use text::text;
