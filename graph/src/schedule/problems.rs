//! What can be wrong with who makes and who reads each part. Every message names both sides.

use std::collections::BTreeMap;

use super::part::{self, Rect};
use super::versions::{Grid, Region, UseRef, only_tests, writes};
use crate::bind::types::Bound;
use crate::diagnostic::{Diagnostic, did_you_mean, list_names};
use crate::expand::types::{Output, PassId, Resource};
use crate::plan::{Access, Role, Step};

/// All of them but cycles, by resource and then by pass.
pub(crate) fn problems(bound: &Bound, grids: &[Grid]) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for (grid, resource) in grids.iter().zip(&bound.expanded.resources) {
        rivals(bound, grid, resource, &mut found);
        unproduced_modifies(bound, grid, resource, &mut found);
        for region in &grid.regions {
            unwritten_reads(bound, grid, region, resource, &mut found);
            wrong_versions(bound, grid, region, resource, &mut found);
            outputs(bound, grid, region, resource, &mut found);
        }
        unmade_past(bound, grid, resource, &mut found);
        unread(bound, grid, resource, &mut found);
    }
    for step in &bound.steps {
        reads_what_it_writes(bound, step, &mut found);
    }
    found
}

fn step(bound: &Bound, pass: PassId) -> &Step {
    &bound.steps[pass.index()]
}

fn rivals(bound: &Bound, grid: &Grid, resource: &Resource, found: &mut Vec<Diagnostic>) {
    for (first, second, rect) in &grid.rivals {
        let (a, b) = (step(bound, first.pass), step(bound, second.pass));
        let part = rect.name(resource);
        found.push(
            Diagnostic::error("schedule::two-producers", format!("`{}` and `{}` both write `{part}`", a.name, b.name))
                .at(second.get(bound).span, format!("`{}` writes it again", b.name))
                .and(first.get(bound).span, format!("`{}` writes it", a.name))
                .note("the order of passes in the file carries no meaning, so neither of them is the later one")
                .hint(format!(
                    "put it under `modify` in the pass that adds to the value of the other, or let `{}` write a resource of its own",
                    b.name
                )),
        );
    }
    for (first, second, rect) in &grid.repeated {
        let writer = step(bound, first.pass);
        found.push(
            Diagnostic::error("schedule::written-twice", format!("`{}` writes `{}` through two slots", writer.name, rect.name(resource)))
                .at(second.get(bound).span, format!("`{}` is bound to it", second.get(bound).slot))
                .and(first.get(bound).span, format!("`{}` is bound to it too", first.get(bound).slot))
                .hint("leave one of them out: under `modify` if it needs the value from before, else under `write`"),
        );
    }
}

fn unproduced_modifies(bound: &Bound, grid: &Grid, resource: &Resource, found: &mut Vec<Diagnostic>) {
    if resource.clear.is_some() {
        return;
    }
    let mut by_writer: BTreeMap<UseRef, Vec<Rect>> = BTreeMap::new();
    for cell in grid.cells.iter().filter(|cell| !cell.produced) {
        if let Some(first) = cell.writers.first() {
            by_writer.entry(*first).or_default().push(cell.rect.clone());
        }
    }
    for (writer, rects) in by_writer {
        let name = &step(bound, writer.pass).name;
        found.push(
            Diagnostic::error(
                "schedule::nothing-to-modify",
                format!("`{name}` modifies {}, which nothing produces", part::names(rects, resource)),
            )
            .at(writer.get(bound).span, "there is no value yet")
            .and(resource.span, "it declares no `clear` value")
            .hint("add `clear:` to the resource, put it under `write` here, or let another pass write it"),
        );
    }
}

fn unwritten_reads(bound: &Bound, grid: &Grid, region: &Region, resource: &Resource, found: &mut Vec<Diagnostic>) {
    if region.unwritten.is_empty() || resource.clear.is_some() {
        return;
    }
    for reader in &region.readers {
        let rects = region.unwritten.iter().map(|cell| grid.cells[*cell].rect.clone()).collect();
        let name = &step(bound, reader.pass).name;
        found.push(
            Diagnostic::error(
                "schedule::nothing-produces",
                format!("`{name}` reads {}, which nothing produces", part::names(rects, resource)),
            )
            .at(reader.get(bound).span, "no pass that stands writes it")
            .and(resource.span, "it declares no `clear` value")
            .hint("add a pass that writes it, or `clear:` with the value that it has where nothing writes it"),
        );
    }
}

/// What is remembered has to be something, all of it.
fn unmade_past(bound: &Bound, grid: &Grid, resource: &Resource, found: &mut Vec<Diagnostic>) {
    let rects: Vec<Rect> = grid.cells.iter().filter(|cell| cell.writers.is_empty()).map(|cell| cell.rect.clone()).collect();
    let Some(recaller) = grid.recallers.first().filter(|_| !rects.is_empty() && resource.clear.is_none()) else { return };
    found.push(
        Diagnostic::error(
            "schedule::nothing-to-remember",
            format!("the past of {} is read, and nothing produces it", part::names(rects, resource)),
        )
        .at(resource.span, "it declares no `clear` value")
        .and(recaller.get(bound).span, "remembered here")
        .hint("add a pass that writes it, or `clear:` with the value that it has where nothing writes it"),
    );
}

