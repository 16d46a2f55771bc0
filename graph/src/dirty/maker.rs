//! What decides a step's value apart from what it reads: comparable between plans.
//!
//! A step of another plan is the same if everything in it is, where numbers that only mean something within their plan stand for
//! what they name: a resource for its name and shape, a shader for its text. Compared in full, never by a hash.

use std::collections::HashMap;

use crate::expand::types::{PassId, ResourceId};
use crate::plan::{BindingTarget, Input, InputId, PartView, Plan, Step, StepKind, Targets, Workgroups};
use crate::source::Span;

/// Texts by number. One table serves the two plans that are compared.
#[derive(Debug, Default)]
pub(super) struct Names {
    known: HashMap<String, u32>,
}

impl Names {
    /// The number of a text.
    pub(super) fn of(&mut self, text: String) -> u32 {
        let next = self.known.len() as u32;
        *self.known.entry(text).or_insert(next)
    }

    /// Every resource of a plan, by name and shape.
    pub(super) fn resources(&mut self, plan: &Plan) -> Vec<ResourceId> {
        plan.resources
            .iter()
            .map(|resource| ResourceId(self.of(format!("{} {:?} {:?}", resource.name, shape(plan, resource), resource.clear))))
            .collect()
    }

    /// A step with every number replaced by one that means the same in all plans.
    pub(super) fn maker(&mut self, plan: &Plan, resources: &[ResourceId], index: usize) -> Step {
        let mut step = plan.steps[index].clone();
        step.pass = PassId(0);
        step.span = Span::NOWHERE;
        step.shader = step.shader.and_then(|shader| plan.shaders.get(shader)).map(|shader| self.of(shader.text.to_string()) as usize);
        let resource = |id: &mut ResourceId| *id = resources[id.index()];
        let view = |part: &mut PartView| resource(&mut part.resource);
        for used in &mut step.uses {
            resource(&mut used.resource);
            used.span = Span::NOWHERE;
            used.version = used.version.map(|pass| {
                let name = plan.steps.iter().find(|step| step.pass == pass).map_or("", |step| &*step.name);
                PassId(self.of(format!("pass {name}")))
            });
        }
        for (part, _) in &mut step.clears {
            view(part);
        }
        for input in step.inputs.iter_mut().chain(step.batch.iter_mut().flat_map(|iteration| &mut iteration.inputs)) {
            *input = InputId(self.of(format!("{:?}", plan.inputs.get(input.index()))));
        }
        match &mut step.kind {
            StepKind::Draw { list, view: place, targets: drawn, .. } => {
                *list = self.of(format!("{:?}", plan.draw_lists.get(*list))) as usize;
                *place = self.of(format!("{:?}", plan.views.get(*place))) as usize;
                targets(drawn, &view);
            }
            StepKind::Procedural { targets: drawn, .. } | StepKind::Fullscreen { targets: drawn, .. } => targets(drawn, &view),
            StepKind::Compute { groups: Workgroups::Indirect { buffer, .. }, .. } => resource(buffer),
            StepKind::Compute { .. } => {}
            StepKind::Copy { source, target } | StepKind::Remember { source, target, .. } => {
                view(source);
                view(target);
            }
            StepKind::Clear { target, .. } | StepKind::Image { target, .. } => view(target),
        }
        for binding in &mut step.bindings {
            match &mut binding.target {
                BindingTarget::View(place) => *place = self.of(format!("{:?}", plan.views.get(*place))) as usize,
                BindingTarget::Texture { view: part, .. } | BindingTarget::StorageTexture { view: part, .. } => view(part),
                BindingTarget::Buffer { resource: buffer, .. } => resource(buffer),
                _ => {}
            }
        }
        step
    }
}

fn targets(targets: &mut Targets, view: &impl Fn(&mut PartView)) {
    for color in targets.colors.iter_mut().flatten() {
        view(&mut color.view);
    }
    if let Some(depth) = &mut targets.depth {
        view(&mut depth.view);
    }
}

/// A shape without places.
fn shape(_plan: &Plan, resource: &crate::plan::PlannedResource) -> String {
    match &resource.shape {
        crate::plan::PlannedShape::Texture(shape, format) => format!(
            "{:?} {format} {}x{}x{} {} {} {}",
            shape.dimension, shape.width, shape.height, shape.depth, shape.layers, shape.mips, shape.samples
        ),
        crate::plan::PlannedShape::Buffer(bytes) => format!("{bytes}"),
    }
}

/// Whether two inputs are the same thing.
pub(super) fn input_places(old: &[Input]) -> HashMap<&Input, usize> {
    old.iter().enumerate().map(|(place, input)| (input, place)).collect()
}
