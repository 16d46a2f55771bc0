//! All triangles of the world, and where a ray meets them first: for questions about the scene's shape, not for pictures.
//!
//! Guarantees: deterministic; whatever is not finite or has no area is left out, so no answer is NaN. Accepted downside: brute
//! force, every triangle for every ray; a few hundred rays against a quarter of a million triangles take a moment.

use bevy_ecs::prelude::World;
use glam::DVec3;

use super::{GlobalTransform, MeshInstance, Meshes, Shown};

/// Triangles in world space, counter-clockwise seen from the front.
#[derive(Debug, Clone, Default)]
pub struct Triangles(Vec<[DVec3; 3]>);

/// Where a ray meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// In lengths of the ray's direction, greater than zero.
    pub distance: f64,
    /// Whether the ray falls on the front.
    pub front: bool,
}

impl Triangles {
    /// Those of every mesh instance that is not hidden. Needs propagated transforms and visibility.
    pub fn of_world(world: &mut World) -> Triangles {
        let mut query = world.query::<(&MeshInstance, &GlobalTransform, &Shown)>();
        let Some(meshes) = world.get_resource::<Meshes>() else { return Triangles::default() };
        let mut triangles = Vec::new();
        for (instance, transform, _) in query.iter(world).filter(|(.., shown)| shown.0) {
            let Some(mesh) = meshes.0.get(instance.mesh) else { continue };
            let transform = transform.0;
            // An odd number of mirrorings turns the winding, and glTF's front with it.
            let mirrored = transform.matrix3.determinant() < 0.0;
            let corner =
                |index: u32| mesh.vertices.get(index as usize).map(|vertex| transform.transform_point3(vertex.position.into()).as_dvec3());
            for indices in mesh.indices.chunks_exact(3) {
                let &[a, b, c] = indices else { continue };
                let (b, c) = if mirrored { (c, b) } else { (b, c) };
                if let (Some(a), Some(b), Some(c)) = (corner(a), corner(b), corner(c)) {
                    triangles.push([a, b, c]);
                }
            }
        }
        Triangles::new(triangles)
    }

    /// How many there are in the world at most, before any is made.
    pub fn count(world: &mut World) -> usize {
        let mut query = world.query::<(&MeshInstance, &Shown)>();
        let Some(meshes) = world.get_resource::<Meshes>() else { return 0 };
        let shown = query.iter(world).filter(|(_, shown)| shown.0);
        shown.filter_map(|(instance, _)| meshes.0.get(instance.mesh)).map(|mesh| mesh.indices.len() / 3).sum()
    }

    /// These, without those that are not finite or have no area.
    pub fn new(triangles: Vec<[DVec3; 3]>) -> Triangles {
        let sound = |[a, b, c]: &[DVec3; 3]| {
            let area = (*b - *a).cross(*c - *a).length();
            area.is_finite() && area > 0.0
        };
        Triangles(triangles.into_iter().filter(sound).collect())
    }

    /// The nearest surface along a ray; the first of equally near ones.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let mut nearest: Option<Hit> = None;
        for triangle in &self.0 {
            if let Some(hit) = hit(triangle, origin, direction)
                && nearest.is_none_or(|known| hit.distance < known.distance)
            {
                nearest = Some(hit);
            }
        }
        nearest
    }
}

/// Möller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection".
fn hit(&[a, b, c]: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<Hit> {
    // Rays along a plane of axes miss most triangles already here.
    for axis in 0..3 {
        let (at, low, high) = (origin[axis], a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        if direction[axis] == 0.0 && (at < low || at > high) {
            return None;
        }
    }
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    if determinant == 0.0 {
        return None;
    }
    let from_a = origin - a;
    let u = from_a.dot(across) / determinant;
    let around = from_a.cross(ab);
    let v = direction.dot(around) / determinant;
    let distance = ac.dot(around) / determinant;
    let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance.is_finite();
    inside.then_some(Hit { distance, front: determinant > 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_side_is_told() {
        let facing_z = |z: f64| [DVec3::new(-1.0, -1.0, z), DVec3::new(1.0, -1.0, z), DVec3::new(0.0, 2.0, z)];
        let nothing = [DVec3::new(0.0, 0.0, 3.0); 3];
        let broken = [DVec3::NAN, DVec3::X, DVec3::Y];
        let triangles = Triangles::new(vec![broken, facing_z(0.0), nothing, facing_z(1.0)]);
        assert_eq!(triangles.0.len(), 2);
        let from = |z, direction| triangles.first_hit(DVec3::new(0.0, 0.0, z), direction);
        assert_eq!(from(5.0, DVec3::NEG_Z), Some(Hit { distance: 4.0, front: true }));
        assert_eq!(from(-2.0, DVec3::Z), Some(Hit { distance: 2.0, front: false }));
        assert_eq!(from(5.0, DVec3::Z), None);
        assert_eq!(from(0.5, DVec3::X), None);
    }
}