fn wrong_versions(bound: &Bound, grid: &Grid, region: &Region, resource: &Resource, found: &mut Vec<Diagnostic>) {
    let Some(version) = region.version else { return };
    if region.foreign.is_empty() {
        return;
    }
    let named = step(bound, version);
    let mut writers: Vec<PassId> =
        grid.cells_in(&region.rect).flat_map(|cell| grid.cells[cell].writers.iter()).map(|writer| writer.pass).collect();
    writers.sort_unstable();
    writers.dedup();
    let names = || writers.iter().map(|pass| step(bound, *pass).name.as_str());
    let hint = did_you_mean(&named.name, names()).unwrap_or_else(|| match writers.is_empty() {
        true => "no pass writes it".to_owned(),
        false => format!("it is written by {}", list_names(names())),
    });
    let rects: Vec<Rect> = region.foreign.iter().map(|cell| grid.cells[*cell].rect.clone()).collect();
    let parts = part::names(rects, resource);
    let mut report = |reader: String, span| {
        found.push(
            Diagnostic::error(
                "schedule::wrong-version",
                format!("{reader} the value of {parts} as `{}` left it, but `{}` doesn't write it", named.name, named.name),
            )
            .at(span, format!("names the value that `{}` left", named.name))
            .and(named.span, "doesn't write that part")
            .hint(hint.clone()),
        );
    };
    for reader in &region.readers {
        report(format!("`{}` reads", step(bound, reader.pass).name), reader.get(bound).span);
    }
    for output in &region.outputs {
        let output = &bound.expanded.outputs[*output];
        report(format!("output `{}` is", output.name), output.part.span);
    }
}

fn outputs(bound: &Bound, grid: &Grid, region: &Region, resource: &Resource, found: &mut Vec<Diagnostic>) {
    for output in region.outputs.iter().map(|index| &bound.expanded.outputs[*index]) {
        if !region.unwritten.is_empty() && resource.clear.is_none() {
            let rects = region.unwritten.iter().map(|cell| grid.cells[*cell].rect.clone()).collect();
            found.push(
                Diagnostic::error(
                    "schedule::output-not-produced",
                    format!("output `{}` is {}, which nothing produces", output.name, part::names(rects, resource)),
                )
                .at(output.part.span, "no pass that stands writes it")
                .and(resource.span, "it declares no `clear` value")
                .hint("add a pass that writes it, or take the output away"),
            );
        }
        if let (Some(version), Some(next)) = (region.version, region.destroyers.first()) {
            let (version, next) = (step(bound, version), step(bound, *next));
            found.push(
                Diagnostic::error(
                    "schedule::output-version",
                    format!("output `{}` is the value that `{}` left, but `{}` changes it", output.name, version.name, next.name),
                )
                .at(output.part.span, "outputs are read after all passes")
                .and(next.span, format!("modifies `{}`", resource.name))
                .hint("copy the value to a resource of its own with a Copy, and output that"),
            );
        }
    }
}

/// The code of the message that comes where outputs are nothing but declared values, which depends on the scene.
pub const NOTHING_RUNS: &str = "schedule::nothing-runs";

/// Outputs that are nothing but declared values, where no pass runs that could fill them.
pub(crate) fn nothing_runs(bound: &Bound) -> Vec<Diagnostic> {
    let outputs = bound.expanded.outputs.iter();
    let report = |output: &Output| {
        let resource = &bound.expanded.resources[output.part.resource.index()];
        Diagnostic::error(
            NOTHING_RUNS,
            format!("output `{}` is the declared value of `{}`, and no pass runs to fill it", output.name, resource.name),
        )
        .at(output.part.span, "nothing produces it")
        .and(resource.span, "declared here")
        .hint("ask for an output that a pass makes, too, or set the value with a Clear pass")
    };
    outputs.map(report).collect()
}

fn reads_what_it_writes(bound: &Bound, step: &Step, found: &mut Vec<Diagnostic>) {
    for write in step.uses.iter().filter(|touched| writes(touched.role) && !only_tests(touched)) {
        for read in step.uses.iter().filter(|touched| touched.role == Role::Read && touched.resource == write.resource) {
            let both = Rect::new(&read.mips, &read.layers).intersection(&Rect::new(&write.mips, &write.layers));
            let (Some(both), Some(resource)) = (both, bound.expanded.resources.get(write.resource.index())) else { continue };
            let verb = if write.role == Role::Modify { "modifies" } else { "writes" };
            found.push(
                Diagnostic::error(
                    "schedule::reads-what-it-writes",
                    format!("`{}` reads `{}` and {verb} it", step.name, both.name(resource)),
                )
                .at(read.span, format!("read as `{}`", read.slot))
                .and(write.span, format!("written as `{}`", write.slot))
                .hint(if write.access == Access::DepthAttachment {
                    "set `depth: (write: false)` to test against it while it is read, or read a copy"
                } else {
                    "read a copy, write another resource, or use one `modify` slot for both"
                }),
            );
        }
    }
}

fn unread(bound: &Bound, grid: &Grid, resource: &Resource, found: &mut Vec<Diagnostic>) {
    if bound.expanded.offered.iter().any(|offered| bound.expanded.resources[offered.index()].name == resource.name) {
        return;
    }
    let Some(writer) = grid.cells.iter().find_map(|cell| cell.writers.first()) else { return };
    let mut writers = grid.cells.iter().flat_map(|cell| &cell.writers);
    // A depth buffer that is only tested against does its work without a reader.
    if !grid.regions.is_empty()
        || !grid.recallers.is_empty()
        || writers.all(|writer| matches!(writer.get(bound).access, Access::DepthAttachment | Access::DepthReadOnly))
    {
        return;
    }
    found.push(
        Diagnostic::warning("schedule::unread-resource", format!("nothing reads `{}`, and it is no output", resource.name))
            .at(resource.span, "declared here")
            .and(writer.get(bound).span, format!("written by `{}`", step(bound, writer.pass).name))
            .hint("read it, name it under `outputs`, or take it away"),
    );
}
