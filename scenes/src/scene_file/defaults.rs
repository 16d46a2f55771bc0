//! What a glTF file that is loaded by itself gets where it says nothing: a sun if it has no light (an interior a lamp, too), and a
//! camera inside if it has no camera and is an interior. (A scene without camera that is no interior is framed from outside, see
//! [`crate::world::framing_camera`].)
//!
//! Guarantee: the same file gives the same defaults. Accepted downside: whether a scene is an interior is told from a few rays
//! through its middle, which something odd in the middle can fool.

use bevy_ecs::prelude::World;
use glam::{Affine3A, Mat3A, Quat, Vec3};
use luminaire_graph::diagnostic::Diagnostic;

use crate::asset::Projection;
use crate::world::{
    Camera, DirectionalLight, Environment, GlobalTransform, LocalLight, MeshInstance, Meshes, Transform, assign_slots, look_at,
    propagate_transforms, scene_bounds, update_bounds,
};

/// Illuminance of the default sun, lux: a white surface that faces it reflects a radiance of 1.
const SUN_ILLUMINANCE: f32 = std::f32::consts::PI;
/// Where the default sun's light goes. Over the shoulder of the camera that frames a scene from outside.
const SUN_OUTSIDE: Vec3 = Vec3::new(-0.55, -0.75, -0.6);
/// The same for interiors: steep, so that it reaches the floors of courtyards.
const SUN_INSIDE: Vec3 = Vec3::new(-0.14, -1.0, -0.2);
/// Illuminance that the default lamp of an interior gives to its walls, lux.
const LAMP_ILLUMINANCE: f32 = 1.5;
/// Radiance behind everything, with the default sun: a clear sky, so that silhouettes stand out.
const SKY_RADIANCE: Vec3 = Vec3::new(0.22, 0.33, 0.5);

/// Directions around the middle that must meet walls.
const WALL_RAYS: usize = 16;
/// So many of them must meet the front of a wall: the middle of a closed model sees backs only.
const LEAST_FRONTS: usize = 12;
/// Height of the eye above the floor, as a part of the height of the scene's middle.
const EYE_HEIGHT: f32 = 0.3;
/// How far towards the wall behind it the camera stands.
const STEP_BACK: f32 = 0.85;

/// Adds the defaults; tells what was added.
pub(super) fn add_defaults(world: &mut World, file: &str) -> Vec<Diagnostic> {
    propagate_transforms(world);
    update_bounds(world);
    let has_camera = world.query::<&Camera>().iter(world).next().is_some();
    let has_light =
        world.query::<&DirectionalLight>().iter(world).next().is_some() || world.query::<&LocalLight>().iter(world).next().is_some();
    if has_camera && has_light {
        return Vec::new();
    }
    let inside = interior(world);
    if let (false, Some(inside)) = (has_camera, &inside) {
        world.spawn((inside.camera.clone(), Transform(inside.place)));
    }
    if has_light {
        return Vec::new();
    }
    let direction = if inside.is_some() { SUN_INSIDE } else { SUN_OUTSIDE };
    let turn = Quat::from_rotation_arc(Vec3::NEG_Z, direction.normalize());
    world.spawn((DirectionalLight { color: Vec3::ONE, illuminance: SUN_ILLUMINANCE }, Transform(Affine3A::from_quat(turn))));
    world.insert_resource(Environment { sky_radiance: SKY_RADIANCE });
    let mut added = format!("a sun of {SUN_ILLUMINANCE:.2} lux");
    if let Some(inside) = &inside {
        let intensity = LAMP_ILLUMINANCE * inside.wall_distance * inside.wall_distance;
        let lamp = LocalLight { color: Vec3::ONE, intensity, range: None, cone: None };
        world.spawn((lamp, Transform(Affine3A::from_translation(inside.middle))));
        added.push_str(&format!(" and a lamp of {intensity:.3} cd in its middle"));
    }
    assign_slots(world);
    let message = format!("`{file}` has no light: it gets {added}");
    vec![Diagnostic::warning("scene::default-light", message).hint("name the file in a scene .ron with lights of its own")]
}

