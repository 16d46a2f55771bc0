//! Nodes, the forest that they form, and the default scene.
//!
//! Guarantees: once read without an error, nodes form a forest, so that everything after may walk it; walks use a stack of their
//! own, so that depth costs no call stack. Transforms are finite.

use glam::{Affine3A, Mat4, Quat, Vec3};

use super::json::Json;
use crate::asset::Pose;

/// A matrix entry beyond this is refused: the square of a product with the largest coordinate would leave 32-bit floats.
pub(super) const LARGEST: f32 = 1e15;

/// How much the last row of a matrix may differ from `0 0 0 1`.
const AFFINE_TOLERANCE: f32 = 1e-4;

/// A checked node. Indices are the file's.
pub(super) struct NodeSource {
    /// The JSON path, for messages.
    pub(super) place: String,
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    pub(super) children: Vec<usize>,
    pub(super) local: Affine3A,
    /// The parts of `local`, unless the file gives a matrix.
    pub(super) pose: Option<Pose>,
    pub(super) mesh: Option<usize>,
    pub(super) skin: Option<usize>,
    pub(super) camera: Option<usize>,
    pub(super) light: Option<usize>,
    /// Morph weights that replace those of the mesh.
    pub(super) weights: Option<Vec<f32>>,
}

/// How many of each thing nodes may refer to.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    pub(super) meshes: usize,
    pub(super) skins: usize,
    pub(super) cameras: usize,
    pub(super) lights: usize,
}

/// Checks every node and their hierarchy.
pub(super) fn read_nodes(root: &Json<'_>, counts: Counts) -> Vec<NodeSource> {
    let list = root.objects("nodes");
    let mut nodes: Vec<NodeSource> = list.iter().enumerate().map(|(index, json)| read_node(json, index, counts, list.len())).collect();
    link_parents(&mut nodes, root);
    nodes
}

fn read_node(json: &Json<'_>, index: usize, counts: Counts, nodes: usize) -> NodeSource {
    let children = json.list("children").iter().filter_map(|child| child.as_index("nodes", nodes)).collect();
    let light = json.extension("KHR_lights_punctual").and_then(|extension| extension.required_index("light", "lights", counts.lights));
    let weights = json.has("weights").then(|| json.list("weights").iter().filter_map(Json::as_number).collect());
    let (local, pose) = read_transform(json);
    NodeSource {
        place: json.place().to_owned(),
        name: json.name_or("node", index),
        parent: None,
        children,
        local,
        pose,
        mesh: json.index("mesh", "meshes", counts.meshes),
        skin: json.index("skin", "skins", counts.skins),
        camera: json.index("camera", "cameras", counts.cameras),
        light,
        weights,
    }
}

fn read_transform(json: &Json<'_>) -> (Affine3A, Option<Pose>) {
    if json.has("matrix") {
        return (read_matrix(json).unwrap_or(Affine3A::IDENTITY), None);
    }
    let translation = json.numbers("translation").map_or(Vec3::ZERO, Vec3::from_array);
    let scale = json.numbers("scale").map_or(Vec3::ONE, Vec3::from_array);
    let rotation = json.numbers("rotation").map_or(Quat::IDENTITY, |xyzw| {
        unit_quaternion(xyzw).unwrap_or_else(|| {
            json.warning_at("rotation", "gltf::rotation", "a quaternion of length 0 is no rotation, and taken as none");
            Quat::IDENTITY
        })
    });
    let pose = Pose { translation, rotation, scale };
    (pose.matrix(), Some(pose))
}

fn read_matrix(json: &Json<'_>) -> Option<Affine3A> {
    let matrix = Mat4::from_cols_array(&json.numbers::<16>("matrix")?);
    if !matrix.row(3).abs_diff_eq(glam::Vec4::W, AFFINE_TOLERANCE) {
        json.error_at("matrix", "gltf::matrix", format_args!("its last row must be 0 0 0 1, found {}", matrix.row(3)));
        return None;
    }
    Some(Affine3A::from_mat4(matrix))
}

