//! The plan: what runs, in which order, in which memory. Immutable, comparable and printable; the executor's only input.
//!
//! Steps are values, never closures. Indices are checked when the plan is built, so that an executor may index freely.

mod step;

pub use step::{
    Access, Binding, BindingTarget, BuiltinSampler, ColorTarget, Cull, DepthTarget, DrawReads, Input, InputId, Load, PartView, Role,
    SampleType, Stages, Step, StepIteration, StepKind, Targets, Use, Workgroups,
};

use std::sync::Arc;

use std::ops::Range;

use crate::device::Feature;
use crate::expand::types::{ClearValue, History, Param, PassId, ResourceId, Spread, TextureShape};
use crate::format::Format;
use crate::published::{DrawFilter, ViewKind, ViewRequest};
use crate::reflect::interface::Shader;
use crate::schedule::flow::Flow;
use crate::source::Span;

/// A compiled pipeline.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The pipeline's path.
    pub name: String,
    /// The pipeline's text.
    pub doc: String,
    /// Width and height of the rendered image.
    pub extent: [u32; 2],
    /// Parameters with their values.
    pub params: Vec<Param>,
    /// By [`ResourceId`], those that nothing kept uses included.
    pub resources: Vec<PlannedResource>,
    /// By [`MemoryId`].
    pub memories: Vec<Memory>,
    /// Shaders that steps name by index.
    pub shaders: Vec<Shader>,
    /// What runs, in order.
    pub steps: Vec<Step>,
    /// What does not run, in the order of the file.
    pub culled: Vec<Culled>,
    /// What steps take from outside.
    pub inputs: Vec<Input>,
    /// Loops of which only some iterations run in a frame.
    pub spreads: Vec<Spread>,
    /// Views that the scene must publish.
    pub views: Vec<ViewRequest>,
    /// Draw lists that the scene must publish.
    pub draw_lists: Vec<(DrawFilter, ViewKind)>,
    /// Results.
    pub outputs: Vec<PlannedOutput>,
    /// What the memory comes to.
    pub figures: MemoryFigures,
    /// What waits for what among the passes that run, for [`Plan::placed`].
    pub flow: Flow,
    /// Features that the device must have, and which pass needs each.
    pub requirements: Vec<Requirement>,
}

/// A memory of [`Plan::memories`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MemoryId(pub u32);

impl MemoryId {
    /// For indexing.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A resource and where it lives.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedResource {
    /// As in the file.
    pub name: String,
    /// Where it is declared.
    pub span: Span,
    /// What it is; a texture's first format is the chosen one.
    pub shape: PlannedShape,
    /// All that is done to it.
    pub usage: Usage,
    /// Tight bytes of all mips, layers and samples.
    pub bytes: u64,
    /// The steps from the first to the last that name it, by index, end exclusive; empty if none does.
    pub lifetime: Range<usize>,
    /// Where it lives; `None` if no step names it.
    pub placement: Option<Placement>,
    /// Why it shares memory with nothing, if so.
    pub retained: Option<Retained>,
    /// Why no other resource has its bytes at another time, if so.
    pub alone: Option<Alone>,
    /// The value of parts that nothing made.
    pub clear: Option<ClearValue>,
    /// The inputs that reach a reader and not the maker: for their sake it is retained.
    pub retained_for: Vec<InputId>,
    /// Whose past it is, if it is one.
    pub history: Option<History>,
}

/// What a resource is.
#[derive(Debug, Clone, PartialEq)]
pub enum PlannedShape {
    /// Texels in the chosen format.
    Texture(TextureShape, Format),
    /// So many bytes.
    Buffer(u64),
}

/// A place in a memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Placement {
    /// Which memory.
    pub memory: MemoryId,
    /// Byte offset in an arena, a multiple of 256; 0 in a texture.
    pub offset: u64,
}

/// Why a resource shares memory with nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Retained {
    /// It is an output that was asked for.
    Output,
    /// It is remembered, or holds what is.
    History,
    /// Passes that run a few at a time make or read it.
    Amortised,
    /// The author says so.
    Kept,
    /// A reader can run without its maker.
    Read,
}

