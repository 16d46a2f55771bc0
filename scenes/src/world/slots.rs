//! Stable slots: which row of a published table an entity has.
//!
//! Guarantees: an entity keeps its slot for life, and a spawn or a removal renumbers nobody. A new entity takes the lowest slot
//! that no living entity holds, in the order of entity indices, so equal histories give equal slots.

use std::collections::BTreeSet;
use std::marker::PhantomData;

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::{Component, Entity, Has, Resource, With, Without, World};
use bevy_ecs::world::DeferredWorld;

use super::components::{
    Camera, CameraSlot, DirectionalLight, DirectionalSlot, LocalLight, LocalSlot, MeshInstance, ObjectSlot, PointSlot, ProbeSlot,
    RectangleLight, RectangleSlot, ReflectionProbe, SpotSlot,
};

/// A component that holds a slot.
pub(super) trait Slot: Component + Sized {
    fn new(row: u32) -> Self;
    fn row(&self) -> u32;
}

macro_rules! slot {
    ($($name:ident),*) => {$(
        impl Slot for $name {
            fn new(row: u32) -> Self {
                Self(row)
            }

            fn row(&self) -> u32 {
                self.0
            }
        }
    )*};
}
slot!(ObjectSlot, DirectionalSlot, LocalSlot, PointSlot, SpotSlot, RectangleSlot, ProbeSlot, CameraSlot);

/// Which slots nobody holds.
#[derive(Resource)]
struct Free<Of> {
    /// Below the end.
    gaps: BTreeSet<u32>,
    /// Nobody holds this one or a higher one.
    end: u32,
    of: PhantomData<fn() -> Of>,
}

impl<Of> Default for Free<Of> {
    fn default() -> Free<Of> {
        Free { gaps: BTreeSet::new(), end: 0, of: PhantomData }
    }
}

impl<Of> Free<Of> {
    fn lowest(&self, count: usize) -> Vec<u32> {
        self.gaps.iter().copied().chain(self.end..u32::MAX).take(count).collect()
    }
}

/// What happens when an entity gets a slot.
pub(super) fn take<Of: Slot>(mut world: DeferredWorld<'_>, context: HookContext) {
    let row = world.get::<Of>(context.entity).map(Slot::row);
    if let (Some(row), Some(mut free)) = (row, world.get_resource_mut::<Free<Of>>()) {
        if row < free.end {
            free.gaps.remove(&row);
        } else {
            let end = free.end;
            free.gaps.extend(end..row);
            free.end = row.saturating_add(1);
        }
    }
}

/// What happens when an entity loses its slot.
pub(super) fn give_back<Of: Slot>(mut world: DeferredWorld<'_>, context: HookContext) {
    let row = world.get::<Of>(context.entity).map(Slot::row);
    if let (Some(row), Some(mut free)) = (row, world.get_resource_mut::<Free<Of>>()) {
        free.gaps.insert(row);
        while let Some(last) = free.end.checked_sub(1)
            && free.gaps.remove(&last)
        {
            free.end = last;
        }
    }
}

/// Gives a slot to every mesh instance, light, reflection probe and camera that has none.
pub fn assign_slots(world: &mut World) {
    assign::<MeshInstance, ObjectSlot>(world);
    assign::<DirectionalLight, DirectionalSlot>(world);
    assign::<LocalLight, LocalSlot>(world);
    assign_by_shadow(world);
    assign::<RectangleLight, RectangleSlot>(world);
    assign::<ReflectionProbe, ProbeSlot>(world);
    assign::<Camera, CameraSlot>(world);
}

fn assign<Kind: Component, Of: Slot>(world: &mut World) {
    let waiting = world.query_filtered::<Entity, (With<Kind>, Without<Of>)>().iter(world).collect();
    give::<Of>(world, waiting);
}

/// Point and spot lights have another slot by what kind of shadow map they need, which follows a change of their cone.
fn assign_by_shadow(world: &mut World) {
    let (mut points, mut spots): (Vec<Entity>, Vec<Entity>) = (Vec::new(), Vec::new());
    for (entity, light, is_point, is_spot) in world.query::<(Entity, &LocalLight, Has<PointSlot>, Has<SpotSlot>)>().iter(world) {
        let cube = light.cone.is_none_or(|cone| cone.is_wide());
        match (cube, is_point, is_spot) {
            (true, true, false) | (false, false, true) => {}
            (true, ..) => points.push(entity),
            (false, ..) => spots.push(entity),
        }
    }
    for entity in &points {
        world.entity_mut(*entity).remove::<SpotSlot>();
    }
    for entity in &spots {
        world.entity_mut(*entity).remove::<PointSlot>();
    }
    give::<PointSlot>(world, points);
    give::<SpotSlot>(world, spots);
}

/// Gives each a slot of its own.
fn give<Of: Slot>(world: &mut World, mut waiting: Vec<Entity>) {
    if waiting.is_empty() {
        return;
    }
    waiting.sort_unstable_by_key(|entity| order(*entity));
    let free = world.get_resource_or_init::<Free<Of>>().lowest(waiting.len());
    for (entity, slot) in waiting.into_iter().zip(free) {
        world.entity_mut(entity).insert(Of::new(slot));
    }
}

/// By what entities are put in order: the index, then how often it was given away.
pub(super) fn order(entity: Entity) -> (u32, u32) {
    (entity.index_u32(), entity.generation().to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Cone, new_world};

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
    fn a_light_has_the_slot_of_its_kind_of_shadow() {
        let mut world = new_world();
        let cone = |outer: f32| Some(Cone { inner: 0.0, outer });
        let [a, b, c, d] = [None, cone(0.5), cone(1.5), cone(1.0)]
            .map(|cone| world.spawn(LocalLight { color: glam::Vec3::ONE, intensity: 1.0, range: None, cone }).id());
        let slots =
            |world: &World, entity| (world.get::<PointSlot>(entity).map(|slot| slot.0), world.get::<SpotSlot>(entity).map(|slot| slot.0));
        assign_slots(&mut world);
        assert_eq!([a, b, c, d].map(|entity| slots(&world, entity)), [(Some(0), None), (None, Some(0)), (Some(1), None), (None, Some(1))]);
        world.get_mut::<LocalLight>(b).unwrap().cone = cone(f32::NAN);
        world.get_mut::<LocalLight>(a).unwrap().cone = cone(0.1);
        assign_slots(&mut world);
        assert_eq!([a, b, c, d].map(|entity| slots(&world, entity)), [(None, Some(0)), (Some(0), None), (Some(1), None), (None, Some(1))]);
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
