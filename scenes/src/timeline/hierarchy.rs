//! Nodes that disappear and nodes that get another parent.

use bevy_ecs::prelude::{Entity, World};
use glam::Affine3A;
use luminaire_graph::diagnostic::Diagnostic;

use super::property::rotation_and_scale;
use crate::asset::Pose;
use crate::world::{ChildOf, Children, RestPose, Transform};

/// How many levels are despawned at once: the library goes down by recursion.
const LEVELS: usize = 64;

/// Despawns an entity and all below it, however deep.
pub(super) fn remove(world: &mut World, root: Entity) {
    let mut level = vec![root];
    let mut cuts = vec![root];
    for depth in 1_usize.. {
        level = level.iter().filter_map(|entity| world.get::<Children>(*entity)).flat_map(|children| children.iter().copied()).collect();
        if level.is_empty() {
            break;
        }
        if depth % LEVELS == 0 {
            cuts.extend(&level);
        }
    }
    for entity in cuts.into_iter().rev() {
        world.despawn(entity);
    }
}

/// Gives an entity another parent. With `keep_place` it stays where it is in the world, else beside its parent.
/// Errors: the new parent has no extent along some direction, so that nothing can keep its place below it.
pub(super) fn reparent(world: &mut World, name: &str, entity: Entity, parent: Option<Entity>, keep_place: bool) -> Result<(), Diagnostic> {
    let below = parent.map_or(Affine3A::IDENTITY, |parent| global(world, parent));
    if keep_place {
        let local = below.inverse() * global(world, entity);
        if !local.is_finite() {
            return Err(Diagnostic::error(
                "world::flat-parent",
                format!("`{name}` can't keep its place below a parent whose scale is zero"),
            )
            .hint("let it take its place from the parent, with `keep_place: false`"));
        }
        if let Some(mut transform) = world.get_mut::<Transform>(entity) {
            transform.0 = local;
        }
        if let (Some((rotation, scale)), Some(mut rest)) = (rotation_and_scale(world, entity), world.get_mut::<RestPose>(entity)) {
            rest.0 = Pose { translation: local.translation.into(), rotation, scale };
        }
    }
    let mut entity = world.entity_mut(entity);
    match parent {
        Some(parent) => entity.insert(ChildOf(parent)),
        None => entity.remove::<ChildOf>(),
    };
    Ok(())
}

/// The product of the transforms above and at the entity.
fn global(world: &World, entity: Entity) -> Affine3A {
    let above = std::iter::successors(Some(entity), |entity| world.get::<ChildOf>(*entity).map(ChildOf::parent));
    above.filter_map(|entity| world.get::<Transform>(entity)).fold(Affine3A::IDENTITY, |below, transform| transform.0 * below)
}
