//! From checked parts to an [`Asset`]: the default scene alone, everything numbered anew.
//!
//! Guarantees: whatever the scene does not use is left out (nodes, meshes, materials, images, lights, cameras, channels of
//! animations), so that a broken image that nothing shows costs nothing. A mesh that several nodes use stands once, unless they
//! morph or skin it differently. A skinned mesh hangs from a node of its own at the root, in the scene's space.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use glam::Affine3A;

use super::Parts;
use super::geometry::{self, Shape};
use super::image;
use super::keys;
use super::material::{MaterialSource, textures_mut};
use super::node;
use super::report::Report;
use super::skin;
use super::topology::Budget;
use super::uri::Folder;
use crate::asset::{Asset, Mesh, Node};

/// A mesh as a node shows it: mesh, bits of the node's own morph weights, and the skin.
type Variant = (usize, Option<Vec<u32>>, Option<usize>);

struct Builder<'p> {
    parts: &'p Parts<'p>,
    report: &'p Report,
    asset: Asset,
    budget: Budget,
    variants: BTreeMap<Variant, Vec<usize>>,
    materials: BTreeMap<Option<usize>, usize>,
    joints: BTreeMap<usize, Option<Rc<[Affine3A]>>>,
    /// The file's index of each image of the asset.
    images: Vec<usize>,
}

/// Builds the asset. Problems are in the report; the result counts only if it has no errors.
pub(super) fn build(parts: &Parts<'_>, folder: &Folder, report: &Report) -> Asset {
    let mut builder = Builder {
        parts,
        report,
        asset: Asset::default(),
        budget: Budget::new(),
        variants: BTreeMap::new(),
        materials: BTreeMap::new(),
        joints: BTreeMap::new(),
        images: Vec::new(),
    };
    builder.add_nodes();
    let used: Vec<_> = builder.images.iter().filter_map(|index| parts.images.get(*index)?.as_ref()).collect();
    if !report.has_errors() {
        builder.asset.images = image::decode(&used, folder, report);
    }
    builder.asset
}

impl<'p> Builder<'p> {
    fn add_nodes(&mut self) {
        let parts = self.parts;
        let globals = node::global_transforms(&parts.nodes);
        let mut numbers: BTreeMap<usize, usize> = BTreeMap::new();
        let (mut lights, mut cameras) = (BTreeMap::new(), BTreeMap::new());
        let (mut skinned, mut skins) = (Vec::new(), BTreeSet::new());
        for index in node::walk(&parts.nodes, &parts.scene) {
            let Some(source) = parts.nodes.get(index) else { continue };
            if !globals.get(index).is_some_and(node::is_usable) {
                let problem = "its transform to the scene is not finite or too large";
                self.report.error(
                    "gltf::transform",
                    &source.place,
                    problem,
                    "check the scales and translations of the node and its parents",
                );
                continue;
            }
            let mut node = Node {
                name: source.name.clone(),
                parent: source.parent.and_then(|parent| numbers.get(&parent).copied()),
                local: source.local,
                pose: source.pose,
                meshes: Vec::new(),
                light: source.light.and_then(|light| renumber(light, &parts.lights, &mut lights, &mut self.asset.lights)),
                camera: source.camera.and_then(|camera| renumber(camera, &parts.cameras, &mut cameras, &mut self.asset.cameras)),
            };
            if source.mesh.is_some() {
                let meshes = self.add_mesh(index, &globals);
                // A skin places its mesh by itself, if the mesh has joints.
                let influenced =
                    |mesh: usize| parts.meshes.get(mesh).is_some_and(|mesh| mesh.primitives.iter().any(|p| !p.influences.is_empty()));
                if source.skin.is_some() && source.mesh.is_some_and(influenced) {
                    skins.extend(source.skin);
                    skinned.push((source.name.clone(), meshes));
                } else {
                    node.meshes = meshes;
                }
            }
            numbers.insert(index, self.asset.nodes.len());
            self.asset.nodes.push(node);
        }
        for (name, meshes) in skinned.into_iter().filter(|(_, meshes)| !meshes.is_empty()) {
            let name = format!("{name} (skinned)");
            self.asset.nodes.push(Node { name, parent: None, local: Affine3A::IDENTITY, pose: None, meshes, light: None, camera: None });
        }
        self.asset.animations = keys::build(&parts.animations, &numbers, &mut self.budget, self.report);
        self.warn_of_moving_joints(&skins, &numbers);
    }

