//! The output of expansion: a flat list of passes over resources with known extents.

use std::sync::Arc;

use smallvec::SmallVec;

use crate::format::Format;
use crate::plan::Cull;
use crate::published::{DrawFilter, ViewKind};
use crate::source::{LoadedImage, Span};
use crate::syntax::document::{BlendDoc, DepthDoc};

/// A resource of [`Expanded::resources`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ResourceId(pub u32);

/// A pass of [`Expanded::passes`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PassId(pub u32);

impl ResourceId {
    /// For indexing.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl PassId {
    /// For indexing.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A pipeline without loops, conditions and expressions.
#[derive(Debug, Clone, PartialEq)]
pub struct Expanded {
    /// The pipeline's text.
    pub doc: String,
    /// Parameters with their values.
    pub params: Vec<Param>,
    /// Resources in the order of the file.
    pub resources: Vec<Resource>,
    /// Passes in the order of the file, loops unrolled in place.
    pub passes: Vec<Pass>,
    /// Loops that [`Run::Spread`] names by index.
    pub spreads: Vec<Spread>,
    /// Bytes that retained resources may take where the author leaves the choice to the compiler.
    pub retained_budget: Option<u64>,
    /// The outputs asked for.
    pub outputs: Vec<Output>,
    /// Resources that outputs name, whether asked for or not.
    pub offered: Vec<ResourceId>,
}

/// A parameter with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Param {
    /// As in the file, behind the path of its block.
    pub name: String,
    /// Where it is declared.
    pub span: Span,
    /// The value in force.
    pub value: Value,
    /// The allowed words, if `value` is a word.
    pub options: Vec<String>,
    /// It is expected to change while frames are rendered: what it reaches should be able to run alone.
    pub live: bool,
}

/// The value of a parameter or an expression.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum Value {
    Bool(bool),
    Int(i64),
    Float(f64),
    /// Index into the options, and the word.
    Word(u32, String),
    /// Two to four components.
    Vector(Vec<f64>),
}

/// A resource with its extent.
#[derive(Debug, Clone, PartialEq)]
pub struct Resource {
    /// As in the file, behind the path of its block.
    pub name: String,
    /// Where it is declared.
    pub span: Span,
    /// What it is.
    pub shape: Shape,
    /// The declared value.
    pub clear: Option<ClearValue>,
    /// Whose past it is, if it is one: in frame n it holds what that resource held at the end of frame n - 1.
    pub history: Option<History>,
    /// What the author says of keeping its content.
    pub keep: Keep,
}

/// A resource that holds the past of another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct History {
    /// Whose past.
    pub of: ResourceId,
    /// The value where that resource did not stand in the frame before.
    pub first: ClearValue,
    /// What happens where it had another extent in the frame before.
    pub on_resize: OnResize,
}

/// What a history holds after its resource changed its extent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum OnResize {
    /// Its first value.
    #[default]
    First,
    /// The texels or bytes that both extents have; elsewhere its first value.
    Crop,
}

/// Whether content that could be made again is kept from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Keep {
    /// The compiler decides.
    #[default]
    Auto,
    /// Kept.
    Always,
    /// Made again when it is needed.
    Never,
}

/// What a resource is.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Texels.
    Texture(TextureShape),
    /// Bytes.
    Buffer {
        /// How many, a multiple of 4 greater than zero.
        bytes: u64,
    },
}

impl Shape {
    /// The extent by its name in expressions; of a buffer the width is its bytes.
    pub fn extent(&self, name: &str) -> u64 {
        match (self, name) {
            (Shape::Buffer { bytes }, "width") => *bytes,
            (Shape::Buffer { .. }, _) => 1,
            (Shape::Texture(shape), _) => u64::from(match name {
                "width" => shape.width,
                "height" => shape.height,
                "depth" => shape.depth,
                "layers" => shape.layers,
                _ => shape.mips,
            }),
        }
    }
}

/// The extent and formats of a texture. Everything is at least 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextureShape {
    /// 1D, 2D, 3D, cube.
    pub dimension: Dimension,
    /// In order of preference; never empty.
    pub formats: SmallVec<[Format; 4]>,
    /// Where the format is written.
    pub format_span: Span,
    /// Of mip 0.
    pub width: u32,
    /// Of mip 0.
    pub height: u32,
    /// Of mip 0; 1 unless 3D.
    pub depth: u32,
    /// Array layers; six per cube.
    pub layers: u32,
    /// Mip levels.
    pub mips: u32,
    /// 1 or 4.
    pub samples: u32,
}

/// The dimension of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum Dimension {
    D1,
    D2,
    D3,
    Cube,
}

/// A value to clear to.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)]
pub enum ClearValue {
    Zero,
    Color([f64; 4]),
    Depth(f32),
    Uint([u32; 4]),
}

