//! Which meshes are solids: closed, with their fronts outside.
//!
//! glTF leaves out the back of a single-sided surface. On a solid it is only ever seen by a camera that stands inside, or whose near
//! plane has cut the front away; there, leaving it out would show what is behind the solid and let the camera see through a wall that
//! light does not pass. So the backs of opaque solids are drawn, which changes no other picture.
//!
//! Accepted downside: a mesh with the smallest hole, or with two surfaces that share an edge, counts as open.

use std::collections::HashMap;

use bevy_ecs::prelude::{Resource, World};
use glam::{DVec3, Vec3};

use super::Meshes;
use crate::asset::Mesh;

/// What is known of the first meshes; meshes are added and never edited in place.
#[derive(Resource, Debug, Default)]
struct Known(Vec<bool>);

/// Per mesh, whether it is a solid.
pub(crate) fn solid_meshes(world: &mut World) -> Vec<bool> {
    let mut known = world.remove_resource::<Known>().unwrap_or_default();
    if let Some(meshes) = world.get_resource::<Meshes>() {
        known.0.truncate(meshes.0.len());
        known.0.extend(meshes.0[known.0.len()..].iter().map(is_solid));
    }
    let solid = known.0.clone();
    world.insert_resource(known);
    solid
}

/// Whether every edge joins two triangles that agree on their outside, and the volume that they enclose is positive.
fn is_solid(mesh: &Mesh) -> bool {
    // Vertices are split where normals or coordinates differ: corners are the same if their positions are. Adding zero makes -0 and 0
    // one number.
    let mut corners: HashMap<[u32; 3], u32> = HashMap::new();
    let welded: Vec<u32> = mesh
        .vertices
        .iter()
        .map(|vertex| {
            let next = corners.len() as u32;
            *corners.entry(vertex.position.map(|value| (value + 0.0).to_bits())).or_insert(next)
        })
        .collect();
    let mut edges: Vec<(u32, u32)> = Vec::with_capacity(mesh.indices.len());
    let mut volume = 0.0;
    for triangle in mesh.indices.chunks_exact(3) {
        let corner = |index: u32| Some((*welded.get(index as usize)?, Vec3::from(mesh.vertices.get(index as usize)?.position).as_dvec3()));
        let (Some((a, at_a)), Some((b, at_b)), Some((c, at_c))) = (corner(triangle[0]), corner(triangle[1]), corner(triangle[2])) else {
            return false;
        };
        if a == b || b == c || c == a {
            continue;
        }
        edges.extend([(a, b), (b, c), (c, a)]);
        volume += DVec3::dot(at_a, at_b.cross(at_c));
    }
    edges.sort_unstable();
    let once = edges.windows(2).all(|pair| pair[0] != pair[1]);
    volume > 0.0 && once && edges.iter().all(|(a, b)| edges.binary_search(&(*b, *a)).is_ok())
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;
    use crate::primitive::{cuboid, plane, sphere};

    #[test]
    fn closed_and_outward_is_solid() {
        assert!(is_solid(&cuboid("box", Vec3::new(1.0, 2.0, 3.0), 0)));
        assert!(is_solid(&sphere("ball", 0.5, 16, 8, 0)));
    }

    #[test]
    fn open_or_inward_is_not() {
        assert!(!is_solid(&plane("plane", Vec2::ONE, 0)));
        let mut open = cuboid("box", Vec3::ONE, 0);
        open.indices.truncate(33);
        assert!(!is_solid(&open));
        let mut room = cuboid("room", Vec3::ONE, 0);
        room.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2));
        assert!(!is_solid(&room));
        let mut torn = cuboid("box", Vec3::ONE, 0);
        torn.indices[0..3].swap(1, 2);
        assert!(!is_solid(&torn));
    }

    #[test]
    fn meshes_that_come_later_are_looked_at() {
        let mut world = super::super::new_world();
        world.resource_mut::<Meshes>().0.push(cuboid("box", Vec3::ONE, 0));
        assert_eq!(solid_meshes(&mut world), [true]);
        world.resource_mut::<Meshes>().0.push(plane("plane", Vec2::ONE, 0));
        assert_eq!(solid_meshes(&mut world), [true, false]);
    }
}
