//! Puts the results of all steps together as a plan.
//!
//! Steps come in the chosen order with their implicit clears. What only culled passes name (shaders, views, draw lists,
//! requirements) is left out, so that a scene publishes and a device offers no more than what runs.

use crate::allocate::Allocation;
use crate::bind::types::Bound;
use crate::expand::types::{PassId, ResourceId, Run, Shape};
use crate::lifetime::Lifetimes;
use crate::plan::{BindingTarget, InputId, MemoryKind, Plan, PlannedOutput, PlannedResource, PlannedShape, Step, StepKind};
use crate::schedule::part::Rect;
use crate::schedule::{InitialClear, Schedule};

/// Builds the plan. `extent` is the width and height of the rendered image.
///
/// In debug builds the plan is checked from scratch, see [`Plan::self_check`].
#[allow(clippy::too_many_arguments, reason = "each is the output of one step")]
pub fn assemble(
    bound: Bound,
    schedule: Schedule,
    lifetimes: Lifetimes,
    allocation: Allocation,
    mut retained_for: Vec<Vec<InputId>>,
    name: &str,
    extent: [u32; 2],
) -> Plan {
    let Bound { expanded, mut shaders, steps, formats, mut views, mut draw_lists, mut inputs, mut requirements } = bound;
    let mut bound_steps: Vec<Option<Step>> = steps.into_iter().map(Some).collect();
    let mut steps: Vec<Step> = schedule.order.iter().filter_map(|pass| bound_steps.get_mut(pass.index()).and_then(Option::take)).collect();
    let mut place_of: Vec<Option<usize>> = vec![None; bound_steps.len()];
    for (place, pass) in schedule.order.iter().enumerate() {
        place_of[pass.index()] = Some(place);
    }
    for InitialClear { pass, part, value, .. } in schedule.initial_clears.into_iter().filter(|initial| initial.modified) {
        if let Some(step) = place_of[pass.index()].and_then(|place| steps.get_mut(place)) {
            step.clears.push((part, value));
        }
    }
    keep_used(&mut steps, &mut shaders, &mut views, &mut draw_lists, &mut inputs, &mut retained_for);
    // A requirement names its pass; loops give every pass a name of its own.
    let culled: std::collections::BTreeSet<&str> = schedule.culled.iter().map(|culled| &*culled.name).collect();
    requirements.retain(|requirement| !culled.contains(&*requirement.pass));

    let outputs = expanded
        .outputs
        .iter()
        .map(|output| {
            let shape = &expanded.resources[output.part.resource.index()].shape;
            PlannedOutput { name: output.name.clone(), view: Rect::of_reference(&output.part, shape).view(output.part.resource, shape) }
        })
        .collect();
    let mut resources = Vec::with_capacity(expanded.resources.len());
    let spans = lifetimes.ranges.into_iter().zip(lifetimes.retained);
    for (index, (resource, (lifetime, retained))) in expanded.resources.into_iter().zip(spans).enumerate() {
        let chosen = formats.get(index).copied().flatten();
        let shape = match resource.shape {
            Shape::Buffer { .. } => PlannedShape::Buffer(allocation.bytes[index]),
            Shape::Texture(mut shape) => match chosen.or_else(|| shape.formats.first().copied()) {
                Some(format) => {
                    // The chosen format stands first.
                    shape.formats.retain(|other| *other != format);
                    shape.formats.insert(0, format);
                    PlannedShape::Texture(shape, format)
                }
                // Expansion leaves no texture without a format.
                None => PlannedShape::Buffer(0),
            },
        };
        resources.push(PlannedResource {
            name: resource.name,
            span: resource.span,
            shape,
            usage: allocation.usages[index],
            bytes: allocation.bytes[index],
            lifetime,
            placement: allocation.placements[index],
            retained,
            alone: allocation.alone[index],
            clear: resource.clear,
            retained_for: retained_for.get(index).cloned().unwrap_or_default(),
            history: resource.history,
        });
    }
    let plan = Plan {
        name: name.to_owned(),
        doc: expanded.doc,
        extent,
        params: expanded.params,
        resources,
        memories: allocation.memories,
        shaders,
        steps,
        culled: schedule.culled,
        inputs,
        spreads: expanded.spreads,
        views,
        draw_lists,
        outputs,
        figures: allocation.figures,
        flow: schedule.flow,
        requirements,
    };
    debug_assert_eq!(plan.self_check(), Vec::<String>::new());
    plan
}

