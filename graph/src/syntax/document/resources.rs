//! Textures, images and buffers of a document.

use std::sync::Arc;

use serde::Deserialize;

use super::{Expr, Text};
use crate::source::LoadedImage;
use crate::syntax::spanned::Spanned;

/// A texture, an image or a buffer.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "Resource", deny_unknown_fields)]
#[allow(clippy::large_enum_variant, reason = "buffers are few; a box would only burden the reader")]
pub enum ResourceDoc {
    /// Texels.
    Texture {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
        /// 2D unless said otherwise.
        #[serde(default)]
        dimension: DimensionDoc,
        /// One of WebGPU's format names, a parameter whose options are some, or a list of either in order of preference.
        format: Spanned<FormatDoc>,
        /// The output's size unless said otherwise.
        #[serde(default)]
        size: Spanned<SizeDoc>,
        /// Array layers, or cubes; 1 unless said otherwise.
        #[serde(default)]
        layers: Option<Expr>,
        /// 1 unless said otherwise.
        #[serde(default)]
        mips: Option<Spanned<MipsDoc>>,
        /// 1 or 4.
        #[serde(default)]
        samples: Option<Expr>,
        /// The value of parts that nothing produced, and of texels that a pass may leave out.
        #[serde(default)]
        clear: Option<Spanned<ClearDoc>>,
        /// How `previous(..)` of it begins.
        #[serde(default)]
        history: Option<Spanned<HistoryDoc>>,
        /// Whether its content is kept from frame to frame.
        #[serde(default)]
        keep: Option<Spanned<KeepDoc>>,
    },
    /// A 2D texture that holds what a file says, and that no pass writes.
    Image {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
        /// Looked up where shaders are.
        file: Text,
        /// One of WebGPU's format names.
        format: Text,
        /// What the file holds, once it has been read.
        #[serde(skip)]
        loaded: Option<Arc<LoadedImage>>,
    },
    /// Bytes.
    Buffer {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
        /// Bytes, a multiple of 4.
        size: Expr,
        /// `Zero`, or nothing.
        #[serde(default)]
        clear: Option<Spanned<ClearDoc>>,
        /// How `previous(..)` of it begins.
        #[serde(default)]
        history: Option<Spanned<HistoryDoc>>,
        /// Whether its content is kept from frame to frame.
        #[serde(default)]
        keep: Option<Spanned<KeepDoc>>,
    },
}

/// The shape of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename = "Dimension")]
pub enum DimensionDoc {
    /// A line of texels.
    D1,
    /// An image.
    #[default]
    D2,
    /// A volume.
    D3,
    /// Six square faces, in WebGPU's order +X -X +Y -Y +Z -Z.
    Cube,
}

/// One format or several in order of preference.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum FormatDoc {
    /// `"rgba16float"`
    One(String),
    /// `["rg11b10ufloat", "rgba16float"]`
    FirstOf(Vec<String>),
}

impl FormatDoc {
    /// All that it names.
    pub fn names(&self) -> &[String] {
        match self {
            FormatDoc::One(name) => std::slice::from_ref(name),
            FormatDoc::FirstOf(names) => names,
        }
    }
}

/// The extent of a texture.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(rename = "Size")]
pub enum SizeDoc {
    /// As large as the rendered image.
    #[default]
    Output,
    /// The rendered image times a factor, rounded up.
    Scaled(Expr),
    /// Width of a 1D texture.
    Line(Expr),
    /// Width and height alike.
    Square(Expr),
    /// Width and height.
    Exact(Expr, Expr),
    /// Width, height and depth alike.
    Cube(Expr),
    /// Width, height and depth.
    Volume(Expr, Expr, Expr),
}

/// How many mip levels.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "Mips")]
pub enum MipsDoc {
    /// Down to one texel.
    Full,
    /// So many.
    Count(Expr),
}

/// A value to clear to.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename = "Clear")]
pub enum ClearDoc {
    /// All bits zero.
    Zero,
    /// Red, green, blue, alpha; linear.
    Color(f64, f64, f64, f64),
    /// Depth, 0 to 1.
    Depth(f64),
    /// For integer formats.
    Uint(u32, u32, u32, u32),
}

/// How the past of a resource begins.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename = "History", deny_unknown_fields)]
pub struct HistoryDoc {
    /// The value where there is no past; the declared value or zero unless said otherwise.
    #[serde(default)]
    pub first: Option<ClearDoc>,
    /// What happens where the resource had another extent.
    #[serde(default)]
    pub on_resize: OnResizeDoc,
}

/// What a history holds after its resource changed its extent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename = "OnResize")]
pub enum OnResizeDoc {
    /// Its first value.
    #[default]
    First,
    /// What both extents have; elsewhere its first value.
    Crop,
}

/// Whether content that could be made again is kept from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename = "Keep")]
pub enum KeepDoc {
    /// The compiler decides.
    Auto,
    /// Kept.
    Always,
    /// Made again when it is needed.
    Never,
}
