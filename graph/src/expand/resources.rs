//! Resources with numbers in place of expressions, within the device's limits.

use smallvec::SmallVec;

use super::environment::Environment;
use super::error::ExpandError;
use super::extents;
use super::types::{Dimension, Resource, Shape, TextureShape, Value};
use crate::device::DeviceFacts;
use crate::format::Format;
use crate::source::Span;
use crate::validate::types::{FormatChoice, Mips, PlacedExpr, ResourceDecl, ResourceKind, Size, Validated};

/// Computes the extents of all resources; `None` if something is wrong.
pub(super) fn resources(environment: &mut Environment<'_>, validated: &Validated, device: &DeviceFacts) -> Option<Vec<Resource>> {
    let decls = &validated.resources;
    environment.shapes = vec![None; decls.len()];
    let mut found: Vec<Option<Resource>> = vec![None; decls.len()];
    for index in extents::order(environment, validated)? {
        // One whose size names a faulty one has no fault of its own.
        if extents::named(&decls[index], &validated.measured).all(|other| environment.shapes.get(other).is_some_and(Option::is_some)) {
            found[index] = resource(environment, &decls[index], device);
            environment.shapes[index] = found[index].as_ref().map(|resource| resource.shape.clone());
        }
    }
    found.into_iter().collect()
}

/// Computes the extent of one resource.
fn resource(environment: &mut Environment<'_>, decl: &ResourceDecl, device: &DeviceFacts) -> Option<Resource> {
    let name = decl.name.value.as_str();
    let shape = match &decl.kind {
        ResourceKind::Buffer { size } => {
            let bytes = environment.count(size, &format!("the size of `{name}`"))?;
            let mut check = Check { environment, name, device };
            check.within("its size in bytes", bytes, device.max_buffer_bytes, size.span)?;
            if !bytes.is_multiple_of(4) {
                check.bad(format!("its size of {bytes} bytes is no multiple of 4"), "round up: `4 * div_ceil(n, 4)`", size.span);
                return None;
            }
            Shape::Buffer { bytes }
        }
        ResourceKind::Texture { .. } => Shape::Texture(texture(environment, name, &decl.kind, device)?),
    };
    Some(Resource { name: name.to_owned(), span: decl.name.span, shape, clear: decl.clear, history: None, keep: decl.keep.value })
}

struct Check<'a, 'b> {
    environment: &'a mut Environment<'b>,
    name: &'a str,
    device: &'a DeviceFacts,
}

impl Check<'_, '_> {
    /// A size that is at least 1 and at most the limit.
    fn within(&mut self, what: &'static str, value: u64, limit: u64, span: Span) -> Option<u32> {
        let name = self.name.to_owned();
        if value == 0 {
            self.environment.report(ExpandError::SizeZero { name, what, span });
            return None;
        }
        if value > limit {
            let device = self.device.name.clone();
            self.environment.report(ExpandError::SizeOverLimit { name, what, value, limit, device, span });
            return None;
        }
        Some(value.min(u64::from(u32::MAX)) as u32)
    }

    fn axis(&mut self, what: &'static str, expr: &PlacedExpr, limit: u32) -> Option<u32> {
        let value = self.environment.count(expr, &format!("{what} of `{}`", self.name))?;
        self.within(what, value, u64::from(limit), expr.span)
    }

    fn bad(&mut self, reason: String, hint: &'static str, span: Span) {
        let name = self.name.to_owned();
        self.environment.report(ExpandError::BadResource { name, reason, hint, span });
    }
}

