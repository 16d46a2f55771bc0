//! One step of a plan as lines of text.

use super::describe;
use crate::plan::{Load, PartView, Plan, Step, StepKind, Targets, Workgroups};
use crate::source::SourceMap;

/// All lines of a step, the first with its number and name.
pub(super) fn step(plan: &Plan, place: usize, step: &Step, sources: &SourceMap) -> Vec<String> {
    let mut head = format!("{place:>4}  {}: {}", step.name, kind(plan, step));
    if let Some(shader) = step.shader.and_then(|shader| plan.shaders.get(shader)) {
        head += &format!(", shader {}", shader.path);
    }
    if let Some(place) = describe::place(sources, step.span) {
        head += &format!("  [{place}]");
    }
    let mut lines = vec![head];
    for (part, value) in &step.clears {
        lines.push(format!("fills     {} with {} first", part_name(plan, part), describe::clear(*value)));
    }
    for used in &step.uses {
        let part = describe::part(plan, used.resource, &used.mips, &used.layers);
        let mut line = format!("{:<9} {}: {part}", describe::role(used.role), used.slot);
        if let Some(version) = used.version {
            line += &format!(" as `{}` left it", describe::pass(plan, version));
        }
        line += &format!(", {} ({})", describe::content(plan, used.resource, &used.mips), describe::access(used.access));
        lines.push(line);
    }
    match &step.kind {
        StepKind::Draw { targets: drawn, .. }
        | StepKind::Procedural { targets: drawn, .. }
        | StepKind::Fullscreen { targets: drawn, .. } => lines.extend(targets(plan, drawn)),
        StepKind::Clear { target, value } => {
            lines.push(format!("sets      {} to {}", part_name(plan, target), describe::clear(*value)));
        }
        StepKind::Compute { .. } | StepKind::Copy { .. } | StepKind::Image { .. } | StepKind::Remember { .. } => {}
    }
    if !step.constants.is_empty() {
        let constants: Vec<String> = step.constants.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        lines.push(format!("constants {}", constants.join(", ")));
    }
    lines
}

/// What a step does and how much of it.
pub(super) fn kind(plan: &Plan, step: &Step) -> String {
    match &step.kind {
        StepKind::Draw { vertex, fragment, list, view, .. } => {
            let mut text = "Draw".to_owned();
            if let Some((filter, _)) = plan.draw_lists.get(*list) {
                text += &format!(" of {} surfaces", describe::objects(*filter));
            }
            if let Some(view) = plan.views.get(*view) {
                text += &format!(" from {} at {} x {}", describe::view(view.kind), view.width, view.height);
            }
            format!("{text}, entries {}", entries(vertex, fragment.as_deref()))
        }
        StepKind::Procedural { vertex, fragment, vertices, instances, .. } => {
            format!("Procedural of {instances} x {vertices} vertices, entries {}", entries(vertex, fragment.as_deref()))
        }
        StepKind::Fullscreen { fragment, targets } => {
            format!("Fullscreen over {} x {}, entry {fragment}", targets.extent[0], targets.extent[1])
        }
        StepKind::Compute { entry, groups: Workgroups::Fixed([x, y, z]) } => {
            format!("Compute of {x} x {y} x {z} workgroups, entry {entry}")
        }
        StepKind::Compute { entry, groups: Workgroups::Indirect { buffer, offset } } => {
            format!("Compute of workgroups by `{}` at byte {offset}, entry {entry}", describe::resource(plan, *buffer))
        }
        StepKind::Copy { source, target } => format!("Copy of {} to {}", part_name(plan, source), part_name(plan, target)),
        StepKind::Clear { target, .. } => format!("Clear of {}", part_name(plan, target)),
        StepKind::Image { image, .. } => format!("Image of {} x {} from {}", image.width, image.height, image.name),
        StepKind::Remember { source, .. } => format!("Remember {} of the frame before", part_name(plan, source)),
    }
}

fn entries(vertex: &str, fragment: Option<&str>) -> String {
    fragment.map_or_else(|| format!("{vertex}, depth alone"), |fragment| format!("{vertex} and {fragment}"))
}

/// The name of a view's part.
pub(super) fn part_name(plan: &Plan, part: &PartView) -> String {
    describe::part(plan, part.resource, &part.mips, &part.layers)
}

fn load(load: Load) -> String {
    match load {
        Load::Clear(value) => format!("cleared to {}", describe::clear(value)),
        Load::Keep => "kept".to_owned(),
    }
}

fn targets(plan: &Plan, targets: &Targets) -> Vec<String> {
    let mut lines = Vec::new();
    for (location, target) in targets.colors.iter().enumerate() {
        lines.push(match target {
            None => format!("target {location}  goes nowhere"),
            Some(target) => {
                let blend = target.blend.map_or_else(String::new, |blend| format!(", blended by {blend:?}"));
                format!("target {location}  {} {}{blend}", part_name(plan, &target.view), load(target.load))
            }
        });
    }
    if let Some(depth) = &targets.depth {
        let written = if depth.write { "written" } else { "not written" };
        let mut line = format!("depth     {} {}, test {:?}, {written}", part_name(plan, &depth.view), load(depth.load), depth.compare);
        if depth.bias != 0 || depth.slope_bias != 0.0 {
            line += &format!(", bias {} and {} per slope", depth.bias, depth.slope_bias);
        }
        lines.push(line);
    }
    if targets.samples > 1 {
        lines.push(format!("samples   {}", targets.samples));
    }
    lines
}
