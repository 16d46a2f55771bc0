//! The document types: what a pipeline file says, as the author wrote it, with places.
//!
//! Names are not resolved and expressions not evaluated here; nothing later edits a document. Every type also reads with the
//! `ron` crate (extensions `implicit_some` and `unwrap_newtypes`), which is the oracle of the reader.

mod blocks;
mod passes;
mod resources;

pub use blocks::*;
pub use passes::*;
pub use resources::*;

use indexmap::IndexMap;
use serde::Deserialize;

use super::spanned::Spanned;

/// A name, an expression or a reference, with its place.
pub type Text = Spanned<String>;
/// An ordered map from names to entries.
pub type Entries<T> = IndexMap<Text, T>;

/// A whole pipeline file, or a block.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "Pipeline", deny_unknown_fields)]
pub struct Document {
    /// What the pipeline computes, from which source, and its limits.
    pub doc: String,
    /// The pipeline that this one changes.
    #[serde(default)]
    pub extend: Option<Box<ExtendDoc>>,
    /// What a user may set.
    #[serde(default)]
    pub params: Entries<ParamDoc>,
    /// What a block is given.
    #[serde(default)]
    pub inputs: Entries<InputDoc>,
    /// Parts that stand in files of their own.
    #[serde(default)]
    pub blocks: Entries<BlockDoc>,
    /// Textures and buffers.
    #[serde(default)]
    pub resources: Entries<ResourceDoc>,
    /// Passes and loops over passes.
    #[serde(default)]
    pub passes: Entries<PassDoc>,
    /// The results, by the names under which users ask for them.
    #[serde(default)]
    pub outputs: Entries<Text>,
    /// MiB that content may take which is kept from frame to frame though it could be made again; without limit unless said.
    #[serde(default)]
    pub retained_budget: Option<Expr>,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "Param", deny_unknown_fields)]
pub struct ParamDoc {
    /// Its value unless set; also decides its type.
    pub default: Spanned<ValueDoc>,
    /// Smallest and largest value, both allowed. For numbers only.
    #[serde(default)]
    pub range: Option<Spanned<(ValueDoc, ValueDoc)>>,
    /// The allowed words, if the default is a string. A shader sees the index of the word.
    #[serde(default)]
    pub options: Option<Spanned<Vec<String>>>,
    /// Only powers of two are allowed. For whole numbers only.
    #[serde(default)]
    pub power_of_two: Option<Spanned<bool>>,
    /// It is expected to change while frames are rendered.
    #[serde(default)]
    pub live: bool,
    /// For people: `m`, `texels`, `EV`.
    #[serde(default)]
    pub unit: Option<String>,
    /// What it does.
    #[serde(default)]
    pub doc: String,
}

/// A literal value.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum ValueDoc {
    /// `true`, `false`.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// A number with a point.
    Float(f64),
    /// A word out of `options`.
    Word(String),
    /// Two to four numbers.
    Vector(Vec<f64>),
}

/// A number, or an expression over parameters as a string.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum ExprDoc {
    /// `128`
    Int(i64),
    /// `0.5`
    Float(f64),
    /// `"resolution / 2"`
    Text(String),
}

/// An expression with its place.
pub type Expr = Spanned<ExprDoc>;
