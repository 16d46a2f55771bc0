//! The plan: what runs, in which order, in which memory. Immutable, comparable and printable; the executor's only input.
//!
//! Steps are values, never closures. Indices are checked when the plan is built, so that an executor may index freely.

use std::ops::Range;

use crate::device::Feature;
use crate::expand::types::{ClearValue, Param, PassId, ResourceId, TextureShape};
use crate::format::Format;
use crate::published::{DrawFilter, ViewKind, ViewRequest};
use crate::reflect::interface::{Shader, StorageAccess, ViewDimension};
use crate::source::Span;
use crate::syntax::document::{BlendDoc, CompareDoc};

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
    /// Views that the scene must publish.
    pub views: Vec<ViewRequest>,
    /// Draw lists that the scene must publish.
    pub draw_lists: Vec<(DrawFilter, ViewKind)>,
    /// Results.
    pub outputs: Vec<PlannedOutput>,
    /// What the memory comes to.
    pub figures: MemoryFigures,
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
        }
    }
}

/// One thing to run.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The expanded pass.
    pub pass: PassId,
    /// Its name.
    pub name: String,
    /// Its name in the file.
    pub span: Span,
    /// Index into [`Plan::shaders`].
    pub shader: Option<usize>,
    /// What it does.
    pub kind: StepKind,
    /// What its shader's variables get, by group and binding.
    pub bindings: Vec<Binding>,
    /// Values of overrides, by name.
    pub constants: Vec<(String, f64)>,
    /// Parts that it fills with the declared value first, since it may leave texels out.
    pub clears: Vec<(PartView, ClearValue)>,
    /// Every part that it touches, in the order reads, writes, modifies.
    pub uses: Vec<Use>,
}

/// What a step does.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum StepKind {
    Draw {
        vertex: String,
        fragment: Option<String>,
        /// Index into [`Plan::draw_lists`].
        list: usize,
        /// Index into [`Plan::views`].
        view: usize,
        cull: Cull,
        /// Attributes by location: names in the vertex schema.
        attributes: Vec<String>,
        targets: Targets,
    },
    Fullscreen {
        fragment: String,
        targets: Targets,
    },
    Compute {
        entry: String,
        /// Workgroups, each at least 1 and within the device's limit.
        groups: [u32; 3],
    },
    Copy {
        source: PartView,
        target: PartView,
    },
    Clear {
        target: PartView,
        value: ClearValue,
    },
}

/// Which side of a triangle is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum Cull {
    None,
    Front,
    Back,
}

/// What a Draw or Fullscreen renders into.
#[derive(Debug, Clone, PartialEq)]
pub struct Targets {
    /// By location; `None` where the shader's output goes nowhere.
    pub colors: Vec<Option<ColorTarget>>,
    /// Depth.
    pub depth: Option<DepthTarget>,
    /// Of all targets.
    pub extent: [u32; 2],
    /// Of all targets.
    pub samples: u32,
}

/// A color attachment.
#[derive(Debug, Clone, PartialEq)]
pub struct ColorTarget {
    /// One mip and layer.
    pub view: PartView,
    /// Its format.
    pub format: Format,
    /// What is there before.
    pub load: Load,
    /// How colors are combined.
    pub blend: Option<BlendDoc>,
}

/// A depth attachment.
#[derive(Debug, Clone, PartialEq)]
pub struct DepthTarget {
    /// One mip and layer.
    pub view: PartView,
    /// Its format.
    pub format: Format,
    /// What is there before.
    pub load: Load,
    /// Whether it is written; if not, it may be sampled in the same pass.
    pub write: bool,
    /// What passes.
    pub compare: CompareDoc,
    /// Constant bias.
    pub bias: i32,
    /// Slope bias.
    pub slope_bias: f32,
}

/// What an attachment holds before the pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// This value.
    Clear(ClearValue),
    /// What was there.
    Keep,
}

/// A part as a view on a texture, or as a buffer range.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct PartView {
    /// Whose part.
    pub resource: ResourceId,
    /// Mip levels; `0..1` for buffers.
    pub mips: Range<u32>,
    /// Layers (faces of cubes); `0..1` for buffers and volumes.
    pub layers: Range<u32>,
    /// How a shader sees it; `D2` for attachments and buffers.
    pub dimension: ViewDimension,
}

/// A shader variable and what it gets.
#[derive(Debug, Clone, PartialEq)]
pub struct Binding {
    /// 0, or 1 for what each draw binds anew.
    pub group: u32,
    /// Within the group.
    pub binding: u32,
    /// The variable.
    pub variable: String,
    /// Which stages use it.
    pub stages: Stages,
    /// What it gets.
    pub target: BindingTarget,
}

/// Shader stages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[allow(missing_docs)]
pub struct Stages {
    pub vertex: bool,
    pub fragment: bool,
    pub compute: bool,
}

