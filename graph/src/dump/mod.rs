//! Plans as text, JSON and Graphviz.
pub(crate) mod units;