/// What encloses its middle.
struct Interior {
    middle: Vec3,
    /// From the middle to the walls, metres, the median.
    wall_distance: f32,
    /// Stands in the scene and looks along it.
    camera: Camera,
    place: Affine3A,
}

/// Tells whether the scene encloses its middle, and from where to look at it.
fn interior(world: &mut World) -> Option<Interior> {
    let bounds = scene_bounds(world)?;
    let middle = bounds.center();
    let around = (0..WALL_RAYS).map(|index| {
        let angle = index as f32 / WALL_RAYS as f32 * std::f32::consts::TAU;
        Vec3::new(angle.cos(), 0.0, angle.sin())
    });
    let rays: Vec<Ray> = around.chain([Vec3::NEG_Y]).map(|direction| Ray { origin: middle, direction }).collect();
    let hits = cast(world, &rays);
    let (walls, floor) = hits.split_at(WALL_RAYS);
    let fronts = walls.iter().filter(|hit| hit.is_some_and(|hit| hit.front)).count();
    let floor = floor.first().copied().flatten().filter(|hit| hit.front)?;
    if walls.iter().any(Option::is_none) || fronts < LEAST_FRONTS {
        return None;
    }
    let eye = middle - Vec3::Y * (floor.distance * (1.0 - EYE_HEIGHT));
    // At the eye's height there may be other walls than in the middle.
    let level: Vec<Ray> = rays[..WALL_RAYS].iter().map(|ray| Ray { origin: eye, direction: ray.direction }).collect();
    let free: Vec<f32> = cast(world, &level).iter().map(|hit| hit.map_or(0.0, |hit| hit.distance)).collect();
    let half = WALL_RAYS / 2;
    let length = |index: &usize| free[*index] + free[(*index + half) % WALL_RAYS];
    let ahead = (0..WALL_RAYS).max_by(|a, b| length(a).total_cmp(&length(b)).then(b.cmp(a)))?;
    let position = eye - level[ahead].direction * (free[(ahead + half) % WALL_RAYS] * STEP_BACK);
    // A little up, to where most of a room is.
    let target = eye + level[ahead].direction * free[ahead] + Vec3::Y * (floor.distance * 0.25);
    let (right, up, back) = look_at((target - position).as_dvec3());
    let axes = Mat3A::from_cols(right.as_vec3().into(), up.as_vec3().into(), back.as_vec3().into());
    let near = (floor.distance * 0.01).clamp(1e-4, 1.0);
    let projection = Projection::Perspective { yfov: 60.0_f32.to_radians(), near, far: None };
    let camera = Camera { name: "inside".to_owned(), projection, ev100: None };
    let mut distances: Vec<f32> = walls.iter().flatten().map(|hit| hit.distance).collect();
    distances.sort_by(f32::total_cmp);
    let wall_distance = distances[WALL_RAYS / 2];
    Some(Interior { middle, wall_distance, camera, place: Affine3A { matrix3: axes, translation: position.into() } })
}

#[derive(Debug, Clone, Copy)]
struct Ray {
    origin: Vec3,
    /// Unit length.
    direction: Vec3,
}

#[derive(Debug, Clone, Copy)]
struct Hit {
    distance: f32,
    /// The side from which its corners run counter-clockwise.
    front: bool,
}

