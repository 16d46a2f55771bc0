//! Which objects each face of a cube sees: those of point lights, rectangles of light and reflection probes.
//!
//! An object is seen by a face if its bounds come within the cube's reach and meet the face's pyramid. The cube of a rectangle may be drawn
//! from any point of it: bounds are as much larger for it as such a point may be off its middle. Kept from frame to frame: a lamp
//! that moves asks the spatial index, an object that moves is tested against every lamp. Accepted downside: bounds are boxes, so that
//! a face may hold an object that it just misses.

use std::collections::{BTreeMap, BTreeSet};

use bevy_ecs::prelude::World;
use glam::DVec3;
use luminaire_graph::published::ViewKind;

use super::cube::FACES;
use super::objects::{Changed, Objects};
use crate::world::{Aabb, Kind, ObjectSlot, SpatialIndex};

/// What has a cube, by slot among its kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Cube {
    Point(u32),
    Rectangle(u32),
    Probe(u32),
}

impl Cube {
    /// The cube of a view, and which face it is of it.
    pub(super) fn of(view: ViewKind) -> Option<(Cube, u32)> {
        match view {
            ViewKind::PointLight(light, face) => Some((Cube::Point(light), face)),
            ViewKind::RectangleLight(light, face) => Some((Cube::Rectangle(light), face)),
            ViewKind::ReflectionProbe(probe, face) => Some((Cube::Probe(probe), face)),
            _ => None,
        }
    }

    fn face(self, face: u32) -> ViewKind {
        match self {
            Cube::Point(light) => ViewKind::PointLight(light, face),
            Cube::Rectangle(light) => ViewKind::RectangleLight(light, face),
            Cube::Probe(probe) => ViewKind::ReflectionProbe(probe, face),
        }
    }
}

/// From where a cube is drawn, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Center {
    pub(super) position: DVec3,
    /// It may be drawn from points that are so far off.
    pub(super) radius: f64,
    /// Near and far plane of the faces.
    pub(super) planes: [f64; 2],
    /// Nothing farther from the position counts.
    pub(super) reach: f64,
}

/// What the faces of one cube see.
#[derive(Debug)]
struct Seen {
    position: DVec3,
    reach: f64,
    radius: f64,
    /// By slot: a bit for each face.
    faces: Vec<u8>,
}

/// What the faces of all cubes see that draw lists ask for.
#[derive(Debug, Default)]
pub(super) struct Casters(BTreeMap<Cube, Seen>);

impl Casters {
    /// Takes changed lamps and objects over; returns the faces that see others than before.
    pub(super) fn update(
        &mut self,
        world: &mut World,
        wanted: impl Iterator<Item = ViewKind>,
        center: impl Fn(Cube) -> Option<Center>,
        objects: &Objects,
        changed: &Changed,
    ) -> BTreeSet<ViewKind> {
        let wanted: BTreeSet<Cube> = wanted.filter_map(Cube::of).map(|(cube, _)| cube).collect();
        self.0.retain(|cube, _| wanted.contains(cube));
        let mut others = BTreeSet::new();
        for cube in wanted {
            let Some(Center { position, radius, reach, .. }) = center(cube) else {
                let gone = self.0.remove(&cube).is_some();
                others.extend((0..6).filter(|_| gone).map(|face| cube.face(face)));
                continue;
            };
            let different = match self.0.get_mut(&cube) {
                Some(seen) if seen.position == position && seen.reach == reach && seen.radius == radius => {
                    seen.test(objects, changed.slots.iter().copied())
                }
                known => {
                    let before = known.map_or_else(Vec::new, |seen| std::mem::take(&mut seen.faces));
                    let mut seen = Seen { position, reach, radius, faces: Vec::new() };
                    seen.test(objects, near(world, position, reach));
                    let different = difference(&before, &seen.faces);
                    self.0.insert(cube, seen);
                    different
                }
            };
            others.extend((0..6).filter(|face| different >> face & 1 == 1).map(|face| cube.face(face)));
        }
        others
    }

    /// Whether a face sees the object of a slot.
    pub(super) fn sees(&self, cube: Cube, face: u32, slot: u32) -> bool {
        self.0.get(&cube).and_then(|seen| seen.faces.get(slot as usize)).is_some_and(|faces| faces >> face & 1 == 1)
    }
}

impl Seen {
    /// Tests the objects of slots again. A bit for each face that sees others than before.
    fn test(&mut self, objects: &Objects, slots: impl Iterator<Item = u32>) -> u8 {
        self.faces.resize(objects.slots().max(self.faces.len()), 0);
        let mut different = 0;
        for slot in slots {
            let faces = objects.get(slot).map_or(0, |object| faces(grown(object.bounds, self.radius), self.position, self.reach));
            if let Some(known) = self.faces.get_mut(slot as usize) {
                different |= *known ^ faces;
                *known = faces;
            }
        }
        different
    }
}

