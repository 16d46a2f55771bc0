//! From an asset to entities.

use std::ops::Range;
use std::sync::Arc;

use bevy_ecs::prelude::{Entity, World};
use glam::{Affine3A, Vec3};

use super::animation::driven_nodes;
use super::glow::{Panel, light, panel};
use super::{
    AnimationPlayer, Camera, ChildOf, Cone, DirectionalLight, Exposure, Images, LocalLight, Materials, MeshInstance, Meshes, Name,
    RestPose, Transform, assign_slots,
};
use crate::asset::{Animation, Asset, Light, LightKind, Material, Node, TextureUse};

/// An asset whose meshes, materials and images are in a world, ready to be spawned any number of times.
#[derive(Debug, Clone)]
pub struct StoredAsset {
    nodes: Arc<[Node]>,
    /// Indices of nodes by their names, then by themselves.
    by_name: Arc<[usize]>,
    lights: Vec<Light>,
    cameras: Vec<crate::asset::Camera>,
    animations: Arc<[Animation]>,
    first_mesh: usize,
    /// Per mesh of the asset, its material in the world.
    mesh_materials: Vec<usize>,
    /// Per mesh of the asset, the rectangle that it is, if it is one.
    panels: Arc<[Option<Panel>]>,
    /// Rows of its materials in the world, in its own order.
    materials: Range<usize>,
}

impl StoredAsset {
    /// Its nodes, in the order in which they are spawned.
    pub(crate) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The nodes of a name.
    pub(crate) fn named(&self, name: &str) -> &[usize] {
        let is = |index: &usize| self.nodes.get(*index).map(|node| node.name.as_str());
        let first = self.by_name.partition_point(|index| is(index) < Some(name));
        let last = self.by_name.partition_point(|index| is(index) <= Some(name));
        self.by_name.get(first..last).unwrap_or_default()
    }

    /// The mesh in the world of each entity that shows one, in the order in which they are spawned.
    pub(crate) fn mesh_rows(&self) -> impl Iterator<Item = usize> + Clone {
        self.nodes.iter().flat_map(|node| &node.meshes).map(|mesh| self.first_mesh + mesh)
    }

    /// Its animations, in the order of the file.
    pub(crate) fn animations(&self) -> &[Animation] {
        &self.animations
    }

    /// Rows of its materials in the world.
    pub(crate) fn materials(&self) -> Range<usize> {
        self.materials.clone()
    }

    /// The same asset with other materials of its own: `change` makes the new one of an old one, or leaves it.
    pub(crate) fn with_materials(&self, world: &mut World, mut change: impl FnMut(&Material) -> Option<Material>) -> StoredAsset {
        let materials = &mut world.get_resource_or_init::<Materials>().0;
        let first = materials.len();
        let own: Vec<Material> = materials.get(self.materials.clone()).unwrap_or_default().to_vec();
        materials.extend(own.into_iter().map(|material| change(&material).unwrap_or(material)));
        let moved = |material: &usize| material - self.materials.start + first;
        StoredAsset { mesh_materials: self.mesh_materials.iter().map(moved).collect(), materials: first..materials.len(), ..self.clone() }
    }
}

/// Moves an asset's meshes, materials and images into the world and returns the rest.
pub fn store_asset(world: &mut World, asset: Asset) -> StoredAsset {
    let first_image = append(&mut world.get_resource_or_init::<Images>().0, asset.images);
    let materials = asset.materials.into_iter().map(|material| shift_images(material, first_image)).collect();
    let rows = &mut world.get_resource_or_init::<Materials>().0;
    let first_material = append(rows, materials);
    let materials = first_material..rows.len();
    let mut meshes = asset.meshes;
    for mesh in &mut meshes {
        mesh.material += first_material;
    }
    let mesh_materials = meshes.iter().map(|mesh| mesh.material).collect();
    let panels = meshes.iter().map(panel).collect();
    let first_mesh = append(&mut world.get_resource_or_init::<Meshes>().0, meshes);
    let animations = asset.animations.into();
    let nodes: Arc<[Node]> = asset.nodes.into();
    let mut by_name: Vec<usize> = (0..nodes.len()).collect();
    by_name.sort_by_key(|index| &nodes[*index].name);
    StoredAsset {
        by_name: by_name.into(),
        nodes,
        lights: asset.lights,
        cameras: asset.cameras,
        animations,
        first_mesh,
        mesh_materials,
        panels,
        materials,
    }
}