    /// Says so if an animation moves a joint, or a node above one.
    fn warn_of_moving_joints(&self, skins: &BTreeSet<usize>, numbers: &BTreeMap<usize, usize>) {
        let mut moving = vec![false; self.asset.nodes.len()];
        for channel in self.asset.animations.iter().flat_map(|animation| &animation.channels) {
            if let Some(moving) = moving.get_mut(channel.node) {
                *moving = true;
            }
        }
        for (index, node) in self.asset.nodes.iter().enumerate() {
            // Parents come first.
            let is_above = node.parent.and_then(|parent| moving.get(parent)) == Some(&true);
            if let Some(moving) = moving.get_mut(index) {
                *moving |= is_above;
            }
        }
        let is_moving = |joint: &usize| numbers.get(joint).and_then(|number| moving.get(*number)) == Some(&true);
        let skin = skins.iter().filter_map(|skin| self.parts.skins.get(*skin)).find(|skin| skin.joints.iter().any(is_moving));
        if let Some(skin) = skin {
            let problem = "an animation moves its joints, and skins are not played; the mesh stays in its pose at rest";
            self.report.warning("gltf::animated-skin", &skin.place, problem, "");
        }
    }

    /// The asset's meshes for the mesh of a node.
    fn add_mesh(&mut self, node: usize, globals: &[Affine3A]) -> Vec<usize> {
        let parts = self.parts;
        let Some(node) = parts.nodes.get(node) else { return Vec::new() };
        let Some((index, source)) = node.mesh.and_then(|index| Some((index, parts.meshes.get(index)?))) else { return Vec::new() };
        let weights = node.weights.as_ref().unwrap_or(&source.weights);
        let own_weights = node.weights.as_ref().map(|weights| weights.iter().map(|weight| weight.to_bits()).collect());
        let variant: Variant = (index, own_weights, node.skin);
        if let Some(known) = self.variants.get(&variant) {
            return known.clone();
        }
        let joints = match node.skin {
            Some(skin) => match self.joints(skin, globals) {
                Some(joints) => Some(joints),
                None => return Vec::new(),
            },
            None => None,
        };
        let shape = Shape { weights, joints: joints.as_deref() };
        let mut meshes = Vec::new();
        for (number, primitive) in source.primitives.iter().enumerate() {
            let standard = MaterialSource::standard();
            let material = primitive.material.and_then(|material| parts.materials.get(material)).unwrap_or(&standard);
            let Some(geometry) = geometry::build(primitive, material, shape, &mut self.budget, self.report) else { continue };
            let material = self.add_material(primitive.material, material);
            let name = if source.primitives.len() == 1 { source.name.clone() } else { format!("{} {number}", source.name) };
            meshes.push(self.asset.meshes.len());
            self.asset.meshes.push(Mesh { name, vertices: geometry.vertices, indices: geometry.indices, material });
        }
        self.variants.insert(variant, meshes.clone());
        meshes
    }

    /// The joint matrices of a skin, worked out once.
    fn joints(&mut self, index: usize, globals: &[Affine3A]) -> Option<Rc<[Affine3A]>> {
        let skin = self.parts.skins.get(index)?;
        let report = self.report;
        self.joints.entry(index).or_insert_with(|| skin::joint_matrices(skin, globals, report).map(Rc::from)).clone()
    }

    fn add_material(&mut self, index: Option<usize>, source: &MaterialSource) -> usize {
        if let Some(known) = self.materials.get(&index) {
            return *known;
        }
        let mut material = source.material.clone();
        for texture in textures_mut(&mut material).into_iter().flatten() {
            texture.image = match self.images.iter().position(|image| *image == texture.image) {
                Some(known) => known,
                None => {
                    self.images.push(texture.image);
                    self.images.len() - 1
                }
            };
        }
        let number = self.asset.materials.len();
        self.asset.materials.push(material);
        self.materials.insert(index, number);
        number
    }
}

/// The asset's index of a thing, which is copied on first use.
fn renumber<T: Clone>(index: usize, sources: &[Option<T>], known: &mut BTreeMap<usize, usize>, list: &mut Vec<T>) -> Option<usize> {
    if let Some(number) = known.get(&index) {
        return Some(*number);
    }
    list.push(sources.get(index)?.clone()?);
    known.insert(index, list.len() - 1);
    Some(list.len() - 1)
}
