//! A camera inside, for a scene that is a room and has no camera of its own.
//!
//! A room shows its middle the fronts of its walls; a closed model, such as a box or a helmet, shows it backs. So rays from the
//! middle tell one from the other. Sidedness of materials is not asked: exporters set `doubleSided` on anything.
//!
//! Guarantees: the same triangles give the same camera, and it stands in free space. Accepted downside: a room is only found if
//! the middle of its bounds lies in it.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::triangles::{Hit, Triangles};
use super::{Aabb, CameraPose, Exposure, look_at};
use crate::asset::Projection;

/// Horizontal rays that look for walls.
const DIRECTIONS: u32 = 16;
/// Of those and the one down, how many may miss, or hit a back.
const EXCEPTIONS: usize = 2;
/// Height of the eye above the floor, metres, if the room is of a person's size...
const EYE: f64 = 1.6;
/// ...and else between these parts of its height.
const EYE_PARTS: (f64, f64) = (0.1, 1.0 / 3.0);
/// Distance from the wall behind, as a part of the free length.
const CLEAR: f64 = 0.08;
/// Vertical, degrees. Wider than for objects, since walls are near.
const FIELD_OF_VIEW: f32 = 55.0;
/// How far the view rises over the free length: rooms have more above the eye than below.
const RISE: f64 = 0.07;

/// A camera that looks along the longest free horizontal line through the middle, from near one end. `None` if the middle
/// is not enclosed.
pub fn interior_camera(triangles: &Triangles, bounds: Aabb) -> Option<CameraPose> {
    let center = bounds.center().as_dvec3();
    let floor = center.y - floor_below(triangles, center)?;
    let top = triangles.first_hit(center, DVec3::Y).map_or(f64::from(bounds.max.y), |hit| center.y + hit.distance);
    let height = top - floor;
    let eye_height = EYE.clamp(height * EYE_PARTS.0, height * EYE_PARTS.1);
    let middle = DVec3::new(center.x, floor + eye_height, center.z);

    // Half of the directions: each is followed both ways. The first of equally long ones.
    let mut longest: Option<(f64, f64, DVec3)> = None;
    for index in 0..DIRECTIONS {
        let forward = horizontal(PI * f64::from(index) / f64::from(DIRECTIONS));
        let (ahead, behind) = (free(triangles, middle, forward, eye_height, bounds), free(triangles, middle, -forward, eye_height, bounds));
        // Not longer by rounding alone.
        if longest.is_none_or(|(a, b, _)| ahead + behind > (a + b) * (1.0 + 1e-9)) {
            longest = Some((ahead, behind, forward));
        }
    }
    let (ahead, behind, forward) = longest?;
    let length = ahead + behind;
    let position = middle - forward * (behind - CLEAR * length);
    let (right, up, back) = look_at(forward + DVec3::Y * RISE);
    let near = (eye_height * 0.03).clamp(1e-6, 1e30) as f32;
    let projection = Projection::Perspective { yfov: FIELD_OF_VIEW.to_radians(), near, far: None };
    (length > 0.0 && position.is_finite()).then_some(CameraPose { position, right, up, back, projection, exposure: Exposure::Unchanged })
}

/// Distance to the floor under the middle of a room; `None` if it is no room.
fn floor_below(triangles: &Triangles, center: DVec3) -> Option<f64> {
    let floor = triangles.first_hit(center, DVec3::NEG_Y)?;
    let mut fronts = usize::from(floor.front);
    for index in 0..DIRECTIONS {
        let wall = triangles.first_hit(center, horizontal(TAU * f64::from(index) / f64::from(DIRECTIONS)));
        fronts += usize::from(wall.is_some_and(|hit: Hit| hit.front));
    }
    (floor.front && fronts + EXCEPTIONS > DIRECTIONS as usize).then_some(floor.distance)
}

/// How far one can go: the shortest of three rays side by side, a shoulder apart. Where nothing stands, the bounds end it.
fn free(triangles: &Triangles, from: DVec3, direction: DVec3, eye_height: f64, bounds: Aabb) -> f64 {
    let aside = direction.cross(DVec3::Y) * (eye_height * 0.3);
    let rays = [DVec3::ZERO, aside, -aside].map(|aside| triangles.first_hit(from + aside, direction).map(|hit| hit.distance));
    rays.into_iter().flatten().fold(f64::from(bounds.radius()), f64::min)
}

/// A unit vector in the ground's plane; angle 0 is +X. Exact along the axes, where walls tend to stand.
fn horizontal(angle: f64) -> DVec3 {
    let exact = |x: f64| if x.abs() < 1e-12 { 0.0 } else { x };
    DVec3::new(exact(angle.cos()), 0.0, exact(-angle.sin()))
}

#[cfg(test)]
mod tests {
    use glam::{Affine3A, Vec3};

    use super::*;
    use crate::primitive::cuboid;
    use crate::world::{MeshInstance, Meshes, Transform, World, camera_pose, new_world, propagate_transforms, scene_bounds, update_bounds};

    /// A world with a box of 12 x 4 x 6 m, its faces outward or (mirrored winding) inward.
    fn world(inward: bool, transform: Affine3A) -> World {
        let mut mesh = cuboid("box", Vec3::new(12.0, 4.0, 6.0), 0);
        if inward {
            for triangle in mesh.indices.chunks_exact_mut(3) {
                triangle.swap(1, 2);
            }
        }
        let mut world = new_world();
        world.get_resource_or_init::<Meshes>().0.push(mesh);
        world.spawn((Transform(transform), MeshInstance { mesh: 0, material: 0 }));
        propagate_transforms(&mut world);
        update_bounds(&mut world);
        world
    }

    fn pose(world: &mut World) -> (CameraPose, Aabb) {
        let bounds = scene_bounds(world).unwrap();
        (camera_pose(world, None, Some(bounds), 1.5).unwrap(), bounds)
    }

    fn is_inside(pose: &CameraPose, bounds: Aabb) -> bool {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        pose.position.cmpgt(min).all() && pose.position.cmplt(max).all()
    }

    #[test]
    fn a_room_is_seen_from_inside_along_its_length() {
        let (pose, bounds) = pose(&mut world(true, Affine3A::from_translation(Vec3::new(3.0, 5.0, -2.0))));
        assert!(is_inside(&pose, bounds));
        // The floor is at 3 m, the room 4 m high: the eye at a third of it. The longest free line is the diagonal or near it.
        assert!((pose.position.y - (3.0 + 4.0 / 3.0)).abs() < 1e-6, "{pose:?}");
        assert!((-pose.back).dot(DVec3::X) > 0.85, "{pose:?}");
        let from_walls = (pose.position - bounds.min.as_dvec3()).min(bounds.max.as_dvec3() - pose.position);
        assert!(from_walls.min_element() > 0.3, "{from_walls}");
    }

    #[test]
    fn a_closed_model_is_seen_from_outside() {
        let (pose, bounds) = pose(&mut world(false, Affine3A::IDENTITY));
        assert!(!is_inside(&pose, bounds));
    }

    #[test]
    fn mirroring_turns_no_model_into_a_room() {
        let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        for inward in [false, true] {
            let (pose, bounds) = pose(&mut world(inward, mirror));
            assert_eq!(is_inside(&pose, bounds), inward);
        }
    }
}
