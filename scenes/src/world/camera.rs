//! Which camera renders, and where it stands.
//!
//! A camera's pose is rigid whatever its node's transform is: scale, shear and mirroring are taken out, and a degenerate axis
//! falls back to a fixed one. A scene without cameras gets one that frames it, or stands in it if it is a room.

use bevy_ecs::prelude::{Entity, Resource, World};
use glam::{Affine3A, DVec3, Mat3A, Vec3};
use luminaire_graph::diagnostic::{Diagnostic, did_you_mean, list_names};

use super::{Aabb, Camera, CameraSlot, Exposure, GlobalTransform, Name, Triangles, interior_camera};
use crate::asset::Projection;

/// A camera in world space: a right-handed orthonormal frame and a projection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraPose {
    /// Where it stands, metres.
    pub position: DVec3,
    /// To the right of the image.
    pub right: DVec3,
    /// To the top of the image.
    pub up: DVec3,
    /// Against the direction of view.
    pub back: DVec3,
    /// Perspective or orthographic.
    pub projection: Projection,
    /// The camera's.
    pub exposure: Exposure,
}

/// The camera of a name, or the first one. `None` if the scene has none and none was asked for.
/// Errors: `world::unknown-camera`.
pub fn select_camera(world: &mut World, name: Option<&str>) -> Result<Option<Entity>, Diagnostic> {
    let mut query = world.query::<(Entity, &Camera, Option<&CameraSlot>, Option<&Name>)>();
    let mut cameras: Vec<_> = query.iter(world).collect();
    cameras.sort_by_key(|(entity, _, slot, _)| (slot.map_or(u32::MAX, |slot| slot.0), entity.index_u32()));
    let Some(name) = name else { return Ok(cameras.first().map(|camera| camera.0)) };
    let by_camera = cameras.iter().find(|(_, camera, ..)| camera.name == name);
    let by_node = || cameras.iter().find(|(.., node)| node.is_some_and(|node| node.as_str() == name));
    match by_camera.or_else(by_node) {
        Some(camera) => Ok(Some(camera.0)),
        None => {
            let known: Vec<&str> = cameras.iter().map(|(_, camera, ..)| camera.name.as_str()).collect();
            Err(Diagnostic::error("world::unknown-camera", format!("the scene has no camera `{name}`"))
                .note(format!("its cameras: {}", list_names(known.iter().copied())))
                .maybe_hint(did_you_mean(name, known)))
        }
    }
}

/// The pose of the camera of a name, of the first camera, or of one made for the scene. `aspect` is width over height.
/// Needs propagated transforms. Errors: `world::unknown-camera`.
pub fn camera_pose(world: &mut World, name: Option<&str>, bounds: Option<Aabb>, aspect: f64) -> Result<CameraPose, Diagnostic> {
    let Some(entity) = select_camera(world, name)? else { return Ok(default_camera(world, bounds, aspect)) };
    let transform = world.get::<GlobalTransform>(entity).map_or(Affine3A::IDENTITY, |transform| transform.0);
    let Some(camera) = world.get::<Camera>(entity) else { return Ok(framing_camera(bounds, aspect)) };
    let (right, up, back) = rigid_axes(transform.matrix3);
    let position = transform.translation.as_dvec3();
    let position = if position.is_finite() { position } else { DVec3::ZERO };
    Ok(CameraPose { position, right, up, back, projection: camera.projection, exposure: camera.exposure })
}

/// The last search for a room: it goes through all triangles, and is made again only when the bounds have changed.
#[derive(Resource, Debug)]
struct LastSearch {
    bounds: Aabb,
    found: Option<CameraPose>,
}

/// Scenes of more triangles are not searched for a room: every ray looks at each of them.
const MOST_TRIANGLES: usize = 1 << 22;

/// The camera inside of a scene that is a room, as [`interior_camera`] finds it. Needs propagated transforms.
pub(crate) fn camera_inside(world: &mut World, bounds: Aabb) -> Option<CameraPose> {
    if let Some(last) = world.get_resource::<LastSearch>().filter(|last| last.bounds == bounds) {
        return last.found;
    }
    let found = if Triangles::count(world) > MOST_TRIANGLES { None } else { interior_camera(&Triangles::of_world(world), bounds) };
    world.insert_resource(LastSearch { bounds, found });
    found
}

/// The camera of a scene that has none: inside of a room, else one that frames the scene.
fn default_camera(world: &mut World, bounds: Option<Aabb>, aspect: f64) -> CameraPose {
    bounds.and_then(|bounds| camera_inside(world, bounds)).unwrap_or_else(|| framing_camera(bounds, aspect))
}

