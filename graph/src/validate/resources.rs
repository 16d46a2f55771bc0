//! Resources: formats that exist, sizes that fit the dimension, clear values that fit the format.

use super::error::ValidateError;
use super::scope::Scope;
use super::types::{FormatChoice, Mips, PlacedExpr, ResourceDecl, ResourceKind, Size};
use crate::expand::types::{ClearValue, Dimension, Keep, Located, OnResize, Value};
use crate::expression::Expression;
use crate::format::{FORMATS, Format, SampleKind};
use crate::source::Span;
use crate::syntax::document::{ClearDoc, DimensionDoc, FormatDoc, HistoryDoc, KeepDoc, MipsDoc, OnResizeDoc, ResourceDoc, SizeDoc, Text};
use crate::syntax::spanned::Spanned;

/// Checks one resource.
pub(super) fn resource(scope: &mut Scope<'_>, name: &Text, doc: &ResourceDoc) -> Option<ResourceDecl> {
    scope.check_name(name);
    let located = Located { value: format!("{}{}", scope.instance().path, name.value), span: name.span };
    match doc {
        ResourceDoc::Buffer { size, clear, history, keep, .. } => {
            let size = scope.expression(size)?;
            let clear = match clear {
                None => None,
                Some(Spanned { value: ClearDoc::Zero, .. }) => Some(ClearValue::Zero),
                Some(other) => {
                    report(scope, name, "a buffer can only be cleared to `Zero`".to_owned(), other.span);
                    None
                }
            };
            if let Some(HistoryDoc { first: Some(first), .. }) = history.as_ref().map(|history| history.value)
                && first != ClearDoc::Zero
            {
                report(scope, name, "a buffer can only begin as `Zero`".to_owned(), history.as_ref().map_or(name.span, |doc| doc.span));
            }
            Some(with_past(located, ResourceKind::Buffer { size }, clear, history.as_ref(), keep.as_ref()))
        }
        ResourceDoc::Image { file, format, loaded, .. } => {
            let formats = formats(scope, &Spanned::new(FormatDoc::One(format.value.clone()), format.span))?;
            if formats
                .iter()
                .flat_map(FormatChoice::all)
                .any(|format| !matches!(format.info().sample, SampleKind::Float | SampleKind::UnfilterableFloat))
            {
                let reason = format!("an image holds fractions, and {} does not", format.value);
                let hint = Some("choose a float or normalised format, such as rgba16float".to_owned());
                scope.report(ValidateError::BadResource { name: name.value.clone(), reason, hint, span: format.span });
                return None;
            }
            let image = loaded.as_ref()?;
            let edge = |texels: u32| PlacedExpr { expression: Expression::Literal(Value::Int(i64::from(texels))), span: file.span };
            let kind = ResourceKind::Texture {
                dimension: Dimension::D2,
                formats,
                format_span: format.span,
                size: Size::Exact(edge(image.width), edge(image.height)),
                size_span: file.span,
                layers: None,
                mips: None,
                samples: None,
            };
            Some(with_past(located, kind, None, None, None))
        }
        ResourceDoc::Texture { dimension, format, size, layers, mips, samples, clear, history, keep, .. } => {
            let dimension = match dimension {
                DimensionDoc::D1 => Dimension::D1,
                DimensionDoc::D2 => Dimension::D2,
                DimensionDoc::D3 => Dimension::D3,
                DimensionDoc::Cube => Dimension::Cube,
            };
            let span = size.span;
            let formats = formats(scope, format);
            let shape = self::size(scope, name, dimension, size);
            let layers_span = layers.as_ref().map(|layers| layers.span);
            let layers = optional(scope, layers.as_ref());
            if let (Some(span), Dimension::D1 | Dimension::D3) = (layers_span, dimension) {
                report(scope, name, "only 2D and cube textures have layers".to_owned(), span);
            }
            let mips = mips.as_ref().map(|mips| match &mips.value {
                MipsDoc::Full => Some(Mips::Full),
                MipsDoc::Count(count) => scope.expression(count).map(Mips::Count),
            });
            let samples = optional(scope, samples.as_ref());
            let formats = formats?;
            let clear = clear.as_ref().and_then(|clear| clear_value(scope, name, clear, &formats));
            if let Some(history) = history
                && let Some(first) = history.value.first
            {
                clear_value(scope, name, &Spanned::new(first, history.span), &formats);
            }
            let (size, layers, mips, samples) = (shape?, layers?, transpose(mips)?, samples?);
            let kind = ResourceKind::Texture {
                dimension,
                formats,
                format_span: format.span,
                size,
                size_span: if span.is_somewhere() { span } else { name.span },
                layers,
                mips,
                samples,
            };
            Some(with_past(located, kind, clear, history.as_ref(), keep.as_ref()))
        }
    }
}

