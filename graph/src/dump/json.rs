//! A plan as JSON for programs. Keys stand in the order in which they are written here; resources, steps and memories refer to
//! each other by name and by index.

use serde_json::{Value as Json, json};

use super::{describe, steps};
use crate::expand::types::{ClearValue, ResourceId, Value};
use crate::plan::{Alone, CullReason, Load, MemoryKind, PartView, Plan, PlannedShape, Step, StepKind, Targets, Use, Workgroups};
use crate::source::SourceMap;

/// The plan as a value; print it with `{:#}` for people.
pub fn json(plan: &Plan, sources: &SourceMap) -> Json {
    let params: Vec<Json> =
        plan.params.iter().map(|param| json!({ "name": param.name, "value": value(&param.value), "options": param.options })).collect();
    let outputs: Vec<Json> = plan.outputs.iter().map(|output| json!({ "name": output.name, "part": part(plan, &output.view) })).collect();
    let steps: Vec<Json> = plan.steps.iter().map(|entry| step(plan, entry, sources)).collect();
    let resources: Vec<Json> = (0..plan.resources.len()).map(|index| resource(plan, index, sources)).collect();
    let memories: Vec<Json> = plan
        .memories
        .iter()
        .map(|memory| {
            json!({
                "kind": if memory.kind == MemoryKind::Arena { "arena" } else { "texture" },
                "bytes": memory.bytes,
                "usage": describe::usages(memory.usage),
                "holders": names(plan, &memory.holders),
            })
        })
        .collect();
    let figures = &plan.figures;
    let placed = plan.placed();
    json!({
        "pipeline": plan.name,
        "doc": plan.doc,
        "extent": plan.extent,
        "params": params,
        "outputs": outputs,
        "steps": steps,
        "resources": resources,
        "memories": memories,
        "culled": culled(plan),
        "figures": {
            "without_sharing": figures.without_sharing,
            "reached": figures.reached,
            "bound": figures.bound,
            "declared_bound": plan.declared_bound(),
            "placed": placed.bytes,
            "placed_bound": placed.bound,
            "retained": figures.retained,
        },
        "views": plan.views.iter().map(|view| json!({
            "kind": describe::view(view.kind), "width": view.width, "height": view.height,
        })).collect::<Vec<Json>>(),
        "draw_lists": plan.draw_lists.iter().map(|(filter, view)| json!({
            "objects": describe::objects(*filter), "view": describe::view(*view),
        })).collect::<Vec<Json>>(),
        "requirements": plan.requirements.iter().map(|requirement| json!({
            "feature": requirement.feature.name(), "pass": requirement.pass, "why": requirement.why,
            "place": describe::place(sources, requirement.span),
        })).collect::<Vec<Json>>(),
    })
}

fn names<'a>(plan: &'a Plan, ids: &[ResourceId]) -> Vec<&'a str> {
    ids.iter().map(|id| describe::resource(plan, *id)).collect()
}

fn value(value: &Value) -> Json {
    match value {
        Value::Bool(value) => json!(value),
        Value::Int(value) => json!(value),
        Value::Float(value) => json!(value),
        Value::Word(_, word) => json!(word),
        Value::Vector(values) => json!(values),
    }
}

fn clear(value: ClearValue) -> Json {
    match value {
        ClearValue::Zero => json!("zero"),
        ClearValue::Color(color) => json!({ "color": color }),
        ClearValue::Depth(depth) => json!({ "depth": depth }),
        ClearValue::Uint(values) => json!({ "uint": values }),
    }
}

fn part(plan: &Plan, view: &PartView) -> Json {
    json!({
        "name": steps::part_name(plan, view),
        "resource": view.resource.0,
        "mips": [view.mips.start, view.mips.end],
        "layers": [view.layers.start, view.layers.end],
    })
}

fn used(plan: &Plan, used: &Use) -> Json {
    json!({
        "role": describe::role(used.role),
        "part": describe::part(plan, used.resource, &used.mips, &used.layers),
        "resource": used.resource.0,
        "mips": [used.mips.start, used.mips.end],
        "layers": [used.layers.start, used.layers.end],
        "access": describe::access(used.access),
        "version": used.version.map(|version| describe::pass(plan, version)),
        "slot": used.slot,
    })
}

fn step(plan: &Plan, step: &Step, sources: &SourceMap) -> Json {
    let clears: Vec<Json> = step.clears.iter().map(|(view, value)| json!({ "part": part(plan, view), "value": clear(*value) })).collect();
    let constants: serde_json::Map<String, Json> = step.constants.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
    json!({
        "pass": step.name,
        "place": describe::place(sources, step.span),
        "shader": step.shader.and_then(|shader| plan.shaders.get(shader)).map(|shader| shader.path.as_str()),
        "kind": kind(plan, &step.kind),
        "constants": constants,
        "clears": clears,
        "uses": step.uses.iter().map(|entry| used(plan, entry)).collect::<Vec<Json>>(),
    })
}

