//! The words that every form of a plan uses for parts, accesses, values and reasons.

use std::ops::Range;

use crate::expand::types::{ClearValue, Dimension, PassId, ResourceId, TextureShape, Value};
use crate::plan::{Access, Alone, CullReason, Plan, PlannedResource, PlannedShape, Retained, Role, Usage};
use crate::published::{DrawFilter, ViewKind};
use crate::schedule::part::Rect;
use crate::source::{SourceMap, Span};

/// `file:line:column` of a place, if it is in a file.
pub(super) fn place(sources: &SourceMap, span: Span) -> Option<String> {
    let (line, column) = sources.line_column(span)?;
    Some(format!("{}:{line}:{column}", sources.get(span.file)?.name))
}

/// The name of a resource.
pub(super) fn resource(plan: &Plan, id: ResourceId) -> &str {
    plan.resources.get(id.index()).map_or("?", |resource| resource.name.as_str())
}

/// The name of a pass, culled or not.
pub(super) fn pass(plan: &Plan, id: PassId) -> &str {
    let run = plan.steps.iter().find(|step| step.pass == id).map(|step| &*step.name);
    run.or_else(|| plan.culled.iter().find(|culled| culled.pass == id).map(|culled| &*culled.name)).unwrap_or("?")
}

/// The name of a part: `x`, `x.mip(1)`, `x.face(2)`.
pub(super) fn part(plan: &Plan, id: ResourceId, mips: &Range<u32>, layers: &Range<u32>) -> String {
    let Some(resource) = plan.resources.get(id.index()) else { return "?".to_owned() };
    let (dimension, whole) = match &resource.shape {
        PlannedShape::Buffer(_) => (None, Rect::new(&(0..1), &(0..1))),
        PlannedShape::Texture(shape, _) => (Some(shape.dimension), Rect::new(&(0..shape.mips), &(0..layers_of(shape)))),
    };
    Rect::new(mips, layers).name_in(&resource.name, dimension, &whole)
}

fn layers_of(shape: &TextureShape) -> u32 {
    if shape.dimension == Dimension::D3 { 1 } else { shape.layers }
}

/// Width, height and depth of a mip level.
pub(super) fn mip_extent(shape: &TextureShape, mip: u32) -> [u32; 3] {
    [shape.width, shape.height, shape.depth].map(|edge| edge.checked_shr(mip).unwrap_or(0).max(1))
}

/// `64 x 32`, of the dimensions that a texture has.
pub(super) fn extent(shape: &TextureShape, mip: u32) -> String {
    let [width, height, depth] = mip_extent(shape, mip);
    match shape.dimension {
        Dimension::D1 => width.to_string(),
        Dimension::D2 | Dimension::Cube => format!("{width} x {height}"),
        Dimension::D3 => format!("{width} x {height} x {depth}"),
    }
}

/// The format and extent of a part: `rgba16float 64 x 64`, `1024 B`.
pub(super) fn content(plan: &Plan, id: ResourceId, mips: &Range<u32>) -> String {
    match plan.resources.get(id.index()).map(|resource| &resource.shape) {
        Some(PlannedShape::Texture(shape, format)) => format!("{format} {}", extent(shape, mips.start)),
        Some(PlannedShape::Buffer(bytes)) => super::units::bytes(*bytes),
        None => "?".to_owned(),
    }
}

/// What a resource is, in full.
pub(super) fn shape(resource: &PlannedResource) -> String {
    let PlannedShape::Texture(shape, format) = &resource.shape else { return "buffer".to_owned() };
    let mut text = format!("{} {format} {}", dimension(shape.dimension), extent(shape, 0));
    for (count, usual, word) in [
        (shape.layers, if shape.dimension == Dimension::Cube { 6 } else { 1 }, "layers"),
        (shape.mips, 1, "mips"),
        (shape.samples, 1, "samples"),
    ] {
        if count != usual {
            text += &format!(", {count} {word}");
        }
    }
    text
}

/// The dimension of a texture.
pub(super) fn dimension(dimension: Dimension) -> &'static str {
    match dimension {
        Dimension::D1 => "1D",
        Dimension::D2 => "2D",
        Dimension::D3 => "3D",
        Dimension::Cube => "cube",
    }
}

/// What a pass does to a part.
pub(super) fn role(role: Role) -> &'static str {
    match role {
        Role::Read => "reads",
        Role::Produce => "writes",
        Role::Modify => "modifies",
        Role::Recall => "recalls",
    }
}

/// How it does it.
pub(super) fn access(access: Access) -> &'static str {
    match access {
        Access::Sampled => "sampled",
        Access::StorageRead => "storage, read",
        Access::StorageWrite => "storage, write",
        Access::StorageReadWrite => "storage, read and write",
        Access::Uniform => "uniform",
        Access::ColorAttachment => "color target",
        Access::DepthAttachment => "depth target",
        Access::DepthReadOnly => "depth, tested only",
        Access::CopySource => "copied from",
        Access::CopyTarget => "copied to",
        Access::Clear => "cleared",
        Access::Indirect => "says how much work",
    }
}

/// The usages that are set.
pub(super) fn usages(usage: Usage) -> Vec<&'static str> {
    let Usage { sampled, storage, uniform, attachment, copy_source, copy_target, indirect } = usage;
    let all = [
        (sampled, "sampled"),
        (storage, "storage"),
        (uniform, "uniform"),
        (attachment, "attachment"),
        (copy_source, "copy source"),
        (copy_target, "copy target"),
        (indirect, "indirect"),
    ];
    all.into_iter().filter(|(set, _)| *set).map(|(_, word)| word).collect()
}

