//! Cameras that travel by themselves.
//!
//! Guarantees: a path that could be made has finite keys whose times increase, so that every time has a pose. Between keys
//! rotations take the shorter arc. Accepted downside: a smooth path bends without a corner at its keys, but its speed changes
//! there as the author's times say.

use bevy_ecs::prelude::{Component, Entity, World};
use glam::{Affine3A, DVec3, DVec4, Mat3, Quat, Vec3, Vec4};
use luminaire_graph::diagnostic::Diagnostic;

use super::sample::{self, Segment, hermite, segment, slerp};
use super::transform::place;
use super::{Camera, Exposure, Repeat, look_at};
use crate::asset::Projection;

/// Farthest coordinate, metres: squares and sums of it stay finite.
const FARTHEST: f32 = 1e9;
/// Keys nearer to each other than this count as one place, metres.
const SAME: f64 = 1e-9;

/// Moves its entity, in its parent's space, along keys; and the entity's [`Camera`], if it has one, to their field of view and
/// exposure.
#[derive(Component, Debug, Clone, PartialEq)]
#[require(super::Transform)]
pub struct CameraPath {
    keys: Vec<PathKey>,
    interpolation: PathInterpolation,
    repeat: Repeat,
}

/// Where a camera is at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathKey {
    /// Seconds; the first key is where the path begins.
    pub time: f64,
    /// Metres.
    pub position: Vec3,
    /// Where it looks.
    pub facing: Facing,
    /// Vertical field of view, radians; only a perspective camera has one. It runs linearly between the keys that have one; if
    /// none has, it is the camera's own.
    pub yfov: Option<f32>,
    /// Exposure value at ISO 100; runs like the field of view.
    pub ev100: Option<f32>,
}

/// Where a camera looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Facing {
    /// At a point, upright. Where all keys have one, the point moves as the position does; else the rotations towards it count.
    Target(Vec3),
    /// Along -Z of this rotation.
    Rotation(Quat),
}

/// How a camera gets from key to key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PathInterpolation {
    /// Straight, and at constant speed.
    Linear,
    /// On a centripetal Catmull-Rom spline, which neither loops nor overshoots between keys (Yuksel, Schaefer and Keyser 2011,
    /// "Parameterization and Applications of Catmull-Rom Curves"). A loop whose first and last positions are the same has no
    /// corner there.
    #[default]
    Smooth,
}

impl CameraPath {
    /// A path through these keys. Rotations need not have unit length.
    /// Errors: `world::camera-path`, for each thing that is wrong: no key, times that do not increase, numbers that are not
    /// finite or too large, a target where the camera stands, a rotation without length, a field of view outside of 0 to pi.
    pub fn new(keys: Vec<PathKey>, interpolation: PathInterpolation, repeat: Repeat) -> Result<CameraPath, Vec<Diagnostic>> {
        let mut problems = Vec::new();
        if keys.is_empty() {
            problems.push("a camera path needs at least one key".to_owned());
        }
        for (index, key) in keys.iter().enumerate() {
            let before = index.checked_sub(1).and_then(|before| keys.get(before)).map_or(f64::NEG_INFINITY, |key| key.time);
            if !(key.time.is_finite() && key.time > before) {
                problems.push(format!("key {index} of a camera path is at {} s, not after {before} s", key.time));
            }
            problems.extend(problem_of(key).map(|problem| format!("key {index} of a camera path {problem}")));
        }
        if problems.is_empty() {
            return Ok(CameraPath { keys, interpolation, repeat });
        }
        Err(problems.into_iter().map(|problem| Diagnostic::error("world::camera-path", problem)).collect())
    }

    /// The time of the last key, seconds.
    pub fn end(&self) -> f64 {
        self.keys.last().map_or(0.0, |key| key.time)
    }

    /// The transform at a time in seconds.
    fn local(&self, time: f64) -> Affine3A {
        let at = segment(&self.keys, |key| key.time, time);
        let position = self.travel(at, false, |key| key.position.extend(0.0).as_dvec4()).truncate();
        let target = |key: &PathKey| match key.facing {
            Facing::Target(target) => Some(target.extend(0.0).as_dvec4()),
            Facing::Rotation(_) => None,
        };
        let axes = if self.keys.iter().all(|key| target(key).is_some()) {
            let target = self.travel(at, false, |key| target(key).unwrap_or_default()).truncate();
            axes(target - position)
        } else {
            Mat3::from_quat(sample::unit(self.travel(at, true, rotation)))
        };
        Affine3A::from_mat3_translation(axes, position.as_vec3())
    }

