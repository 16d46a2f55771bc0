//! Boxes that stand at an angle: what volumes and probes fill.
//!
//! Guarantees: exact but for rounding in 64 bits, whatever turned, stretched or sheared the box, and if it is as flat as a sheet, a line
//! or a point.

use glam::{Affine3A, DVec3, Vec3};

use crate::world::Aabb;

/// A box around a middle; its edges need not be at right angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientedBox {
    /// World space, metres.
    pub center: DVec3,
    /// From the middle to the middles of three faces, metres.
    pub halves: [DVec3; 3],
}

impl OrientedBox {
    /// The box of such edges around the origin of an entity, along its axes. `None` if that is not finite.
    pub fn new(size: Vec3, place: Affine3A) -> Option<OrientedBox> {
        let columns = [place.matrix3.x_axis, place.matrix3.y_axis, place.matrix3.z_axis].map(|column| Vec3::from(column).as_dvec3());
        let half = size.as_dvec3() * 0.5;
        let found = OrientedBox {
            center: Vec3::from(place.translation).as_dvec3(),
            halves: [columns[0] * half.x, columns[1] * half.y, columns[2] * half.z],
        };
        let Aabb { min, max } = found.bounds();
        (min.is_finite() && max.is_finite()).then_some(found)
    }

    /// The box of axis-aligned bounds.
    pub fn of_bounds(bounds: Aabb) -> OrientedBox {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let half = (max - min) * 0.5;
        OrientedBox { center: (min + max) * 0.5, halves: [DVec3::X * half.x, DVec3::Y * half.y, DVec3::Z * half.z] }
    }

    /// The smallest axis-aligned box around it whose corners are single precision.
    pub fn bounds(&self) -> Aabb {
        let reach = self.halves.iter().fold(DVec3::ZERO, |reach, half| reach + half.abs());
        let down = |value: f64| if f64::from(value as f32) > value { (value as f32).next_down() } else { value as f32 };
        let (min, max) = (self.center - reach, (self.center + reach) * -1.0);
        Aabb { min: Vec3::from_array(min.to_array().map(down)), max: -Vec3::from_array(max.to_array().map(down)) }
    }

    /// Whether they have a point in common: no plane stands between them (separating axes, Gottschalk, Lin and Manocha 1996,
    /// "OBBTree", there for right angles).
    pub fn meets(&self, other: &OrientedBox) -> bool {
        let between = other.center - self.center;
        let parts = |axis: DVec3, of: &OrientedBox| of.halves.iter().map(|half| half.dot(axis).abs()).sum::<f64>();
        // What touches meets, rounding or not.
        let size = between.abs().max_element() + [self, other].iter().flat_map(|of| of.halves).map(|half| half.length()).sum::<f64>();
        let apart = |axis: DVec3| between.dot(axis).abs() > parts(axis, self) + parts(axis, other) + 1e-12 * size;
        let axes = [self, other].into_iter().flat_map(OrientedBox::normals);
        let crossed = self.halves.iter().flat_map(|a| other.halves.iter().map(|b| a.cross(*b)));
        !axes.chain(crossed).filter_map(DVec3::try_normalize).any(apart)
    }

    /// Across its faces. Where it is flat, some are zero.
    fn normals(&self) -> [DVec3; 3] {
        let [x, y, z] = self.halves;
        [y.cross(z), z.cross(x), x.cross(y)]
    }

    /// Whether all of another one lies in it.
    pub fn encloses(&self, other: &OrientedBox) -> bool {
        // Convex, so that the corners tell.
        (0..8).all(|corner| {
            let signs = [1, 2, 4].map(|bit| if corner & bit == 0 { -1.0 } else { 1.0 });
            let point = other.halves.iter().zip(signs).fold(other.center, |point, (half, sign)| point + *half * sign);
            let size = [self.center, point].map(|of| of.abs().max_element()).into_iter().fold(0.0, f64::max);
            self.distance_squared(point) <= (1e-12 * size).powi(2)
        })
    }