/// A box with all that is so near to it.
fn grown(bounds: Aabb, by: f64) -> Aabb {
    Aabb { min: bounds.min - by as f32, max: bounds.max + by as f32 }
}

/// The slots of the objects that come within reach.
fn near(world: &mut World, position: DVec3, reach: f64) -> impl Iterator<Item = u32> {
    let index = world.get_resource_mut::<SpatialIndex>();
    let found = index.map(|mut index| index.in_sphere(Kind::Object, position, reach));
    let world = &*world;
    found.unwrap_or_default().into_iter().filter_map(|entity| world.get::<ObjectSlot>(entity)).map(|slot| slot.0)
}

fn difference(a: &[u8], b: &[u8]) -> u8 {
    let at = |faces: &[u8], slot: usize| faces.get(slot).copied().unwrap_or(0);
    (0..a.len().max(b.len())).fold(0, |different, slot| different | at(a, slot) ^ at(b, slot))
}

/// The faces whose pyramid a box meets within reach, a bit for each.
fn faces(bounds: Aabb, position: DVec3, reach: f64) -> u8 {
    if bounds.distance_squared(position) > reach * reach {
        return 0;
    }
    let (min, max) = (bounds.min.as_dvec3() - position, bounds.max.as_dvec3() - position);
    let (middle, half) = ((min + max) * 0.5, (max - min) * 0.5);
    // Rounding must leave nothing out.
    let slack = 1e-6 * (middle.abs() + half).max_element();
    // Ahead follows from the four sides for a point, and not for a box.
    let inside = |[right, up, forward]: &[DVec3; 3]| {
        [*forward, forward + right, forward - right, forward + up, forward - up]
            .iter()
            .all(|plane| plane.dot(middle) + plane.abs().dot(half) + slack >= 0.0)
    };
    FACES.iter().enumerate().fold(0, |faces, (face, frame)| if inside(frame) { faces | 1 << face } else { faces })
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;

    fn cube(center: Vec3, half: f32) -> Aabb {
        Aabb { min: center - half, max: center + half }
    }

    #[test]
    fn a_box_is_seen_where_it_stands() {
        let from = DVec3::new(1.0, 2.0, 3.0);
        for (face, axis) in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z].into_iter().enumerate() {
            assert_eq!(faces(cube(from.as_vec3() + axis * 5.0, 0.5), from, 100.0), 1 << face);
            assert_eq!(faces(cube(from.as_vec3() + axis * 5.0, 0.5), from, 4.4), 0, "out of reach");
        }
        assert_eq!(faces(cube(from.as_vec3(), 0.1), from, 1.0), 0b11_1111, "around the lamp");
        assert_eq!(faces(cube(from.as_vec3() + Vec3::new(5.0, 5.0, 0.0), 0.5), from, 100.0), 0b00_0101, "across an edge");
    }

    proptest! {
        /// A point of the box that falls on a face is enough.
        #[test]
        fn no_face_misses_a_point(center in prop::array::uniform3(-9.0_f32..9.0), half in 0.01_f32..3.0, at in prop::array::uniform3(-1.0_f32..1.0)) {
            let bounds = cube(Vec3::from_array(center), half);
            let point = (Vec3::from_array(center) + Vec3::from_array(at) * half).as_dvec3();
            let seen = faces(bounds, DVec3::ZERO, f64::INFINITY);
            let axis = (0..3).max_by(|a, b| point[*a].abs().total_cmp(&point[*b].abs())).unwrap();
            let face = 2 * axis + usize::from(point[axis] < 0.0);
            prop_assert!(seen >> face & 1 == 1, "{:?} on {}: {:b}", point, face, seen);
        }

        /// Nor does it from another point from where its cube may be drawn.
        #[test]
        fn no_face_misses_a_point_from_aside(center in prop::array::uniform3(-9.0_f32..9.0), aside in prop::array::uniform3(-1.0_f32..1.0), radius in 0.01_f32..3.0) {
            let aside = Vec3::from_array(aside).clamp_length_max(1.0) * radius;
            let seen = faces(grown(cube(Vec3::from_array(center), 0.1), f64::from(radius)), DVec3::ZERO, f64::INFINITY);
            let point = (Vec3::from_array(center) - aside).as_dvec3();
            let axis = (0..3).max_by(|a, b| point[*a].abs().total_cmp(&point[*b].abs())).unwrap();
            let face = 2 * axis + usize::from(point[axis] < 0.0);
            prop_assert!(seen >> face & 1 == 1, "{:?} on {}: {:b}", point, face, seen);
        }
    }
}
