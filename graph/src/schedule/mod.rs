//! Which passes run, and in which order.
//!
//! From the parts that each pass touches ([`uses`]) follow the producers, modifiers and readers of every part ([`versions`]), what must
//! come before what ([`dag`]), which passes nothing needs ([`cull`]) and an order that takes little memory ([`order`]). The
//! order of passes in the file carries no meaning but among the modifiers of one part; where something else would decide, that
//! is an error. All errors are found before any is returned, whatever outputs are asked for.
//!
//! Accepted: the warning about unread resources knows only the outputs that were asked for.

mod clears;
mod cull;
mod cycle;
mod dag;
pub(crate) mod flow;
mod order;
pub(crate) mod part;
mod problems;
pub(crate) mod sweep;
mod uses;
mod versions;

pub use problems::NOTHING_RUNS;
pub(crate) use uses::{Touch, Uses};
pub(crate) use versions::writes;

use crate::allocate::model::Model;
use crate::bind::types::Bound;
use crate::diagnostic::Diagnostic;
use crate::expand::types::{ClearValue, PassId, ResourceId};
use crate::plan::{Culled, PartView, Retained};
use dag::Dag;
use flow::Flow;
use versions::Versions;

/// A part that nothing produces and that is used all the same.
#[derive(Debug, Clone, PartialEq)]
pub struct InitialClear {
    /// The first step that uses it.
    pub pass: PassId,
    /// Which.
    pub part: PartView,
    /// The declared value.
    pub value: ClearValue,
    /// The step modifies it: it gets the declared value whenever the step runs, and not only when it is not held.
    pub modified: bool,
}

/// A resource that nothing reads and no output names.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unread {
    /// Which.
    pub resource: ResourceId,
    /// The first pass that writes it.
    pub writer: PassId,
    /// The use that does, by its place in the step.
    pub place: usize,
}

/// What runs, in order, and what does not.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Schedule {
    /// The passes that run, in the order in which they do.
    pub order: Vec<PassId>,
    /// The same passes in the declared order: always the ready one that stands first in the file.
    pub declared: Vec<PassId>,
    /// The passes that do not run, in the order of the file.
    pub culled: Vec<Culled>,
    /// Parts that nothing produces, in the order of the steps that use them first.
    pub initial_clears: Vec<InitialClear>,
    /// Resources that only cost time, by id: a mistake, mostly. Their texts wait until they are wanted, see [`Schedule::warnings`].
    pub unread: Vec<Unread>,
    /// What waits for what among the passes that run.
    pub flow: Flow,
    /// What memory planning knows of the pipeline.
    pub model: Model,
}

impl Schedule {
    /// What the author probably did not mean, by place.
    pub fn warnings(&self, bound: &Bound) -> Vec<Diagnostic> {
        by_place(self.unread.iter().map(|unread| unread.diagnostic(bound)).collect())
    }
}

/// Schedules a bound pipeline, given why each resource outlives the frame, if it does. Fails with all problems, warnings too, if
/// one is an error.
pub fn schedule(bound: &Bound, retained: &[Option<Retained>]) -> Result<Schedule, Vec<Diagnostic>> {
    let uses = Uses::new(bound);
    let versions = Versions::new(bound, &uses);
    let mut found = problems::problems(bound, &uses, &versions);
    let dag = Dag::new(bound, &uses, &versions);
    if dag.has_cycle() {
        found.extend(cycle::cycles(bound, &uses, &versions));
    }
    let unread = problems::unread(bound, &uses, &versions);
    let with_warnings = |mut found: Vec<Diagnostic>| {
        found.extend(unread.iter().map(|unread| unread.diagnostic(bound)));
        by_place(found)
    };
    if !found.is_empty() {
        return Err(with_warnings(found));
    }
    let alive = cull::alive(bound, &uses, &dag, &versions);
    if !alive.contains(&true) && !bound.expanded.outputs.is_empty() {
        return Err(with_warnings(problems::nothing_runs(bound)));
    }
    let model = Model::new(bound, &uses, retained, &alive);
    let flow = Flow::new(&dag, &alive, &model);
    let order = flow.passes_of(&order::chosen(&flow, &model));
    let culled = cull::culled(bound, &uses, &dag, &alive);
    let initial_clears = clears::initial_clears(bound, &uses, &versions, &order);
    let declared = flow.passes_of(&flow.declared);
    Ok(Schedule { order, declared, culled, initial_clears, unread, flow, model })
}

/// Stable: problems of one place keep the order in which they were found.
fn by_place(mut found: Vec<Diagnostic>) -> Vec<Diagnostic> {
    found.sort_by_key(|diagnostic| diagnostic.primary.as_ref().map(|label| label.span));
    found
}