fn with_past(
    name: Located<String>,
    kind: ResourceKind,
    clear: Option<ClearValue>,
    history: Option<&Spanned<HistoryDoc>>,
    keep: Option<&Spanned<KeepDoc>>,
) -> ResourceDecl {
    let first = history.and_then(|history| history.value.first).map(plain_clear);
    let on_resize = match history.map(|history| history.value.on_resize).unwrap_or_default() {
        OnResizeDoc::First => OnResize::First,
        OnResizeDoc::Crop => OnResize::Crop,
    };
    let span = keep.map_or(name.span, |keep| keep.span);
    let keep = match keep.map(|keep| keep.value) {
        None | Some(KeepDoc::Auto) => Keep::Auto,
        Some(KeepDoc::Always) => Keep::Always,
        Some(KeepDoc::Never) => Keep::Never,
    };
    ResourceDecl { name, kind, clear, first, on_resize, keep: Located { value: keep, span } }
}

/// `Some(None)` where nothing is given, `None` where what is given is wrong.
fn optional(scope: &mut Scope<'_>, expr: Option<&crate::syntax::document::Expr>) -> Option<Option<PlacedExpr>> {
    match expr {
        None => Some(None),
        Some(expr) => scope.expression(expr).map(Some),
    }
}

fn transpose<T>(value: Option<Option<T>>) -> Option<Option<T>> {
    match value {
        None => Some(None),
        Some(inner) => inner.map(Some),
    }
}

fn report(scope: &mut Scope<'_>, name: &Text, reason: String, span: Span) {
    scope.report(ValidateError::BadResource { name: name.value.clone(), reason, hint: None, span });
}

fn formats(scope: &mut Scope<'_>, format: &Spanned<FormatDoc>) -> Option<Vec<FormatChoice>> {
    let names = format.value.names();
    let choices: Vec<FormatChoice> = names.iter().filter_map(|name| format_choice(scope, name, format.span)).collect();
    (choices.len() == names.len() && !choices.is_empty()).then_some(choices)
}

/// A format by its name, or by that of a parameter whose options are formats.
fn format_choice(scope: &mut Scope<'_>, name: &str, span: Span) -> Option<FormatChoice> {
    if let Some(format) = Format::from_name(name) {
        if scope.is_param(name) {
            scope.report(ValidateError::Ambiguous { name: name.to_owned(), first: "a format", second: "a parameter", span });
        }
        return Some(FormatChoice::Named(format));
    }
    let formats = || FORMATS.iter().map(|info| info.name.to_owned());
    let document = scope.document();
    let Some((declared, param)) = document.params.get_key_value(name) else {
        // Parameters are known, too, where they are words.
        let words = document.params.iter().filter(|(_, param)| param.options.is_some()).map(|(name, _)| name.value.clone());
        let known = words.chain(formats()).collect();
        scope.report(ValidateError::Unknown { what: "format", name: name.to_owned(), known, span });
        return None;
    };
    let Some(options) = &param.options else {
        let reason = "it chooses a format, and must be a word".to_owned();
        scope.report(ValidateError::BadParam {
            name: name.to_owned(),
            reason,
            hint: Some("add `options: [\"..\", ..]`, the formats that may be chosen".to_owned()),
            span: declared.span,
        });
        return None;
    };
    let mut found = Vec::new();
    for option in &options.value {
        match Format::from_name(option) {
            Some(format) => found.push(format),
            None => {
                let known = formats().collect();
                scope.report(ValidateError::Unknown { what: "format", name: option.clone(), known, span: options.span });
            }
        }
    }
    let whole = found.len() == options.value.len();
    whole.then(|| FormatChoice::Param(format!("{}{name}", scope.instance().path), found))
}

