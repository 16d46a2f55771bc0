//! From checked parts to entities.

use std::ops::Range;

use bevy_ecs::prelude::{Entity, World};
use glam::{Affine3A, UVec3};

use super::assets::UsedFile;
use super::check::{Controller, Declaration, Kind, Play, Repeat};
use crate::timeline::NodeRef;
use crate::world::{AnimationPlayer, ChildOf, MeshInstance, Name, Transform, assign_slots, spawn_stored};

/// The entities of a declaration.
#[derive(Debug)]
pub(crate) struct Spawned {
    pub(crate) root: Entity,
    /// Per node of a glTF file.
    pub(crate) inside: Vec<Entity>,
}

/// Spawns some declarations, in their order, and puts them below their parents. Meshes and materials are in the world.
pub(crate) fn spawn(
    world: &mut World,
    declarations: &[Declaration],
    range: Range<usize>,
    parents: &[Option<NodeRef>],
    files: &[UsedFile],
    spawned: &mut [Option<Spawned>],
) {
    for index in range.clone() {
        if let (Some(declaration), Some(slot)) = (declarations.get(index), spawned.get_mut(index)) {
            *slot = Some(one(world, declaration, files));
        }
    }
    for index in range {
        let Some(parent) = parents.get(index).copied().flatten() else { continue };
        let entity = |node: NodeRef| {
            let spawned = spawned.get(node.declaration)?.as_ref()?;
            node.inside.map_or(Some(spawned.root), |inner| spawned.inside.get(inner).copied())
        };
        if let (Some(parent), Some(child)) = (entity(parent), entity(NodeRef::of(index)))
            && let Ok(mut child) = world.get_entity_mut(child)
        {
            child.insert(ChildOf(parent));
        }
    }
    assign_slots(world);
}

fn one(world: &mut World, declaration: &Declaration, files: &[UsedFile]) -> Spawned {
    let mut entity = world.spawn((Name::new(declaration.name.value.clone()), Transform(declaration.local)));
    let root = entity.id();
    let mut inside = Vec::new();
    match &declaration.kind {
        Kind::Group => {}
        Kind::Camera { camera, path, controller } => {
            entity.insert(camera.clone());
            if let Some(path) = path {
                entity.insert(path.clone());
            }
            match controller {
                Some(Controller::Fly(fly)) => {
                    entity.insert(*fly);
                }
                Some(Controller::Orbit(orbit)) => {
                    entity.insert(*orbit);
                }
                None => {}
            }
        }
        Kind::Directional(light) => {
            entity.insert(*light);
        }
        Kind::Local(light) => {
            entity.insert(*light);
        }
        Kind::Rectangle { light, mesh, material } => {
            entity.insert((*light, MeshInstance { mesh: *mesh, material: *material }));
        }
        Kind::Object { mesh, material, repeat: None } => {
            entity.insert(MeshInstance { mesh: *mesh, material: *material });
        }
        Kind::Object { mesh, material, repeat: Some(repeat) } => copies(world, root, *mesh, *material, repeat),
        Kind::File(used) => {
            if let Some(UsedFile { asset, play }) = files.get(*used) {
                inside = spawn_stored(world, asset, Some(root));
                if let Some(play) = play {
                    play_clip(world, root, play);
                }
            }
        }
        Kind::ProbeVolume(volume) => {
            entity.insert(*volume);
        }
        Kind::ReflectionProbe(probe) => {
            entity.insert(*probe);
        }
        Kind::Volume(volume) => {
            entity.insert(*volume);
        }
    }
    Spawned { root, inside }
}

/// Plays a clip of the file that was spawned below the entity, and no other.
pub(crate) fn play_clip(world: &mut World, root: Entity, play: &Play) {
    if let Some(mut player) = world.get_mut::<AnimationPlayer>(root) {
        player.playing = vec![play.clip];
        (player.speed, player.start, player.repeat) = (play.speed, play.start, play.repeat);
    }
}

/// Copies on a grid around the parent, x running fastest. They have no names.
fn copies(world: &mut World, parent: Entity, mesh: usize, material: usize, repeat: &Repeat) {
    let middle = (repeat.count.as_vec3() - 1.0) * 0.5;
    for z in 0..repeat.count.z {
        for y in 0..repeat.count.y {
            for x in 0..repeat.count.x {
                let index = UVec3::new(x, y, z);
                let material = repeat.materials.get((x + y + z) as usize % repeat.materials.len().max(1)).copied().unwrap_or(material);
                let local = Affine3A::from_translation((index.as_vec3() - middle) * repeat.spacing);
                world.spawn((Transform(local), MeshInstance { mesh, material }, ChildOf(parent)));
            }
        }
    }
}