    /// A point, or a rotation at any length, between keys.
    fn travel(&self, at: Segment, is_rotation: bool, of: impl Fn(&PathKey) -> DVec4) -> DVec4 {
        let value = |index: usize| self.keys.get(index).map_or(DVec4::ZERO, &of);
        let (from, to) = (value(at.from), value(at.to));
        if self.interpolation == PathInterpolation::Linear || at.from == at.to {
            return if is_rotation { slerp(from, to, at.fraction) } else { from.lerp(to, at.fraction) };
        }
        // Neighbours of the two keys; past an open end the curve runs out evenly.
        let last = self.keys.len() - 1;
        let ends = (self.keys.first().map(|key| key.position), self.keys.last().map(|key| key.position));
        let is_closed = self.repeat == Repeat::Loop && last > 1 && ends.0 == ends.1;
        let before = match at.from.checked_sub(1) {
            Some(before) => Some(before),
            None => is_closed.then(|| last - 1),
        };
        let after = if at.to < last { Some(at.to + 1) } else { is_closed.then_some(1) };
        // Of the two signs of a rotation, the one nearer to another.
        let aligned = |value: DVec4, other: DVec4| if is_rotation && value.dot(other) < 0.0 { -value } else { value };
        let to = aligned(to, from);
        let before = before.map_or(2.0 * from - to, |index| aligned(value(index), from));
        let after = after.map_or(2.0 * to - from, |index| aligned(value(index), to));
        catmull_rom([before, from, to, after], at.fraction)
    }

    /// A number that only some keys have.
    fn number(&self, time: f64, of: impl Fn(&PathKey) -> Option<f32>) -> Option<f32> {
        let keys: Vec<(f64, f32)> = self.keys.iter().filter_map(|key| Some((key.time, of(key)?))).collect();
        let at = segment(&keys, |key| key.0, time);
        let value = |index: usize| keys.get(index).map(|key| f64::from(key.1));
        let (from, to) = (value(at.from)?, value(at.to)?);
        Some((from + (to - from) * at.fraction) as f32)
    }
}

/// What is wrong with a key by itself.
fn problem_of(key: &PathKey) -> Option<String> {
    let is_far = |point: Vec3| !point.abs().cmple(Vec3::splat(FARTHEST)).all();
    if is_far(key.position) {
        return Some(format!("is at {}, which is no place within {FARTHEST:e} m", key.position));
    }
    match key.facing {
        Facing::Target(target) if is_far(target) => return Some(format!("looks at {target}, which is no place within {FARTHEST:e} m")),
        Facing::Target(target) if target == key.position => return Some(format!("looks at {target}, where it stands")),
        Facing::Rotation(rotation) if Vec4::from(rotation).as_dvec4().try_normalize().is_none() => {
            return Some(format!("has the rotation {rotation}, which is none"));
        }
        _ => {}
    }
    if let Some(yfov) = key.yfov.filter(|yfov| !(*yfov > 0.0 && *yfov < std::f32::consts::PI)) {
        return Some(format!("has a field of view of {yfov} rad, which does not lie between 0 and pi"));
    }
    let ev100 = key.ev100.filter(|ev100| !ev100.is_finite())?;
    Some(format!("has an exposure value of {ev100}, which is no finite number"))
}

/// Right, up and back of what looks along a direction.
fn axes(forward: DVec3) -> Mat3 {
    let (right, up, back) = look_at(forward);
    Mat3::from_cols(right.as_vec3(), up.as_vec3(), back.as_vec3())
}

/// The rotation of a key, unit length.
fn rotation(key: &PathKey) -> DVec4 {
    let rotation = match key.facing {
        Facing::Target(target) => Quat::from_mat3(&axes((target - key.position).as_dvec3())),
        Facing::Rotation(rotation) => rotation,
    };
    Vec4::from(rotation).as_dvec4().try_normalize().unwrap_or(DVec4::W)
}

/// The curve from the second point to the third, as a cubic with the derivatives that knots at square roots of distances give.
fn catmull_rom([a, b, c, d]: [DVec4; 4], fraction: f64) -> DVec4 {
    let knot = |from: DVec4, to: DVec4| from.distance(to).sqrt();
    let middle = knot(b, c);
    if middle < SAME.sqrt() {
        return b.lerp(c, fraction);
    }
    // A neighbour in the same place says nothing about the direction.
    let or_middle = |length: f64| if length < SAME.sqrt() { middle } else { length };
    let (first, last) = (or_middle(knot(a, b)), or_middle(knot(c, d)));
    let out_of_b = (b - a) / first - (c - a) / (first + middle) + (c - b) / middle;
    let into_c = (c - b) / middle - (d - b) / (middle + last) + (d - c) / last;
    hermite(b, out_of_b * middle, c, into_c * middle, fraction)
}

/// Places everything that follows a path.
pub(super) fn follow(world: &mut World, time: f64) {
    let mut poses = Vec::new();
    let mut query = world.query::<(Entity, &CameraPath)>();
    for (entity, path) in query.iter(world) {
        let start = path.keys.first().map_or(0.0, |key| key.time);
        let at = start + path.repeat.phase(time - start, 1.0, path.end() - start);
        let (yfov, ev100) = (path.number(at, |key| key.yfov), path.number(at, |key| key.ev100));
        poses.push((entity, path.local(at), yfov, ev100));
    }
    for (entity, local, yfov, ev100) in poses {
        place(world, entity, local);
        let Some(mut camera) = world.get_mut::<Camera>(entity) else { continue };
        let mut wanted = camera.clone();
        if let (Projection::Perspective { yfov: own, .. }, Some(yfov)) = (&mut wanted.projection, yfov) {
            *own = yfov;
        }
        wanted.exposure = ev100.map_or(wanted.exposure, Exposure::Ev100);
        if *camera != wanted {
            *camera = wanted;
        }
    }
}

#[cfg(test)]
mod tests;