/// A value to clear to.
pub(super) fn clear(value: ClearValue) -> String {
    match value {
        ClearValue::Zero => "zero".to_owned(),
        ClearValue::Color([r, g, b, a]) => format!("({r}, {g}, {b}, {a})"),
        ClearValue::Depth(depth) => format!("depth {depth}"),
        ClearValue::Uint([r, g, b, a]) => format!("({r}, {g}, {b}, {a})"),
    }
}

/// The value of a parameter, as it is written in RON.
pub(super) fn value(value: &Value) -> String {
    match value {
        Value::Bool(value) => value.to_string(),
        Value::Int(value) => value.to_string(),
        Value::Float(value) => format!("{value:?}"),
        Value::Word(_, word) => format!("{word:?}"),
        Value::Vector(values) => {
            let values: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
            format!("({})", values.join(", "))
        }
    }
}

/// From where a pass draws.
pub(super) fn view(kind: ViewKind) -> String {
    match kind {
        ViewKind::Camera => "the camera".to_owned(),
        ViewKind::DirectionalLight(light) => format!("directional light {light}"),
        ViewKind::Cascade(cascade) => format!("directional light {}, cascade {}", cascade.light, cascade.index),
        ViewKind::PointLight(light, face) => format!("point light {light}, face {face}"),
        ViewKind::SpotLight(light) => format!("spot light {light}"),
        ViewKind::RectangleLight(light, face) => format!("rectangle of light {light}, face {face}"),
        ViewKind::WholeScene(light) => format!("directional light {light}, whole scene"),
        ViewKind::ReflectionProbe(probe, face) => format!("reflection probe {probe}, face {face}"),
    }
}

/// Which surfaces it draws.
pub(super) fn objects(filter: DrawFilter) -> &'static str {
    match filter {
        DrawFilter::Opaque => "opaque",
        DrawFilter::Masked => "masked",
        DrawFilter::Solid => "solid",
        DrawFilter::Blended => "blended",
        DrawFilter::All => "all",
    }
}

/// Why a resource has bytes of its own.
pub(super) fn alone(plan: &Plan, alone: Alone) -> String {
    match alone {
        Alone::Retained(why) => format!("retained, since {}", retained(why)),
        Alone::OnlyOfItsDescriptor => "shares with nothing: no other texture has its format, extent, layers, mips and samples".to_owned(),
        Alone::InUseTogether { count, step } => {
            format!("shares with nothing: {count} textures of its kind are in use at once at step {step}")
        }
        Alone::OnlyBuffer => "shares with nothing: there is no other buffer".to_owned(),
        Alone::BuffersInUse => "shares no bytes: every other buffer is in use at the same time".to_owned(),
        Alone::AccessConflict { rival } => {
            format!("shares no bytes: a pass uses `{}` of the arena it would fit in with other access", resource(plan, rival))
        }
        Alone::NothingToGain => "shares no bytes: the arena has room for it as it is".to_owned(),
    }
}

/// Why a resource keeps its content, as the end of a sentence.
pub(super) fn retained(why: Retained) -> &'static str {
    match why {
        Retained::Output => "it is an output",
        Retained::History => "it is remembered from frame to frame",
        Retained::Amortised => "passes that run a few at a time make or read it",
        Retained::Kept => "its author says `keep: Always`",
        Retained::Read => "a reader can run without its maker",
    }
}

/// Stable names of the reasons, for programs.
pub(super) fn alone_name(alone: Alone) -> &'static str {
    match alone {
        Alone::Retained(Retained::Output) => "retained-output",
        Alone::Retained(Retained::History) => "retained-history",
        Alone::Retained(Retained::Amortised) => "retained-amortised",
        Alone::Retained(Retained::Kept) => "retained-kept",
        Alone::Retained(Retained::Read) => "retained-read",
        Alone::OnlyOfItsDescriptor => "only-of-its-descriptor",
        Alone::InUseTogether { .. } => "in-use-together",
        Alone::OnlyBuffer => "only-buffer",
        Alone::BuffersInUse => "buffers-in-use",
        Alone::AccessConflict { .. } => "access-conflict",
        Alone::NothingToGain => "nothing-to-gain",
    }
}

/// Why a pass does not run.
pub(super) fn culled(plan: &Plan, reason: &CullReason) -> String {
    match reason {
        CullReason::WritesNothing => "it writes nothing".to_owned(),
        CullReason::Unread => "nothing reads what it writes, and no asked-for output shows it".to_owned(),
        CullReason::OnlyCulledReaders(readers) => {
            let names = crate::diagnostic::list_names(readers.iter().map(|reader| pass(plan, *reader)));
            format!("only passes that do not run read what it writes: {names}")
        }
    }
}

/// The other holders of a resource's memory that have some of the same bytes at another time, by first use.
pub(crate) fn sharers(plan: &Plan, id: ResourceId) -> Vec<ResourceId> {
    let bytes = |id: ResourceId| {
        let resource = plan.resources.get(id.index())?;
        let start = resource.placement?.offset;
        Some(start..start.saturating_add(resource.bytes))
    };
    let memory = plan.resources.get(id.index()).and_then(|resource| plan.memories.get(resource.placement?.memory.index()));
    let (Some(memory), Some(own)) = (memory, bytes(id)) else { return Vec::new() };
    let overlaps = |other: &Range<u64>| other.start < own.end && own.start < other.end;
    memory.holders.iter().copied().filter(|other| *other != id && bytes(*other).is_some_and(|bytes| overlaps(&bytes))).collect()
}
