//! Why each pass ran in a frame or did not, why each resource shares memory or does not, and why each culled pass is culled.

use std::sync::Arc;

use serde_json::{Value as Json, json};

use super::describe;
use super::units::bytes as human;
use crate::dirty::{Frame, Idle, Tracker, Why};
use crate::expand::types::ResourceId;
use crate::plan::{Input, InputId, Plan};

/// A pass and what became of it.
struct Story {
    pass: Arc<str>,
    ran: bool,
    /// Stable, for programs.
    reason: &'static str,
    text: String,
}

/// All of it as text; `only` names the one pass of interest.
pub fn explain_text(tracker: &Tracker, frame: &Frame, only: Option<&str>) -> String {
    let plan = tracker.plan();
    let mut out = String::new();
    let stories = stories(tracker, frame, only);
    let ran = stories.iter().filter(|story| story.ran).count();
    out += &format!("passes: {ran} of {} ran\n", plan.steps.len());
    for story in &stories {
        out += &format!("  {} {}: {}\n", if story.ran { "ran " } else { "idle" }, story.pass, story.text);
    }
    let culled: Vec<_> = plan.culled.iter().filter(|culled| only.is_none_or(|name| *name == *culled.name)).collect();
    if !culled.is_empty() {
        out += &format!("\nculled: {}\n", culled.len());
        for pass in culled {
            out += &format!("  {}: {}\n", pass.name, describe::culled(plan, &pass.reason));
        }
    }
    if only.is_some() {
        return out;
    }
    out += &format!("\nresources: {}\n", plan.resources.len());
    for index in 0..plan.resources.len() {
        out += &format!("  {}: {}\n", plan.resources[index].name, resource(plan, ResourceId(index as u32)));
    }
    out += "\nbytes retained for each input\n";
    for (name, bytes) in costs(plan) {
        out += &format!("  {name}: {}\n", human(bytes));
    }
    out
}

/// The same as JSON.
pub fn explain_json(tracker: &Tracker, frame: &Frame) -> Json {
    let plan = tracker.plan();
    let passes: Vec<Json> = stories(tracker, frame, None)
        .into_iter()
        .map(|story| json!({ "pass": story.pass, "ran": story.ran, "reason": story.reason, "text": story.text }))
        .collect();
    let culled: Vec<Json> =
        plan.culled.iter().map(|culled| json!({ "pass": culled.name, "text": describe::culled(plan, &culled.reason) })).collect();
    let resources: Vec<Json> = (0..plan.resources.len())
        .map(|index| {
            let id = ResourceId(index as u32);
            json!({
                "resource": plan.resources[index].name,
                "retained": plan.resources[index].retained.is_some(),
                "shares_with": describe::sharers(plan, id).into_iter().map(|id| describe::resource(plan, id)).collect::<Vec<_>>(),
                "text": resource(plan, id),
            })
        })
        .collect();
    let costs: Vec<Json> = costs(plan).into_iter().map(|(input, bytes)| json!({ "input": input, "retained_bytes": bytes })).collect();
    json!({ "passes": passes, "culled": culled, "resources": resources, "inputs": costs })
}

fn stories(tracker: &Tracker, frame: &Frame, only: Option<&str>) -> Vec<Story> {
    let plan = tracker.plan();
    let wanted = |name: &str| only.is_none_or(|only| only == name);
    let mut runs = frame.runs.iter().peekable();
    let mut found = Vec::new();
    for (place, step) in plan.steps.iter().enumerate() {
        let run = runs.next_if(|run| run.step == place);
        if !wanted(&step.name) {
            continue;
        }
        let (ran, reason, text) = match run {
            Some(run) => {
                let (reason, text) = why(plan, run.why);
                let iterations = match run.iterations.len() {
                    0 => String::new(),
                    count => format!(" ({count} of {} iterations)", step.batch.len()),
                };
                (true, reason, text + &iterations)
            }
            None => {
                let (reason, text) = idle(tracker.idle(place));
                (false, reason, text)
            }
        };
        found.push(Story { pass: step.name.clone(), ran, reason, text });
    }
    found
}

