//! What is hidden, with all that stands below it.
//!
//! Hiding removes nothing: slots, places, animations and what stands in the spatial index stay, so that showing costs as little. Accepted
//! downside: a camera below something hidden still looks, since it shows nothing itself.

use std::collections::HashSet;

use bevy_ecs::prelude::{Added, Changed, Component, Entity, Or, With, World};

use super::{ChildOf, Children};

/// Neither drawn nor throwing shadows nor giving light, and neither is anything below.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Hidden;

/// Whether neither the entity nor anything above it is [`Hidden`]; written by [`propagate_visibility`].
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shown(pub bool);

impl Default for Shown {
    fn default() -> Shown {
        Shown(true)
    }
}

/// Writes every [`Shown`] that is another. Looks only below what was hidden, shown, spawned or got another parent since the world's
/// trackers were cleared ([`super::update`]), and at nothing while nothing is hidden.
pub fn propagate_visibility(world: &mut World) {
    let revealed: Vec<Entity> = world.removed::<Hidden>().filter(|entity| world.get_entity(*entity).is_ok()).collect();
    let none = world.query_filtered::<(), With<Hidden>>().iter(world).next().is_none();
    if none && world.removed::<Hidden>().next().is_none() {
        return;
    }
    type Stale = Or<(Added<Hidden>, Changed<ChildOf>, Added<Shown>)>;
    let mut stale: Vec<Entity> = world.query_filtered::<Entity, Stale>().iter(world).collect();
    stale.extend(revealed);
    stale.extend(world.removed::<ChildOf>().filter(|entity| world.get_entity(*entity).is_ok()));
    // Looked up and never walked.
    let set: HashSet<Entity> = stale.iter().copied().collect();
    let parent = |world: &World, entity: Entity| world.get::<ChildOf>(entity).map(ChildOf::parent);
    let mut stack: Vec<(Entity, bool)> = Vec::new();
    for entity in stale {
        let mut above = std::iter::successors(parent(world, entity), |above| parent(world, *above));
        if !above.clone().any(|above| set.contains(&above)) {
            stack.push((entity, above.all(|above| world.get::<Hidden>(above).is_none())));
        }
    }
    while let Some((entity, above)) = stack.pop() {
        let shown = above && world.get::<Hidden>(entity).is_none();
        if let Some(mut stored) = world.get_mut::<Shown>(entity)
            && stored.0 != shown
        {
            stored.0 = shown;
        }
        if let Some(children) = world.get::<Children>(entity) {
            stack.extend(children.iter().map(|child| (*child, shown)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Transform, new_world, update};

    #[test]
    fn what_is_hidden_hides_all_below_and_nothing_else() {
        let mut world = new_world();
        let root = world.spawn(Transform::default()).id();
        // Without a place, as entities of an application may be.
        let middle = world.spawn(ChildOf(root)).id();
        let leaf = world.spawn((Transform::default(), ChildOf(middle))).id();
        let other = world.spawn(Transform::default()).id();
        let mut shown = |change: &dyn Fn(&mut World)| {
            change(&mut world);
            update(&mut world);
            [root, leaf, other].map(|entity| world.get::<Shown>(entity).is_none_or(|shown| shown.0))
        };
        assert_eq!(shown(&|_| {}), [true, true, true]);
        assert_eq!(shown(&|world| _ = world.entity_mut(middle).insert(Hidden)), [true, false, true]);
        assert_eq!(shown(&|world| _ = world.entity_mut(root).insert(Hidden)), [false, false, true]);
        assert_eq!(shown(&|world| _ = world.entity_mut(middle).remove::<Hidden>()), [false, false, true]);
        assert_eq!(shown(&|world| _ = world.entity_mut(other).insert(ChildOf(leaf))), [false, false, false]);
        assert_eq!(shown(&|world| _ = world.entity_mut(leaf).remove::<ChildOf>()), [false, true, true]);
        assert_eq!(shown(&|world| _ = world.entity_mut(leaf).insert(ChildOf(middle))), [false, false, false]);
        assert_eq!(shown(&|world| _ = world.entity_mut(root).remove::<Hidden>()), [true, true, true]);
        // What hid something, and is gone, hides it no more.
        shown(&|world| _ = world.entity_mut(middle).insert(Hidden));
        let orphan = |world: &mut World| {
            world.entity_mut(leaf).remove::<ChildOf>();
            world.despawn(middle);
        };
        assert_eq!(shown(&orphan), [true, true, true]);
    }
}
