//! What changes in a scene while time goes on: a light moves, the sun sets, a wall is blasted away.
//!
//! Guarantees: names are resolved and numbers in range, so that only nodes which somebody else removed can be missing. The state
//! at a time is a function of that time: whoever goes there in steps and whoever jumps there get the same bits, since values are
//! closed forms between events, and time stops at each event on the way. All meshes, materials and images are in the world from the
//! beginning, and slots are stable, so that a spawn uploads rows and no geometry.
//! Accepted downside: time can't go back behind an event that has happened; the scene has to be loaded again.

mod advance;
mod events;
mod hierarchy;
mod property;
mod segment;

#[cfg(test)]
mod tests;

pub(crate) use advance::advance;
pub(crate) use events::{Action, Event, Field, NodeRef, Property, Timeline};
pub(crate) use segment::{Ease, Goal};
