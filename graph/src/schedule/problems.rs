//! What can be wrong with who makes and who reads each part. Every message names both sides.

use std::collections::BTreeMap;

use super::Unread;
use super::part::{self, Rect};
use super::uses::{UseId, Uses};
use super::versions::{Grid, Region, Versions, only_tests, writes};
use crate::bind::types::Bound;
use crate::diagnostic::{Diagnostic, did_you_mean, list_names};
use crate::expand::types::{Output, PassId, Resource, ResourceId};
use crate::plan::{Access, Role, Step};

/// All errors but cycles, by resource and then by pass.
pub(crate) fn problems(bound: &Bound, uses: &Uses, versions: &Versions) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for (grid, resource) in versions.grids().zip(&bound.expanded.resources) {
        let mut context = Context { bound, uses, grid, resource, found: &mut found };
        context.rivals();
        context.unproduced_modifies();
        for region in grid.regions {
            context.unwritten_reads(region);
            context.wrong_versions(region);
            context.outputs(region);
        }
        context.unmade_past();
    }
    for (pass, step) in bound.steps.iter().enumerate() {
        reads_what_it_writes(bound, uses, pass, step, &mut found);
    }
    found
}

/// A resource, and what is found at it.
struct Context<'a> {
    bound: &'a Bound,
    uses: &'a Uses,
    grid: Grid<'a>,
    resource: &'a Resource,
    found: &'a mut Vec<Diagnostic>,
}

fn step(bound: &Bound, pass: PassId) -> &Step {
    &bound.steps[pass.index()]
}