fn texture(environment: &mut Environment<'_>, name: &str, kind: &ResourceKind, device: &DeviceFacts) -> Option<TextureShape> {
    let ResourceKind::Texture { dimension, formats, format_span, size, size_span, layers, mips, samples } = kind else { return None };
    let dimension = *dimension;
    let formats = self::formats(environment, formats);
    let output = environment.output;
    let mut check = Check { environment, name, device };
    let limit_2d = device.max_texture_2d;
    let (width, height, depth) = match size {
        Size::Output => {
            let width = check.within("the width", u64::from(output[0]), u64::from(limit_2d), *size_span);
            let height = check.within("the height", u64::from(output[1]), u64::from(limit_2d), *size_span);
            (width?, height?, 1)
        }
        Size::Scaled(factor) => {
            let factor_value = check.environment.number(factor, &format!("the scale of `{name}`"))?;
            let scaled = |extent: u32| (f64::from(extent) * factor_value).ceil().clamp(0.0, 1.0e9) as u64;
            let width = check.within("the width", scaled(output[0]), u64::from(limit_2d), factor.span);
            let height = check.within("the height", scaled(output[1]), u64::from(limit_2d), factor.span);
            (width?, height?, 1)
        }
        Size::Line(width) => (check.axis("the width", width, device.max_texture_1d)?, 1, 1),
        Size::Square(edge) => {
            let edge = check.axis("the edge", edge, limit_2d)?;
            (edge, edge, 1)
        }
        Size::Exact(width, height) => {
            let (width, height) = (check.axis("the width", width, limit_2d), check.axis("the height", height, limit_2d));
            (width?, height?, 1)
        }
        Size::Cube(edge) => {
            let edge = check.axis("the edge", edge, device.max_texture_3d)?;
            (edge, edge, edge)
        }
        Size::Volume(x, y, z) => {
            let limit = device.max_texture_3d;
            let (x, y, z) = (check.axis("the width", x, limit), check.axis("the height", y, limit), check.axis("the depth", z, limit));
            (x?, y?, z?)
        }
    };
    let faces = if dimension == Dimension::Cube { 6 } else { 1 };
    let layers = match layers {
        None => faces,
        Some(expr) => {
            let what = if faces == 6 { "the number of cubes" } else { "the number of layers" };
            check.axis(what, expr, device.max_layers / faces)? * faces
        }
    };
    let largest = width.max(height).max(depth);
    let full = if dimension == Dimension::D1 { 1 } else { largest.ilog2() + 1 };
    let mips = match mips {
        None => 1,
        Some(Mips::Full) => full,
        Some(Mips::Count(expr)) => {
            let count = check.environment.count(expr, &format!("the mips of `{name}`"))?;
            if count == 0 || count > u64::from(full) {
                check.bad(
                    format!("it can have 1 to {full} mips at this size, not {count}"),
                    "`mips: Full` goes down to one texel",
                    expr.span,
                );
                return None;
            }
            count as u32
        }
    };
    let samples = match samples {
        None => 1,
        Some(expr) => match check.environment.count(expr, &format!("the samples of `{name}`"))? {
            1 => 1,
            4 if dimension == Dimension::D2 && layers == 1 && mips == 1 => 4,
            4 => {
                check.bad(
                    "only 2D textures with one layer and one mip can have 4 samples".to_owned(),
                    "leave out layers and mips",
                    expr.span,
                );
                return None;
            }
            other => {
                check.bad(format!("a texture has 1 or 4 samples, not {other}"), "those two are what every adapter offers", expr.span);
                return None;
            }
        },
    };
    if samples == 4
        && let Some(format) = formats.iter().find(|format| !format.info().multisample)
    {
        check.bad(
            format!("the format {format} can't have 4 samples"),
            "choose a format that can be multisampled, such as rgba16float",
            *format_span,
        );
        return None;
    }
    if matches!(dimension, Dimension::D1 | Dimension::D3)
        && let Some(format) = formats.iter().find(|format| format.is_depth())
    {
        check.bad(format!("the depth format {format} needs a 2D or cube texture"), "use `dimension: D2` or `Cube`", *format_span);
        return None;
    }
    Some(TextureShape { dimension, formats, format_span: *format_span, width, height, depth, layers, mips, samples })
}

/// What choices come to, each format once.
fn formats(environment: &Environment<'_>, choices: &[FormatChoice]) -> SmallVec<[Format; 4]> {
    let mut found = SmallVec::new();
    for choice in choices {
        let format = match choice {
            FormatChoice::Named(format) => Some(*format),
            FormatChoice::Param(name, options) => {
                match environment.params.iter().find(|param| param.name == *name).map(|param| &param.value) {
                    Some(Value::Word(index, _)) => options.get(*index as usize).copied(),
                    _ => None,
                }
            }
        };
        found.extend(format.filter(|format| !found.contains(format)));
    }
    found
}
