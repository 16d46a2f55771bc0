//! Attachments of Draw and Fullscreen passes: formats, extents, load operations.

use super::error::BindError;
use super::slots::{Taken, Taker};
use super::views::{extent, whole};
use crate::device::DeviceFacts;
use crate::expand::types::{ClearValue, Dimension, Expanded, Pass, PassKind, Shape};
use crate::format::{Format, SampleKind};
use crate::plan::{ColorTarget, DepthTarget, Load, PartView, Role, Targets};
use crate::reflect::interface::{EntryPoint, ScalarKind};
use crate::source::Span;

struct Builder<'a> {
    pass: &'a Pass,
    problems: &'a mut Vec<BindError>,
    /// Extent, samples, and the slot that said so.
    agreed: Option<([u32; 2], u32, String)>,
}

impl Builder<'_> {
    fn bad(&mut self, reason: String, hint: &str, span: Span) {
        let hint = (!hint.is_empty()).then(|| hint.to_owned());
        self.problems.push(BindError::Target { pass: self.pass.name.clone(), reason, hint, span });
    }

    /// The one mip and layer that an attachment is, and its format.
    fn attachment(&mut self, slot: &Taken, expanded: &Expanded, formats: &[Option<Format>]) -> Option<(PartView, Format)> {
        let resource = &expanded.resources[slot.part.resource.index()];
        let name = &resource.name;
        let Shape::Texture(shape) = &resource.shape else {
            self.bad(format!("the slot `{}` is a target, and `{name}` is a buffer", slot.name), "", slot.part.span);
            return None;
        };
        if matches!(shape.dimension, Dimension::D1 | Dimension::D3) {
            self.bad(format!("`{name}` is no 2D or cube texture, and can't be drawn into"), "write it from a Compute", slot.part.span);
            return None;
        }
        let view = whole(resource, &slot.part);
        if view.mips.len() != 1 || view.layers.len() != 1 {
            let reason = format!("a target is one mip and one layer, and `{name}` has {} and {}", view.mips.len(), view.layers.len());
            self.bad(reason, "name the part: .mip(i), .layer(i), .face(i)", slot.part.span);
            return None;
        }
        let [width, height, _] = extent(shape, view.mips.start);
        match &self.agreed {
            None => self.agreed = Some(([width, height], shape.samples, slot.name.clone())),
            Some((size, samples, first)) if *size != [width, height] || *samples != shape.samples => {
                let reason = format!(
                    "its targets differ: `{first}` is {}x{} with {samples} sample(s), `{}` is {width}x{height} with {}",
                    size[0], size[1], slot.name, shape.samples
                );
                self.bad(reason, "all targets of a pass have one size and one number of samples", slot.part.span);
            }
            Some(_) => {}
        }
        Some((view, formats[slot.part.resource.index()]?))
    }
}

/// Builds the attachments of a pass from its slots.
pub(super) fn targets(
    pass: &Pass,
    taken: &[Taken],
    main: Option<&EntryPoint>,
    expanded: &Expanded,
    formats: &[Option<Format>],
    device: &DeviceFacts,
    problems: &mut Vec<BindError>,
) -> Option<Targets> {
    let blends = match &pass.kind {
        PassKind::Draw { blend, .. } | PassKind::Procedural { blend, .. } | PassKind::Fullscreen { blend, .. } => blend.as_slice(),
        _ => &[],
    };
    // A Fullscreen covers every texel, unless the shader discards; what blends sees what was there.
    let covers = matches!(pass.kind, PassKind::Fullscreen { .. }) && main.is_some_and(|main| !main.discards);
    let mut builder = Builder { pass, problems, agreed: None };
    let mut colors: Vec<Option<ColorTarget>> = vec![None; main.map_or(0, |main| main.color_outputs.len())];
    let mut depth = None;
    for slot in taken {
        let declared = expanded.resources[slot.part.resource.index()].clear;
        match &slot.taker {
            Taker::Color { output, .. } => {
                let Some((view, format)) = builder.attachment(slot, expanded, formats) else { continue };
                let expected = match format.info().sample {
                    SampleKind::Uint => ScalarKind::Uint,
                    SampleKind::Sint => ScalarKind::Sint,
                    _ => ScalarKind::Float,
                };
                if output.kind != expected || output.components < format.info().components {
                    let reason = format!(
                        "the shader's output `{}` has {} components of {:?}, and {format} needs {} of {expected:?}",
                        output.name,
                        output.components,
                        output.kind,
                        format.info().components
                    );
                    builder.bad(reason, "change the output's type or the format", slot.part.span);
                }
                let blend = blends.iter().find(|(name, _)| name.value == slot.name).map(|(_, blend)| *blend);
                let load = match slot.role {
                    Role::Modify | Role::Read | Role::Recall => Load::Keep,
                    Role::Produce if covers && blend.is_none() => Load::Clear(ClearValue::Zero),
                    Role::Produce => Load::Clear(declared.unwrap_or(ClearValue::Zero)),
                };
                if let Some(target) = colors.get_mut(output.location as usize) {
                    *target = Some(ColorTarget { view, format, load, blend });
                }
            }
            Taker::Depth => {
                let (PassKind::Draw { depth: Some(test), .. } | PassKind::Procedural { depth: Some(test), .. }) = &pass.kind else {
                    continue;
                };
                let Some((view, format)) = builder.attachment(slot, expanded, formats) else { continue };
                let load = match (slot.role, declared) {
                    (Role::Modify | Role::Read | Role::Recall, _) => Load::Keep,
                    (Role::Produce, Some(value)) => Load::Clear(value),
                    (Role::Produce, None) => {
                        let name = &expanded.resources[slot.part.resource.index()].name;
                        let reason = format!("it draws into the depth of `{name}`, which has no declared value to start from");
                        builder.bad(
                            reason,
                            "declare it at the resource: clear: Depth(1.0), or Depth(0.0) for reversed depth",
                            slot.part.span,
                        );
                        Load::Clear(ClearValue::Zero)
                    }
                };
                depth = Some(DepthTarget {
                    view,
                    format,
                    load,
                    write: test.write,
                    compare: test.test,
                    bias: test.bias,
                    slope_bias: test.slope_bias,
                });
            }
            _ => {}
        }
    }
    while colors.last().is_some_and(Option::is_none) {
        colors.pop();
    }
    let bytes: u32 = colors.iter().flatten().map(|target| target.format.info().attachment_bytes).sum();
    let count = colors.len() as u32;
    if count > device.max_color_attachments {
        let reason = format!("it has {count} color targets, and the limit is {} ({})", device.max_color_attachments, device.name);
        builder.problems.push(BindError::OverLimit { pass: pass.name.clone(), reason, span: pass.span });
    }
    if bytes > device.max_attachment_bytes {
        let limit = device.max_attachment_bytes;
        let reason =
            format!("its color targets take {bytes} bytes a sample (8-bit RGBA counts 8), and the limit is {limit} ({})", device.name);
        builder.problems.push(BindError::OverLimit { pass: pass.name.clone(), reason, span: pass.span });
    }
    match builder.agreed.clone() {
        Some((extent, samples, _)) => Some(Targets { colors, depth, extent, samples }),
        None => {
            if builder.problems.is_empty() {
                builder.bad("it draws into nothing".to_owned(), "name a target under `write` or `modify`", pass.span);
            }
            None
        }
    }
}