/// Why no other resource uses the same bytes. Every refusal has a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Alone {
    /// It keeps its value from frame to frame.
    Retained(Retained),
    /// No other transient texture has the same descriptor.
    OnlyOfItsDescriptor,
    /// So many textures of its descriptor are in use at once at a step, each in a memory of its own: one more sharer saves nothing.
    InUseTogether {
        /// How many.
        count: usize,
        /// The step, by index.
        step: usize,
    },
    /// There is no other transient buffer.
    OnlyBuffer,
    /// Every other buffer is in use at the same time.
    BuffersInUse,
    /// Whatever is free at other times stands in an arena with this buffer, which a pass uses with different access (or copies
    /// to or from): the driver tracks whole buffers, so the two never share an arena.
    AccessConflict {
        /// The buffer.
        rival: ResourceId,
    },
    /// Other buffers are free at other times, and none of them gains by it: they are placed below or above.
    NothingToGain,
}

/// What the executor creates once.
#[derive(Debug, Clone, PartialEq)]
pub struct Memory {
    /// Texture or arena.
    pub kind: MemoryKind,
    /// The union of its holders' usages.
    pub usage: Usage,
    /// Bytes that it takes.
    pub bytes: u64,
    /// Resources that live in it, by first use.
    pub holders: Vec<ResourceId>,
}

/// What a memory is.
#[derive(Debug, Clone, PartialEq)]
pub enum MemoryKind {
    /// One texture, used whole by one resource at a time.
    Texture(TextureShape, Format),
    /// One buffer that holds sub-ranges.
    Arena,
}

/// What is done to a resource or memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Usage {
    /// Sampled or loaded as a texture.
    pub sampled: bool,
    /// Bound as a storage texture or buffer.
    pub storage: bool,
    /// Bound as a uniform buffer.
    pub uniform: bool,
    /// Drawn into.
    pub attachment: bool,
    /// Copied from.
    pub copy_source: bool,
    /// Copied to, or cleared by a copy.
    pub copy_target: bool,
    /// Says how much another pass works.
    pub indirect: bool,
}

impl Usage {
    /// Everything that either does.
    pub fn union(self, other: Usage) -> Usage {
        Usage {
            sampled: self.sampled | other.sampled,
            storage: self.storage | other.storage,
            uniform: self.uniform | other.uniform,
            attachment: self.attachment | other.attachment,
            copy_source: self.copy_source | other.copy_source,
            copy_target: self.copy_target | other.copy_target,
            indirect: self.indirect | other.indirect,
        }
    }
}

/// A pass that does not run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Culled {
    /// Which.
    pub pass: PassId,
    /// Its name.
    pub name: Arc<str>,
    /// Its kind in RON.
    pub kind: &'static str,
    /// The resources that it would have written.
    pub writes: Vec<ResourceId>,
    /// The resources that it would have read.
    pub reads: Vec<ResourceId>,
    /// Why it does not run.
    pub reason: CullReason,
}

/// Why a pass does not run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CullReason {
    /// It has no results.
    WritesNothing,
    /// Nothing uses its results.
    Unread,
    /// Only passes that do not run use its results.
    OnlyCulledReaders(Vec<PassId>),
}

/// A result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlannedOutput {
    /// The name under which users ask.
    pub name: String,
    /// The part: one mip.
    pub view: PartView,
}

/// What transient resources cost, in bytes. Retained ones are apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MemoryFigures {
    /// Every transient resource in memory of its own: tight bytes of textures, buffers in units of 256.
    pub without_sharing: u64,
    /// What the executor allocates for them.
    pub reached: u64,
    /// The largest sum of live bytes at any step: no plan with this order can take less.
    pub bound: u64,
    /// Resources that share with nothing.
    pub retained: u64,
}

/// A feature that the device must have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Requirement {
    /// Which.
    pub feature: Feature,
    /// The pass that needs it.
    pub pass: Arc<str>,
    /// Where.
    pub span: Span,
    /// Why, as the end of a sentence: `to filter "radiance" (r32float)`.
    pub why: String,
}
