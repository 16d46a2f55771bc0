//! A plan as one page for a browser: which pass uses what, how long each resource lives, and what shares memory.
//!
//! Columns are steps in their order, rows are resources grouped by the memory that they live in, so that bars in one group never
//! cover each other. No script and no other file: the page can be saved and sent. Accepted downside: beyond some thousand steps a
//! browser scrolls slowly.

use std::fmt::Write;

use super::units::bytes as human;
use super::{describe, steps};
use crate::expand::types::ResourceId;
use crate::plan::{MemoryKind, Plan, PlannedResource, Role};
use crate::source::SourceMap;

/// Width of a step and height of a resource, in pixels.
const COLUMN: usize = 18;
const ROW: usize = 20;
/// Room for the names of resources and of steps.
const LEFT: usize = 260;
const TOP: usize = 170;

const STYLE: &str = "\
body { font: 14px/1.45 system-ui, sans-serif; margin: 2em; color: #222; background: #fff }
pre { white-space: pre-wrap; margin: .2em 0 .8em }
details { margin: .15em 0 }
summary { cursor: pointer }
table { border-collapse: collapse }
td, th { padding: .1em 1em .1em 0; text-align: left; font-weight: normal; vertical-align: top }
td.n { text-align: right; font-variant-numeric: tabular-nums }
.chart { overflow: auto; max-height: 85vh; border: 1px solid #ccc }
svg text { font: 11px system-ui, sans-serif; fill: #222 }
svg .memory { font-weight: 600 }
svg .line { stroke: #eee }
svg .shared { fill: #9ecae9 }
svg .alone { fill: #d9d9d9 }
svg .retained { fill: #f6c98f }
svg .write { fill: #1f3b57 }
svg .modify { fill: #1f3b57; fill-opacity: .55 }
svg .read { fill: #fff; stroke: #1f3b57 }
.key { display: inline-block; width: 1em; height: 1em; margin: 0 .4em 0 1.2em; vertical-align: -.15em }
";

/// The whole plan.
pub fn html(plan: &Plan, sources: &SourceMap) -> String {
    let mut page = String::new();
    let title = escaped(&plan.name);
    let [width, height] = plan.extent;
    page += &format!("<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n");
    page += &format!("<h1>{title}</h1>\n<pre>{}</pre>\n", escaped(&plan.doc));
    page += &format!("<p>{} steps for an image of {width} x {height}; {} passes do not run.</p>\n", plan.steps.len(), plan.culled.len());
    figures(plan, &mut page);
    page += "<h2>Steps and resources</h2>\n<p>";
    for (color, meaning) in [("#9ecae9", "shares its bytes"), ("#d9d9d9", "bytes of its own"), ("#f6c98f", "kept from frame to frame")] {
        page += &format!("<span class=\"key\" style=\"background:{color}\"></span>{meaning}");
    }
    page += ". Dark: written; paler: modified; hollow: read. Point at something to see what it is.</p>\n";
    chart(plan, &mut page);
    page += "<h2>Steps</h2>\n";
    for (place, step) in plan.steps.iter().enumerate() {
        let lines = steps::step(plan, place, step, sources);
        let first = lines.first().map(|line| escaped(line)).unwrap_or_default();
        let rest: Vec<String> = lines.iter().skip(1).map(|line| escaped(line)).collect();
        page += &format!("<details id=\"step{place}\"><summary>{first}</summary><pre>{}</pre></details>\n", rest.join("\n"));
    }
    if !plan.culled.is_empty() {
        page += "<h2>Passes that do not run</h2>\n<table>\n";
        for culled in &plan.culled {
            let why = describe::culled(plan, &culled.reason);
            page += &format!("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", escaped(&culled.name), culled.kind, escaped(&why));
        }
        page += "</table>\n";
    }
    page + "</html>\n"
}

fn figures(plan: &Plan, page: &mut String) {
    let figures = &plan.figures;
    *page += "<h2>Memory</h2>\n<table>\n";
    for (what, bytes) in [
        ("transient, without sharing", figures.without_sharing),
        ("transient, reached", figures.reached),
        ("the most in use at once", figures.bound),
        ("the same in the order of the file", plan.declared_bound()),
        ("retained", figures.retained),
        ("total", figures.reached.saturating_add(figures.retained)),
    ] {
        *page += &format!("<tr><td>{what}</td><td class=\"n\">{}</td><td class=\"n\">{bytes} bytes</td></tr>\n", human(bytes));
    }
    *page += "</table>\n";
}

fn chart(plan: &Plan, page: &mut String) {
    let rows: usize = plan.memories.iter().map(|memory| memory.holders.len() + 1).sum();
    let (width, height) = (LEFT + (plan.steps.len() + 6) * COLUMN, TOP + (rows + 1) * ROW);
    *page += &format!("<div class=\"chart\"><svg width=\"{width}\" height=\"{height}\" role=\"img\">\n");
    for (place, step) in plan.steps.iter().enumerate() {
        let x = column(place);
        let name = escaped(&step.name);
        let middle = x + COLUMN / 2;
        *page += &format!("<line class=\"line\" x1=\"{middle}\" y1=\"{TOP}\" x2=\"{middle}\" y2=\"{height}\"/>");
        let (x, y) = (middle + 4, TOP - 8);
        *page += &format!("<a href=\"#step{place}\"><text x=\"{x}\" y=\"{y}\" transform=\"rotate(-60 {x} {y})\">{name}</text></a>\n");
    }
    let uses = uses_by_resource(plan);
    let mut y = TOP;
    for (index, memory) in plan.memories.iter().enumerate() {
        let kind = if memory.kind == MemoryKind::Arena { "arena" } else { "texture" };
        let text = format!("memory {index}: {kind}, {}", human(memory.bytes));
        *page += &format!("<text class=\"memory\" x=\"4\" y=\"{}\">{text}</text>\n", y + 15);
        y += ROW;
        for holder in &memory.holders {
            if let Some(resource) = plan.resources.get(holder.index()) {
                row(plan, *holder, resource, uses.get(holder.index()).map_or(&[], Vec::as_slice), y, page);
            }
            y += ROW;
        }
    }
    *page += "</svg></div>\n";
}

fn column(step: usize) -> usize {
    LEFT + step * COLUMN
}

/// What each step does to each resource, by resource: the step, the role, and the words for both.
fn uses_by_resource(plan: &Plan) -> Vec<Vec<(usize, Role, String)>> {
    let mut uses = vec![Vec::new(); plan.resources.len()];
    for (place, step) in plan.steps.iter().enumerate() {
        for used in &step.uses {
            let part = describe::part(plan, used.resource, &used.mips, &used.layers);
            let words = format!("{} {} {part} ({})", step.name, describe::role(used.role), describe::access(used.access));
            if let Some(list) = uses.get_mut(used.resource.index()) {
                list.push((place, used.role, words));
            }
        }
    }
    uses
}

fn row(plan: &Plan, id: ResourceId, resource: &PlannedResource, uses: &[(usize, Role, String)], y: usize, page: &mut String) {
    let name = escaped(&resource.name);
    let about = format!("{}: {}, {}", resource.name, describe::shape(resource), human(resource.bytes));
    let (class, why) = match (resource.retained, resource.alone) {
        (Some(why), _) => ("retained", describe::retained(why).to_owned()),
        (None, Some(alone)) => ("alone", describe::alone(plan, alone)),
        (None, None) => {
            let names = crate::diagnostic::list_names(describe::sharers(plan, id).iter().map(|id| describe::resource(plan, *id)));
            ("shared", format!("shares its bytes with {names}"))
        }
    };
    // What is retained is there in every step.
    let life = if resource.retained.is_some() { 0..plan.steps.len() } else { resource.lifetime.clone() };
    let (x, length) = (column(life.start), life.len() * COLUMN);
    let title = escaped(&format!("{about}; {why}"));
    let _ = write!(page, "<text x=\"16\" y=\"{}\">{name}<title>{title}</title></text>", y + 15);
    let _ = write!(
        page,
        "<rect class=\"{class}\" x=\"{x}\" y=\"{}\" width=\"{length}\" height=\"{}\" rx=\"3\"><title>{title}</title></rect>",
        y + 2,
        ROW - 4
    );
    for (step, role, words) in uses {
        let class = match role {
            Role::Produce => "write",
            Role::Modify => "modify",
            Role::Read | Role::Recall => "read",
        };
        let (x, y) = (column(*step) + COLUMN / 2, y + ROW / 2);
        let _ = write!(page, "<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"5\"><title>{}</title></circle>", escaped(words));
    }
    page.push('\n');
}

/// As text of a page: names come from files.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