    /// How far a point is from the box, squared; 0 inside.
    pub fn distance_squared(&self, point: DVec3) -> f64 {
        let offset = point - self.center;
        if parts(self.halves, offset).iter().all(|part| part.abs() <= 1.0) {
            return 0.0;
        }
        // Outside, the nearest point lies within a face or an edge, where it is the foot of a perpendicular, or is a corner. All 26 are
        // tried; what falls beside its face is put back, which only makes it farther.
        let mut least = f64::INFINITY;
        for part in 1..27 {
            let sides = [part % 3, part / 3 % 3, part / 9].map(|side| [None, Some(-1.0), Some(1.0)][side]);
            let mut free = self.halves.iter().zip(sides).filter(|(_, side)| side.is_none()).map(|(half, _)| *half);
            let start = self.halves.iter().zip(sides).fold(DVec3::ZERO, |sum, (half, side)| sum + *half * side.unwrap_or(0.0));
            let foot = foot(free.next(), free.next(), offset - start);
            least = least.min((offset - start).distance_squared(foot));
        }
        least
    }
}

/// What share of each vector makes up a point (Cramer's rule). Not finite where the vectors lie in a plane.
fn parts([a, b, c]: [DVec3; 3], point: DVec3) -> [f64; 3] {
    let volume = a.dot(b.cross(c));
    [point.dot(b.cross(c)), a.dot(point.cross(c)), a.dot(b.cross(point))].map(|part| part / volume)
}

