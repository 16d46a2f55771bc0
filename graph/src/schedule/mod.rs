//! Which passes run, and in which order.
//!
//! From the parts that each pass touches follow the producers, modifiers and readers of every part ([`versions`]), what must
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
mod versions;

pub use problems::NOTHING_RUNS;
pub(crate) use versions::writes;

use crate::allocate::model::Model;
use crate::bind::types::Bound;
use crate::diagnostic::{Diagnostic, has_errors};
use crate::expand::types::{ClearValue, PassId};
use crate::plan::{Culled, PartView, Retained};
use flow::Flow;

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
    /// What waits for what among the passes that run.
    pub flow: Flow,
    /// What memory planning knows of the pipeline.
    pub model: Model,
}

/// Schedules a bound pipeline, given why each resource outlives the frame, if it does. The schedule is there if none of the problems is an error.
pub fn schedule(bound: &Bound, retained: &[Option<Retained>]) -> (Option<Schedule>, Vec<Diagnostic>) {
    let grids = versions::versions(bound);
    let mut found = problems::problems(bound, &grids);
    let dag = dag::dag(bound, &grids);
    found.extend(cycle::cycles(bound, &dag));
    // Stable: problems of one place keep the order in which they were found.
    found.sort_by_key(|diagnostic| diagnostic.primary.as_ref().map(|label| label.span));
    if has_errors(&found) {
        return (None, found);
    }
    let alive = cull::alive(&dag, &grids);
    if !alive.contains(&true) && !bound.expanded.outputs.is_empty() {
        found.extend(problems::nothing_runs(bound));
        return (None, found);
    }
    let model = Model::new(bound, retained, |pass| alive[pass]);
    let flow = Flow::new(&dag, &alive, &model);
    let order = flow.passes_of(&order::chosen(&flow, &model));
    let culled = cull::culled(bound, &dag, &alive);
    let initial_clears = clears::initial_clears(bound, &grids, &order);
    let declared = flow.passes_of(&flow.declared);
    let schedule = Schedule { order, declared, culled, initial_clears, flow, model };
    (Some(schedule), found)
}
