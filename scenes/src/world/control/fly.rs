//! Flying: a camera that goes where it looks.

use bevy_ecs::prelude::Component;
use glam::{Affine3A, DVec3};

use super::{Command, View, bounded, near};

/// Slowest and fastest, metres per second.
const SPEEDS: (f64, f64) = (0.1, 30.0);
/// How much a step of the wheel adds to the speed.
const FASTER: f64 = 1.1;

/// Goes along its view and turns about itself; upright, and at most 89 degrees up or down.
#[derive(Component, Debug, Clone, Copy, PartialEq)]
#[require(crate::world::Transform)]
pub struct Fly {
    /// Metres per second, from 0.1 to 30; 3 at first. [`Command::Reset`] leaves it.
    pub speed: f64,
    /// Radians per second; 1 at first.
    pub turn: f64,
    position: DVec3,
    view: View,
    home: (DVec3, View),
}

impl Fly {
    /// Begins where this transform is and looks, levelled. Scale has no meaning.
    pub fn at(transform: Affine3A) -> Fly {
        let position = transform.translation.as_dvec3();
        let position = if position.is_finite() { near(position) } else { DVec3::ZERO };
        let view = View::of(transform);
        Fly { speed: 3.0, turn: 1.0, position, view, home: (position, view) }
    }

    pub(super) fn obey(&mut self, command: Command, seconds: f64) {
        let by = |rate: f64, amount: f64| rate * amount * seconds;
        match command {
            Command::Move(axis, amount) => self.go(self.view.step(axis, by(self.speed, amount))),
            Command::Turn { yaw, pitch } => self.view = self.view.turned(by(self.turn, yaw), by(self.turn, pitch)),
            Command::Look { yaw, pitch } => self.view = self.view.turned(yaw, pitch),
            Command::Zoom(steps) => self.speed = bounded(self.speed * FASTER.powf(steps)).clamp(SPEEDS.0, SPEEDS.1),
            Command::Pan { right, up } => {
                let axes = self.view.axes();
                self.go(axes.x_axis * bounded(right) + axes.y_axis * bounded(up));
            }
            Command::Reset => (self.position, self.view) = self.home,
        }
    }

    fn go(&mut self, step: DVec3) {
        self.position = near(self.position + step);
    }

    pub(super) fn local(&self) -> Affine3A {
        self.view.local(self.position)
    }
}