/// A pass with everything resolved but its shader.
#[derive(Debug, Clone, PartialEq)]
pub struct Pass {
    /// Stable and unique: `shade`, `faces[3].draw`, `shadows.draw`.
    pub name: Arc<str>,
    /// Begins the names of parameters that its shader sees: the path of its block, `shadows.`, or nothing.
    pub block: Arc<str>,
    /// The list in which it stands, counted through all files and blocks: within one, the order says who modifies first.
    pub list: u32,
    /// The name in the file.
    pub span: Span,
    /// Loop variables with their values, outermost first. They reach `params` like parameters.
    pub indices: Vec<(String, u32)>,
    /// What it does.
    pub kind: PassKind,
    /// The shader file, for kinds that have one.
    pub shader: Option<Located<String>>,
    /// Values of `override` constants.
    pub constants: Vec<(Located<String>, f64)>,
    /// Inputs. A Copy has one, named `read`.
    pub reads: Vec<Slot>,
    /// Outputs. A Copy or Clear has one, named `write`.
    pub writes: Vec<Slot>,
    /// Outputs that keep what is there.
    pub modifies: Vec<Slot>,
    /// Passes that must come first.
    pub after: Vec<PassId>,
    /// When it runs.
    pub run: Run,
    /// Its iterations, if it stands for all of a batched loop. The slots then name the smallest parts that hold those of all
    /// iterations.
    pub batch: Option<Batch>,
    /// Elements of the loops around, outermost first.
    pub elements: Vec<Element>,
}

/// When a pass runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Run {
    /// When something that it reads has changed.
    #[default]
    OnChange,
    /// In every frame.
    EveryFrame,
    /// Once a frame, so many times after a change. The shader sees the number of the run as `params.accumulated`.
    Accumulate(u32),
    /// With its iteration of a loop of which only some iterations run in a frame.
    Spread {
        /// Index into [`Expanded::spreads`].
        spread: u32,
        /// The loop's index. A batched pass takes it from its iterations.
        iteration: u32,
    },
}

/// A loop of which only some iterations run in a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Spread {
    /// The loop.
    pub name: String,
    /// Where it is named.
    pub span: Span,
    /// At most so many iterations a frame.
    pub per_frame: u32,
    /// How often each runs after a change.
    pub rounds: u32,
}

/// The iterations of a batched loop. Those that are due run as one pass, whose shader finds their indices in `batch`.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// The name of the index.
    pub variable: String,
    /// By index, from 0.
    pub iterations: Vec<BatchIteration>,
}

/// An iteration of a batched loop.
#[derive(Debug, Clone, PartialEq)]
pub struct BatchIteration {
    /// What each slot names in this iteration, in the order reads, writes, modifies.
    pub parts: Vec<PartRef>,
    /// Its element.
    pub element: Option<Element>,
}

/// The row of a published table that a loop stands at.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Element {
    /// The shader variable that gets the row.
    pub variable: String,
    /// The published table.
    pub table: String,
    /// The row.
    pub row: u32,
}

/// A value with its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where it is written.
    pub span: Span,
}

/// What a pass does.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum PassKind {
    Draw {
        vertex: Option<Located<String>>,
        fragment: Option<Located<String>>,
        objects: DrawFilter,
        view: ViewKind,
        depth: Option<DepthDoc>,
        cull: Cull,
        blend: Vec<(Located<String>, BlendDoc)>,
    },
    Procedural {
        vertex: Option<Located<String>>,
        fragment: Option<Located<String>>,
        vertices: u32,
        instances: u32,
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
        work: Work,
    },
    Copy,
    Clear {
        value: Option<ClearValue>,
    },
    /// Holds what a file says. Generated; its one write is the image.
    Image(Arc<LoadedImage>),
    /// Brings the past of a resource up to the frame before. Generated; its one write is the history.
    Remember,
}

impl PassKind {
    /// The kind's name in RON.
    pub fn name(&self) -> &'static str {
        match self {
            PassKind::Draw { .. } => "Draw",
            PassKind::Procedural { .. } => "Procedural",
            PassKind::Fullscreen { .. } => "Fullscreen",
            PassKind::Compute { .. } => "Compute",
            PassKind::Copy => "Copy",
            PassKind::Clear { .. } => "Clear",
            PassKind::Image(_) => "Image",
            PassKind::Remember => "Remember",
        }
    }
}

/// How much work a Compute does.
#[derive(Debug, Clone, PartialEq)]
pub enum Work {
    /// One invocation per texel.
    Cover(PartRef),
    /// At least so many invocations along x.
    Count(u32),
    /// So many workgroups.
    Groups([u32; 3]),
    /// Three `u32` of a buffer say how many workgroups.
    Indirect {
        /// The buffer; it is among the reads, too, in a slot `indirect`.
        buffer: PartRef,
        /// Bytes from its start, a multiple of 4.
        offset: u64,
    },
}

/// A shader variable or output, and the part it gets.
#[derive(Debug, Clone, PartialEq)]
pub struct Slot {
    /// The variable, output member or `depth`.
    pub name: Located<String>,
    /// What it gets.
    pub part: PartRef,
}

/// Mip levels or layers that follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Indices {
    /// The first.
    pub first: u32,
    /// How many, at least 1.
    pub count: u32,
}

impl Indices {
    /// A single one.
    pub fn one(index: u32) -> Indices {
        Indices { first: index, count: 1 }
    }

    /// As a range.
    pub fn range(self) -> std::ops::Range<u32> {
        self.first..self.first.saturating_add(self.count)
    }

    /// The smallest run that holds both.
    pub fn join(self, other: Indices) -> Indices {
        let first = self.first.min(other.first);
        Indices { first, count: self.range().end.max(other.range().end) - first }
    }
}

/// A part of a resource.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartRef {
    /// Whose part.
    pub resource: ResourceId,
    /// Some mip levels, or all.
    pub mips: Option<Indices>,
    /// Some layers or faces, or all.
    pub layers: Option<Indices>,
    /// The value as this pass left it, instead of the final one.
    pub version: Option<PassId>,
    /// Where the reference is written.
    pub span: Span,
}

/// A result that was asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// The name under which users ask.
    pub name: String,
    /// What it is.
    pub part: PartRef,
}