/// What a shader variable gets.
#[derive(Debug, Clone, PartialEq)]
pub enum BindingTarget {
    /// A published uniform table.
    UniformTable(String),
    /// A published storage table.
    StorageTable(String),
    /// The view table of this view, by index into [`Plan::views`].
    View(usize),
    /// The `params` struct, packed.
    Params(Vec<u8>),
    /// A texture of the material that is drawn, by index into the schema's list.
    MaterialTexture(usize),
    /// A sampler of the material that is drawn, by index into the schema's list.
    MaterialSampler(usize),
    /// A built-in sampler.
    Sampler(BuiltinSampler),
    /// A sampled texture.
    Texture {
        /// What is seen.
        view: PartView,
        /// How its samples appear.
        sample: SampleType,
        /// 4 samples per texel.
        multisampled: bool,
    },
    /// A storage texture.
    StorageTexture {
        /// What is seen: one mip level.
        view: PartView,
        /// Its format.
        format: Format,
        /// Its access mode.
        access: StorageAccess,
    },
    /// A buffer resource.
    Buffer {
        /// Which.
        resource: ResourceId,
        /// Uniform or storage.
        uniform: bool,
        /// Declared `read_write`.
        writable: bool,
    },
}

/// How samples of a texture binding appear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum SampleType {
    FilterableFloat,
    UnfilterableFloat,
    Depth,
    Sint,
    Uint,
}

/// Samplers that every shader may declare by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum BuiltinSampler {
    LinearClamp,
    LinearRepeat,
    NearestClamp,
    NearestRepeat,
    /// Comparison `LessEqual`, linear, clamped.
    CompareLess,
    /// Comparison `GreaterEqual`, linear, clamped.
    CompareGreater,
}

impl BuiltinSampler {
    /// All of them.
    pub const ALL: [BuiltinSampler; 6] = [
        BuiltinSampler::LinearClamp,
        BuiltinSampler::LinearRepeat,
        BuiltinSampler::NearestClamp,
        BuiltinSampler::NearestRepeat,
        BuiltinSampler::CompareLess,
        BuiltinSampler::CompareGreater,
    ];

    /// The variable's name in WGSL.
    pub fn name(self) -> &'static str {
        match self {
            BuiltinSampler::LinearClamp => "linear_clamp",
            BuiltinSampler::LinearRepeat => "linear_repeat",
            BuiltinSampler::NearestClamp => "nearest_clamp",
            BuiltinSampler::NearestRepeat => "nearest_repeat",
            BuiltinSampler::CompareLess => "compare_less",
            BuiltinSampler::CompareGreater => "compare_greater",
        }
    }

    /// Whether the variable is a `sampler_comparison`.
    pub fn is_comparison(self) -> bool {
        matches!(self, BuiltinSampler::CompareLess | BuiltinSampler::CompareGreater)
    }

    /// Whether it filters.
    pub fn is_filtering(self) -> bool {
        !matches!(self, BuiltinSampler::NearestClamp | BuiltinSampler::NearestRepeat)
    }
}

/// A part that a pass touches.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Use {
    /// Whose part.
    pub resource: ResourceId,
    /// Mip levels; `0..1` for buffers.
    pub mips: Range<u32>,
    /// Layers; `0..1` for buffers and volumes.
    pub layers: Range<u32>,
    /// Producer, modifier or reader.
    pub role: Role,
    /// How.
    pub access: Access,
    /// For a reader: the value as this pass left it, instead of the final one.
    pub version: Option<PassId>,
    /// The shader variable, output or slot.
    pub slot: String,
    /// Where the reference is written.
    pub span: Span,
}

/// What a pass does to a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Sees the value.
    Read,
    /// Makes the value.
    Produce,
    /// Changes the value.
    Modify,
}

/// How a pass touches a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum Access {
    Sampled,
    StorageRead,
    StorageWrite,
    StorageReadWrite,
    Uniform,
    ColorAttachment,
    DepthAttachment,
    DepthReadOnly,
    CopySource,
    CopyTarget,
    Clear,
}

impl Access {
    /// The usage that a memory needs for it.
    pub fn usage(self) -> Usage {
        let mut usage = Usage::default();
        match self {
            Access::Sampled => usage.sampled = true,
            Access::StorageRead | Access::StorageWrite | Access::StorageReadWrite => usage.storage = true,
            Access::Uniform => usage.uniform = true,
            Access::ColorAttachment | Access::DepthAttachment | Access::DepthReadOnly => usage.attachment = true,
            Access::CopySource => usage.copy_source = true,
            // The executor clears through an attachment or through a copy, as the format allows.
            Access::CopyTarget | Access::Clear => usage.copy_target = true,
        }
        usage
    }
}

/// A pass that does not run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Culled {
    /// Which.
    pub pass: PassId,
    /// Its name.
    pub name: String,
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
    /// The same for the declared order.
    pub declared_bound: u64,
    /// What they would take if they could be placed by byte in this order.
    pub placed: u64,
    /// Resources that share with nothing.
    pub retained: u64,
}

/// A feature that the device must have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Requirement {
    /// Which.
    pub feature: Feature,
    /// The pass that needs it.
    pub pass: String,
    /// Where.
    pub span: Span,
    /// Why, as the end of a sentence: `to filter "radiance" (r32float)`.
    pub why: String,
}
