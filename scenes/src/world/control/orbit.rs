//! Orbiting: a camera that goes around what it looks at.

use bevy_ecs::prelude::Component;
use glam::{Affine3A, DVec3};

use super::{Command, FARTHEST, View, bounded, near};

/// What a step of the wheel leaves of the distance.
const NEARER: f64 = 0.9;

/// Looks at a target from a distance; upright, and at most 89 degrees from below or above. Its commands turn the view: a turn to
/// the left takes the camera to the right around its target.
#[derive(Component, Debug, Clone, Copy, PartialEq)]
#[require(crate::world::Transform)]
pub struct Orbit {
    /// Radians per second; 1 at first.
    pub turn: f64,
    /// Smallest distance to the target, metres; 0.01 at first.
    pub nearest: f64,
    /// Largest distance to the target, metres; 10,000 at first.
    pub farthest: f64,
    target: DVec3,
    distance: f64,
    view: View,
    home: (DVec3, f64, View),
}

impl Orbit {
    /// Begins where this transform is and looks at `target`, whatever the transform looks at; a metre away from it along the
    /// transform's view if that is the same place.
    pub fn around(target: DVec3, transform: Affine3A) -> Orbit {
        let target = if target.is_finite() { near(target) } else { DVec3::ZERO };
        let forward = target - transform.translation.as_dvec3();
        let distance = forward.length();
        let (view, distance) = if distance > 0.0 && distance.is_finite() {
            (View::along(forward), distance.min(FARTHEST))
        } else {
            (View::of(transform), 1.0)
        };
        Orbit { turn: 1.0, nearest: 0.01, farthest: 1e4, target, distance, view, home: (target, distance, view) }
    }

    /// What it looks at.
    pub fn target(&self) -> DVec3 {
        self.target
    }

    /// From the target, metres.
    pub fn distance(&self) -> f64 {
        self.distance
    }

    pub(super) fn obey(&mut self, command: Command, seconds: f64) {
        let by = |rate: f64, amount: f64| rate * amount * seconds;
        match command {
            Command::Move(axis, amount) => self.go(self.view.step(axis, by(self.distance, amount))),
            Command::Turn { yaw, pitch } => self.view = self.view.turned(by(self.turn, yaw), by(self.turn, pitch)),
            Command::Look { yaw, pitch } => self.view = self.view.turned(yaw, pitch),
            Command::Zoom(steps) => {
                // One after the other, since limits that exclude each other must not stop the program.
                let wanted = (self.distance * NEARER.powf(steps)).min(self.farthest).max(self.nearest).min(FARTHEST);
                self.distance = if wanted > 0.0 { wanted } else { self.distance };
            }
            Command::Pan { right, up } => {
                let axes = self.view.axes();
                self.go(axes.x_axis * bounded(right) + axes.y_axis * bounded(up));
            }
            Command::Reset => (self.target, self.distance, self.view) = self.home,
        }
    }

    fn go(&mut self, step: DVec3) {
        self.target = near(self.target + step);
    }

    pub(super) fn local(&self) -> Affine3A {
        self.view.local(self.target + self.view.axes().z_axis * self.distance)
    }
}
