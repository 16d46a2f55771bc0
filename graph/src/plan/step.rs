//! Steps: what a pass does on a device, as values. Every name is resolved, and indices point into the [`Plan`](super::Plan).

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use super::Usage;
use crate::expand::types::{ClearValue, OnResize, PassId, ResourceId, Run};
use crate::format::Format;
use crate::published::{DrawFilter, RowReads, ViewKind, ViewRequest};
use crate::reflect::interface::{StorageAccess, ViewDimension};
use crate::source::{LoadedImage, Span};
use crate::syntax::document::{BlendDoc, CompareDoc};

/// One thing to run.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The expanded pass.
    pub pass: PassId,
    /// Its name.
    pub name: Arc<str>,
    /// Its name in the file.
    pub span: Span,
    /// Index into [`super::Plan::shaders`].
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
    /// When it runs.
    pub run: Run,
    /// Its iterations, if it stands for all of a batched loop.
    pub batch: Vec<StepIteration>,
    /// What it takes from outside of the graph, by index into [`super::Plan::inputs`], rising. What depends on the iteration stands
    /// there.
    pub inputs: Vec<InputId>,
}

/// An iteration of a batched step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StepIteration {
    /// Mip levels and layers of each of the step's uses in this iteration.
    pub parts: Vec<(Range<u32>, Range<u32>)>,
    /// What this iteration alone takes from outside.
    pub inputs: Vec<InputId>,
}

/// An input of [`super::Plan::inputs`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct InputId(pub u32);

impl InputId {
    /// For indexing.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Something outside of the graph that has a revision.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Input {
    /// What is read of a published table: of every row, and how many there are.
    Table(String, RowReads),
    /// What is read of a row of a published table.
    Row(String, u32, RowReads),
    /// A published texture of the whole scene.
    Texture(String),
    /// The table of a view.
    View(ViewRequest),
    /// What a draw list shows: its batches, their geometry, and what is read of their rows.
    Draws(DrawFilter, ViewKind, DrawReads),
    /// A parameter that is marked `live`.
    Param(String),
}

/// What a Draw reads of what its list shows.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct DrawReads {
    /// By the name of the table.
    pub rows: BTreeMap<String, RowReads>,
    /// Textures and samplers of materials.
    pub textures: bool,
}

/// What a step does.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum StepKind {
    Draw {
        vertex: String,
        fragment: Option<String>,
        /// Index into [`super::Plan::draw_lists`].
        list: usize,
        /// Index into [`super::Plan::views`].
        view: usize,
        cull: Cull,
        /// Attributes by location: names in the vertex schema.
        attributes: Vec<String>,
        targets: Targets,
    },
    Procedural {
        vertex: String,
        fragment: Option<String>,
        /// Of an instance.
        vertices: u32,
        instances: u32,
        cull: Cull,
        targets: Targets,
    },
    Fullscreen {
        fragment: String,
        targets: Targets,
    },
    Compute {
        entry: String,
        /// How many workgroups.
        groups: Workgroups,
    },
    Copy {
        source: PartView,
        target: PartView,
    },
    Clear {
        target: PartView,
        value: ClearValue,
    },
    /// Fills a texture with what a file says.
    Image {
        target: PartView,
        image: Arc<LoadedImage>,
    },
    /// Copies what a resource held at the end of the frame before.
    Remember {
        source: PartView,
        target: PartView,
        first: ClearValue,
        on_resize: OnResize,
    },
}

/// How many workgroups a Compute runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Workgroups {
    /// Each at least 1 and within the device's limit. Of a batched step for one iteration: then `z` is 1, and grows by one for each
    /// iteration that is due.
    Fixed([u32; 3]),
    /// As three `u32` of a buffer say.
    Indirect {
        /// Which.
        buffer: ResourceId,
        /// Bytes from its start.
        offset: u64,
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
    /// The view table of this view, by index into [`super::Plan::views`].
    View(usize),
    /// A row of a published storage table, as a uniform.
    TableRow(String, u32),
    /// The indices of the iterations that are due, of a batched step.
    Batch,
    /// The `params` struct, packed.
    Params {
        /// Its bytes.
        bytes: Vec<u8>,
        /// Where the number of the run goes, in an accumulating pass whose shader asks for it.
        accumulated: Option<usize>,
    },
    /// A published texture of the whole scene.
    SceneTexture(String),
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
    /// Sees the value that the frame before left; before anything changes it.
    Recall,
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
    Indirect,
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
            Access::Indirect => usage.indirect = true,
            // The executor clears through an attachment or through a copy, as the format allows.
            Access::CopyTarget | Access::Clear => usage.copy_target = true,
        }
        usage
    }
}