impl Context<'_> {
    fn rivals(&mut self) {
        let Context { bound, uses, grid, resource, found } = self;
        let at = |id: &UseId| uses.in_step(bound, *id);
        let of = |id: &UseId| step(bound, uses.get(*id).pass);
        for (first, second, rect) in &grid.exceptions.rivals {
            let (a, b) = (of(first), of(second));
            let part = rect.name(resource);
            found.push(
                Diagnostic::error("schedule::two-producers", format!("`{}` and `{}` both write `{part}`", a.name, b.name))
                    .at(at(second).span, format!("`{}` writes it again", b.name))
                    .and(at(first).span, format!("`{}` writes it", a.name))
                    .note("the order of passes in the file carries no meaning, so neither of them is the later one")
                    .hint(format!(
                        "put it under `modify` in the pass that adds to the value of the other, or let `{}` write a resource of its own",
                        b.name
                    )),
            );
        }
        for (first, second, rect) in &grid.exceptions.repeated {
            let writer = of(first);
            found.push(
                Diagnostic::error(
                    "schedule::written-twice",
                    format!("`{}` writes `{}` through two slots", writer.name, rect.name(resource)),
                )
                .at(at(second).span, format!("`{}` is bound to it", at(second).slot))
                .and(at(first).span, format!("`{}` is bound to it too", at(first).slot))
                .hint("leave one of them out: under `modify` if it needs the value from before, else under `write`"),
            );
        }
    }

    fn unproduced_modifies(&mut self) {
        let Context { bound, uses, grid, resource, found } = self;
        let at = |id: &UseId| uses.in_step(bound, *id);
        let of = |id: &UseId| step(bound, uses.get(*id).pass);
        let mut by_writer: BTreeMap<UseId, Vec<Rect>> = BTreeMap::new();
        for cell in grid.cells.iter().filter(|cell| !cell.produced && resource.clear.is_none()) {
            if let Some(first) = grid.writers(cell).first() {
                by_writer.entry(*first).or_default().push(cell.rect.clone());
            }
        }
        for (writer, rects) in by_writer {
            let name = &of(&writer).name;
            found.push(
                Diagnostic::error(
                    "schedule::nothing-to-modify",
                    format!("`{name}` modifies {}, which nothing produces", part::names(rects, resource)),
                )
                .at(at(&writer).span, "there is no value yet")
                .and(resource.span, "it declares no `clear` value")
                .hint("add `clear:` to the resource, put it under `write` here, or let another pass write it"),
            );
        }
    }

    fn unwritten_reads(&mut self, region: &Region) {
        let Context { bound, uses, grid, resource, found } = self;
        let at = |id: &UseId| uses.in_step(bound, *id);
        let of = |id: &UseId| step(bound, uses.get(*id).pass);
        if grid.unwritten(region).is_empty() || resource.clear.is_some() {
            return;
        }
        for reader in grid.readers(region) {
            let rects = grid.rects(grid.unwritten(region));
            let name = &of(reader).name;
            found.push(
                Diagnostic::error(
                    "schedule::nothing-produces",
                    format!("`{name}` reads {}, which nothing produces", part::names(rects, resource)),
                )
                .at(at(reader).span, "no pass that stands writes it")
                .and(resource.span, "it declares no `clear` value")
                .hint("add a pass that writes it, or `clear:` with the value that it has where nothing writes it"),
            );
        }
    }

    /// What is remembered has to be something, all of it.
    fn unmade_past(&mut self) {
        let Context { bound, uses, grid, resource, found } = self;
        let at = |id: &UseId| uses.in_step(bound, *id);
        let Some(recaller) = grid.exceptions.recallers.first().filter(|_| resource.clear.is_none()) else { return };
        let rects: Vec<Rect> = grid.cells.iter().filter(|cell| grid.writers(cell).is_empty()).map(|cell| cell.rect.clone()).collect();
        if rects.is_empty() {
            return;
        }
        found.push(
            Diagnostic::error(
                "schedule::nothing-to-remember",
                format!("the past of {} is read, and nothing produces it", part::names(rects, resource)),
            )
            .at(resource.span, "it declares no `clear` value")
            .and(at(recaller).span, "remembered here")
            .hint("add a pass that writes it, or `clear:` with the value that it has where nothing writes it"),
        );
    }

    fn wrong_versions(&mut self, region: &Region) {
        let Context { bound, uses, grid, resource, found } = self;
        let at = |id: &UseId| uses.in_step(bound, *id);
        let of = |id: &UseId| step(bound, uses.get(*id).pass);
        let Some(version) = region.version else { return };
        if grid.foreign(region).is_empty() {
            return;
        }
        let named = step(bound, version);
        let inside = grid.cells.iter().filter(|cell| cell.rect.intersection(&region.rect).is_some());
        let mut writers: Vec<PassId> = inside.flat_map(|cell| grid.writers(cell)).map(|writer| uses.get(*writer).pass).collect();
        writers.sort_unstable();
        writers.dedup();
        let names = || writers.iter().map(|pass| &*step(bound, *pass).name);
        let hint = did_you_mean(&named.name, names()).unwrap_or_else(|| match writers.is_empty() {
            true => "no pass writes it".to_owned(),
            false => format!("it is written by {}", list_names(names())),
        });
        let parts = part::names(grid.rects(grid.foreign(region)), resource);
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
        for reader in grid.readers(region) {
            report(format!("`{}` reads", of(reader).name), at(reader).span);
        }
        for output in grid.outputs(region) {
            let output = &bound.expanded.outputs[*output as usize];
            report(format!("output `{}` is", output.name), output.part.span);
        }
    }

    fn outputs(&mut self, region: &Region) {
        let Context { bound, grid, resource, found, .. } = self;
        for output in grid.outputs(region).iter().map(|index| &bound.expanded.outputs[*index as usize]) {
            if !grid.unwritten(region).is_empty() && resource.clear.is_none() {
                let rects = grid.rects(grid.unwritten(region));
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
            if let (Some(version), Some(next)) = (region.version, grid.destroyers(region).first()) {
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

fn reads_what_it_writes(bound: &Bound, uses: &Uses, pass: usize, step: &Step, found: &mut Vec<Diagnostic>) {
    let touches = || uses.of_pass(pass).iter().enumerate();
    for (write_index, write) in touches().filter(|(_, touch)| writes(touch.role) && !only_tests(touch.access)) {
        for (read_index, read) in touches().filter(|(_, touch)| touch.role == Role::Read && touch.resource == write.resource) {
            let resource = bound.expanded.resources.get(write.resource.index());
            let (Some(both), Some(resource)) = (read.rect.intersection(&write.rect), resource) else { continue };
            let (read, write) = (&step.uses[read_index], &step.uses[write_index]);
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

/// Resources that nothing reads and no output names, by id.
pub(crate) fn unread(bound: &Bound, uses: &Uses, versions: &Versions) -> Vec<Unread> {
    let mut offered = vec![false; bound.expanded.resources.len()];
    bound.expanded.offered.iter().for_each(|resource| offered[resource.index()] = true);
    let mut found = Vec::new();
    for (index, grid) in versions.grids().enumerate() {
        if offered[index] || !grid.regions.is_empty() || !grid.exceptions.recallers.is_empty() {
            continue;
        }
        // A depth buffer that is only tested against does its work without a reader.
        let works = |id| !matches!(uses.get(id).access, Access::DepthAttachment | Access::DepthReadOnly);
        if let Some(writer) = grid.all_writers().next().filter(|_| grid.all_writers().any(works)) {
            found.push(Unread { resource: ResourceId(index as u32), writer: uses.get(writer).pass, place: uses.place_in_step(writer) });
        }
    }
    found
}

impl Unread {
    /// As a warning.
    pub(crate) fn diagnostic(&self, bound: &Bound) -> Diagnostic {
        let resource = &bound.expanded.resources[self.resource.index()];
        let writer = step(bound, self.writer);
        Diagnostic::warning("schedule::unread-resource", format!("nothing reads `{}`, and it is no output", resource.name))
            .at(resource.span, "declared here")
            .and(writer.uses[self.place].span, format!("written by `{}`", writer.name))
            .hint("read it, name it under `outputs`, or take it away")
    }
}
