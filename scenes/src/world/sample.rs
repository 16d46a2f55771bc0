//! Values between keys (glTF 2.0, appendix C).
//!
//! Guarantees: in 64 bits, found by binary search; before the first key the first value, after the last the last. The result is
//! finite if keys are; rotations have unit length.

use glam::{DQuat, DVec4, Quat, Vec3, Vec4};

use crate::asset::{Channel, Interpolation, Pose, Property};

/// Below this angle (radians) an arc is as good as its chord, and its sine too small to divide by.
const STRAIGHT: f64 = 1e-6;

/// The keys around a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Segment {
    /// The key before, or the first one.
    pub(super) from: usize,
    /// The key after, or the last one. The same as `from` outside of all keys.
    pub(super) to: usize,
    /// 0 at `from`, less than 1 at every time before `to`.
    pub(super) fraction: f64,
    /// Between the two keys, seconds.
    pub(super) length: f64,
}

/// The segment of a time. Keys must not go back in time; of keys at one time the last counts from then on.
pub(super) fn segment<Key>(keys: &[Key], time_of: impl Fn(&Key) -> f64, time: f64) -> Segment {
    let after = keys.partition_point(|key| time_of(key) <= time);
    let from = after.saturating_sub(1);
    match (after.checked_sub(1).and_then(|before| keys.get(before)), keys.get(after)) {
        (Some(before), Some(next)) => {
            let length = time_of(next) - time_of(before);
            Segment { from, to: after, fraction: (time - time_of(before)) / length, length }
        }
        _ => Segment { from, to: from, fraction: 0.0, length: 0.0 },
    }
}

/// Sets the channel's property of a pose to its value at a time in seconds.
pub(super) fn apply(channel: &Channel, time: f64, pose: &mut Pose) {
    let Some(value) = sample(channel, time) else { return };
    match channel.property {
        Property::Translation => pose.translation = single(value),
        Property::Rotation => pose.rotation = unit(value),
        Property::Scale => pose.scale = single(value),
    }
}

/// The value of a channel; `None` if it has too few values, which a checked one has not.
fn sample(channel: &Channel, time: f64) -> Option<DVec4> {
    let Segment { from, to, fraction, length } = segment(&channel.times, |time| f64::from(*time), time);
    let value = |index: usize| channel.values.get(index).copied().map(Vec4::as_dvec4);
    Some(match channel.interpolation {
        Interpolation::Step => value(from)?,
        Interpolation::Linear => {
            let (a, b) = (value(from)?, value(to)?);
            if channel.property == Property::Rotation { slerp(a, b, fraction) } else { a.lerp(b, fraction) }
        }
        Interpolation::CubicSpline => {
            let (a, b) = (value(3 * from + 1)?, value(3 * to + 1)?);
            hermite(a, value(3 * from + 2)? * length, b, value(3 * to)? * length, fraction)
        }
    })
}

/// The cubic from `a` to `b` with these derivatives at its ends, at a fraction of 0 to 1.
pub(super) fn hermite(a: DVec4, from_a: DVec4, b: DVec4, to_b: DVec4, fraction: f64) -> DVec4 {
    let (t, rest) = (fraction, 1.0 - fraction);
    a * (rest * rest * (1.0 + 2.0 * t)) + from_a * (t * rest * rest) + b * (t * t * (1.0 + 2.0 * rest)) - to_b * (t * t * rest)
}

/// The point at a fraction of the shorter arc between two rotations of unit length (Shoemake 1985, "Animating Rotation with
/// Quaternion Curves").
pub(super) fn slerp(a: DVec4, b: DVec4, fraction: f64) -> DVec4 {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    // Exact for small angles, where the arc cosine of the dot product is not.
    let angle = 2.0 * (b - a).length().atan2((b + a).length());
    if angle < STRAIGHT {
        return a.lerp(b, fraction);
    }
    (a * ((1.0 - fraction) * angle).sin() + b * (fraction * angle).sin()) / angle.sin()
}

/// In 32 bits, and finite.
fn single(value: DVec4) -> Vec3 {
    let limit = f64::from(f32::MAX);
    value.clamp(DVec4::splat(-limit), DVec4::splat(limit)).as_vec4().truncate()
}

