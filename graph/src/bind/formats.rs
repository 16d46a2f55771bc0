//! The choice of each texture's format: the first of its list that can do all that passes do with it.

use super::error::BindError;
use super::slots::{Taken, Taker};
use crate::device::{DeviceFacts, Feature};
use crate::expand::types::{Expanded, Shape};
use crate::format::{Format, SampleKind, StorageSupport};
use crate::reflect::interface::{GlobalKind, StorageAccess};

/// A feature that some use of a format needs.
pub(super) fn feature_for(format: Format, taker: &Taker) -> Option<(Feature, &'static str)> {
    match taker {
        Taker::Variable(global) => match &global.kind {
            GlobalKind::Texture { filtered: true, .. } if format.info().sample == SampleKind::UnfilterableFloat => {
                Some((Feature::Float32Filterable, "to filter"))
            }
            _ => None,
        },
        Taker::Color { blend: true, .. } if !format.info().blendable && format.info().sample == SampleKind::UnfilterableFloat => {
            Some((Feature::Float32Blendable, "to blend into"))
        }
        Taker::Color { .. } if format.name() == "rg11b10ufloat" => Some((Feature::Rg11b10UfloatRenderable, "to render into")),
        _ => None,
    }
}

/// Whether a format can serve a use; `Err` says why not.
fn can(format: Format, taker: &Taker, device: &DeviceFacts) -> Result<(), String> {
    let info = format.info();
    let feature = feature_for(format, taker);
    let granted = feature.is_some_and(|(feature, _)| device.features.contains(&feature));
    if let Some((feature, what)) = feature
        && !granted
    {
        return Err(format!("{format}: {what} it, the device needs the feature `{}`", feature.name()));
    }
    match taker {
        Taker::Variable(global) => match &global.kind {
            GlobalKind::StorageTexture { format: declared, access, .. } => {
                if *declared != format {
                    return Err(format!("{format}: the shader's storage texture `{}` is {declared}", global.name));
                }
                match (info.storage, access) {
                    (StorageSupport::None, _) => Err(format!("{format}: it can't be a storage texture")),
                    (StorageSupport::ReadOrWrite, StorageAccess::ReadWrite) => Err(format!(
                        "{format}: it can't be read and written in one storage texture (only r32uint, r32sint and r32float can)"
                    )),
                    _ => Ok(()),
                }
            }
            _ => Ok(()),
        },
        Taker::Color { blend, .. } => {
            if format.is_depth() {
                Err(format!("{format}: a depth format is no color target"))
            } else if !info.renderable && !granted {
                Err(format!("{format}: it can't be rendered into"))
            } else if *blend && !info.blendable && !granted {
                Err(format!("{format}: it can't be blended"))
            } else {
                Ok(())
            }
        }
        Taker::Depth => {
            if format.is_depth() {
                Ok(())
            } else {
                Err(format!("{format}: a depth target needs a depth format, such as depth32float"))
            }
        }
        Taker::Transfer | Taker::Indirect => Ok(()),
    }
}

/// Chooses a format for every texture.
pub(super) fn choose(
    expanded: &Expanded,
    taken: &[Vec<Taken>],
    device: &DeviceFacts,
    problems: &mut Vec<BindError>,
) -> Vec<Option<Format>> {
    let mut uses: Vec<Vec<(usize, &Taken)>> = vec![Vec::new(); expanded.resources.len()];
    for (pass, slots) in taken.iter().enumerate() {
        for slot in slots {
            // A history has the format of its resource.
            let resource = &expanded.resources[slot.part.resource.index()];
            let id = resource.history.map_or(slot.part.resource, |history| history.of);
            uses[id.index()].push((pass, slot));
        }
    }
    let mut chosen = Vec::new();
    for (index, resource) in expanded.resources.iter().enumerate() {
        let uses = &uses[resource.history.map_or(index, |history| history.of.index())];
        let Shape::Texture(shape) = &resource.shape else {
            chosen.push(None);
            continue;
        };
        let mut reasons = Vec::new();
        let mut first = None;
        let format = shape.formats.iter().copied().find(|format| {
            for (pass, slot) in uses {
                if let Err(reason) = can(*format, &slot.taker, device) {
                    let pass = &expanded.passes[*pass].name;
                    first.get_or_insert((slot.part.span, format!("used here by `{pass}`")));
                    reasons.push(reason);
                    return false;
                }
            }
            true
        });
        if format.is_none() && resource.history.is_none() {
            problems.push(BindError::NoFormat { resource: resource.name.clone(), reasons, span: shape.format_span, first });
        }
        // A format that can't do it still lets the rest be checked.
        chosen.push(format.or(shape.formats.first().copied()));
    }
    chosen
}