/// The nearest hit of each ray with the scene's triangles (Möller and Trumbore 1997), by going through all of them.
fn cast(world: &mut World, rays: &[Ray]) -> Vec<Option<Hit>> {
    let mut nearest: Vec<Option<Hit>> = vec![None; rays.len()];
    let mut query = world.query::<(&MeshInstance, &GlobalTransform)>();
    let Some(meshes) = world.get_resource::<Meshes>() else { return nearest };
    for (instance, transform) in query.iter(world) {
        let Some(mesh) = meshes.0.get(instance.mesh) else { continue };
        let mirrored = transform.0.matrix3.determinant() < 0.0;
        let corner = |index: u32| mesh.vertices.get(index as usize).map(|vertex| transform.0.transform_point3(Vec3::from(vertex.position)));
        for triangle in mesh.indices.chunks_exact(3) {
            let (Some(a), Some(b), Some(c)) = (corner(triangle[0]), corner(triangle[1]), corner(triangle[2])) else { continue };
            let (ab, ac) = (b - a, c - a);
            for (ray, nearest) in rays.iter().zip(&mut nearest) {
                let across = ray.direction.cross(ac);
                let determinant = ab.dot(across);
                let from_a = ray.origin - a;
                let u = from_a.dot(across) / determinant;
                let along = from_a.cross(ab);
                let v = ray.direction.dot(along) / determinant;
                let distance = ac.dot(along) / determinant;
                // A triangle without area gives values that are no numbers, which fail every comparison.
                let hit = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0;
                if hit && nearest.is_none_or(|known| distance < known.distance) {
                    *nearest = Some(Hit { distance, front: (determinant > 0.0) != mirrored });
                }
            }
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::{Asset, Material, Mesh, Node};
    use crate::primitive::cuboid;
    use crate::world::{new_world, spawn_asset};

    fn world_of(mesh: Mesh, local: Affine3A) -> World {
        let node = Node { name: "node".to_owned(), parent: None, local, meshes: vec![0], light: None, camera: None };
        let asset = Asset { nodes: vec![node], meshes: vec![mesh], materials: vec![Material::default()], ..Asset::default() };
        let mut world = new_world();
        spawn_asset(&mut world, &asset, Affine3A::IDENTITY);
        world
    }

    fn cameras(world: &mut World) -> usize {
        world.query::<&Camera>().iter(world).count()
    }

    /// A box of 12 x 3 x 5 m, its triangles turned inwards.
    fn room() -> Mesh {
        let mut room = cuboid("room", Vec3::new(12.0, 3.0, 5.0), 0);
        for triangle in room.indices.chunks_exact_mut(3) {
            triangle.swap(1, 2);
        }
        room
    }

    #[test]
    fn a_room_is_seen_from_inside_along_its_length() {
        for local in [Affine3A::IDENTITY, Affine3A::from_scale(Vec3::splat(10.0))] {
            let mut world = world_of(room(), local);
            let warnings = add_defaults(&mut world, "room.glb");
            assert_eq!(warnings.len(), 1);
            let mut query = world.query::<(&Camera, &Transform)>();
            let (_, place) = query.iter(&world).next().expect("a camera");
            let scale = local.matrix3.x_axis.x;
            let position = Vec3::from(place.0.translation) / scale;
            assert!(position.x.abs() > 4.0 && position.x.abs() < 6.0, "{position}");
            assert!(position.y > -1.5 && position.y < 0.0, "{position}");
            let forward = -Vec3::from(place.0.matrix3.z_axis);
            assert!(forward.x * position.x < 0.0 && forward.x.abs() > 0.9, "{forward}");
        }
    }

    #[test]
    fn a_mirrored_room_turned_outwards_is_one_too() {
        let mut world = world_of(cuboid("box", Vec3::new(12.0, 3.0, 5.0), 0), Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)));
        add_defaults(&mut world, "box.glb");
        assert_eq!(cameras(&mut world), 0, "mirroring turns the winding, and the front stays outside");
    }

    #[test]
    fn a_closed_model_is_seen_from_outside() {
        let mut world = world_of(cuboid("box", Vec3::ONE, 0), Affine3A::IDENTITY);
        add_defaults(&mut world, "box.glb");
        assert_eq!(cameras(&mut world), 0);
        assert_eq!(world.query::<&DirectionalLight>().iter(&world).count(), 1);
    }

    #[test]
    fn nothing_is_added_to_a_world_that_has_it() {
        let mut world = world_of(room(), Affine3A::IDENTITY);
        let lamp = LocalLight { color: Vec3::ONE, intensity: 1.0, range: None, cone: None };
        let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
        world.spawn((lamp, Camera { name: "own".to_owned(), projection, ev100: None }));
        assert!(add_defaults(&mut world, "room.glb").is_empty());
        assert_eq!((cameras(&mut world), world.query::<&DirectionalLight>().iter(&world).count()), (1, 0));
    }
}
