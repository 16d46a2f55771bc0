//! How one value goes from what it was to what it shall be: closed form in time, so that no step on the way counts.

use glam::{Quat, Vec3, Vec4};

use crate::scene_file::rotation_of;

/// How a change goes on between its beginning and its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ease {
    /// Evenly.
    Linear,
    /// `3t^2 - 2t^3`.
    Smooth,
    /// `t^2`.
    In,
    /// `1 - (1 - t)^2`.
    Out,
    /// 0 before the end.
    Hold,
}

impl Ease {
    /// From 0..1 to 0..1, with 0 to 0 and 1 to 1.
    pub(crate) fn at(self, t: f64) -> f64 {
        match self {
            Ease::Linear => t,
            Ease::Smooth => t * t * (3.0 - 2.0 * t),
            Ease::In => t * t,
            Ease::Out => t * (2.0 - t),
            Ease::Hold => f64::from(t >= 1.0),
        }
    }
}

/// Where a value goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Goal {
    /// To this value, component by component.
    Value(Vec4),
    /// To this rotation (a quaternion), by the shortest way.
    Rotation(Vec4),
    /// By these angles about fixed x, y and z, radians.
    Turn(Vec3),
}

/// A change that has begun.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    /// Seconds.
    pub(super) start: f64,
    /// Seconds.
    pub(super) during: f64,
    pub(super) ease: Ease,
    pub(super) from: Vec4,
    pub(super) goal: Goal,
}

impl Segment {
    /// What stays as it is.
    pub(super) fn constant(start: f64, value: Vec4) -> Segment {
        Segment { start, during: 0.0, ease: Ease::Linear, from: value, goal: Goal::Value(value) }
    }

    /// Whether the change is over.
    pub(super) fn has_ended(&self, now: f64) -> bool {
        now >= self.start + self.during
    }

    /// The value at a time, which is not before the start.
    pub(super) fn at(&self, now: f64) -> Vec4 {
        let ended = self.has_ended(now);
        let t = if ended { 1.0 } else { self.ease.at(((now - self.start) / self.during).clamp(0.0, 1.0)) as f32 };
        match self.goal {
            Goal::Value(to) | Goal::Rotation(to) if ended => to,
            Goal::Value(to) => self.from + (to - self.from) * t,
            Goal::Rotation(to) => Quat::from_vec4(self.from).slerp(Quat::from_vec4(to), t).normalize().into(),
            Goal::Turn(by) => (rotation_of(by * t) * Quat::from_vec4(self.from)).normalize().into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eases_begin_at_0_and_end_at_1_and_never_turn_back() {
        for ease in [Ease::Linear, Ease::Smooth, Ease::In, Ease::Out, Ease::Hold] {
            assert_eq!((ease.at(0.0), ease.at(1.0)), (0.0, 1.0), "{ease:?}");
            for step in 0..100 {
                let t = f64::from(step) / 100.0;
                assert!(ease.at(t) <= ease.at(t + 0.01) + 1e-12, "{ease:?}");
            }
        }
        assert_eq!((Ease::Smooth.at(0.5), Ease::In.at(0.5), Ease::Out.at(0.5), Ease::Hold.at(0.99)), (0.5, 0.25, 0.75, 0.0));
    }

    #[test]
    fn values_and_turns_are_as_written() {
        let segment = |from, goal| Segment { start: 2.0, during: 4.0, ease: Ease::Linear, from, goal };
        let value = segment(Vec4::ZERO, Goal::Value(Vec4::new(4.0, 0.0, 8.0, 0.0)));
        assert_eq!(value.at(3.0), Vec4::new(1.0, 0.0, 2.0, 0.0));
        assert_eq!((value.at(2.0), value.at(9.0)), (Vec4::ZERO, Vec4::new(4.0, 0.0, 8.0, 0.0)));
        // A whole turn is half a turn after half of the time; a rotation to the same orientation is none at all.
        let turn = segment(Quat::IDENTITY.into(), Goal::Turn(Vec3::new(0.0, std::f32::consts::TAU, 0.0)));
        let half = Quat::from_vec4(turn.at(4.0)) * Vec3::X;
        assert!((half + Vec3::X).length() < 1e-6, "{half}");
        let there = Quat::from_rotation_y(1.0);
        let rotation = segment(Quat::IDENTITY.into(), Goal::Rotation(there.into()));
        assert!(Quat::from_vec4(rotation.at(4.0)).angle_between(Quat::from_rotation_y(0.5)) < 1e-3);
        assert_eq!(rotation.at(6.0), Vec4::from(there));
    }
}