/// A rotation; none where the four components cancel out.
pub(super) fn unit(value: DVec4) -> Quat {
    value.try_normalize().map_or(Quat::IDENTITY, |value| DQuat::from_vec4(value).as_quat())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_1_SQRT_2;

    use super::*;

    fn channel(property: Property, interpolation: Interpolation, times: &[f32], values: &[Vec4]) -> Channel {
        Channel { node: 0, property, interpolation, times: times.into(), values: values.into() }
    }

    fn at(channel: &Channel, time: f64) -> Pose {
        let mut pose = Pose::default();
        apply(channel, time, &mut pose);
        pose
    }

    /// About +Y.
    fn turn(degrees: f64) -> Vec4 {
        Vec4::from(DQuat::from_rotation_y(degrees.to_radians()).as_quat())
    }

    #[test]
    fn steps_hold_and_ends_clamp() {
        let steps = channel(Property::Scale, Interpolation::Step, &[1.0, 2.0, 4.0], &[Vec4::X, Vec4::Y, Vec4::Z]);
        for (time, expected) in
            [(-5.0, Vec3::X), (1.0, Vec3::X), (1.999, Vec3::X), (2.0, Vec3::Y), (3.9, Vec3::Y), (4.0, Vec3::Z), (9.0, Vec3::Z)]
        {
            assert_eq!(at(&steps, time).scale, expected, "at {time}");
        }
        assert_eq!(at(&steps, f64::NAN).scale, Vec3::X);
    }

    #[test]
    fn lines_are_straight_and_two_keys_at_one_time_jump() {
        let [a, b, c] = [Vec4::ZERO, Vec4::new(2.0, -4.0, 8.0, 0.0), Vec4::ONE];
        let line = channel(Property::Translation, Interpolation::Linear, &[1.0, 3.0, 3.0, 4.0], &[a, b, c, c]);
        assert_eq!(at(&line, 1.5).translation, Vec3::new(0.5, -1.0, 2.0));
        assert_eq!([0.0, 3.0, 3.5, 8.0].map(|time| at(&line, time).translation), [Vec3::ZERO, Vec3::ONE, Vec3::ONE, Vec3::ONE]);
        let nearly = at(&line, 3.0 - 1e-9).translation;
        assert!((nearly - b.truncate()).length() < 1e-6, "{nearly}");
    }

    #[test]
    fn rotations_take_the_shorter_arc_at_constant_speed() {
        // From 10 to 90 degrees; the far end is written the long way round.
        let arc = channel(Property::Rotation, Interpolation::Linear, &[0.0, 4.0], &[turn(10.0), -turn(90.0)]);
        for (time, degrees) in [(0.0, 10.0_f64), (1.0, 30.0), (2.0, 50.0), (3.0, 70.0), (4.0, 90.0)] {
            let rotated = at(&arc, time).rotation * Vec3::X;
            let expected = Vec3::new(degrees.to_radians().cos() as f32, 0.0, -degrees.to_radians().sin() as f32);
            assert!((rotated - expected).length() < 1e-6, "at {time}: {rotated}, not {expected}");
        }
        let still = channel(Property::Rotation, Interpolation::Linear, &[0.0, 1.0], &[turn(30.0), turn(30.0)]);
        assert!((at(&still, 0.5).rotation * Vec3::Z).abs_diff_eq(Vec3::new(0.5, 0.0, 0.75_f32.sqrt()), 1e-6));
    }

    #[test]
    fn splines_follow_their_cubic_whatever_their_interval_is() {
        // 5 + x - x^3 / 4 between 2 and 6: values and derivatives (1 - 3 x^2 / 4) at both ends make it exact.
        let cubic = |x: f32| 5.0 + x - x * x * x / 4.0;
        let slope = |x: f32| 1.0 - 0.75 * x * x;
        let unused = Vec4::splat(1e9);
        let keys = [unused, Vec4::splat(cubic(2.0)), Vec4::splat(slope(2.0)), Vec4::splat(slope(6.0)), Vec4::splat(cubic(6.0)), unused];
        let spline = channel(Property::Translation, Interpolation::CubicSpline, &[2.0, 6.0], &keys);
        for time in [2.0_f32, 2.5, 3.0, 4.75, 6.0] {
            let found = at(&spline, f64::from(time)).translation;
            assert!((found - Vec3::splat(cubic(time))).length() < 1e-5, "at {time}: {found}, not {}", cubic(time));
        }
        assert_eq!(at(&spline, 0.0).translation, Vec3::splat(cubic(2.0)));
        assert_eq!(at(&spline, 7.0).translation, Vec3::splat(cubic(6.0)));
    }

    #[test]
    fn splines_of_rotations_are_normalised() {
        // Without tangents the middle is half of the sum: (0, 0, 0, 1) and a turn of 90 degrees about X give one of 45.
        let quarter = Vec4::new(FRAC_1_SQRT_2 as f32, 0.0, 0.0, FRAC_1_SQRT_2 as f32);
        let keys = [Vec4::ZERO, Vec4::W, Vec4::ZERO, Vec4::ZERO, quarter, Vec4::ZERO];
        let spline = channel(Property::Rotation, Interpolation::CubicSpline, &[0.0, 1.0], &keys);
        let middle = at(&spline, 0.5).rotation;
        assert!(middle.abs_diff_eq(Quat::from_rotation_x(45_f32.to_radians()), 1e-6), "{middle}");
        let cancelling = [Vec4::ZERO, Vec4::W, Vec4::ZERO, Vec4::ZERO, -Vec4::W, Vec4::ZERO];
        let spline = channel(Property::Rotation, Interpolation::CubicSpline, &[0.0, 1.0], &cancelling);
        assert_eq!(at(&spline, 0.5).rotation, Quat::IDENTITY);
    }
}
