//! From local transforms to world space.

use std::collections::HashSet;

use bevy_ecs::prelude::{Changed, Entity, Or, World};
use glam::Affine3A;

use super::{ChildOf, Children, GlobalTransform, Transform};

/// Writes every [`GlobalTransform`] that differs from the product of the transforms above it. Entities without a
/// [`Transform`] in between count as the identity. Looks only below what moved, or got another parent, since the world's trackers were
/// cleared ([`super::update`]).
pub fn propagate_transforms(world: &mut World) {
    let mut moved: Vec<Entity> = world.query_filtered::<Entity, Or<(Changed<Transform>, Changed<ChildOf>)>>().iter(world).collect();
    moved.extend(world.removed::<ChildOf>().chain(world.removed::<Transform>()).filter(|entity| world.get_entity(*entity).is_ok()));
    // Looked up and never walked.
    let set: HashSet<Entity> = moved.iter().copied().collect();
    let parent = |world: &World, entity: Entity| world.get::<ChildOf>(entity).map(ChildOf::parent);
    let mut stack: Vec<(Entity, Affine3A)> = Vec::new();
    for entity in moved {
        let above = std::iter::successors(parent(world, entity), |above| parent(world, *above));
        if above.clone().any(|above| set.contains(&above)) {
            continue;
        }
        // Nothing above it moved, so that the nearest place above it is up to date.
        let place = above.into_iter().find(|above| world.get::<Transform>(*above).is_some());
        let place = place.and_then(|above| world.get::<GlobalTransform>(above)).map_or(Affine3A::IDENTITY, |global| global.0);
        stack.push((entity, place));
    }
    while let Some((entity, parent)) = stack.pop() {
        let local = world.get::<Transform>(entity).map(|transform| transform.0);
        let global = local.map_or(parent, |local| parent * local);
        if local.is_some()
            && let Some(mut stored) = world.get_mut::<GlobalTransform>(entity)
            && stored.0 != global
        {
            stored.0 = global;
        }
        if let Some(children) = world.get::<Children>(entity) {
            stack.extend(children.iter().copied().map(|child| (child, global)));
        }
    }
}

/// Writes the [`Transform`] of an entity that has one if it differs in any bit.
pub(super) fn place(world: &mut World, entity: Entity, local: Affine3A) {
    let bits = |transform: &Affine3A| transform.to_cols_array().map(f32::to_bits);
    if let Some(mut stored) = world.get_mut::<Transform>(entity)
        && bits(&stored.0) != bits(&local)
    {
        stored.0 = local;
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};

    use super::*;
    use crate::world::new_world;

    #[test]
    fn products_go_down_the_hierarchy() {
        let mut world = new_world();
        let parent = Affine3A::from_scale_rotation_translation(Vec3::new(2.0, -1.0, 1.0), Quat::from_rotation_y(1.0), Vec3::X);
        let child = Affine3A::from_translation(Vec3::new(0.0, 3.0, 0.0));
        let root = world.spawn(Transform(parent)).id();
        let middle = world.spawn(ChildOf(root)).id();
        let leaf = world.spawn((Transform(child), ChildOf(middle))).id();
        propagate_transforms(&mut world);
        assert_eq!(world.get::<GlobalTransform>(root).unwrap().0, parent);
        assert_eq!(world.get::<GlobalTransform>(leaf).unwrap().0, parent * child);
        assert!(world.get::<GlobalTransform>(leaf).unwrap().0.matrix3.determinant() < 0.0);
    }
}