/// Spawns a copy of the asset's nodes below `parent` (or at the root) and returns an entity per node, in the asset's order.
/// Meshes become children of their node, one each, without a name, and get a child that is a light where they are glowing rectangles
/// (see [`super::RectangleLight`]); lights and cameras stand on the node itself. If the asset has
/// animations, `parent` gets an [`AnimationPlayer`], or an entity of its own does where there is no parent or it has one already.
pub fn spawn_stored(world: &mut World, asset: &StoredAsset, parent: Option<Entity>) -> Vec<Entity> {
    let mut entities: Vec<Entity> = Vec::with_capacity(asset.nodes.len());
    for node in asset.nodes.iter() {
        let mut entity = world.spawn((Name::new(node.name.clone()), Transform(node.local)));
        if let Some(above) = node.parent.and_then(|index| entities.get(index).copied()).or(parent) {
            entity.insert(ChildOf(above));
        }
        match node.light.and_then(|index| asset.lights.get(index)) {
            Some(Light { kind: LightKind::Directional, color, intensity, .. }) => {
                entity.insert(DirectionalLight { color: Vec3::from(*color), illuminance: *intensity });
            }
            Some(Light { kind, color, intensity, range, .. }) => {
                let cone = match kind {
                    LightKind::Spot { inner, outer } => Some(Cone { inner: *inner, outer: *outer }),
                    LightKind::Point | LightKind::Directional => None,
                };
                entity.insert(LocalLight { color: Vec3::from(*color), intensity: *intensity, range: *range, cone });
            }
            None => {}
        }
        if let Some(camera) = node.camera.and_then(|index| asset.cameras.get(index)) {
            entity.insert(Camera { name: camera.name.clone(), projection: camera.projection, exposure: Exposure::Unchanged });
        }
        let entity = entity.id();
        for mesh in &node.meshes {
            if let Some(material) = asset.mesh_materials.get(*mesh) {
                let instance = MeshInstance { mesh: asset.first_mesh + mesh, material: *material };
                let shown = world.spawn((Transform(Affine3A::IDENTITY), instance, ChildOf(entity))).id();
                let glow = asset.panels.get(*mesh).copied().flatten().and_then(|panel| {
                    let material = world.get_resource::<Materials>()?.0.get(*material)?;
                    Some((Transform(panel.place), light(material, panel.size)?))
                });
                if let Some(glow) = glow {
                    world.spawn((glow, ChildOf(shown)));
                }
            }
        }
        entities.push(entity);
    }
    if !asset.animations.is_empty() {
        spawn_player(world, asset, &entities, parent);
    }
    assign_slots(world);
    entities
}

/// Adds the player. `entities` has one for each node.
fn spawn_player(world: &mut World, asset: &StoredAsset, entities: &[Entity], parent: Option<Entity>) {
    let mut driven = Vec::new();
    for node in driven_nodes(&asset.animations) {
        let pose = asset.nodes.get(node).and_then(|node| node.pose);
        if let (Some(pose), Some(entity)) = (pose, entities.get(node)) {
            world.entity_mut(*entity).insert(RestPose(pose));
            driven.push((node, *entity));
        }
    }
    let player = AnimationPlayer::new(asset.animations.clone(), driven);
    let stand = match parent {
        Some(parent) if world.get::<AnimationPlayer>(parent).is_none() => parent,
        Some(parent) => world.spawn(ChildOf(parent)).id(),
        None => world.spawn_empty().id(),
    };
    world.entity_mut(stand).insert(player);
}

/// Stores an asset and spawns it once, below an own root with the transform `parent` unless that is the identity.
pub fn spawn_asset(world: &mut World, asset: &Asset, parent: Affine3A) -> Vec<Entity> {
    let stored = store_asset(world, asset.clone());
    let root = (parent != Affine3A::IDENTITY).then(|| world.spawn(Transform(parent)).id());
    spawn_stored(world, &stored, root)
}

/// Appends and returns the index of the first new element.
fn append<T>(list: &mut Vec<T>, mut new: Vec<T>) -> usize {
    let first = list.len();
    list.append(&mut new);
    first
}

fn shift_images(material: Material, first_image: usize) -> Material {
    let shift = |texture: Option<TextureUse>| texture.map(|texture| TextureUse { image: texture.image + first_image, ..texture });
    Material {
        base_color_texture: shift(material.base_color_texture),
        metallic_roughness_texture: shift(material.metallic_roughness_texture),
        normal_texture: shift(material.normal_texture),
        occlusion_texture: shift(material.occlusion_texture),
        emissive_texture: shift(material.emissive_texture),
        specular_texture: shift(material.specular_texture),
        specular_color_texture: shift(material.specular_color_texture),
        ..material
    }
}
