//! What was decided over and over in the same way, so that it need not be decided again.
//!
//! A camera that moves changes the same inputs in every frame. What runs follows from the state and from which inputs changed, and what
//! [`super::Tracker::commit`] leaves follows from what ran: running the same passes twice holds what running them once does. So a
//! decision that came back from the state that it had left itself comes back for ever, until something else happens.
//!
//! Accepted: amortised passes count on from frame to frame, so that their frames are decided every time, but for those that only start
//! again.

use std::sync::Arc;

use super::Frame;

/// The first frame after something new may still tidy up (a first past, lost content); the second starts where it left off, and the
/// third starts where an equal one did.
const OFTEN: u32 = 3;

/// The last decision, and how often it came in a row.
#[derive(Debug, Clone)]
pub(super) struct Habit {
    /// Inputs that had changed, rising.
    changed: Vec<u32>,
    frame: Arc<Frame>,
    times: u32,
}

impl Habit {
    /// The decision for these changes, if there is no doubt about it.
    pub(super) fn recall(&self, changed: impl Iterator<Item = u32>) -> Option<&Arc<Frame>> {
        (self.times >= OFTEN && changed.eq(self.changed.iter().copied())).then_some(&self.frame)
    }

    /// Whether this is the frame of [`Habit::recall`].
    pub(super) fn is(&self, frame: &Arc<Frame>) -> bool {
        self.times >= OFTEN && Arc::ptr_eq(&self.frame, frame)
    }

    /// After a frame was submitted.
    pub(super) fn next(before: Option<Habit>, changed: Vec<u32>, frame: &Arc<Frame>) -> Habit {
        let same = before.filter(|habit| habit.changed == changed && habit.frame == *frame);
        let times = same.map_or(1, |habit| habit.times.saturating_add(1));
        Habit { changed, frame: Arc::clone(frame), times }
    }
}
