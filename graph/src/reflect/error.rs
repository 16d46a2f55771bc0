//! What can be wrong with a shader file, and how it is told.

use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::source::{FileError, Span};

/// A label: a place and what is there.
pub(super) type Place = (Span, String);

/// A problem that reflection found.
#[derive(Debug, Clone, thiserror::Error)]
pub(super) enum ReflectError {
    /// A file could not be read.
    #[error("can't read the {} `{path}`: {cause}", if *is_root { "shader file" } else { "imported shader file" })]
    FileUnreadable { path: String, span: Span, cause: FileError, nearest: Option<String>, is_root: bool },
    /// A path with more than one spelling.
    #[error("the path `{path}` is not plain")]
    ImportPath { path: String, span: Span },
    /// A `#` line that is no import.
    #[error("`{line}` is not an import")]
    ImportSyntax { line: String, span: Span },
    /// The files, the first again at the end.
    #[error("imports go in a circle: {}", cycle.iter().map(|path| format!("`{path}`")).collect::<Vec<_>>().join(" -> "))]
    ImportCycle { cycle: Vec<String>, span: Span },
    /// Too much text.
    #[error("`{path}` and what was imported before it have more than {limit} bytes")]
    TooLarge { path: String, span: Span, limit: usize },
    /// More than naga can follow.
    #[error("{what}")]
    TooComplex { what: String, span: Span },
    /// `/*` without `*/`.
    #[error("a comment is never closed")]
    OpenComment { span: Span },
    /// A bracket without its partner.
    #[error("`{bracket}` has no partner in its file")]
    Unbalanced { bracket: String, span: Span },
    /// naga could not parse it.
    #[error("{message}")]
    Syntax { message: String, places: Vec<Place>, notes: Vec<String> },
    /// naga found it invalid.
    #[error("{message}")]
    Invalid { message: String, places: Vec<Place>, notes: Vec<String> },
    /// `@group` or `@binding`.
    #[error("the variable `{name}` has {attributes}")]
    WrittenBinding { name: String, attributes: String, span: Span },
    /// `@location` where names bind.
    #[error("the {what} `{name}` of `{entry}` has @location")]
    WrittenLocation { what: &'static str, name: String, entry: String, span: Span },
    /// No `@location` where names do not bind.
    #[error("the {what} `{name}` of `{entry}` has no @location")]
    MissingLocation { what: &'static str, name: String, entry: String, span: Span },
    /// A color without a name.
    #[error("the fragment entry point `{entry}` returns a value that has no name")]
    UnnamedOutput { entry: String, span: Span },
    /// Two structs with vertex inputs.
    #[error("the vertex entry point `{entry}` takes its inputs from more than one struct")]
    TwoInputStructs { entry: String, span: Span },
    /// Not a float vector.
    #[error("the vertex input `{name}` of `{entry}` has type `{wgsl}`")]
    VertexInputType { name: String, entry: String, wgsl: String, span: Span },
    /// Not a 32-bit number or vector.
    #[error("the output `{name}` of `{entry}` has type `{wgsl}`")]
    OutputType { name: String, entry: String, wgsl: String, span: Span },
    /// A stage that pipelines have not.
    #[error("the entry point `{entry}` is of stage {stage}, which no pass kind runs")]
    Stage { entry: String, stage: String, span: Span },
    /// A variable of a kind that nothing can feed.
    #[error("the variable `{name}` is {what}, which no pipeline can bind")]
    Unsupported { name: String, what: String, span: Span },
    /// An atomic float.
    #[error("the variable `{name}` holds float atomics (`{wgsl}`)")]
    FloatAtomic { name: String, wgsl: String, span: Span },
    /// A storage texture format that pipelines can't name.
    #[error("the storage texture `{name}` has format `{format}`, which {why}")]
    StorageFormat { name: String, format: String, why: &'static str, span: Span },
    /// A size that can't be told.
    #[error("the workgroup size of `{entry}` has no value: {why}")]
    WorkgroupSize { entry: String, why: String, span: Span },
    /// A vertex stage that could write.
    #[error("the vertex entry point `{entry}` uses `{name}`, which it could write")]
    VertexWrites { entry: String, name: String, span: Span },
    /// Bytes that do not fit.
    #[error("the variable `{name}` has more bytes than can be counted")]
    LayoutTooLarge { name: String, span: Span },
}

impl ReflectError {
    /// The stable code.
    fn code(&self) -> &'static str {
        match self {
            ReflectError::FileUnreadable { is_root: true, .. } => "reflect::missing-shader",
            ReflectError::FileUnreadable { .. } => "reflect::missing-import",
            ReflectError::ImportPath { .. } => "reflect::import-path",
            ReflectError::ImportSyntax { .. } => "reflect::import-syntax",
            ReflectError::ImportCycle { .. } => "reflect::import-cycle",
            ReflectError::TooLarge { .. } => "reflect::shader-too-large",
            ReflectError::TooComplex { .. } => "reflect::too-complex",
            ReflectError::OpenComment { .. } => "reflect::open-comment",
            ReflectError::Unbalanced { .. } => "reflect::unbalanced-bracket",
            ReflectError::Syntax { .. } => "reflect::wgsl-syntax",
            ReflectError::Invalid { .. } => "reflect::wgsl-invalid",
            ReflectError::WrittenBinding { .. } => "reflect::written-binding",
            ReflectError::WrittenLocation { .. } => "reflect::written-location",
            ReflectError::MissingLocation { .. } => "reflect::missing-location",
            ReflectError::UnnamedOutput { .. } => "reflect::unnamed-output",
            ReflectError::TwoInputStructs { .. } => "reflect::two-input-structs",
            ReflectError::VertexInputType { .. } => "reflect::vertex-input-type",
            ReflectError::OutputType { .. } => "reflect::output-type",
            ReflectError::Stage { .. } => "reflect::unsupported-stage",
            ReflectError::Unsupported { .. } => "reflect::unsupported-variable",
            ReflectError::FloatAtomic { .. } => "reflect::float-atomic",
            ReflectError::StorageFormat { .. } => "reflect::storage-format",
            ReflectError::WorkgroupSize { .. } => "reflect::workgroup-size-override",
            ReflectError::VertexWrites { .. } => "reflect::vertex-stage-writable",
            ReflectError::LayoutTooLarge { .. } => "reflect::layout-too-large",
        }
    }

    /// Whether naga would refuse the module for the same reason, in other words.
    pub(super) fn blocks_validation(&self) -> bool {
        match self {
            ReflectError::WrittenBinding { .. }
            | ReflectError::WrittenLocation { .. }
            | ReflectError::WorkgroupSize { .. }
            | ReflectError::VertexWrites { .. } => false,
            ReflectError::StorageFormat { format, .. } => format.ends_with("16unorm") || format.ends_with("16snorm"),
            _ => true,
        }
    }

    /// What to do about it.
    fn hint(&self) -> Option<String> {
        let hint = match self {
            ReflectError::FileUnreadable { path, nearest, .. } => return did_you_mean(path, nearest.as_deref()),
            ReflectError::ImportPath { .. } => "paths start at the shaders folder, as in `shared/brdf.wgsl`, without `.`, `..` and `\\`",
            ReflectError::ImportSyntax { .. } => {
                "the only directive is `#import \"folder/file.wgsl\"`, on a line of its own; variants are `override` constants"
            }
            ReflectError::ImportCycle { .. } => "move what both files need into a third one",
            ReflectError::WrittenBinding { .. } => "leave them out: variables bind by name, and the compiler assigns groups and bindings",
            ReflectError::WrittenLocation { .. } => {
                "leave it out: vertex inputs and fragment outputs bind by name; only what goes from the vertex to the fragment stage has \
                 @location, in a struct of its own"
            }
            ReflectError::MissingLocation { .. } => {
                "values between the vertex and the fragment stage need @location(n), equal on both sides"
            }
            ReflectError::UnnamedOutput { .. } => {
                "return a struct whose members are named after the slots that they write, without @location"
            }
            ReflectError::TwoInputStructs { .. } => "put all vertex inputs into one struct",
            ReflectError::VertexInputType { .. } => "vertex inputs are `f32`, `vec2<f32>`, `vec3<f32>` or `vec4<f32>`",
            ReflectError::OutputType { .. } => "color outputs are 32-bit numbers or vectors of them",
            ReflectError::Unsupported { .. } => "shaders can have uniform and storage buffers, textures, storage textures and samplers",
            ReflectError::FloatAtomic { .. } => {
                "their sums depend on the order of invocations; accumulate fixed-point numbers in `atomic<u32>`, or gather instead"
            }
            ReflectError::WorkgroupSize { .. } => "give each override that it uses a default, and use whole-number arithmetic only",
            ReflectError::VertexWrites { .. } => "declare it `read`, or write it in a compute or fragment entry point",
            _ => return None,
        };
        Some(hint.to_owned())
    }

    /// Labelled places, the first is the primary one.
    fn places(&self) -> Vec<Place> {
        let (span, text) = match self {
            ReflectError::Syntax { places, .. } | ReflectError::Invalid { places, .. } => return places.clone(),
            ReflectError::FileUnreadable { span, is_root: true, .. } => (span, "asked for here"),
            ReflectError::FileUnreadable { span, .. } => (span, "imported here"),
            ReflectError::ImportCycle { span, .. } => (span, "this import closes the circle"),
            ReflectError::OpenComment { span } => (span, "it starts here"),
            ReflectError::ImportPath { span, .. } | ReflectError::TooLarge { span, .. } => (span, "this file"),
            ReflectError::ImportSyntax { span, .. }
            | ReflectError::Unbalanced { span, .. }
            | ReflectError::TooComplex { span, .. }
            | ReflectError::WrittenBinding { span, .. }
            | ReflectError::WrittenLocation { span, .. }
            | ReflectError::MissingLocation { span, .. } => (span, "here"),
            ReflectError::UnnamedOutput { span, .. } => (span, "this result"),
            ReflectError::TwoInputStructs { span, .. }
            | ReflectError::WorkgroupSize { span, .. }
            | ReflectError::VertexWrites { span, .. }
            | ReflectError::Stage { span, .. } => (span, "this entry point"),
            ReflectError::VertexInputType { span, .. } => (span, "this input"),
            ReflectError::OutputType { span, .. } => (span, "this output"),
            ReflectError::Unsupported { span, .. }
            | ReflectError::FloatAtomic { span, .. }
            | ReflectError::StorageFormat { span, .. }
            | ReflectError::LayoutTooLarge { span, .. } => (span, "declared here"),
        };
        vec![(*span, text.to_owned())]
    }

    /// Causes and facts.
    fn notes(&self) -> Vec<String> {
        match self {
            ReflectError::Syntax { notes, .. } | ReflectError::Invalid { notes, .. } => notes.clone(),
            _ => Vec::new(),
        }
    }
}

impl From<ReflectError> for Diagnostic {
    fn from(error: ReflectError) -> Diagnostic {
        let mut diagnostic = Diagnostic::error(error.code(), error.to_string()).maybe_hint(error.hint());
        diagnostic.notes = error.notes();
        for (index, (span, text)) in error.places().into_iter().enumerate() {
            diagnostic = if index == 0 { diagnostic.at(span, text) } else { diagnostic.and(span, text) };
        }
        diagnostic
    }
}
