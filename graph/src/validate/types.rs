//! The output of validation: the document with names resolved and expressions parsed, loops and conditions still in place.

use std::sync::Arc;

use crate::expand::types::{ClearValue, Dimension, Keep, Located, OnResize, ResourceId, Value};
use crate::expression::Expression;
use crate::format::Format;
use crate::plan::Cull;
use crate::published::DrawFilter;
use crate::source::{FileId, LoadedImage, Span};
use crate::syntax::document::{BlendDoc, DepthDoc};

/// A document whose every name stands for something.
#[derive(Debug, Clone, PartialEq)]
pub struct Validated {
    /// The pipeline's text.
    pub doc: String,
    /// Parameters in the order of the file.
    pub params: Vec<ParamDecl>,
    /// By [`ResourceId`].
    pub resources: Vec<ResourceDecl>,
    /// Blocks, each behind the one that uses it.
    pub blocks: Vec<BlockDecl>,
    /// What it is given, if it is a block that stands alone. It can be checked, and not expanded.
    pub inputs: Vec<Located<String>>,
    /// Blocks, then passes and loops in the order of the file.
    pub items: Vec<Item>,
    /// Outputs in the order of the file.
    pub outputs: Vec<(Located<String>, PartExpr)>,
    /// Resources whose past is read, each once. Their histories are numbered behind all of `resources`, in this order.
    pub histories: Vec<Located<ResourceId>>,
    /// Resources that hold what a file says.
    pub images: Vec<ImageDecl>,
    /// What expressions ask the extents of: `$3.width` is the width of the fourth.
    pub measured: Vec<PartExpr>,
    /// MiB that content may take which is kept though it could be made again.
    pub retained_budget: Option<PlacedExpr>,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct ParamDecl {
    /// Its name, with the path of its block.
    pub name: Located<String>,
    /// The value that whoever uses its block gives it.
    pub given: Option<PlacedExpr>,
    /// Its default; decides the type.
    pub default: Value,
    /// Smallest and largest value.
    pub range: Option<(f64, f64)>,
    /// The words, if it is one.
    pub options: Vec<String>,
    /// Other numbers are not allowed.
    pub power_of_two: bool,
    /// It is expected to change while frames are rendered.
    pub live: bool,
    /// For people.
    pub unit: Option<String>,
    /// For people.
    pub doc: String,
}

/// An expression with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedExpr {
    /// What to compute.
    pub expression: Expression,
    /// Where it is written.
    pub span: Span,
}

/// A resource.
#[derive(Debug, Clone, PartialEq)]
pub struct ResourceDecl {
    /// Its name.
    pub name: Located<String>,
    /// What it is.
    pub kind: ResourceKind,
    /// The declared value.
    pub clear: Option<ClearValue>,
    /// The first value of its history, if that is not the declared value or zero.
    pub first: Option<ClearValue>,
    /// What its history holds after it changed its extent.
    pub on_resize: OnResize,
    /// What the author says of keeping its content.
    pub keep: Located<Keep>,
}

/// A resource that holds what a file says.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageDecl {
    /// Which.
    pub resource: ResourceId,
    /// What the file holds.
    pub image: Arc<LoadedImage>,
    /// Where the file is named.
    pub span: Span,
}

/// What a resource is.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
#[allow(clippy::large_enum_variant, reason = "buffers are few; a box would only burden the reader")]
pub enum ResourceKind {
    Texture {
        dimension: Dimension,
        formats: Vec<FormatChoice>,
        format_span: Span,
        size: Size,
        size_span: Span,
        layers: Option<PlacedExpr>,
        mips: Option<Mips>,
        samples: Option<PlacedExpr>,
    },
    Buffer {
        size: PlacedExpr,
    },
}

/// One of the formats that a texture may get.
#[derive(Debug, Clone, PartialEq)]
pub enum FormatChoice {
    /// This one.
    Named(Format),
    /// What a parameter, by its whole name, says; the formats of its options.
    Param(String, Vec<Format>),
}

impl FormatChoice {
    /// Every format that it may stand for.
    pub fn all(&self) -> &[Format] {
        match self {
            FormatChoice::Named(format) => std::slice::from_ref(format),
            FormatChoice::Param(_, options) => options,
        }
    }
}

/// The extent of a texture; its number of dimensions fits the texture's.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum Size {
    Output,
    Scaled(PlacedExpr),
    Line(PlacedExpr),
    Square(PlacedExpr),
    Exact(PlacedExpr, PlacedExpr),
    Cube(PlacedExpr),
    Volume(PlacedExpr, PlacedExpr, PlacedExpr),
}

/// How many mip levels.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum Mips {
    Full,
    Count(PlacedExpr),
}

/// A part of a resource whose indices are expressions.
#[derive(Debug, Clone, PartialEq)]
pub struct PartExpr {
    /// Whose part.
    pub resource: ResourceId,
    /// `.mip(..)`
    pub mip: Option<PlacedExpr>,
    /// `.layer(..)` or `.face(..)`
    pub layer: Option<PlacedExpr>,
    /// `@pass`
    pub version: Option<Located<String>>,
    /// What is named instead where a block does not stand; the first that applies.
    pub otherwise: Vec<Otherwise>,
    /// The whole reference.
    pub span: Span,
}

impl PartExpr {
    /// What it may stand for, whichever blocks stand.
    pub fn resources(&self) -> Vec<ResourceId> {
        let others = self.otherwise.iter().flat_map(|otherwise| otherwise.part.resources());
        std::iter::once(self.resource).chain(others).collect()
    }
}

