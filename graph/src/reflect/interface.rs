//! The output of reflection: what a shader file declares and what each of its entry points uses.

use std::sync::Arc;

use crate::expand::types::Dimension;
use crate::format::Format;
use crate::published::{ReadMember, RowReads};
use crate::source::Span;

/// A shader file with its imports, checked.
#[derive(Debug, Clone)]
pub struct Shader {
    /// The path as pipelines name it.
    pub path: String,
    /// The module, valid, with a group and binding on every global resource and a location on every vertex input and
    /// fragment output.
    pub module: Arc<naga::Module>,
    /// The text that it was made from, imports included: equal texts are equal shaders.
    pub text: Arc<str>,
    /// Entry points in the order of the file.
    pub entries: Vec<EntryPoint>,
    /// Pipeline-overridable constants in the order of the file.
    pub overrides: Vec<Override>,
    /// Features that the module needs.
    pub features: Vec<crate::device::Feature>,
}

/// The shader stage of an entry point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum Stage {
    Vertex,
    Fragment,
    Compute,
}

/// An entry point and what it uses.
#[derive(Debug, Clone, PartialEq)]
pub struct EntryPoint {
    /// The function's name.
    pub name: String,
    /// Where it stands.
    pub span: Span,
    /// Vertex, fragment or compute.
    pub stage: Stage,
    /// Of a compute entry point, else zero. Where overrides take part, with their defaults; see [`Shader::workgroup_size`].
    pub workgroup_size: [u32; 3],
    /// The resource variables that it uses, directly or through what it calls, in the order of the file. One whose size alone is asked
    /// for (`arrayLength`, `textureDimensions`) is used, and neither read nor written.
    pub globals: Vec<Global>,
    /// Inputs of a vertex entry point: names and components of float vectors, in location order (location = index).
    pub vertex_inputs: Vec<VertexInput>,
    /// What goes from the vertex to the fragment stage: user-defined outputs of a vertex entry point, inputs of a fragment one, by
    /// location.
    pub varyings: Vec<Varying>,
    /// Outputs of a fragment entry point, in location order (location = index).
    pub color_outputs: Vec<ColorOutput>,
    /// The fragment entry point writes `@builtin(frag_depth)`.
    pub writes_depth: bool,
    /// The fragment entry point may discard.
    pub discards: bool,
    /// Overrides that it uses.
    pub overrides: Vec<String>,
}

/// An input of a vertex entry point.
#[derive(Debug, Clone, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct VertexInput {
    pub name: String,
    pub span: Span,
    pub location: u32,
    pub components: u32,
}

/// A value between the vertex and the fragment stage.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Varying {
    /// Of the parameter or member.
    pub name: String,
    /// Where the name stands.
    pub span: Span,
    /// Written by the author.
    pub location: u32,
    /// WGSL type.
    pub wgsl: String,
    /// As in `@interpolate(...)`, with defaults: `perspective, center`.
    pub interpolation: String,
}

/// A color output of a fragment entry point.
#[derive(Debug, Clone, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct ColorOutput {
    pub name: String,
    pub span: Span,
    pub location: u32,
    pub kind: ScalarKind,
    pub components: u32,
}

/// The scalar behind a vector.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum ScalarKind {
    Float,
    Sint,
    Uint,
}

/// A pipeline-overridable constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Override {
    /// Its name.
    pub name: String,
    /// Where it is declared.
    pub span: Span,
    /// `bool`, `f32`, `i32`, `u32`.
    pub wgsl: String,
    /// Whether it has a value of its own.
    pub has_default: bool,
}

/// A resource variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Global {
    /// Its name.
    pub name: String,
    /// Where it is declared.
    pub span: Span,
    /// Assigned: 1 for what every draw binds anew (material textures and samplers), 0 for all else.
    pub group: u32,
    /// Assigned. Group 0: the place among the file's variables of that group; group 1: the place in the schema's material textures,
    /// samplers after them.
    pub binding: u32,
    /// What it is.
    pub kind: GlobalKind,
    /// Of a uniform or storage variable: what the entry point reads of the struct, or of each element of the array.
    pub reads: RowReads,
}

/// What a resource variable is.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum GlobalKind {
    /// `var<uniform>`
    Uniform { layout: Layout },
    /// `var<storage>`
    Storage {
        /// Declared `read_write`, and this entry point writes it.
        writes: bool,
        /// Declared `read_write`.
        writable: bool,
        /// This entry point reads it (or applies atomics).
        reads: bool,
        /// Its memory.
        layout: Layout,
    },
    /// `texture_2d<f32>` and kin.
    Texture {
        dimension: ViewDimension,
        kind: ScalarKind,
        multisampled: bool,
        /// Used together with a filtering sampler by this entry point: `textureSample*` and `textureGather` with `sampler`.
        filtered: bool,
    },
    /// `texture_depth_2d` and kin.
    DepthTexture { dimension: ViewDimension, multisampled: bool },
    /// `texture_storage_2d` and kin.
    StorageTexture { dimension: ViewDimension, format: Format, access: StorageAccess },
    /// `sampler` or `sampler_comparison`.
    Sampler { comparison: bool },
}

/// The dimension of a texture variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum ViewDimension {
    D1,
    D2,
    D2Array,
    D3,
    Cube,
    CubeArray,
}

impl ViewDimension {
    /// The dimension of textures that such a variable can view.
    pub fn of_texture(self) -> Dimension {
        match self {
            ViewDimension::D1 => Dimension::D1,
            ViewDimension::D2 | ViewDimension::D2Array => Dimension::D2,
            ViewDimension::D3 => Dimension::D3,
            ViewDimension::Cube | ViewDimension::CubeArray => Dimension::Cube,
        }
    }
}

/// The access mode of a storage texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)]
pub enum StorageAccess {
    Read,
    Write,
    ReadWrite,
}

/// The memory layout of a uniform or storage variable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// Bytes; of one element where it is a runtime-sized array.
    pub size: u32,
    /// Members of the struct (of the element's struct, for arrays); empty where it is no struct.
    pub members: Vec<Member>,
    /// It is a runtime-sized array, or a struct that ends with one.
    pub runtime_array: bool,
}

impl Layout {
    /// A read of these members, by index.
    pub(super) fn reads(&self, members: impl Iterator<Item = usize>) -> RowReads {
        let end = |index: usize| self.members.get(index + 1).map_or(self.size, |next| next.offset);
        let read = |index: usize| {
            self.members.get(index).map(|member| ReadMember { offset: member.offset, end: end(index), name: member.name.clone() })
        };
        RowReads::Members(members.filter_map(read).collect())
    }
}

/// A member of a struct.
#[derive(Debug, Clone, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Member {
    pub name: String,
    pub span: Span,
    /// WGSL type: `f32`, `u32`, `vec3<f32>`, `mat4x4<f32>`, `array<vec4<f32>, 4>`.
    pub wgsl: String,
    pub offset: u32,
}
