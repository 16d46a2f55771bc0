//! Checks of single values, which collect their problems and go on with a harmless value.

use std::ops::RangeInclusive;

use glam::{Affine3A, EulerRot, Quat, Vec3};
use luminaire_graph::diagnostic::{Diagnostic, did_you_mean, list_names};
use luminaire_graph::source::Span;
use luminaire_graph::syntax::spanned::Spanned;

use super::document::{Number, Vector};

/// Farthest coordinate and largest size, metres: a scene file with more is a slip.
pub(super) const FAR: f32 = 1e6;
/// Brightest light or emission, in its unit: ten billion is beyond the sun's disc seen from the ground.
pub(super) const BRIGHT: f32 = 1e10;
/// Largest factor of a light's color.
pub(super) const COLORFUL: f32 = 1e3;
/// Latest moment and longest change, seconds: more than a week.
pub(super) const LATE: f64 = 1e6;
/// Problems that go through all names for a hint; what comes later is a consequence, or a text of a program.
const HELPFUL: usize = 20;
/// Smallest size, metres.
pub(super) const SMALL: f32 = 1e-6;

/// What was found so far.
#[derive(Debug, Default)]
pub(super) struct Problems(pub(super) Vec<Diagnostic>);

impl Problems {
    pub(super) fn add(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic);
    }

    /// Adds that a name is unknown, with those that there are; beyond the first few it is the fact alone that counts.
    pub(super) fn add_unknown<'a, Known: Iterator<Item = &'a str>>(
        &mut self,
        problem: Diagnostic,
        what: &str,
        wrong: Option<&str>,
        known: impl Fn() -> Known,
    ) {
        self.0.push(if self.0.len() < HELPFUL {
            let hint = wrong.and_then(|wrong| did_you_mean(wrong, known()));
            problem.note(format!("{what}: {}", list_names(known()))).maybe_hint(hint)
        } else {
            problem
        });
    }

    fn out_of_range(&mut self, what: &str, shown: &str, span: Span, range: &RangeInclusive<f32>) {
        self.add(
            Diagnostic::error("scene::bad-number", format!("{what} is {shown}"))
                .at(span, format!("must lie between {} and {}", range.start(), range.end())),
        );
    }

    /// A number in a range; the default where it is left out.
    pub(super) fn number(&mut self, what: &str, value: Option<&Number>, default: f32, range: RangeInclusive<f32>) -> f32 {
        let Some(number) = value else { return default };
        if range.contains(&number.value) {
            return number.value;
        }
        self.out_of_range(what, &number.value.to_string(), number.span, &range);
        default
    }

    /// Three numbers in a range.
    pub(super) fn vector(&mut self, what: &str, value: Option<&Vector>, default: Vec3, range: RangeInclusive<f32>) -> Vec3 {
        let Some(vector) = value else { return default };
        let (x, y, z) = vector.value;
        if [x, y, z].iter().all(|component| range.contains(component)) {
            return Vec3::new(x, y, z);
        }
        self.out_of_range(what, &format!("({x}, {y}, {z})"), vector.span, &range);
        default
    }

    /// A place in the scene.
    pub(super) fn position(&mut self, what: &str, value: &Vector) -> Vec3 {
        self.vector(what, Some(value), Vec3::ZERO, -FAR..=FAR)
    }

    /// A direction of unit length.
    pub(super) fn direction(&mut self, what: &str, value: &Vector) -> Vec3 {
        let direction = self.vector(what, Some(value), Vec3::NEG_Y, -FAR..=FAR);
        direction.try_normalize().unwrap_or_else(|| {
            self.add(Diagnostic::error("scene::no-direction", format!("{what} has no length")).at(value.span, "points nowhere"));
            Vec3::NEG_Y
        })
    }

    /// A factor or radiance per channel, at most `limit`.
    pub(super) fn color(&mut self, what: &str, value: Option<&Vector>, default: Vec3, limit: f32) -> Vec3 {
        self.vector(what, value, default, 0.0..=limit)
    }

    /// A moment or a span of time; 0 where it is left out.
    pub(super) fn seconds(&mut self, what: &str, value: Option<&Spanned<f64>>) -> f64 {
        let Some(seconds) = value else { return 0.0 };
        if (0.0..=LATE).contains(&seconds.value) {
            return seconds.value;
        }
        let message = format!("{what} is {}", seconds.value);
        self.add(Diagnostic::error("scene::bad-time", message).at(seconds.span, format!("must lie between 0 and {LATE} seconds")));
        0.0
    }

    /// The rotation about fixed x, y and z by degrees.
    pub(super) fn angles(&mut self, what: &str, value: Option<&Vector>) -> Vec3 {
        self.vector(what, value, Vec3::ZERO, -36000.0..=36000.0).map(f32::to_radians)
    }

    /// Scale, then rotation about fixed x, y and z, then translation.
    pub(super) fn placement(
        &mut self,
        of: &str,
        translation: Option<&Vector>,
        rotation: Option<&Vector>,
        scale: Option<&Vector>,
    ) -> Affine3A {
        let translation = self.vector(&format!("`translation` of {of}"), translation, Vec3::ZERO, -FAR..=FAR);
        let rotation = rotation_of(self.angles(&format!("`rotation` of {of}"), rotation));
        let scale = self.vector(&format!("`scale` of {of}"), scale, Vec3::ONE, -FAR..=FAR);
        Affine3A::from_scale_rotation_translation(scale, rotation, translation)
    }
}

/// The rotation about fixed x, then y, then z, by radians.
pub(crate) fn rotation_of(angles: Vec3) -> Quat {
    Quat::from_euler(EulerRot::ZYX, angles.z, angles.y, angles.x)
}

#[cfg(test)]
mod tests {
    use luminaire_graph::syntax::spanned::Spanned;

    use super::*;

    fn spanned<T>(value: T) -> Spanned<T> {
        Spanned { value, span: Span::NOWHERE }
    }

    #[test]
    fn values_out_of_range_are_named() {
        let mut problems = Problems::default();
        assert_eq!(problems.number("`fov` of camera `a`", Some(&spanned(f32::NAN)), 45.0, 1.0..=179.0), 45.0);
        assert_eq!(problems.position("`position`", &spanned((0.0, f32::INFINITY, 0.0))), Vec3::ZERO);
        assert_eq!(problems.direction("`direction`", &spanned((0.0, 0.0, 0.0))), Vec3::NEG_Y);
        let codes: Vec<&str> = problems.0.iter().map(|problem| problem.code).collect();
        assert_eq!(codes, ["scene::bad-number", "scene::bad-number", "scene::no-direction"]);
        assert_eq!(problems.0[0].message, "`fov` of camera `a` is NaN");
    }

    #[test]
    fn rotations_go_about_x_then_y_then_z() {
        let mut problems = Problems::default();
        let placed =
            problems.placement("it", Some(&spanned((1.0, 0.0, 0.0))), Some(&spanned((90.0, 90.0, 0.0))), Some(&spanned((2.0, 1.0, 1.0))));
        // Scaled along x, then x stays under the turn about x, then goes to -z under the turn about y.
        assert!((placed.transform_point3(Vec3::X) - Vec3::new(1.0, 0.0, -2.0)).length() < 1e-6);
        // y goes to z, and that to x.
        assert!((placed.transform_vector3(Vec3::Y) - Vec3::X).length() < 1e-6);
        assert!(problems.0.is_empty());
    }
}
