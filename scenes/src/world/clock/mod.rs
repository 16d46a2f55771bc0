//! The time of a scene: everything that moves by itself is a function of it.
//!
//! Guarantees: setting the same time twice changes nothing, and a time set directly gives the same bits as going there in steps.
//! What moves later overrides what moves earlier: the scene's timeline, animations, then controllers, then camera paths.

use bevy_ecs::prelude::{Resource, World};
use luminaire_graph::diagnostic::Diagnostic;

use super::{animation, camera_path, control};
use crate::timeline;

/// Seconds since the scene began. Absent until [`set_time`] is called: a scene is loaded at rest.
#[derive(Resource, Debug, Clone, Copy, PartialEq)]
pub struct Time(pub f64);

/// Moves the world to a time in seconds, which may lie before an earlier one or be negative.
/// Errors: `world::bad-time` if it is no finite number, `world::time-backwards` if it lies behind an event of the scene's timeline
/// that has happened; nothing has changed then. `world::unknown-node` and `world::flat-parent`, one for each event on the way that
/// could not happen, because somebody removed its node or nothing can keep its place; all else has happened, the world stands at the
/// time, and can go on from there.
pub fn set_time(world: &mut World, seconds: f64) -> Result<(), Vec<Diagnostic>> {
    if !seconds.is_finite() {
        return Err(vec![Diagnostic::error("world::bad-time", format!("the time is {seconds}, which is no finite number"))]);
    }
    let failed = timeline::advance(world, seconds, settle).map_err(|refused| vec![refused])?;
    settle(world, seconds);
    if world.get_resource::<Time>() != Some(&Time(seconds)) {
        world.insert_resource(Time(seconds));
    }
    if failed.is_empty() { Ok(()) } else { Err(failed) }
}

/// Places everything that moves by itself.
fn settle(world: &mut World, seconds: f64) {
    animation::animate(world, seconds);
    control::steer(world);
    camera_path::follow(world, seconds);
}

#[cfg(test)]
mod tests;
