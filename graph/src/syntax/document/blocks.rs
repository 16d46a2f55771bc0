//! Documents made of other documents: blocks, their inputs, and what a pipeline that extends another changes in it.

use serde::Deserialize;

use super::{DimensionDoc, Entries, Expr, FormatDoc, ParamDoc, PassDoc, ResourceDoc, Text, ValueDoc};
use crate::syntax::spanned::Spanned;

/// A pipeline from another file that stands as a part of this one.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "Block", deny_unknown_fields)]
pub struct BlockDoc {
    /// For people.
    #[serde(default)]
    pub doc: Option<String>,
    /// Where it is written.
    pub file: Text,
    /// Stands only if this is true.
    #[serde(default)]
    pub when: Option<Expr>,
    /// Stands only if the scene has some of these.
    #[serde(default)]
    pub has: Option<Text>,
    /// Values of its parameters. A string is an expression over parameters of this file.
    #[serde(default)]
    pub params: Entries<Spanned<ValueDoc>>,
    /// What its inputs are, as references.
    #[serde(default)]
    pub inputs: Entries<Text>,
    /// What its outputs are while it does not stand, as references.
    #[serde(default)]
    pub otherwise: Entries<Text>,
    /// Passes that must come before all of its own.
    #[serde(default)]
    pub after: Vec<Text>,
}

/// What a block is given by whoever uses it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "Input", deny_unknown_fields)]
pub enum InputDoc {
    /// A texture, or a part of one.
    Texture {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
        /// 2D unless said otherwise.
        #[serde(default)]
        dimension: DimensionDoc,
        /// The formats that it may have; any unless said otherwise.
        #[serde(default)]
        format: Option<Spanned<FormatDoc>>,
    },
    /// A buffer.
    Buffer {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
    },
}

/// What a pipeline changes in another one, which it otherwise is.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "Extend", deny_unknown_fields)]
pub struct ExtendDoc {
    /// The other pipeline.
    pub file: Text,
    /// Entries that stand in place of the other's.
    #[serde(default)]
    pub replace: ReplaceDoc,
    /// Names of entries that are left out.
    #[serde(default)]
    pub remove: RemoveDoc,
    /// Passes that stand before a pass, by its name.
    #[serde(default)]
    pub before: Entries<Entries<PassDoc>>,
    /// Passes that stand behind a pass, by its name.
    #[serde(default)]
    pub after: Entries<Entries<PassDoc>>,
}

/// Entries that stand in place of others.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(rename = "Replace", deny_unknown_fields)]
#[allow(missing_docs)]
pub struct ReplaceDoc {
    #[serde(default)]
    pub params: Entries<ParamDoc>,
    #[serde(default)]
    pub resources: Entries<ResourceDoc>,
    #[serde(default)]
    pub blocks: Entries<BlockDoc>,
    /// By name, `loop.pass` or `block.pass`.
    #[serde(default)]
    pub passes: Entries<PassDoc>,
    #[serde(default)]
    pub outputs: Entries<Text>,
}

/// Names of entries that are left out.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(rename = "Remove", deny_unknown_fields)]
#[allow(missing_docs)]
pub struct RemoveDoc {
    #[serde(default)]
    pub params: Vec<Text>,
    #[serde(default)]
    pub resources: Vec<Text>,
    #[serde(default)]
    pub blocks: Vec<Text>,
    /// By name, `loop.pass` or `block.pass`.
    #[serde(default)]
    pub passes: Vec<Text>,
    #[serde(default)]
    pub outputs: Vec<Text>,
}
