//! What runs in a frame: the passes that a change reaches, and whatever they need that is no longer there.
//!
//! Everything outside of the graph has a revision; a pass is due if something that it reads has changed since it last ran. A
//! pass that is due pulls, transitively, what it reads and no memory holds. The passes that run are the least set closed under
//! three rules: what is due runs; a producer and its modifiers run together, or light would be added twice; what a running pass
//! reads and is not held is made again.
//!
//! [`Tracker`] knows one plan at a time and what its memories hold. [`Tracker::frame`] decides, [`Tracker::commit`] records what was
//! submitted; in between nothing changes, so that a frame that failed is decided again. [`retention`] chooses, when a plan is made,
//! what keeps its content.
//!
//! A decision that came several times in a row is kept ([`habit`]).
//!
//! Accepted: a history is remembered whole, so that its readers run when any part of it changed. A frame compares the revision of
//! every input; all else costs time in proportion to what the changes reach.

mod adopt;
mod cells;
mod closure;
mod flow;
mod habit;
mod maker;
mod marks;
mod place;
mod pull;
mod retention;
mod tracker;

pub use adopt::{Adoption, Carry};
pub(crate) use place::overlap;
pub use retention::{Retention, retention};
pub use tracker::Tracker;

use crate::expand::types::{ClearValue, ResourceId};
use crate::plan::{InputId, PartView};

/// What runs in a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Frame {
    /// In the order of the plan.
    pub runs: Vec<StepRun>,
    /// Declared values that nothing but outputs and histories show, set after the last step.
    pub last_fills: Vec<(PartView, ClearValue)>,
    /// Nodes whose value changes, and amortised ones that start anew; for the tracker.
    changed: Vec<u32>,
    restarted: Vec<u32>,
    /// Resources whose declared parts are filled.
    filled: Vec<u32>,
}

impl Frame {
    /// Whether there is nothing to submit.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty() && self.last_fills.is_empty()
    }
}

/// A step that runs.
#[derive(Debug, Clone, PartialEq)]
pub struct StepRun {
    /// Index into [`crate::plan::Plan::steps`].
    pub step: usize,
    /// Of a batched step: places in [`crate::plan::Step::batch`], rising.
    pub iterations: Vec<u32>,
    /// Of an accumulating step: the number of the run since the last change.
    pub accumulated: u32,
    /// Declared values that it needs and no memory holds: set right before it, and before its clears.
    pub fills: Vec<(PartView, ClearValue)>,
    /// What [`crate::plan::Step::clears`] come to in this frame.
    pub clears: Vec<(PartView, ClearValue)>,
    /// Of a step that remembers: where the value of the frame before is.
    pub remembered: Option<Remembered>,
    /// Why it runs; of a batched step, why the first of its iterations does.
    pub why: Why,
}

/// Where the value of the frame before is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Remembered {
    /// In the resource's memory.
    Here,
    /// In a memory of a plan before, that the backend carries.
    Carried,
    /// Nowhere: the history gets its first value.
    Gone,
}

/// Why a pass does not run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Idle {
    /// Nothing that it reads has changed since it ran.
    Clean,
    /// Its iteration's turn has not come.
    Waits,
    /// It has gathered so many, which is all.
    Gathered(u32),
}

/// Why a pass runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Why {
    /// It has not run as it is.
    New,
    /// An input changed.
    Input(InputId),
    /// What it reads or modifies was made anew by this step.
    Reads {
        /// Index into the steps.
        step: usize,
        /// In this resource.
        resource: ResourceId,
    },
    /// It runs in every frame.
    EveryFrame,
    /// It accumulates, and has not gathered all.
    Accumulates,
    /// It is the turn of its iteration.
    Turn,
    /// What it remembers changed in the frame before.
    Remembers,
    /// It runs together with this step.
    Together {
        /// Index into the steps.
        step: usize,
    },
    /// This step reads what it makes, and no memory holds that any more.
    Pulled {
        /// Index into the steps; `None` for outputs and histories.
        step: Option<usize>,
        /// The resource.
        resource: ResourceId,
    },
}
