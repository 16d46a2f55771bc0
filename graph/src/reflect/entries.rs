//! The interface of every entry point of a valid module.

use naga::valid::ModuleInfo;
use naga::{Binding, BuiltIn, Module, ShaderStage};

use super::error::ReflectError;
use super::globals::{self, Declared};
use super::interface::{ColorOutput, EntryPoint, Override, Stage, Varying, VertexInput};
use super::io::{Io, inputs, outputs};
use super::overrides;
use super::places::Places;
use super::reads;
use super::types::{numeric, type_text};
use super::varyings::interpolation_text;

/// The stages that passes run.
pub(super) fn stage(stage: ShaderStage) -> Option<Stage> {
    match stage {
        ShaderStage::Vertex => Some(Stage::Vertex),
        ShaderStage::Fragment => Some(Stage::Fragment),
        ShaderStage::Compute => Some(Stage::Compute),
        _ => None,
    }
}

/// What can be said of entry points before the module is known to be valid: their stages, and sizes that have a value.
pub(super) fn check(module: &Module, places: &Places<'_>) -> Vec<ReflectError> {
    let mut errors = Vec::new();
    for entry in &module.entry_points {
        let span = places.function_span(&entry.name);
        if stage(entry.stage).is_none() {
            let stage = format!("{:?}", entry.stage).to_lowercase();
            errors.push(ReflectError::Stage { entry: entry.name.clone(), stage, span });
        } else if let Err(why) = overrides::workgroup_size(module, entry, &|_| None) {
            errors.push(ReflectError::WorkgroupSize { entry: entry.name.clone(), why, span });
        }
    }
    errors
}

/// Describes the entry points of a valid module in the order of the text.
pub(super) fn describe(
    module: &Module,
    info: &ModuleInfo,
    declared: &[Declared],
    constants: &[Override],
    places: &Places<'_>,
) -> (Vec<EntryPoint>, Vec<ReflectError>) {
    let mut order: Vec<_> = module.entry_points.iter().enumerate().collect();
    order.sort_by_key(|(index, entry)| (places.function_order(&entry.name), *index));
    let mut errors = Vec::new();
    let mut entries = Vec::new();
    let reads = reads::of_entries(module, info);
    for (index, entry) in order {
        let Some(stage) = stage(entry.stage) else { continue };
        let info = info.get_entry_point(index);
        let Some(reads) = reads.get(index) else { continue };
        let globals = globals::used(module, info, declared, reads);
        errors.extend(globals::check_stage(entry, &globals, places));
        let (inputs, outputs) = (inputs(module, entry, places), outputs(module, entry, places));
        let mut described = EntryPoint {
            name: entry.name.clone(),
            span: places.function_span(&entry.name),
            stage,
            workgroup_size: overrides::workgroup_size(module, entry, &|_| None).unwrap_or_default(),
            globals,
            vertex_inputs: Vec::new(),
            varyings: Vec::new(),
            color_outputs: Vec::new(),
            writes_depth: false,
            discards: stage == Stage::Fragment && info.may_kill,
            overrides: overrides::used(module, entry, constants),
        };
        match stage {
            Stage::Vertex => {
                described.vertex_inputs = inputs.iter().filter_map(|io| vertex_input(module, io)).collect();
                described.vertex_inputs.sort_by_key(|input| input.location);
                described.varyings = varyings(module, &outputs);
            }
            Stage::Fragment => {
                described.varyings = varyings(module, &inputs);
                described.color_outputs = outputs.iter().filter_map(|io| color_output(module, io)).collect();
                described.color_outputs.sort_by_key(|output| output.location);
                described.writes_depth = outputs.iter().any(|io| io.binding == Some(Binding::BuiltIn(BuiltIn::FragDepth)));
            }
            Stage::Compute => {}
        }
        entries.push(described);
    }
    (entries, errors)
}

fn vertex_input(module: &Module, io: &Io) -> Option<VertexInput> {
    let (_, components) = numeric(module, io.ty)?;
    Some(VertexInput { name: io.name.clone(), span: io.span, location: io.location()?, components })
}

fn color_output(module: &Module, io: &Io) -> Option<ColorOutput> {
    let (kind, components) = numeric(module, io.ty)?;
    Some(ColorOutput { name: io.name.clone(), span: io.span, location: io.location()?, kind, components })
}

fn varyings(module: &Module, all: &[Io]) -> Vec<Varying> {
    let mut found: Vec<Varying> = all
        .iter()
        .filter_map(|io| match io.binding {
            Some(Binding::Location { location, interpolation, sampling, .. }) => Some(Varying {
                name: io.name.clone(),
                span: io.span,
                location,
                wgsl: type_text(module, io.ty),
                interpolation: interpolation_text(interpolation, sampling),
            }),
            _ => None,
        })
        .collect();
    found.sort_by_key(|varying| varying.location);
    found
}