/// The point nearest to another one among the sums of these vectors, each at most once forwards or backwards; some such sum if it is
/// not within them.
fn foot(a: Option<DVec3>, b: Option<DVec3>, point: DVec3) -> DVec3 {
    // What has no extent adds nothing: the edges beside it have the nearest point.
    let once = |part: f64| if part.is_finite() { part.clamp(-1.0, 1.0) } else { 0.0 };
    match (a, b) {
        (Some(a), Some(b)) => {
            let normal = a.cross(b);
            let [of_a, of_b, _] = parts([a, b, normal], point);
            a * once(of_a) + b * once(of_b)
        }
        (Some(a), None) | (None, Some(a)) => a * once(point.dot(a) / a.length_squared()),
        (None, None) => DVec3::ZERO,
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use proptest::prelude::*;

    use super::*;

    fn placed(size: [f32; 3], stretch: [f32; 3], angles: [f32; 3], at: [f32; 3]) -> OrientedBox {
        // Stretched after it was turned: its edges are at no right angles.
        let turned = Affine3A::from_rotation_x(angles[0]) * Affine3A::from_rotation_y(angles[1]) * Affine3A::from_rotation_z(angles[2]);
        let place = Affine3A::from_translation(Vec3::from(at)) * Affine3A::from_scale(Vec3::from(stretch)) * turned;
        OrientedBox::new(Vec3::from(size), place).unwrap()
    }

    /// The nearest point by coordinate descent, which can't miss in a convex box, but may be slow.
    fn distance_by_steps(of: &OrientedBox, point: DVec3) -> f64 {
        let mut parts = [0.0_f64; 3];
        for _ in 0..20_000 {
            for axis in 0..3 {
                let rest = (0..3).filter(|other| *other != axis).fold(of.center, |sum, other| sum + of.halves[other] * parts[other]);
                let square = of.halves[axis].length_squared();
                parts[axis] = if square > 0.0 { ((point - rest).dot(of.halves[axis]) / square).clamp(-1.0, 1.0) } else { 0.0 };
            }
        }
        let nearest = (0..3).fold(of.center, |sum, axis| sum + of.halves[axis] * parts[axis]);
        nearest.distance(point)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 128, ..ProptestConfig::default() })]

        #[test]
        fn distances_are_those_of_a_slow_search(
            size in prop::array::uniform3(prop_oneof![1 => Just(0.0_f32), 4 => 0.5_f32..4.0]), stretch in prop::array::uniform3(0.5_f32..2.0),
            angles in prop::array::uniform3(-3.0_f32..3.0), point in prop::array::uniform3(-6.0_f64..6.0),
        ) {
            let found = placed(size, stretch, angles, [0.5, -0.25, 1.0]);
            let point = DVec3::from_array(point);
            let (exact, slow) = (found.distance_squared(point).sqrt(), distance_by_steps(&found, point));
            prop_assert!((exact - slow).abs() < 1e-6, "{exact} and not {slow}: {found:?}");
            prop_assert_eq!(exact == 0.0, found.encloses(&OrientedBox { center: point, halves: [DVec3::ZERO; 3] }));
        }

        /// Two boxes meet if one of them comes to the points of the other: alternating projections find the way.
        #[test]
        fn boxes_meet_where_their_points_do(
            size in prop::array::uniform3(0.5_f32..3.0), stretch in prop::array::uniform3(0.5_f32..2.0),
            angles in prop::array::uniform3(-3.0_f32..3.0), at in prop::array::uniform3(-4.0_f32..4.0), other in prop::array::uniform3(0.2_f32..3.0),
            inside in prop::array::uniform3(-1.0_f64..1.0), outside in prop::array::uniform3(-1.0_f64..1.0),
        ) {
            let (a, b) = (placed(size, stretch, angles, at), placed(other, [1.0; 3], [0.0; 3], [0.0; 3]));
            let point = |of: &OrientedBox, parts: [f64; 3]| (0..3).fold(of.center, |sum, axis| sum + of.halves[axis] * parts[axis]);
            prop_assert_eq!(a.meets(&b), b.meets(&a));
            for (one, two) in [(&a, &b), (&b, &a)] {
                let shared = two.distance_squared(point(one, inside)) == 0.0;
                prop_assert!(!shared || one.meets(two));
            }
            // Where they do not meet, nothing lies in both, and a plane of the search stands between them.
            if !a.meets(&b) {
                prop_assert!(a.distance_squared(point(&b, outside)) > 0.0 && !a.encloses(&b) && !b.encloses(&a));
            }
            let around = OrientedBox::of_bounds(a.bounds());
            prop_assert!(around.encloses(&a) && around.meets(&a) && a.meets(&around));
        }
    }

    #[test]
    fn edges_that_cross_in_the_air_do_not_meet() {
        // Two beams at right angles and at 45 degrees, whose bounds overlap: only an axis across both edges tells them apart.
        let beam =
            |turn: Quat, at: Vec3| OrientedBox::new(Vec3::new(10.0, 1.0, 1.0), Affine3A::from_rotation_translation(turn, at)).unwrap();
        let along_x = beam(Quat::from_rotation_x(0.7), Vec3::ZERO);
        let quarter = std::f32::consts::FRAC_PI_2;
        let above = |height: f32| beam(Quat::from_rotation_y(quarter) * Quat::from_rotation_x(0.3), Vec3::Y * height);
        let reach = |turn: f64| 0.5 * (turn.sin() + turn.cos());
        let touch = (reach(f64::from(0.7_f32)) + reach(f64::from(0.3_f32))) as f32;
        assert!(along_x.meets(&above(touch - 1e-3)) && !along_x.meets(&above(touch + 1e-3)));
    }

    #[test]
    fn a_sheet_a_line_and_a_point_are_boxes() {
        let cube = OrientedBox::new(Vec3::splat(2.0), Affine3A::IDENTITY).unwrap();
        for size in [Vec3::new(4.0, 0.0, 4.0), Vec3::new(4.0, 0.0, 0.0), Vec3::ZERO] {
            let at = |y: f32| OrientedBox::new(size, Affine3A::from_translation(Vec3::Y * y)).unwrap();
            assert!(cube.meets(&at(0.5)) && cube.meets(&at(1.0)) && !cube.meets(&at(1.25)), "{size}");
            assert_eq!(at(3.0).distance_squared(DVec3::ZERO), 9.0);
            assert_eq!(cube.encloses(&at(0.5)), size == Vec3::ZERO);
        }
        assert_eq!(OrientedBox::new(Vec3::ONE, Affine3A::from_scale(Vec3::splat(f32::NAN))), None);
        assert_eq!(OrientedBox::new(Vec3::splat(f32::MAX), Affine3A::from_scale(Vec3::splat(1e3))), None);
    }
}
