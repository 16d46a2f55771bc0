//! The document types: what a pipeline file says, as the author wrote it, with places.
//!
//! Names are not resolved and expressions not evaluated here; nothing later edits a document. Every type also reads with the
//! `ron` crate (extensions `implicit_some` and `unwrap_newtypes`), which is the oracle of the reader.

use indexmap::IndexMap;
use serde::Deserialize;

use super::spanned::Spanned;

/// A name, an expression or a reference, with its place.
pub type Text = Spanned<String>;
/// An ordered map from names to entries.
pub type Entries<T> = IndexMap<Text, T>;

/// A whole pipeline file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "Pipeline", deny_unknown_fields)]
pub struct Document {
    /// What the pipeline computes, from which source, and its limits.
    pub doc: String,
    /// What a user may set.
    #[serde(default)]
    pub params: Entries<ParamDoc>,
    /// Textures and buffers.
    #[serde(default)]
    pub resources: Entries<ResourceDoc>,
    /// Passes and loops over passes.
    pub passes: Entries<PassDoc>,
    /// The results, by the names under which users ask for them.
    pub outputs: Entries<Text>,
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

/// A texture or a buffer.
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
        /// One of WebGPU's format names, or a list in order of preference.
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

/// Which surfaces a Draw draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[serde(rename = "Objects")]
pub enum ObjectsDoc {
    /// Those without transparency.
    Opaque,
    /// Those with an alpha cutoff.
    Masked,
    /// Opaque and masked.
    Solid,
    /// Those that blend, back to front from the view.
    Blended,
    /// All.
    All,
}

/// From where a Draw draws.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(rename = "View")]
pub enum ViewDoc {
    /// The camera that renders.
    #[default]
    Camera,
    /// The orthographic shadow view of a directional light, by its index among them, fitted to the camera's frustum.
    DirectionalLight(Expr),
    /// One cube face of a point or spot light: the light's index among them, and the face.
    LocalLight(Expr, Expr),
}

/// Depth test and write of a Draw or Fullscreen.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename = "Depth", deny_unknown_fields)]
pub struct DepthDoc {
    /// What passes.
    pub test: CompareDoc,
    /// Whether depth is written; needs `depth` under `write` or `modify`.
    #[serde(default = "yes")]
    pub write: bool,
    /// Added to depth, in the smallest steps of the format.
    #[serde(default)]
    pub bias: i32,
    /// Added times the depth slope.
    #[serde(default)]
    pub slope_bias: f32,
}

fn yes() -> bool {
    true
}

/// A comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename = "Compare")]
#[allow(missing_docs)]
pub enum CompareDoc {
    Never,
    Less,
    Equal,
    LessEqual,
    Greater,
    NotEqual,
    GreaterEqual,
    Always,
}

/// Which side of a triangle is left out. Surfaces that the scene calls double-sided are never culled; mirrored ones are handled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Deserialize)]
#[serde(rename = "Cull")]
pub enum CullDoc {
    /// Draw both sides.
    None,
    /// Leave out the front.
    Front,
    /// Leave out the back.
    #[default]
    Back,
}

/// How a color output is combined with what is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename = "Blend")]
pub enum BlendDoc {
    /// Source over destination, source not premultiplied.
    Alpha,
    /// Source over destination, source premultiplied.
    Premultiplied,
    /// Sum.
    Add,
    /// Product.
    Multiply,
    /// Smaller of both.
    Min,
    /// Larger of both.
    Max,
}

/// What a loop runs over.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "Each")]
pub enum EachDoc {
    /// 0 up to a count.
    Count(Expr),
    /// The six faces of a cube texture.
    Face(Text),
}

/// A pass, or a loop over passes.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "Pass", deny_unknown_fields)]
pub enum PassDoc {
    /// Rasterises the scene's surfaces.
    Draw {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
        /// Stands only if this is true.
        #[serde(default)]
        when: Option<Expr>,
        /// Stands only if the scene has some of these.
        #[serde(default)]
        has: Option<Text>,
        /// WGSL file.
        shader: Text,
        /// Vertex entry point, where the file has several.
        #[serde(default)]
        vertex: Option<Text>,
        /// Fragment entry point, where the file has several. A file without one draws depth alone.
        #[serde(default)]
        fragment: Option<Text>,
        /// Values of `override` constants.
        #[serde(default)]
        constants: Entries<Expr>,
        /// What to draw.
        objects: ObjectsDoc,
        /// From where.
        #[serde(default)]
        view: Spanned<ViewDoc>,
        /// Depth test; needs the slot `depth`.
        #[serde(default)]
        depth: Option<Spanned<DepthDoc>>,
        /// Sides left out.
        #[serde(default)]
        cull: CullDoc,
        /// Blending by slot.
        #[serde(default)]
        blend: Entries<BlendDoc>,
        /// Inputs by shader variable.
        #[serde(default)]
        read: Entries<Text>,
        /// Outputs by shader output or variable; `depth` is the depth attachment.
        #[serde(default)]
        write: Entries<Text>,
        /// Outputs that keep what is there.
        #[serde(default)]
        modify: Entries<Text>,
        /// Passes that must come first.
        #[serde(default)]
        after: Vec<Text>,
    },
    /// Runs a fragment shader once per texel of its targets.
    Fullscreen {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
        /// Stands only if this is true.
        #[serde(default)]
        when: Option<Expr>,
        /// Stands only if the scene has some of these.
        #[serde(default)]
        has: Option<Text>,
        /// WGSL file.
        shader: Text,
        /// Fragment entry point, where the file has several.
        #[serde(default)]
        entry: Option<Text>,
        /// Values of `override` constants.
        #[serde(default)]
        constants: Entries<Expr>,
        /// Blending by slot.
        #[serde(default)]
        blend: Entries<BlendDoc>,
        /// Inputs by shader variable.
        #[serde(default)]
        read: Entries<Text>,
        /// Outputs by shader output or variable.
        #[serde(default)]
        write: Entries<Text>,
        /// Outputs that keep what is there.
        #[serde(default)]
        modify: Entries<Text>,
        /// Passes that must come first.
        #[serde(default)]
        after: Vec<Text>,
    },
    /// Runs a compute shader. Exactly one of `cover`, `count` and `groups`.
    Compute {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
        /// Stands only if this is true.
        #[serde(default)]
        when: Option<Expr>,
        /// Stands only if the scene has some of these.
        #[serde(default)]
        has: Option<Text>,
        /// WGSL file.
        shader: Text,
        /// Compute entry point, where the file has several.
        #[serde(default)]
        entry: Option<Text>,
        /// Values of `override` constants.
        #[serde(default)]
        constants: Entries<Expr>,
        /// One invocation per texel of this part; a promise that all of it is written.
        #[serde(default)]
        cover: Option<Text>,
        /// At least so many invocations, along x.
        #[serde(default)]
        count: Option<Expr>,
        /// So many workgroups.
        #[serde(default)]
        groups: Option<Spanned<(Expr, Expr, Expr)>>,
        /// Inputs by shader variable.
        #[serde(default)]
        read: Entries<Text>,
        /// Outputs by shader variable.
        #[serde(default)]
        write: Entries<Text>,
        /// Outputs that keep what is there.
        #[serde(default)]
        modify: Entries<Text>,
        /// Passes that must come first.
        #[serde(default)]
        after: Vec<Text>,
    },
    /// Copies a part onto another of the same extent and format.
    Copy {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
        /// Stands only if this is true.
        #[serde(default)]
        when: Option<Expr>,
        /// Stands only if the scene has some of these.
        #[serde(default)]
        has: Option<Text>,
        /// What is read.
        read: Text,
        /// What is written.
        write: Text,
        /// Passes that must come first.
        #[serde(default)]
        after: Vec<Text>,
    },
    /// Fills a part with one value.
    Clear {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
        /// Stands only if this is true.
        #[serde(default)]
        when: Option<Expr>,
        /// Stands only if the scene has some of these.
        #[serde(default)]
        has: Option<Text>,
        /// What is written.
        write: Text,
        /// The resource's declared value, unless said here.
        #[serde(default)]
        value: Option<Spanned<ClearDoc>>,
        /// Passes that must come first.
        #[serde(default)]
        after: Vec<Text>,
    },
    /// Unrolls its passes once per element.
    Repeat {
        /// For people.
        #[serde(default)]
        doc: Option<String>,
        /// Stands only if this is true.
        #[serde(default)]
        when: Option<Expr>,
        /// Stands only if the scene has some of these.
        #[serde(default)]
        has: Option<Text>,
        /// The elements.
        each: Spanned<EachDoc>,
        /// The name of the index in expressions, parts and `params`.
        r#as: Text,
        /// What is repeated.
        passes: Entries<PassDoc>,
    },
}