/// Drops what no step names, and renumbers.
fn keep_used<A, B, C, D>(
    steps: &mut [Step],
    shaders: &mut Vec<A>,
    views: &mut Vec<B>,
    lists: &mut Vec<C>,
    inputs: &mut Vec<D>,
    retained_for: &mut [Vec<InputId>],
) {
    let mut kept = [Kept::new(shaders.len()), Kept::new(views.len()), Kept::new(lists.len()), Kept::new(inputs.len())];
    for step in steps.iter_mut() {
        each_index(step, &mut |what, index| kept[what as usize].mark(*index));
    }
    for entry in &mut kept {
        entry.number();
    }
    for step in steps {
        each_index(step, &mut |what, index| *index = kept[what as usize].renumbered(*index));
    }
    for input in retained_for.iter_mut().flatten() {
        *input = InputId(kept[What::Input as usize].renumbered(input.index()) as u32);
    }
    kept[What::Shader as usize].keep(shaders);
    kept[What::View as usize].keep(views);
    kept[What::DrawList as usize].keep(lists);
    kept[What::Input as usize].keep(inputs);
}

#[derive(Clone, Copy)]
enum What {
    Shader,
    View,
    DrawList,
    Input,
}

/// Every index of a step into the plan's lists.
fn each_index(step: &mut Step, visit: &mut impl FnMut(What, &mut usize)) {
    if let Some(shader) = &mut step.shader {
        visit(What::Shader, shader);
    }
    for input in step.inputs.iter_mut().chain(step.batch.iter_mut().flat_map(|iteration| &mut iteration.inputs)) {
        let mut index = input.index();
        visit(What::Input, &mut index);
        *input = InputId(index as u32);
    }
    if let StepKind::Draw { list, view, .. } = &mut step.kind {
        visit(What::DrawList, list);
        visit(What::View, view);
    }
    for binding in &mut step.bindings {
        if let BindingTarget::View(view) = &mut binding.target {
            visit(What::View, view);
        }
    }
}

/// New numbers for a list of which some entries stay.
struct Kept(Vec<Option<usize>>);

impl Kept {
    fn new(count: usize) -> Kept {
        Kept(vec![None; count])
    }

    fn mark(&mut self, index: usize) {
        if let Some(entry) = self.0.get_mut(index) {
            *entry = Some(0);
        }
    }

    fn number(&mut self) {
        for (number, entry) in self.0.iter_mut().flatten().enumerate() {
            *entry = number;
        }
    }

    fn renumbered(&self, index: usize) -> usize {
        self.0.get(index).copied().flatten().unwrap_or(index)
    }

    fn keep<T>(&self, list: &mut Vec<T>) {
        let mut entries = self.0.iter();
        list.retain(|_| entries.next().is_some_and(Option::is_some));
    }
}

impl Plan {
    /// The resource behind an id of this plan.
    pub fn resource(&self, id: ResourceId) -> &PlannedResource {
        &self.resources[id.index()]
    }

    /// The place of a pass in the order, if it runs.
    pub fn place_of(&self, pass: PassId) -> Option<usize> {
        self.steps.iter().position(|step| step.pass == pass)
    }

    /// Whether an image depends on the frames before it, and not on the state of its inputs alone: something is remembered, gathered or
    /// spread over frames, or runs in every frame.
    pub fn carries_over(&self) -> bool {
        self.steps.iter().any(|step| match step.run {
            Run::OnChange => matches!(step.kind, StepKind::Remember { .. }),
            Run::EveryFrame | Run::Accumulate(_) => true,
            Run::Spread { spread, .. } => self.takes_turns(spread),
        })
    }

    /// Whether what is due of a loop may need more than one frame.
    fn takes_turns(&self, spread: u32) -> bool {
        let iterations = |step: &Step| match step.run {
            Run::Spread { spread: own, iteration } if own == spread => step.batch.len().max(iteration as usize + 1),
            _ => 0,
        };
        let all = self.steps.iter().map(iterations).max().unwrap_or(0);
        self.spreads.get(spread as usize).is_none_or(|spread| spread.rounds > 1 || (spread.per_frame as usize) < all)
    }

    /// The memory kind that a resource needs.
    pub(crate) fn is_texture(&self, memory: usize) -> bool {
        matches!(self.memories.get(memory).map(|memory| &memory.kind), Some(MemoryKind::Texture(..)))
    }
}
