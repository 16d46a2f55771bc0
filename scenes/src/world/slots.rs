//! Stable slots: which row of a published table an entity has.
//!
//! Guarantees: an entity keeps its slot for life, and a spawn or a removal renumbers nobody. A new entity takes the lowest slot
//! that no living entity holds, in the order of entity indices, so equal histories give equal slots.

use bevy_ecs::prelude::{Component, Entity, With, Without, World};

use super::components::{Camera, CameraSlot, DirectionalLight, DirectionalSlot, LocalLight, LocalSlot, MeshInstance, ObjectSlot};

/// Gives a slot to every mesh instance, light and camera that has none.
pub fn assign_slots(world: &mut World) {
    assign::<MeshInstance, ObjectSlot>(world, ObjectSlot, |slot| slot.0);
    assign::<DirectionalLight, DirectionalSlot>(world, DirectionalSlot, |slot| slot.0);
    assign::<LocalLight, LocalSlot>(world, LocalSlot, |slot| slot.0);
    assign::<Camera, CameraSlot>(world, CameraSlot, |slot| slot.0);
}

fn assign<Kind: Component, Slot: Component>(world: &mut World, make: fn(u32) -> Slot, index: fn(&Slot) -> u32) {
    let mut waiting: Vec<Entity> = world.query_filtered::<Entity, (With<Kind>, Without<Slot>)>().iter(world).collect();
    if waiting.is_empty() {
        return;
    }
    waiting.sort_unstable_by_key(|entity| order(*entity));
    let mut held: Vec<u32> = world.query::<&Slot>().iter(world).map(index).collect();
    held.sort_unstable();
    let mut held = held.into_iter().peekable();
    let free = (0..u32::MAX).filter(|slot| {
        while held.next_if(|taken| taken < slot).is_some() {}
        held.peek() != Some(slot)
    });
    for (entity, slot) in waiting.into_iter().zip(free) {
        world.entity_mut(entity).insert(make(slot));
    }
}

/// By what entities are put in order: the index, then how often it was given away.
pub(super) fn order(entity: Entity) -> (u32, u32) {
    (entity.index_u32(), entity.generation().to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::new_world;

    fn spawn(world: &mut World) -> Entity {
        let entity = world.spawn(MeshInstance { mesh: 0, material: 0 }).id();
        assign_slots(world);
        entity
    }

    fn slot(world: &World, entity: Entity) -> u32 {
        world.get::<ObjectSlot>(entity).unwrap().0
    }

    #[test]
    fn a_removal_renumbers_nobody_and_frees_its_slot() {
        let mut world = new_world();
        let [a, b, c] = [spawn(&mut world), spawn(&mut world), spawn(&mut world)];
        assert_eq!([slot(&world, a), slot(&world, b), slot(&world, c)], [0, 1, 2]);
        world.despawn(b);
        let d = spawn(&mut world);
        let e = spawn(&mut world);
        assert_eq!([slot(&world, a), slot(&world, c), slot(&world, d), slot(&world, e)], [0, 2, 1, 3]);
    }

    #[test]
    fn several_new_entities_fill_the_gaps_in_order() {
        let mut world = new_world();
        let all: Vec<Entity> = (0..6).map(|_| spawn(&mut world)).collect();
        for gap in [1, 2, 4] {
            world.despawn(all[gap]);
        }
        let new: Vec<Entity> = (0..4).map(|_| world.spawn(MeshInstance { mesh: 0, material: 0 }).id()).collect();
        assign_slots(&mut world);
        let mut slots: Vec<u32> = new.iter().map(|entity| slot(&world, *entity)).collect();
        slots.sort_unstable();
        assert_eq!(slots, [1, 2, 4, 6]);
    }
}