fn why(plan: &Plan, why: Why) -> (&'static str, String) {
    let step = |index: usize| plan.steps.get(index).map_or("?", |step| &*step.name);
    let resource = |id| describe::resource(plan, id);
    match why {
        Why::New => ("new", "it has not run as it is".to_owned()),
        Why::Input(id) => ("input", format!("`{}` changed", input(plan, id))),
        Why::Reads { step: maker, resource: id } => ("reads", format!("`{}` made `{}` anew", step(maker), resource(id))),
        Why::EveryFrame => ("every-frame", "it runs in every frame".to_owned()),
        Why::Accumulates => ("accumulates", "it has not gathered all".to_owned()),
        Why::Turn => ("turn", "it is its turn".to_owned()),
        Why::Remembers => ("remembers", "what it remembers changed in the frame before".to_owned()),
        Why::Together { step: other } => ("together", format!("it changes what `{}` does, and runs together with it", step(other))),
        Why::Pulled { step: Some(reader), resource: id } => {
            ("pulled", format!("`{}` reads `{}`, which no memory holds", step(reader), resource(id)))
        }
        Why::Pulled { step: None, resource: id } => ("pulled", format!("`{}` is shown, and no memory holds it", resource(id))),
    }
}

fn idle(idle: Idle) -> (&'static str, String) {
    match idle {
        Idle::Clean => ("clean", "nothing that it reads has changed since it ran".to_owned()),
        Idle::Waits => ("waits", "its turn has not come".to_owned()),
        Idle::Gathered(count) => ("gathered", format!("it has gathered all {count}")),
    }
}

/// The name of an input: `camera.exposure`, `local_lights[2]`, `view of point light 0, face 3`.
pub(crate) fn input_name(plan: &Plan, index: usize) -> String {
    match plan.inputs.get(index) {
        Some(Input::Table(name, reads)) => format!("{name}{reads}"),
        Some(Input::Row(name, row, reads)) => format!("{name}[{row}]{reads}"),
        Some(Input::Texture(name)) => name.clone(),
        Some(Input::View(view)) => format!("view of {}", describe::view(view.kind)),
        Some(Input::Draws(filter, view, _)) => format!("{} surfaces of {}", describe::objects(*filter), describe::view(*view)),
        Some(Input::Param(name)) => format!("parameter {name}"),
        None => "?".to_owned(),
    }
}

fn input(plan: &Plan, id: InputId) -> String {
    input_name(plan, id.index())
}

fn resource(plan: &Plan, id: ResourceId) -> String {
    let resource = &plan.resources[id.index()];
    if resource.placement.is_none() {
        return "no step uses it".to_owned();
    }
    let text = match resource.alone {
        Some(alone) => describe::alone(plan, alone),
        None => {
            let sharers = describe::sharers(plan, id);
            format!("shares its bytes with {}", crate::diagnostic::list_names(sharers.iter().map(|id| describe::resource(plan, *id))))
        }
    };
    if resource.retained_for.is_empty() {
        return text;
    }
    const SHOWN: usize = 3;
    let inputs: Vec<String> = resource.retained_for.iter().take(SHOWN).map(|id| input(plan, *id)).collect();
    let more = match resource.retained_for.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{text}: {}{more} can change alone", inputs.join(", "))
}

/// What each input costs in retained bytes: of all resources that are retained since it can change alone.
pub(super) fn costs(plan: &Plan) -> Vec<(String, u64)> {
    let bytes = |id: InputId| {
        let retained = plan.resources.iter().filter(|resource| resource.retained_for.contains(&id) && resource.placement.is_some());
        retained.fold(0u64, |sum, resource| sum.saturating_add(resource.bytes))
    };
    (0..plan.inputs.len() as u32).map(InputId).map(|id| (input(plan, id), bytes(id))).collect()
}