fn size(scope: &mut Scope<'_>, name: &Text, dimension: Dimension, size: &Spanned<SizeDoc>) -> Option<Size> {
    let span = if size.span.is_somewhere() { size.span } else { name.span };
    let fits = match size.value {
        SizeDoc::Line(_) => dimension == Dimension::D1,
        SizeDoc::Output | SizeDoc::Scaled(_) | SizeDoc::Exact(..) => dimension == Dimension::D2,
        SizeDoc::Square(_) => matches!(dimension, Dimension::D2 | Dimension::Cube),
        SizeDoc::Cube(_) | SizeDoc::Volume(..) => dimension == Dimension::D3,
    };
    if !fits {
        let (what, hint) = match dimension {
            Dimension::D1 => ("a 1D texture", "size: Line(\"n\")"),
            Dimension::D2 => ("a 2D texture", "size: Output, Scaled(0.5), Square(\"n\") or Exact(\"w\", \"h\")"),
            Dimension::D3 => ("a 3D texture", "size: Cube(\"n\") or Volume(\"x\", \"y\", \"z\")"),
            Dimension::Cube => ("a cube texture", "size: Square(\"n\")"),
        };
        scope.report(ValidateError::BadResource {
            name: name.value.clone(),
            reason: format!("this size does not fit {what}"),
            hint: Some(format!("write {hint}")),
            span,
        });
        return None;
    }
    Some(match &size.value {
        SizeDoc::Output => Size::Output,
        SizeDoc::Scaled(factor) => Size::Scaled(scope.expression(factor)?),
        SizeDoc::Line(width) => Size::Line(scope.expression(width)?),
        SizeDoc::Square(edge) => Size::Square(scope.expression(edge)?),
        SizeDoc::Cube(edge) => Size::Cube(scope.expression(edge)?),
        SizeDoc::Exact(width, height) => match (scope.expression(width), scope.expression(height)) {
            (Some(width), Some(height)) => Size::Exact(width, height),
            _ => return None,
        },
        SizeDoc::Volume(x, y, z) => match (scope.expression(x), scope.expression(y), scope.expression(z)) {
            (Some(x), Some(y), Some(z)) => Size::Volume(x, y, z),
            _ => return None,
        },
    })
}

/// Checks a clear value against the formats of its texture.
pub(super) fn clear_value(scope: &mut Scope<'_>, name: &Text, clear: &Spanned<ClearDoc>, formats: &[FormatChoice]) -> Option<ClearValue> {
    let value = plain_clear(clear.value);
    for format in formats.iter().flat_map(FormatChoice::all) {
        if let Err(reason) = clear_fits(value, *format) {
            report(scope, name, reason, clear.span);
            return None;
        }
    }
    Some(value)
}

/// The document's clear value as later steps see it.
pub(super) fn plain_clear(clear: ClearDoc) -> ClearValue {
    match clear {
        ClearDoc::Zero => ClearValue::Zero,
        ClearDoc::Color(r, g, b, a) => ClearValue::Color([r, g, b, a]),
        ClearDoc::Depth(depth) => ClearValue::Depth(depth as f32),
        ClearDoc::Uint(x, y, z, w) => ClearValue::Uint([x, y, z, w]),
    }
}

/// Whether texels of a format can hold a clear value.
pub(crate) fn clear_fits(value: ClearValue, format: Format) -> Result<(), String> {
    let sample = format.info().sample;
    let fits = match value {
        ClearValue::Zero => true,
        ClearValue::Color(channels) => {
            if channels.iter().any(|channel| !channel.is_finite()) {
                return Err("the clear value is not finite".to_owned());
            }
            matches!(sample, SampleKind::Float | SampleKind::UnfilterableFloat)
        }
        ClearValue::Depth(depth) => {
            if !(0.0..=1.0).contains(&depth) {
                return Err(format!("a depth of {depth} is outside of 0 to 1"));
            }
            sample == SampleKind::Depth
        }
        ClearValue::Uint(_) => matches!(sample, SampleKind::Uint | SampleKind::Sint),
    };
    let expected = match sample {
        SampleKind::Float | SampleKind::UnfilterableFloat => "Color(r, g, b, a)",
        SampleKind::Depth => "Depth(d)",
        SampleKind::Uint | SampleKind::Sint => "Uint(x, y, z, w)",
    };
    if fits { Ok(()) } else { Err(format!("this clear value does not fit the format {format}: expected `Zero` or `{expected}`")) }
}