/// The quaternion at unit length; `None` if it has no length.
pub(super) fn unit_quaternion([x, y, z, w]: [f32; 4]) -> Option<Quat> {
    // In 64 bits, so that a long quaternion does not overflow.
    let quaternion = glam::DQuat::from_xyzw(x.into(), y.into(), z.into(), w.into());
    (quaternion.length() > f64::from(f32::MIN_POSITIVE)).then(|| quaternion.normalize().as_quat())
}

/// Fills in the parents, and reports whatever is not a forest.
fn link_parents(nodes: &mut [NodeSource], root: &Json<'_>) {
    let edges: Vec<(usize, usize)> =
        nodes.iter().enumerate().flat_map(|(parent, node)| node.children.iter().map(move |child| (parent, *child))).collect();
    let mut forest = true;
    for (parent, child) in edges {
        let Some(node) = nodes.get_mut(child) else { continue };
        match node.parent {
            None => node.parent = Some(parent),
            Some(first) => {
                let problem = format!("is a child of nodes[{first}] and again of nodes[{parent}]; a node has one parent");
                let hint = "copy the node, so that each parent has its own";
                root.report().error("gltf::node-two-parents", &node.place, problem, hint);
                forest = false;
            }
        }
    }
    if !forest {
        return;
    }
    // With one parent each, whatever can't be reached from a root lies on or below a cycle.
    let roots: Vec<usize> = nodes.iter().enumerate().filter(|(_, node)| node.parent.is_none()).map(|(index, _)| index).collect();
    let mut reached = vec![false; nodes.len()];
    for index in walk(nodes, &roots) {
        if let Some(reached) = reached.get_mut(index) {
            *reached = true;
        }
    }
    if let Some(index) = reached.iter().position(|reached| !reached)
        && let Some(node) = nodes.get(index)
    {
        root.report().error("gltf::node-cycle", &node.place, "is its own ancestor, or below a node that is", "break the cycle of children");
    }
}

/// The nodes below the roots, parents first, children in the order of the file. The nodes must form a forest.
pub(super) fn walk(nodes: &[NodeSource], roots: &[usize]) -> Vec<usize> {
    let mut order = Vec::new();
    let mut stack: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(index) = stack.pop() {
        let Some(node) = nodes.get(index) else { continue };
        order.push(index);
        stack.extend(node.children.iter().rev());
    }
    order
}

/// The roots of the default scene. `None` where there is none.
pub(super) fn default_scene(root: &Json<'_>, nodes: &[NodeSource]) -> Option<Vec<usize>> {
    let scenes: Vec<Vec<usize>> = root.objects("scenes").iter().map(|scene| read_scene(scene, nodes)).collect();
    let chosen = if root.has("scene") { root.index("scene", "scenes", scenes.len())? } else { 0 };
    scenes.into_iter().nth(chosen)
}

fn read_scene(scene: &Json<'_>, nodes: &[NodeSource]) -> Vec<usize> {
    let mut roots = Vec::new();
    let mut seen = std::collections::BTreeSet::new();
    for entry in scene.list("nodes") {
        let Some(index) = entry.as_index("nodes", nodes.len()) else { continue };
        if !seen.insert(index) {
            entry.error("gltf::scene-root", format_args!("names nodes[{index}] twice"));
        } else if let Some(parent) = nodes.get(index).and_then(|node| node.parent) {
            entry.error("gltf::scene-root", format_args!("nodes[{index}] is a child of nodes[{parent}]; a scene lists only roots"));
        } else {
            roots.push(index);
        }
    }
    roots
}

/// The transform of every node to the scene's space.
pub(super) fn global_transforms(nodes: &[NodeSource]) -> Vec<Affine3A> {
    let roots: Vec<usize> = nodes.iter().enumerate().filter(|(_, node)| node.parent.is_none()).map(|(index, _)| index).collect();
    let mut globals = vec![Affine3A::IDENTITY; nodes.len()];
    for index in walk(nodes, &roots) {
        let Some(node) = nodes.get(index) else { continue };
        let parent = node.parent.and_then(|parent| globals.get(parent)).copied().unwrap_or(Affine3A::IDENTITY);
        if let Some(global) = globals.get_mut(index) {
            *global = parent * node.local;
        }
    }
    globals
}

/// Whether all entries are finite, with room for products.
pub(super) fn is_usable(transform: &Affine3A) -> bool {
    transform.to_cols_array().iter().all(|entry| entry.abs() <= LARGEST)
}
