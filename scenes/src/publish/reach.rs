//! How far a point or spot light reaches.
//!
//! With a range, glTF's window ends it there. Without one its light is pure inverse square, and ends where it falls below the least
//! illuminance that counts. A light that reaches all of the scene has no end at all, so that it is the unbounded light bit for bit.

use glam::{DVec3, Vec3};

use crate::world::Aabb;

/// Metres, all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    /// Beyond this it gives nothing; 0 is no end, or a range that ends it.
    pub(super) end: f64,
    /// Near and far plane of its shadow views. Nothing beyond the far one throws a shadow.
    pub(super) planes: [f64; 2],
}

/// `intensity` is in candela, `least` in lux. `solid` are the bounds of what throws shadows.
pub(super) fn reach(position: DVec3, intensity: Vec3, range: Option<f32>, least: f32, bounds: Option<Aabb>, solid: Option<Aabb>) -> Reach {
    let farthest = |bounds: Option<Aabb>| bounds.map_or(0.0, |bounds| bounds.farthest(position));
    let fades = if least > 0.0 { (f64::from(intensity.max_element()) / f64::from(least)).sqrt() } else { f64::INFINITY };
    let end = if range.is_none() && fades < farthest(bounds) { fades } else { 0.0 };
    // A little stronger or weaker, and the shadow map stays as it is.
    let fading = if end > 0.0 { round_up(end) } else { f64::INFINITY };
    let limit = range.map_or(fading, f64::from);
    let planes = planes(farthest(solid), limit);
    Reach { end, planes }
}

/// Near and far plane of shadow views from whatever point within `radius` of a position, for a light that has no end.
pub(super) fn endless_planes(position: DVec3, radius: f64, solid: Option<Aabb>) -> [f64; 2] {
    planes(solid.map_or(0.0, |bounds| bounds.farthest(position)) + radius, f64::INFINITY)
}

/// Far is the farthest caster or the limit, if that is nearer, and a hundredth more. Near is 1 cm, or a thousandth of far if
/// that is more (so that a depth buffer keeps its precision), and never beyond a tenth of far.
fn planes(farthest: f64, limit: f64) -> [f64; 2] {
    let farthest = if farthest > 1e-4 { round_up(farthest) } else { 1.0 };
    let far = farthest.min(limit).max(1e-4) * 1.01;
    [(far / 1000.0).max(0.01).min(far / 10.0), far]
}

/// Up to the next quarter of an octave, so that what follows from a scene's size seldom changes with it.
pub(super) fn round_up(size: f64) -> f64 {
    ((size.max(1e-6).log2() * 4.0).ceil() / 4.0).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(half: f32) -> Option<Aabb> {
        Some(Aabb { min: Vec3::splat(-half), max: Vec3::splat(half) })
    }

    #[test]
    fn light_ends_where_it_fades_or_never() {
        let at = |candela: f32, range, least| reach(DVec3::ZERO, Vec3::new(0.05, candela, 0.0), range, least, scene(10.0), scene(10.0)).end;
        assert_eq!(at(0.1, None, 0.001), 10.0_f64.min((0.1_f32 as f64 / 0.001_f32 as f64).sqrt()));
        assert_eq!(at(0.31, None, 0.001), 0.0, "sqrt(310) is beyond the farthest corner, sqrt(300)");
        assert_eq!(at(0.1, Some(2.0), 0.001), 0.0, "the window ends it");
        assert_eq!(at(0.1, None, 0.0), 0.0);
    }

    #[test]
    fn planes_are_positive_and_in_order() {
        for (size, range) in [(0.0, None), (1e-6, None), (10.0, Some(2.0)), (1e6, None), (1e6, Some(1e-6))] {
            let [near, far] = reach(DVec3::ZERO, Vec3::ONE, range, 0.0, scene(size), scene(size)).planes;
            assert!(0.0 < near && near < far && far.is_finite(), "{size} {range:?}: {near} {far}");
        }
        let reach = reach(DVec3::ZERO, Vec3::ONE, Some(2.0), 0.001, scene(10.0), scene(10.0));
        assert_eq!(reach.planes[1], 2.02);
    }

    #[test]
    fn a_size_is_rounded_by_less_than_a_fifth() {
        for size in [0.3, 1.0, 7.9, 1000.0] {
            let rounded = round_up(size);
            assert!(rounded >= size * (1.0 - 1e-12) && rounded < size * 1.1893);
            assert_eq!(round_up(rounded * 0.999), rounded);
        }
    }
}