/// A camera that sees all of the bounds, from the front, a little from the right and above, with a vertical field of view of
/// 45 degrees. Without bounds it looks at the unit sphere. The same bounds and aspect give the same camera.
pub fn framing_camera(bounds: Option<Aabb>, aspect: f64) -> CameraPose {
    let center = bounds.map_or(DVec3::ZERO, |bounds| bounds.center().as_dvec3());
    let radius = bounds.map_or(1.0, |bounds| f64::from(bounds.radius()));
    let radius = if radius > 1e-6 { radius } else { 1.0 };
    let half_y = 22.5_f64.to_radians();
    let half_x = (half_y.tan() * aspect.clamp(1e-3, 1e3)).atan();
    // The sphere around the box touches the narrower pair of planes; 5 % of air.
    let distance = 1.05 * radius / half_y.min(half_x).sin();
    let position = center + DVec3::new(0.45, 0.35, 1.0).normalize() * distance;
    let (right, up, back) = look_at(center - position);
    let near = ((distance - radius) * 0.05).clamp(1e-6, 1e30) as f32;
    let projection = Projection::Perspective { yfov: 2.0 * half_y as f32, near, far: None };
    CameraPose { position, right, up, back, projection, exposure: Exposure::Unchanged }
}

/// Right, up and back of something at the origin that looks along `forward` with +Y up (with -Z up where it looks along Y).
pub fn look_at(forward: DVec3) -> (DVec3, DVec3, DVec3) {
    let back = (-forward).try_normalize().unwrap_or(DVec3::Z);
    let hint = if back.y.abs() < 0.9999 { DVec3::Y } else { DVec3::NEG_Z };
    let right = hint.cross(back).try_normalize().unwrap_or(DVec3::X);
    (right, back.cross(right), back)
}

/// The right-handed orthonormal axes (x, y, z) nearest to a matrix in this sense: z keeps its direction, y its plane with z.
pub fn rigid_axes(matrix: Mat3A) -> (DVec3, DVec3, DVec3) {
    let axis = |column: glam::Vec3A| Vec3::from(column).as_dvec3();
    let Some(back) = axis(matrix.z_axis).try_normalize() else { return (DVec3::X, DVec3::Y, DVec3::Z) };
    let y = axis(matrix.y_axis);
    match y.cross(back).try_normalize() {
        Some(right) => (right, back.cross(right), back),
        None => look_at(-back),
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};

    use super::*;
    use crate::world::{Transform, assign_slots, new_world, propagate_transforms};

    fn camera(name: &str) -> Camera {
        Camera {
            name: name.to_owned(),
            projection: Projection::Perspective { yfov: 1.0, near: 0.1, far: None },
            exposure: Exposure::Unchanged,
        }
    }

    #[test]
    fn selects_by_name_then_by_order() {
        let mut world = new_world();
        let first = world.spawn((camera("front"), Name::new("node"))).id();
        let second = world.spawn(camera("side")).id();
        assign_slots(&mut world);
        assert_eq!(select_camera(&mut world, None).unwrap(), Some(first));
        assert_eq!(select_camera(&mut world, Some("side")).unwrap(), Some(second));
        assert_eq!(select_camera(&mut world, Some("node")).unwrap(), Some(first));
        let error = select_camera(&mut world, Some("sid")).unwrap_err();
        assert_eq!((error.code, error.hint.as_deref()), ("world::unknown-camera", Some("did you mean `side`?")));
    }

    #[test]
    fn a_pose_is_rigid_whatever_the_node_is() {
        let cases = [
            Affine3A::from_scale_rotation_translation(Vec3::new(-3.0, 0.1, 2.0), Quat::from_rotation_x(0.7), Vec3::X),
            Affine3A::from_scale(Vec3::ZERO),
            Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0)),
            Affine3A::from_scale(Vec3::splat(f32::NAN)),
        ];
        for local in cases {
            let mut world = new_world();
            world.spawn((camera("c"), Transform(local)));
            propagate_transforms(&mut world);
            let pose = camera_pose(&mut world, None, None, 1.0).unwrap();
            assert!((pose.right.cross(pose.up) - pose.back).length() < 1e-9, "{local:?}: {pose:?}");
            assert!((pose.right.length() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn the_framing_camera_sees_every_corner() {
        let bounds = Aabb { min: Vec3::new(-1.0, 0.0, -20.0), max: Vec3::new(2.0, 3.0, 5.0) };
        for aspect in [0.25, 1.0, 3.0] {
            let pose = framing_camera(Some(bounds), aspect);
            let limit = 22.5_f64.to_radians().tan();
            for corner in bounds.corners() {
                let offset = corner.as_dvec3() - pose.position;
                let depth = -offset.dot(pose.back);
                assert!(depth > 0.0);
                assert!((offset.dot(pose.up) / depth).abs() <= limit && (offset.dot(pose.right) / depth).abs() <= limit * aspect);
            }
        }
        let point = Aabb { min: Vec3::ONE, max: Vec3::ONE };
        assert!(framing_camera(Some(point), 1.0).position.is_finite() && framing_camera(None, 1.0).position.is_finite());
    }
}
