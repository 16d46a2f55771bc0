//! Controllers: entities that are steered by commands.
//!
//! Commands know no input device: whoever reads keys, a mouse or a script turns them into commands and hands them over with the
//! time for which they were held. Guarantees: the same commands and durations give the same bits; a controller's place is its own
//! and not read back from a transform, so that nothing drifts; it stays finite. Controllers work in the space of the entity's
//! parent.

mod fly;
mod orbit;

use bevy_ecs::prelude::{Entity, World};
use glam::{Affine3A, DMat3, DVec3};
use luminaire_graph::diagnostic::Diagnostic;

pub use fly::Fly;
pub use orbit::Orbit;

use super::rigid_axes;
use super::transform::place;

/// How far up and down controllers look, radians: 89 degrees.
const STEEPEST: f64 = 89.0 / 180.0 * std::f64::consts::PI;
/// Farthest coordinate, metres.
const FARTHEST: f64 = 1e9;

/// A direction to move in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// To the right of the view.
    Right,
    /// Along +Y of the parent's space, wherever the view looks.
    Up,
    /// Along the view.
    Forward,
}

/// What a controller is told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command {
    /// Go in a direction for the duration, at this part of the controller's speed; negative goes the other way. An [`Orbit`]
    /// takes its target along, at its distance in a second.
    Move(Axis, f64),
    /// Turn for the duration, at these parts of the controller's turn speed: to the left, and up.
    Turn {
        /// To the left.
        yaw: f64,
        /// Up.
        pitch: f64,
    },
    /// Turn by these angles at once, radians.
    Look {
        /// To the left.
        yaw: f64,
        /// Up.
        pitch: f64,
    },
    /// Steps of a wheel, at once: an [`Orbit`] comes a tenth of its distance nearer with each, a [`Fly`] gets a tenth faster.
    Zoom(f64),
    /// Shift by metres in the plane of the image, at once.
    Pan {
        /// To the right.
        right: f64,
        /// To the top of the image.
        up: f64,
    },
    /// Go back to where the controller began.
    Reset,
}

impl Command {
    fn is_finite(self) -> bool {
        match self {
            Command::Move(_, amount) | Command::Zoom(amount) => amount.is_finite(),
            Command::Turn { yaw: a, pitch: b } | Command::Look { yaw: a, pitch: b } | Command::Pan { right: a, up: b } => {
                a.is_finite() && b.is_finite()
            }
            Command::Reset => true,
        }
    }
}

/// Gives commands to the entity's [`Fly`] or [`Orbit`], one after the other; those that last do so for `seconds`. The entity's
/// transform follows at once.
/// Errors: `world::no-controller`; `world::bad-duration` and `world::bad-command` for numbers that are not finite, and a negative
/// duration. Nothing has changed then.
pub fn control(world: &mut World, entity: Entity, commands: &[Command], seconds: f64) -> Result<(), Vec<Diagnostic>> {
    let mut problems = Vec::new();
    if world.get::<Fly>(entity).is_none() && world.get::<Orbit>(entity).is_none() {
        problems.push(
            Diagnostic::error("world::no-controller", format!("entity {entity} has no controller")).hint("insert a `Fly` or an `Orbit`"),
        );
    }
    if !(seconds.is_finite() && seconds >= 0.0) {
        problems
            .push(Diagnostic::error("world::bad-duration", format!("commands last {seconds} s, which is no finite number of at least 0")));
    }
    for command in commands.iter().filter(|command| !command.is_finite()) {
        problems.push(Diagnostic::error("world::bad-command", format!("{command:?} holds a number that is not finite")));
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    if let Some(mut fly) = world.get_mut::<Fly>(entity) {
        commands.iter().for_each(|command| fly.obey(*command, seconds));
    }
    if let Some(mut orbit) = world.get_mut::<Orbit>(entity) {
        commands.iter().for_each(|command| orbit.obey(*command, seconds));
    }
    steer(world);
    Ok(())
}

/// Places everything that has a controller.
pub(super) fn steer(world: &mut World) {
    let fly = world.query::<(Entity, &Fly)>().iter(world).map(|(entity, fly)| (entity, fly.local())).collect::<Vec<_>>();
    let orbit = world.query::<(Entity, &Orbit)>().iter(world).map(|(entity, orbit)| (entity, orbit.local())).collect::<Vec<_>>();
    for (entity, local) in fly.into_iter().chain(orbit) {
        place(world, entity, local);
    }
}

/// A level direction of view.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct View {
    /// Radians to the left of -Z.
    yaw: f64,
    /// Radians above the horizon.
    pitch: f64,
}

impl View {
    /// The view of a transform, levelled.
    fn of(transform: Affine3A) -> View {
        let (_, _, back) = rigid_axes(transform.matrix3);
        View::along(-back)
    }

    /// The view along a direction; along -Z if it has no length.
    fn along(forward: DVec3) -> View {
        let forward = forward.try_normalize().unwrap_or(DVec3::NEG_Z);
        let flat = DVec3::new(forward.x, 0.0, forward.z).length();
        View { yaw: (-forward.x).atan2(-forward.z), pitch: forward.y.atan2(flat).clamp(-STEEPEST, STEEPEST) }
    }

    fn turned(self, yaw: f64, pitch: f64) -> View {
        let yaw = (self.yaw + bounded(yaw)).rem_euclid(std::f64::consts::TAU);
        View { yaw, pitch: (self.pitch + bounded(pitch)).clamp(-STEEPEST, STEEPEST) }
    }

    /// Columns: right, up and back.
    fn axes(self) -> DMat3 {
        DMat3::from_rotation_y(self.yaw) * DMat3::from_rotation_x(self.pitch)
    }

    /// What a step along an axis is.
    fn step(self, axis: Axis, length: f64) -> DVec3 {
        let axes = self.axes();
        let direction = match axis {
            Axis::Right => axes.x_axis,
            Axis::Up => DVec3::Y,
            Axis::Forward => -axes.z_axis,
        };
        direction * bounded(length)
    }

    fn local(self, position: DVec3) -> Affine3A {
        Affine3A::from_mat3_translation(self.axes().as_mat3(), position.as_vec3())
    }
}

/// A length or an angle that can be added to a finite one. What is no number, since a speed was set to none, is 0.
fn bounded(length: f64) -> f64 {
    if length.is_nan() { 0.0 } else { length.clamp(-FARTHEST, FARTHEST) }
}

/// A place that can be moved on.
fn near(position: DVec3) -> DVec3 {
    position.clamp(DVec3::splat(-FARTHEST), DVec3::splat(FARTHEST))
}

#[cfg(test)]
mod tests;