fn kind(plan: &Plan, kind: &StepKind) -> Json {
    match kind {
        StepKind::Draw { vertex, fragment, list, view, cull, attributes, targets: drawn } => json!({
            "name": "Draw", "vertex": vertex, "fragment": fragment, "draw_list": list, "view": view,
            "cull": format!("{cull:?}"), "attributes": attributes, "targets": targets(plan, drawn),
        }),
        StepKind::Procedural { vertex, fragment, vertices, instances, cull, targets: drawn } => json!({
            "name": "Procedural", "vertex": vertex, "fragment": fragment, "vertices": vertices, "instances": instances,
            "cull": format!("{cull:?}"), "targets": targets(plan, drawn),
        }),
        StepKind::Fullscreen { fragment, targets: drawn } => {
            json!({ "name": "Fullscreen", "fragment": fragment, "targets": targets(plan, drawn) })
        }
        StepKind::Compute { entry, groups: Workgroups::Fixed(groups) } => json!({ "name": "Compute", "entry": entry, "groups": groups }),
        StepKind::Compute { entry, groups: Workgroups::Indirect { buffer, offset } } => json!({
            "name": "Compute", "entry": entry, "indirect": describe::resource(plan, *buffer), "offset": offset,
        }),
        StepKind::Copy { source, target } => json!({ "name": "Copy", "source": part(plan, source), "target": part(plan, target) }),
        StepKind::Clear { target, value } => json!({ "name": "Clear", "target": part(plan, target), "value": clear(*value) }),
        StepKind::Image { target, image } => json!({ "name": "Image", "target": part(plan, target), "file": image.name }),
        StepKind::Remember { source, target, first, on_resize } => json!({
            "name": "Remember", "source": part(plan, source), "target": part(plan, target), "first": clear(*first),
            "on_resize": format!("{on_resize:?}"),
        }),
    }
}

fn load(load: Load) -> Json {
    match load {
        Load::Clear(value) => json!({ "clear": clear(value) }),
        Load::Keep => json!("keep"),
    }
}

fn targets(plan: &Plan, targets: &Targets) -> Json {
    let colors: Vec<Json> = targets
        .colors
        .iter()
        .map(|target| match target {
            None => Json::Null,
            Some(target) => json!({
                "part": part(plan, &target.view), "format": target.format.name(), "load": load(target.load),
                "blend": target.blend.map(|blend| format!("{blend:?}")),
            }),
        })
        .collect();
    let depth = targets.depth.as_ref().map(|depth| {
        json!({
            "part": part(plan, &depth.view), "format": depth.format.name(), "load": load(depth.load), "write": depth.write,
            "test": format!("{:?}", depth.compare), "bias": depth.bias, "slope_bias": depth.slope_bias,
        })
    });
    json!({ "extent": targets.extent, "samples": targets.samples, "colors": colors, "depth": depth })
}

fn resource(plan: &Plan, index: usize, sources: &SourceMap) -> Json {
    let resource = &plan.resources[index];
    let shape = match &resource.shape {
        PlannedShape::Buffer(bytes) => json!({ "kind": "buffer", "bytes": bytes }),
        PlannedShape::Texture(shape, format) => json!({
            "kind": "texture", "dimension": describe::dimension(shape.dimension), "format": format.name(),
            "extent": describe::mip_extent(shape, 0), "layers": shape.layers, "mips": shape.mips, "samples": shape.samples,
        }),
    };
    let alone = resource.alone.map(|alone| {
        let mut reason = json!({ "reason": describe::alone_name(alone) });
        match alone {
            Alone::InUseTogether { count, step } => (reason["count"], reason["step"]) = (json!(count), json!(step)),
            Alone::AccessConflict { rival } => reason["rival"] = json!(describe::resource(plan, rival)),
            _ => {}
        }
        reason
    });
    json!({
        "name": resource.name,
        "place": describe::place(sources, resource.span),
        "shape": shape,
        "usage": describe::usages(resource.usage),
        "bytes": resource.bytes,
        "first_step": (!resource.lifetime.is_empty()).then_some(resource.lifetime.start),
        "last_step": resource.lifetime.end.checked_sub(1).filter(|_| !resource.lifetime.is_empty()),
        "memory": resource.placement.map(|placement| placement.memory.0),
        "offset": resource.placement.map(|placement| placement.offset),
        "shares_with": names(plan, &describe::sharers(plan, ResourceId(index as u32))),
        "alone": alone,
    })
}

fn culled(plan: &Plan) -> Vec<Json> {
    plan.culled
        .iter()
        .map(|culled| {
            let (reason, readers) = match &culled.reason {
                CullReason::WritesNothing => ("writes-nothing", Vec::new()),
                CullReason::Unread => ("unread", Vec::new()),
                CullReason::OnlyCulledReaders(readers) => {
                    ("only-culled-readers", readers.iter().map(|reader| describe::pass(plan, *reader)).collect())
                }
            };
            json!({
                "pass": culled.name, "kind": culled.kind, "writes": names(plan, &culled.writes), "reads": names(plan, &culled.reads),
                "reason": reason, "readers": readers,
            })
        })
        .collect()
}
