//! What a scene holds, for people and for programs: nodes as a tree, lights and cameras with units, bounds, memory, timeline.
//!
//! Guarantees: equal worlds give equal text. Nodes are a flat list, parents first, so that no depth is too much. Accepted downside: of
//! many unnamed siblings that are the same, the text shows one line with their number.

mod nodes;
mod text;
mod timeline;

pub use text::text;

use bevy_ecs::prelude::World;
use serde::Serialize;

use crate::publish::counts;
use crate::timeline::Timeline;
use crate::world::{
    Environment, Images, Materials, MeshInstance, Meshes, Shown, Time, propagate_transforms, propagate_visibility, scene_bounds,
    update_bounds,
};

/// A scene in words and numbers. Lengths in metres, angles in degrees, colours linear Rec.709.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Description {
    /// The moment that is described, seconds.
    pub time: f64,
    /// Nodes, each behind its parent, in the order of the tree.
    pub nodes: Vec<Node>,
    /// Materials by their rows.
    pub materials: Vec<Material>,
    /// Different meshes.
    pub meshes: usize,
    /// Triangles of the different meshes.
    pub stored_triangles: u64,
    /// Triangles that are drawn: those of every instance that is not hidden.
    pub drawn_triangles: u64,
    /// Decoded images.
    pub images: usize,
    /// What planners count: lights, surfaces.
    pub counts: std::collections::BTreeMap<String, u32>,
    /// Radiance of the sky, nits.
    pub sky: [f32; 3],
    /// Smallest and largest coordinates; none if nothing is drawn.
    pub bounds: Option<[[f32; 3]; 2]>,
    /// Bytes of vertices and indices.
    pub geometry_bytes: u64,
    /// Bytes of images with all their mip levels.
    pub texture_bytes: u64,
    /// What will happen, by time.
    pub timeline: Vec<Event>,
}

/// A node.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Node {
    /// Its name; none for copies and for meshes of glTF nodes.
    pub name: Option<String>,
    /// Index of its parent in the list.
    pub parent: Option<usize>,
    /// How many nodes stand above it.
    pub depth: usize,
    /// Where it stands in the world, metres.
    pub position: [f32; 3],
    /// What it is, one phrase each; empty for a node that only holds others.
    pub parts: Vec<String>,
}

/// A material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// What it is like.
    pub looks: String,
    /// Entities that are drawn with it.
    pub used_by: usize,
}

/// Something that happens.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Event {
    /// Seconds.
    pub at: f64,
    /// What happens.
    pub what: String,
}

/// Describes a world as it is now.
pub fn describe(world: &mut World) -> Description {
    propagate_transforms(world);
    propagate_visibility(world);
    update_bounds(world);
    let bounds = scene_bounds(world).map(|bounds| [bounds.min.to_array(), bounds.max.to_array()]);
    let instances: Vec<(MeshInstance, bool)> =
        world.query::<(&MeshInstance, &Shown)>().iter(world).map(|(instance, shown)| (*instance, shown.0)).collect();
    let nodes = nodes::nodes(world);
    let counts = counts(world).into_iter().collect();
    let meshes = world.get_resource::<Meshes>().map_or(&[][..], |meshes| &meshes.0);
    let triangles = |index: usize| meshes.get(index).map_or(0, |mesh| mesh.indices.len() as u64 / 3);
    let materials = world.get_resource::<Materials>().map_or(&[][..], |materials| &materials.0);
    let images = world.get_resource::<Images>().map_or(&[][..], |images| &images.0);
    let mut used_by = vec![0; materials.len()];
    for (instance, _) in &instances {
        if let Some(count) = used_by.get_mut(instance.material) {
            *count += 1;
        }
    }
    let describe = |(material, used_by): (&crate::asset::Material, usize)| Material {
        name: material.name.clone(),
        looks: text::looks(material),
        used_by,
    };
    Description {
        time: world.get_resource::<Time>().map_or(0.0, |time| time.0),
        nodes,
        materials: materials.iter().zip(used_by).map(describe).collect(),
        meshes: meshes.len(),
        stored_triangles: (0..meshes.len()).map(triangles).sum(),
        drawn_triangles: instances.iter().filter(|(_, shown)| *shown).map(|(instance, _)| triangles(instance.mesh)).sum(),
        images: images.len(),
        counts,
        sky: world.get_resource::<Environment>().map_or([0.0; 3], |environment| environment.sky_radiance.to_array()),
        bounds,
        geometry_bytes: meshes.iter().map(|mesh| (mesh.vertices.len() * 64 + mesh.indices.len() * 4) as u64).sum(),
        texture_bytes: images.iter().map(|image| mip_bytes(image.width, image.height)).sum(),
        timeline: world.get_resource::<Timeline>().map_or_else(Vec::new, |timeline| timeline::events(timeline, materials)),
    }
}

/// Bytes of an image of four bytes a texel with all its levels.
fn mip_bytes(width: u32, height: u32) -> u64 {
    let levels = width.max(height).max(1).ilog2() + 1;
    (0..levels).map(|level| 4 * u64::from((width >> level).max(1)) * u64::from((height >> level).max(1))).sum()
}

#[cfg(test)]
mod tests {
    use luminaire_graph::source::SourceMap;

    use super::*;
    use crate::load_scene_text;

    #[test]
    fn levels_of_images_are_counted() {
        assert_eq!(mip_bytes(1, 1), 4);
        assert_eq!(mip_bytes(4, 2), 4 * (8 + 2 + 1));
    }

    #[test]
    fn the_text_of_a_scene_is_as_expected() {
        let scene = include_str!("fixture.ron");
        let mut world = load_scene_text("fixture.ron", scene, &mut SourceMap::default()).unwrap().world;
        let shown = text(&describe(&mut world));
        assert_eq!(shown, include_str!("fixture.txt"), "\n{shown}");
        assert_eq!(shown, text(&describe(&mut world)));
    }
}
