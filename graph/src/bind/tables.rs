//! Variables that get what the scene publishes, by their names alone.

use super::error::{BindError, Mismatch};
use crate::diagnostic::{did_you_mean, list_names};
use crate::expand::types::{Pass, PassKind};
use crate::plan::{BindingTarget, BuiltinSampler};
use crate::published::{PublishedSchema, TableKind, TableSchema};
use crate::reflect::interface::{Global, GlobalKind, Layout, ScalarKind, ViewDimension};

/// What a published or built-in name gives; `None` if nothing has that name. `view` is the pass's own view.
pub(super) fn bind(
    pass: &Pass,
    global: &Global,
    published: &PublishedSchema,
    view: &mut dyn FnMut() -> usize,
) -> Option<Result<BindingTarget, BindError>> {
    let name = global.name.as_str();
    let mismatch = |kind: Mismatch, reason: &str, hint: Option<String>| {
        Err(BindError::Table {
            kind,
            pass: pass.name.clone(),
            variable: name.to_owned(),
            reason: reason.to_owned(),
            hint,
            variable_span: global.span,
            pass_span: pass.span,
        })
    };
    if let Some(sampler) = BuiltinSampler::ALL.into_iter().find(|sampler| sampler.name() == name) {
        return Some(match global.kind {
            GlobalKind::Sampler { comparison } if comparison == sampler.is_comparison() => Ok(BindingTarget::Sampler(sampler)),
            _ => {
                let expected = if sampler.is_comparison() { "sampler_comparison" } else { "sampler" };
                mismatch(Mismatch::Kind, "is the name of a built-in sampler", Some(format!("declare `var {name}: {expected};`")))
            }
        });
    }
    let texture_2d =
        matches!(&global.kind, GlobalKind::Texture { dimension: ViewDimension::D2, kind: ScalarKind::Float, multisampled: false, .. });
    if published.textures.iter().any(|known| known == name) {
        return Some(match &global.kind {
            GlobalKind::Texture { filtered: true, .. } if texture_2d => mismatch(
                Mismatch::Kind,
                "holds 32-bit floats, which not every device filters",
                Some(format!("read texels with `textureLoad({name}, ..)` and mix them")),
            ),
            _ if texture_2d => Ok(BindingTarget::SceneTexture(name.to_owned())),
            _ => mismatch(Mismatch::Kind, "is a texture of the scene", Some(format!("declare `var {name}: texture_2d<f32>;`"))),
        });
    }
    let is_draw = matches!(pass.kind, PassKind::Draw { .. });
    let material = |list: &[String]| list.iter().position(|known| known == name);
    if let Some(index) = material(&published.material_textures) {
        return Some(match (is_draw, texture_2d) {
            (false, _) => mismatch(Mismatch::Kind, "is a texture of the material that is drawn, and this pass draws none", None),
            (true, false) => {
                mismatch(Mismatch::Kind, "is a texture of the material", Some(format!("declare `var {name}: texture_2d<f32>;`")))
            }
            (true, true) => Ok(BindingTarget::MaterialTexture(index)),
        });
    }
    if let Some(index) = material(&published.material_samplers) {
        return Some(match (is_draw, &global.kind) {
            (false, _) => mismatch(Mismatch::Kind, "is a sampler of the material that is drawn, and this pass draws none", None),
            (true, GlobalKind::Sampler { comparison: false }) => Ok(BindingTarget::MaterialSampler(index)),
            (true, _) => mismatch(Mismatch::Kind, "is a sampler of the material", Some(format!("declare `var {name}: sampler;`"))),
        });
    }
    if name == BATCH && pass.batch.is_some() {
        return Some(match &global.kind {
            GlobalKind::Storage { layout, writable: false, .. } if layout.runtime_array && layout.size == 4 => Ok(BindingTarget::Batch),
            _ => mismatch(Mismatch::Kind, "holds the indices of the iterations that are due", Some(BATCH_HINT.to_owned())),
        });
    }
    if let Some(element) = pass.elements.iter().rev().find(|element| element.variable == name) {
        let table = published.tables.get(&element.table)?;
        return Some(match &global.kind {
            GlobalKind::Uniform { layout } => match check_members(layout, table) {
                Ok(()) if layout.size <= table.stride.next_multiple_of(16) => {
                    Ok(BindingTarget::TableRow(element.table.clone(), element.row))
                }
                Ok(()) => mismatch(Mismatch::Layout, &format!("is {} bytes large, and a row has {}", layout.size, table.stride), None),
                Err((reason, hint)) => mismatch(Mismatch::Layout, &reason, hint),
            },
            _ => mismatch(Mismatch::Kind, "is the element of a loop", Some(format!("declare `var<uniform> {name}: ..;`"))),
        });
    }
    let table = published.tables.get(name)?;
    let (layout, target) = match (&global.kind, table.kind) {
        (GlobalKind::Uniform { layout }, TableKind::Uniform) => (layout, BindingTarget::UniformTable(name.to_owned())),
        (GlobalKind::Uniform { layout }, TableKind::View) => (layout, BindingTarget::View(view())),
        (GlobalKind::Storage { layout, writable: false, .. }, TableKind::Storage) => (layout, BindingTarget::StorageTable(name.to_owned())),
        (_, TableKind::Uniform | TableKind::View) => {
            return Some(mismatch(Mismatch::Kind, "is a published uniform table", Some(format!("declare `var<uniform> {name}: ..;`"))));
        }
        (_, TableKind::Storage) => {
            let hint = Some(format!("declare `var<storage, read> {name}: array<..>;`"));
            return Some(mismatch(Mismatch::Kind, "is a published storage table", hint));
        }
    };
    Some(match check_layout(layout, table) {
        Ok(()) => Ok(target),
        Err((reason, hint)) => mismatch(Mismatch::Layout, &reason, hint),
    })
}

/// The variable that holds the indices of the iterations of a batch that are due.
const BATCH: &str = "batch";
const BATCH_HINT: &str = "declare `var<storage, read> batch: array<u32>;`";

/// The members that a shader declares must lie where they are published.
fn check_members(layout: &Layout, table: &TableSchema) -> Result<(), (String, Option<String>)> {
    for member in &layout.members {
        let Some(known) = table.members.iter().find(|known| known.name == member.name) else {
            let names = || table.members.iter().map(|member| member.name.as_str());
            let hint = did_you_mean(&member.name, names()).unwrap_or_else(|| format!("published are {}", list_names(names())));
            return Err((format!("has the member `{}`, which is not published", member.name), Some(hint)));
        };
        if known.wgsl != member.wgsl || known.offset != member.offset {
            let reason = format!(
                "has the member `{}` as {} at byte {}, and it is published as {} at byte {}",
                member.name, member.wgsl, member.offset, known.wgsl, known.offset
            );
            return Err((reason, Some("declare the members in the published order".to_owned())));
        }
    }
    Ok(())
}

/// A shader may declare leading members only, of a table that is no array.
fn check_layout(layout: &Layout, table: &TableSchema) -> Result<(), (String, Option<String>)> {
    check_members(layout, table)?;
    let is_array = table.kind == TableKind::Storage;
    if is_array && (!layout.runtime_array || layout.size != table.stride) {
        let reason = format!("has elements of {} bytes, and they are published with {}", layout.size, table.stride);
        return Err((reason, Some("declare every member of the element, and an array without a length".to_owned())));
    }
    if !is_array && layout.size > table.stride {
        return Err((format!("is {} bytes large, and {} are published", layout.size, table.stride), None));
    }
    Ok(())
}
