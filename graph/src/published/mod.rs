//! The small interface between scenes and passes: what a scene publishes, by name.
//!
//! The graph knows the *schema* (names, kinds and layouts, to check shaders against and to bind by name) and nothing of what
//! the tables mean. The *data* is plain bytes: a scene fills it, an executor uploads it, and neither knows the other.

mod reads;
mod scene;
mod table;

use indexmap::IndexMap;

pub use reads::{ReadMember, RowReads};
pub use scene::{
    DrawBatch, DrawList, MaterialBinding, PublishedGeometry, PublishedMaterials, PublishedSampler, PublishedScene, PublishedTexels,
    PublishedTexture, PublishedWrap,
};
pub use table::Table;

/// Everything that shaders may declare by name and get.
#[derive(Debug, Clone, Default)]
pub struct PublishedSchema {
    /// Tables, by the name of the shader variable.
    pub tables: IndexMap<String, TableSchema>,
    /// 2D textures of the whole scene: variable names.
    pub textures: Vec<String>,
    /// Per-material textures, available to Draw passes: variable names in the order of [`MaterialBinding::textures`].
    pub material_textures: Vec<String>,
    /// Per-material samplers, in the order of [`MaterialBinding::samplers`].
    pub material_samplers: Vec<String>,
    /// Vertex attributes, by the name of the vertex shader's input.
    pub vertex: VertexSchema,
    /// What `has` and `scene.NAME` may ask for: the names of counts.
    pub counts: Vec<String>,
    /// What loops may run over: storage tables whose rows are things of their own, by the name of their count.
    pub collections: IndexMap<String, Collection>,
}

/// Things of which a scene has several.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Collection {
    /// Their storage table, a row each, in stable slots.
    pub table: String,
    /// The shader variable that gets the row of the loop's element, as a uniform.
    pub element: String,
}

/// A uniform or storage table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableSchema {
    /// How it binds.
    pub kind: TableKind,
    /// For people.
    pub doc: String,
    /// Members of the struct (for `Storage`: of one element), each with WGSL type and byte offset. A shader's struct may declare
    /// the leading members only.
    pub members: Vec<TableMember>,
    /// Bytes of the struct or of one element.
    pub stride: u32,
    /// A Draw depends on those rows alone that its draw list shows.
    pub per_draw: bool,
}

/// How a table binds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableKind {
    /// `var<uniform> name: Struct`
    Uniform,
    /// `var<uniform> name: Struct`, its content by the pass's view.
    View,
    /// `var<storage, read> name: array<Struct>` (or `array<u32>` where there are no members). Never empty: at least one zeroed
    /// element; counts stand in a uniform.
    Storage,
}

/// A member of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableMember {
    /// Name in WGSL.
    pub name: String,
    /// WGSL type as naga prints it: `f32`, `u32`, `vec3<f32>`, `mat4x4<f32>`.
    pub wgsl: String,
    /// Byte offset.
    pub offset: u32,
}

/// The layout of the one vertex buffer.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct VertexSchema {
    /// Bytes of a vertex.
    pub stride: u32,
    /// Attributes by name.
    pub attributes: IndexMap<String, VertexAttribute>,
}

/// A vertex attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct VertexAttribute {
    /// Its format in memory.
    pub format: VertexFormat,
    /// Byte offset.
    pub offset: u32,
}

/// Formats of vertex attributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VertexFormat {
    /// `vec2<f32>`
    Float32x2,
    /// `vec3<f32>`
    Float32x3,
    /// `vec4<f32>`
    Float32x4,
    /// `vec4<f32>` in a shader, four bytes in memory.
    Unorm8x4,
}

impl VertexFormat {
    /// Components of the shader's vector.
    pub fn components(self) -> u32 {
        match self {
            VertexFormat::Float32x2 => 2,
            VertexFormat::Float32x3 => 3,
            VertexFormat::Float32x4 | VertexFormat::Unorm8x4 => 4,
        }
    }
}

/// How many of each thing a scene has: decides `has`, counts of loops and `scene.NAME` in expressions.
pub type SceneCounts = IndexMap<String, u32>;

/// A view that a plan draws from, in the order of [`crate::plan::Plan::views`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ViewRequest {
    /// From where.
    pub kind: ViewKind,
    /// Extent of the target in texels; shadow views snap to it.
    pub width: u32,
    /// Extent of the target in texels.
    pub height: u32,
}

/// From where a view looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ViewKind {
    /// The rendering camera.
    Camera,
    /// The shadow view of a directional light, by its index among directional lights.
    DirectionalLight(u32),
    /// The shadow view of a directional light, fitted to a part of what the camera sees.
    Cascade(CascadeView),
    /// A cube face of a point light, by its index among those, and the face.
    PointLight(u32, u32),
    /// The shadow view of a spot light, by its index among those.
    SpotLight(u32),
    /// A cube face of a rectangle of light, by its index among those, and the face.
    RectangleLight(u32, u32),
    /// The shadow view of a directional light over all of the scene, whatever the camera sees, by its index among directional lights.
    WholeScene(u32),
    /// A cube face of a reflection probe, by its index among those, and the face.
    ReflectionProbe(u32, u32),
}

/// Which part of the camera's frustum a view of a directional light is fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CascadeView {
    /// The light's index among directional lights.
    pub light: u32,
    /// Which part, from 0, the nearest; less than `count`.
    pub index: u32,
    /// How the frustum is parted.
    pub split: CascadeSplit,
}

/// How the camera's frustum is parted in depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CascadeSplit {
    /// How many parts; not 0.
    pub count: u32,
    /// Metres from the camera to where the last part ends, at most.
    pub distance: Positive,
    /// From 0, parts of equal depth, to 1, parts that double in depth.
    pub lambda: Positive,
    /// Whether a camera that moves shifts the views by whole texels.
    pub snap: bool,
}

/// A finite number that is not negative: such numbers are in the order of their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Positive(u32);

impl Positive {
    /// What is negative or no number becomes 0, what is infinite the largest number.
    pub fn new(value: f32) -> Positive {
        // The sum makes a plain zero of a negative one.
        Positive((value.clamp(0.0, f32::MAX).max(0.0) + 0.0).to_bits())
    }

    /// The number.
    pub fn get(self) -> f32 {
        f32::from_bits(self.0)
    }
}

/// Which surfaces a draw list holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum DrawFilter {
    Opaque,
    Masked,
    Solid,
    Blended,
    All,
}
