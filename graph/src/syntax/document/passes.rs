//! Passes and loops of a document.

use serde::Deserialize;

use super::{ClearDoc, Entries, Expr, ExprDoc, Text};
use crate::syntax::spanned::Spanned;

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
    /// The orthographic shadow view of a directional light, fitted to one of several parts of the camera's frustum.
    Cascade {
        /// Its index among directional lights.
        light: Expr,
        /// Which part: 0 is nearest to the camera.
        index: Expr,
        /// How many parts there are.
        count: Expr,
        /// Metres from the camera to where the last part ends, at most.
        distance: Expr,
        /// From 0, parts of equal depth, to 1, parts that double in depth.
        lambda: Expr,
        /// Whether a camera that moves shifts the view by whole texels.
        #[serde(default)]
        snap: Option<Expr>,
    },
    /// One cube face of a point light: the light's index among them, and the face.
    PointLight(Expr, Expr),
    /// The perspective shadow view of a spot light, by its index among them.
    SpotLight(Expr),
    /// One cube face of a rectangle of light, from its middle: its index among them, and the face.
    RectangleLight(Expr, Expr),
    /// The orthographic shadow view of a directional light over all of the scene, by its index among them.
    WholeScene(Expr),
    /// One cube face of a reflection probe: its index among them, and the face.
    ReflectionProbe(Expr, Expr),
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
    /// The layers of a texture.
    Layer(Text),
    /// The mip levels of a texture, from the second value on.
    Mip(Text, #[serde(default)] Option<Expr>),
    /// 0, 1 and 2: x, y and z.
    Axis,
    /// What the scene has of something, by the name of its count; at most as many as the second value says.
    Scene(Text, #[serde(default)] Option<Expr>),
}

/// When a pass runs.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(rename = "Run")]
pub enum RunDoc {
    /// When something that it reads has changed.
    #[default]
    OnChange,
    /// In every frame.
    EveryFrame,
    /// Once a frame, so many times after a change.
    Accumulate(Expr),
}

/// When the iterations of a loop run.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename = "RepeatRun", deny_unknown_fields)]
pub enum RepeatRunDoc {
    /// Some a frame, until none is due.
    Spread {
        /// At most so many iterations a frame.
        per_frame: Expr,
        /// How often each runs after a change; once unless said otherwise.
        #[serde(default)]
        rounds: Option<Expr>,
    },
}

/// The buffer that says how many workgroups run.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum IndirectDoc {
    /// `"args"`
    First(String),
    /// `("args", 16)`: so many bytes from its start.
    At(String, ExprDoc),
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
        /// When it runs.
        #[serde(default)]
        run: Spanned<RunDoc>,
        /// Passes that must come first.
        #[serde(default)]
        after: Vec<Text>,
    },
    /// Rasterises triangles that its vertex shader makes from the vertex's and the instance's index.
    Procedural {
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
        /// Vertices of an instance, three per triangle.
        vertices: Expr,
        /// How many instances; one unless said otherwise.
        #[serde(default)]
        instances: Option<Expr>,
        /// Depth test; needs the slot `depth`.
        #[serde(default)]
        depth: Option<Spanned<DepthDoc>>,
        /// Sides left out; counter-clockwise triangles show their front.
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
        /// When it runs.
        #[serde(default)]
        run: Spanned<RunDoc>,
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
        /// When it runs.
        #[serde(default)]
        run: Spanned<RunDoc>,
        /// Passes that must come first.
        #[serde(default)]
        after: Vec<Text>,
    },
    /// Runs a compute shader. Exactly one of `cover`, `count`, `groups` and `indirect`.
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
        /// As many workgroups as three `u32` of a buffer say.
        #[serde(default)]
        indirect: Option<Spanned<IndirectDoc>>,
        /// Inputs by shader variable.
        #[serde(default)]
        read: Entries<Text>,
        /// Outputs by shader variable.
        #[serde(default)]
        write: Entries<Text>,
        /// Outputs that keep what is there.
        #[serde(default)]
        modify: Entries<Text>,
        /// When it runs.
        #[serde(default)]
        run: Spanned<RunDoc>,
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
        /// When it runs.
        #[serde(default)]
        run: Spanned<RunDoc>,
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
        /// When it runs.
        #[serde(default)]
        run: Spanned<RunDoc>,
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
        /// All iterations that are due run as one pass.
        #[serde(default)]
        batched: bool,
        /// Not all iterations run in one frame.
        #[serde(default)]
        run: Option<Spanned<RepeatRunDoc>>,
        /// What is repeated.
        passes: Entries<PassDoc>,
        /// Passes that must come first.
        #[serde(default)]
        after: Vec<Text>,
    },
}

impl PassDoc {
    /// What its slots name: outputs first, then inputs.
    pub fn slots(&self) -> Vec<(&str, &Text)> {
        match self {
            PassDoc::Draw { read, write, modify, .. }
            | PassDoc::Procedural { read, write, modify, .. }
            | PassDoc::Fullscreen { read, write, modify, .. }
            | PassDoc::Compute { read, write, modify, .. } => {
                [write, modify, read].into_iter().flatten().map(|(name, part)| (name.value.as_str(), part)).collect()
            }
            PassDoc::Copy { read, write, .. } => vec![("write", write), ("read", read)],
            PassDoc::Clear { write, .. } => vec![("write", write)],
            PassDoc::Repeat { .. } => Vec::new(),
        }
    }
}
