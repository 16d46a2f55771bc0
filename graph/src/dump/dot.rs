//! A plan as a Graphviz graph: passes are boxes, resources are ellipses, what does not run is grey and dashed, and outputs have
//! a double border.

use std::collections::BTreeSet;

use super::{describe, steps};
use crate::expand::types::ResourceId;
use crate::plan::{Plan, Role};

/// The graph, for `dot -Tsvg`. Edges of parts carry the part's name; a resource that only culled passes touch is dimmed too.
pub fn dot(plan: &Plan) -> String {
    let mut out = String::from(
        "digraph pipeline {\n  rankdir=LR;\n  node [fontname=\"sans-serif\", fontsize=10];\n  edge [fontname=\"sans-serif\", fontsize=8];\n",
    );
    out += &format!("  label={};\n", quoted(&format!("{}, {} x {}", plan.name, plan.extent[0], plan.extent[1])));
    for (place, step) in plan.steps.iter().enumerate() {
        let kind = steps::kind(plan, step);
        let label = format!("{place}: {}\n{}", step.name, kind.split(", ").next().unwrap_or_default());
        out += &format!("  p{} [shape=box, label={}];\n", step.pass.0, quoted(&label));
    }
    const DIMMED: &str = "style=dashed, color=grey, fontcolor=grey";
    for culled in &plan.culled {
        let label = format!("{}\n{}", culled.name, culled.kind);
        out += &format!("  p{} [shape=box, {DIMMED}, label={}];\n", culled.pass.0, quoted(&label));
    }
    let named_by_culled: BTreeSet<ResourceId> =
        plan.culled.iter().flat_map(|culled| culled.reads.iter().chain(&culled.writes)).copied().collect();
    for (index, resource) in plan.resources.iter().enumerate() {
        let id = ResourceId(index as u32);
        if resource.lifetime.is_empty() && !named_by_culled.contains(&id) {
            continue;
        }
        let outputs: Vec<&str> =
            plan.outputs.iter().filter(|output| output.view.resource == id).map(|output| output.name.as_str()).collect();
        let mut label = format!("{}\n{}\n{}", resource.name, describe::shape(resource), super::units::bytes(resource.bytes));
        if !outputs.is_empty() {
            label += &format!("\noutput {}", outputs.join(", "));
        }
        let look = match (resource.lifetime.is_empty(), outputs.is_empty()) {
            (true, _) => format!(", {DIMMED}"),
            (false, false) => ", peripheries=2, style=bold".to_owned(),
            (false, true) => String::new(),
        };
        out += &format!("  r{index} [shape=ellipse{look}, label={}];\n", quoted(&label));
    }
    let mut edges = BTreeSet::new();
    for step in &plan.steps {
        for used in &step.uses {
            let part = describe::part(plan, used.resource, &used.mips, &used.layers);
            let part = part.strip_prefix(describe::resource(plan, used.resource)).unwrap_or_default().to_owned();
            edges.insert((step.pass.0, used.resource.0, used.role, part));
        }
    }
    for (pass, resource, role, part) in edges {
        let label = if part.is_empty() { String::new() } else { format!(" [label={}]", quoted(&part)) };
        out += &match role {
            Role::Read => format!("  r{resource} -> p{pass}{label};\n"),
            Role::Recall => format!("  r{resource} -> p{pass} [style=dotted];\n"),
            Role::Produce => format!("  p{pass} -> r{resource}{label};\n"),
            Role::Modify if part.is_empty() => format!("  p{pass} -> r{resource} [dir=both];\n"),
            Role::Modify => format!("  p{pass} -> r{resource} [dir=both, label={}];\n", quoted(&part)),
        };
    }
    for culled in &plan.culled {
        for resource in &culled.reads {
            out += &format!("  r{} -> p{} [{DIMMED}];\n", resource.0, culled.pass.0);
        }
        for resource in &culled.writes {
            out += &format!("  p{} -> r{} [{DIMMED}];\n", culled.pass.0, resource.0);
        }
    }
    out + "}\n"
}

/// A string in Graphviz's quotes; line breaks centre.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for character in text.chars() {
        match character {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            character if character.is_control() => out.push(' '),
            character => out.push(character),
        }
    }
    out.push('"');
    out
}