/// What is named while a block does not stand.
#[derive(Debug, Clone, PartialEq)]
pub struct Otherwise {
    /// By index into [`Validated::blocks`].
    pub block: usize,
    /// What takes its output's place.
    pub part: PartExpr,
}

/// A pass, a loop, or the passes of a block.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum Item {
    Pass(Box<PassDecl>),
    Repeat(Box<RepeatDecl>),
    /// By index into [`Validated::blocks`].
    Block(usize, Vec<Item>),
}

/// A block at one of the places where it stands. The pipeline itself is the first.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockDecl {
    /// Begins the names of what it has: `shadows.`, and nothing for the pipeline.
    pub path: String,
    /// The one that uses it; the pipeline is its own.
    pub parent: usize,
    /// When it stands.
    pub condition: Condition,
    /// Passes that must come before all of its own, as seen by the one that uses it.
    pub after: Vec<Located<String>>,
}

/// When a pass or loop stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// Must be true.
    pub when: Option<PlacedExpr>,
    /// The scene must have some of these.
    pub has: Option<String>,
}

/// A loop.
#[derive(Debug, Clone, PartialEq)]
pub struct RepeatDecl {
    /// Its name.
    pub name: Located<String>,
    /// When it stands.
    pub condition: Condition,
    /// How often.
    pub each: Each,
    /// The name of the index.
    pub variable: String,
    /// All iterations become one pass.
    pub batched: bool,
    /// Only some iterations run in a frame.
    pub spread: Option<SpreadDecl>,
    /// Passes that must come before all of its own.
    pub after: Vec<Located<String>>,
    /// What is repeated.
    pub items: Vec<Item>,
}

/// How many iterations of a loop run in a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SpreadDecl {
    /// At most so many a frame.
    pub per_frame: PlacedExpr,
    /// How often each runs after a change.
    pub rounds: Option<PlacedExpr>,
}

/// What a loop runs over.
#[derive(Debug, Clone, PartialEq)]
pub enum Each {
    /// 0 up to a count.
    Count(PlacedExpr),
    /// The six faces of a cube texture.
    Face,
    /// The layers of a texture.
    Layer(ResourceId),
    /// The mip levels of a texture, from one on.
    Mip(ResourceId, Option<PlacedExpr>),
    /// x, y, z.
    Axis,
    /// The rows of a published table.
    Scene {
        /// The name of their count.
        count: String,
        /// The table.
        table: String,
        /// The shader variable that gets the row.
        element: String,
        /// At most so many.
        most: Option<PlacedExpr>,
    },
}

/// When a pass runs.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum RunDecl {
    OnChange,
    EveryFrame,
    Accumulate(PlacedExpr),
}

/// A pass.
#[derive(Debug, Clone, PartialEq)]
pub struct PassDecl {
    /// Its name.
    pub name: Located<String>,
    /// The file in whose list it stands.
    pub file: FileId,
    /// When it stands.
    pub condition: Condition,
    /// What it does.
    pub kind: PassKindDecl,
    /// Its shader file.
    pub shader: Option<Located<String>>,
    /// Values of overrides.
    pub constants: Vec<(Located<String>, PlacedExpr)>,
    /// Inputs.
    pub reads: Vec<(Located<String>, PartExpr)>,
    /// Outputs.
    pub writes: Vec<(Located<String>, PartExpr)>,
    /// Outputs that keep what is there.
    pub modifies: Vec<(Located<String>, PartExpr)>,
    /// When it runs.
    pub run: RunDecl,
    /// Passes that must come first.
    pub after: Vec<Located<String>>,
}

/// What a pass does.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum PassKindDecl {
    Draw {
        vertex: Option<Located<String>>,
        fragment: Option<Located<String>>,
        objects: DrawFilter,
        view: View,
        depth: Option<DepthDoc>,
        cull: Cull,
        blend: Vec<(Located<String>, BlendDoc)>,
    },
    Procedural {
        vertex: Option<Located<String>>,
        fragment: Option<Located<String>>,
        vertices: PlacedExpr,
        instances: Option<PlacedExpr>,
        depth: Option<DepthDoc>,
        cull: Cull,
        blend: Vec<(Located<String>, BlendDoc)>,
    },
    Fullscreen {
        entry: Option<Located<String>>,
        blend: Vec<(Located<String>, BlendDoc)>,
    },
    Compute {
        entry: Option<Located<String>>,
        work: WorkDecl,
    },
    Copy,
    Clear {
        value: Option<ClearValue>,
    },
}

/// From where a Draw draws.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum View {
    Camera,
    DirectionalLight(PlacedExpr),
    Cascade(Box<CascadeDecl>),
    PointLight(PlacedExpr, PlacedExpr),
    SpotLight(PlacedExpr),
    RectangleLight(PlacedExpr, PlacedExpr),
    WholeScene(PlacedExpr),
    ReflectionProbe(PlacedExpr, PlacedExpr),
}

/// A part of what the camera sees, along a directional light.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub struct CascadeDecl {
    pub light: PlacedExpr,
    pub index: PlacedExpr,
    pub count: PlacedExpr,
    pub distance: PlacedExpr,
    pub lambda: PlacedExpr,
    pub snap: Option<PlacedExpr>,
}

/// How much a Compute works.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum WorkDecl {
    Cover(PartExpr),
    Count(PlacedExpr),
    Groups(PlacedExpr, PlacedExpr, PlacedExpr),
    /// The buffer, and the bytes from its start.
    Indirect(PartExpr, Option<PlacedExpr>),
}
