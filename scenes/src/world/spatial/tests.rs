//! Answers of the index against a look at everything.

use glam::Affine3A;
use proptest::prelude::*;

use super::*;
use crate::primitive::cuboid;
use crate::world::{ChildOf, MeshInstance, Meshes, Transform, new_world, update};

fn box_at(world: &mut World, at: Vec3) -> Entity {
    world.spawn((Transform(Affine3A::from_translation(at)), MeshInstance { mesh: 0, material: 0 })).id()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Spawns, moves and removals against a look at everything.
    #[test]
    fn answers_are_those_of_a_look_at_everything(
        steps in prop::collection::vec((0_u8..4, 0_usize..40, prop::array::uniform3(-9.0_f32..9.0)), 1..120),
        center in prop::array::uniform3(-9.0_f64..9.0),
        radius in 0.0_f64..8.0,
    ) {
        let mut world = new_world();
        world.resource_mut::<Meshes>().0.push(cuboid("box", Vec3::ONE, 0));
        // Enough that few changes are made in the tree that stands.
        let grid = (0..3 * FEW).map(|index| Vec3::new((index % 20) as f32 - 10.0, 0.0, (index / 20) as f32 - 10.0));
        let mut boxes: Vec<Entity> = grid.map(|at| box_at(&mut world, at)).collect();
        let center = DVec3::from_array(center);
        for (what, which, at) in steps {
            let at = Vec3::from_array(at);
            let which = (!boxes.is_empty()).then(|| which % boxes.len().max(1));
            match (what, which) {
                (0, Some(which)) => _ = world.despawn(boxes.remove(which)),
                (1, Some(which)) => world.get_mut::<Transform>(boxes[which]).unwrap().0.translation = at.into(),
                _ => boxes.push(box_at(&mut world, at)),
            }
            if what > 0 {
                update(&mut world);
            }
            if what > 1 {
                world.resource_mut::<SpatialIndex>().in_sphere(Kind::Object, center, radius);
            }
        }
        update(&mut world);
        let bounds: Vec<(Entity, Aabb)> =
            world.query::<(Entity, &WorldBounds)>().iter(&world).map(|(entity, bounds)| (entity, bounds.bounds.unwrap())).collect();
        let mut index = world.resource_mut::<SpatialIndex>();
        let near = bounds.iter().filter(|(_, bounds)| bounds.distance_squared(center) <= radius * radius);
        prop_assert_eq!(index.in_sphere(Kind::Object, center, radius), sorted(near.map(|(entity, _)| *entity)));
        let nearest = bounds.iter().map(|(_, bounds)| bounds.distance_squared(center).sqrt()).fold(f64::INFINITY, f64::min);
        let found = index.nearest(Kind::Object, center, 1);
        prop_assert_eq!(found.is_empty(), bounds.is_empty());
        prop_assert!(found.iter().all(|(_, distance)| (distance - nearest).abs() < 1e-4));
    }
}

/// Markers of all kinds, everywhere, under parents that turn and stretch them.
fn change(world: &mut World, things: &mut Vec<Entity>, (what, which, at, angle): (u8, usize, [f32; 3], f32)) {
    let some = (!things.is_empty()).then(|| things[which % things.len().max(1)]);
    let turned = Affine3A::from_rotation_z(angle) * Affine3A::from_rotation_x(1.0);
    let place = Transform(Affine3A::from_translation(Vec3::from(at)) * turned * Affine3A::from_scale(Vec3::new(1.0, 0.5, 2.0)));
    let size = Vec3::from(at).abs();
    match (what, some) {
        (0, Some(thing)) => {
            world.despawn(thing);
            things.retain(|other| world.get_entity(*other).is_ok());
        }
        (1, Some(thing)) => *world.get_mut::<Transform>(thing).unwrap() = place,
        (2, Some(thing)) if thing != things[0] => _ = world.entity_mut(thing).insert(ChildOf(things[0])),
        (3, Some(thing)) => _ = world.entity_mut(thing).remove::<ChildOf>(),
        (4, Some(thing)) => _ = world.entity_mut(thing).remove::<Volume>(),
        (5, Some(thing)) => _ = world.entity_mut(thing).insert(Volume { size }),
        (6, _) => things.push(world.spawn((place, Volume { size })).id()),
        (7, _) => things.push(world.spawn((place, ReflectionProbe { size, near: 0.1, far: 10.0 })).id()),
        (8, _) => {
            let counts = glam::UVec3::new(1 + which as u32 % 3, 2, 1);
            things.push(world.spawn((place, ProbeVolume { counts, spacing: size })).id());
        }
        _ => things.push(box_at(world, Vec3::from(at))),
    }
}

fn boxes_of<Of: Marker>(world: &mut World) -> Vec<(Entity, OrientedBox)> {
    let mut query = world.query::<(Entity, &Of, &GlobalTransform)>();
    query.iter(world).map(|(entity, marker, place)| (entity, OrientedBox::new(marker.size(), place.0).unwrap())).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// What volumes hold and which markers are near, after moves, removals, other sizes and other parents.
    #[test]
    fn markers_are_found_as_by_a_look_at_everything(
        steps in prop::collection::vec((0_u8..12, 0_usize..40, prop::array::uniform3(-6.0_f32..6.0), -3.0_f32..3.0), 1..80),
        center in prop::array::uniform3(-6.0_f64..6.0),
        radius in 0.0_f64..3.0,
    ) {
        let mut world = new_world();
        world.resource_mut::<Meshes>().0.push(cuboid("box", Vec3::ONE, 0));
        let (mut things, center) = (Vec::new(), DVec3::from_array(center));
        for (step, entry) in steps.into_iter().enumerate() {
            change(&mut world, &mut things, entry);
            if step % 3 > 0 {
                update(&mut world);
                world.resource_mut::<SpatialIndex>().nearest(Kind::Volume, center, 1);
            }
        }
        update(&mut world);
        let objects: Vec<(Entity, OrientedBox)> =
            world.query::<(Entity, &WorldBounds)>().iter(&world).map(|(entity, known)| (entity, OrientedBox::of_bounds(known.bounds.unwrap()))).collect();
        let volumes = boxes_of::<Volume>(&mut world);
        let probes = boxes_of::<ReflectionProbe>(&mut world);
        let grids = boxes_of::<ProbeVolume>(&mut world);
        let mut index = world.resource_mut::<SpatialIndex>();
        for (volume, shape) in &volumes {
            prop_assert_eq!(index.shape(*volume), Some(*shape));
            for (kind, all) in [(Kind::Object, &objects), (Kind::ReflectionProbe, &probes), (Kind::ProbeVolume, &grids), (Kind::Volume, &volumes)] {
                for (holds, test) in [(Holds::Meeting, OrientedBox::meets as fn(&_, &_) -> bool), (Holds::Enclosed, OrientedBox::encloses)] {
                    let expected = sorted(all.iter().filter(|(_, other)| test(shape, other)).map(|(entity, _)| *entity));
                    prop_assert_eq!(index.held_by(kind, *volume, holds), Some(expected));
                }
            }
        }
        for (kind, all) in [(Kind::ReflectionProbe, &probes), (Kind::ProbeVolume, &grids), (Kind::Volume, &volumes)] {
            let near = all.iter().filter(|(_, shape)| shape.distance_squared(center) <= radius * radius);
            prop_assert_eq!(index.in_sphere(kind, center, radius), sorted(near.map(|(entity, _)| *entity)));
            let mut by_distance: Vec<(Entity, f64, f64)> = all
                .iter()
                .map(|(entity, shape)| (*entity, shape.distance_squared(center).sqrt(), shape.center.distance_squared(center)))
                .collect();
            by_distance.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)).then(order(a.0).cmp(&order(b.0))));
            for count in [0, 1, 3, 100] {
                let expected: Vec<_> = by_distance.iter().take(count).map(|(entity, distance, _)| (*entity, *distance)).collect();
                prop_assert_eq!(index.nearest(kind, center, count), expected);
            }
        }
        if let Some((object, _)) = objects.iter().find(|(object, _)| volumes.iter().all(|(volume, _)| volume != object)) {
            prop_assert_eq!(index.held_by(Kind::Object, *object, Holds::Meeting), None);
        }
    }
}

#[test]
fn a_slanted_volume_holds_what_meets_it_and_not_what_meets_its_bounds() {
    let mut world = new_world();
    world.resource_mut::<Meshes>().0.push(cuboid("box", Vec3::ONE, 0));
    // A long box along the diagonal.
    let slanted = Transform(Affine3A::from_rotation_y(std::f32::consts::FRAC_PI_4));
    let volume = world.spawn((slanted, Volume { size: Vec3::new(20.0, 4.0, 2.0) })).id();
    let [inside, across, beside] = [Vec3::ZERO, Vec3::new(5.0, 0.0, -6.0), Vec3::new(5.0, 0.0, 5.0)].map(|at| box_at(&mut world, at));
    update(&mut world);
    let mut index = world.resource_mut::<SpatialIndex>();
    assert_eq!(index.held_by(Kind::Object, volume, Holds::Meeting), Some(vec![inside, across]));
    assert_eq!(index.held_by(Kind::Object, volume, Holds::Enclosed), Some(vec![inside]));
    let bounds = index.shape(volume).unwrap().bounds();
    assert_eq!(index.in_box(Kind::Object, bounds), [inside, across, beside]);
}

#[test]
fn of_equally_near_ones_the_first_is_found_whatever_the_tree_looks_like() {
    let mut world = new_world();
    let probe = ReflectionProbe { size: Vec3::splat(2.0), near: 0.1, far: 10.0 };
    let ring = |step: usize| Transform(Affine3A::from_rotation_y(step as f32) * Affine3A::from_translation(Vec3::X * 10.0));
    let probes: Vec<Entity> = (0..300).map(|_| world.spawn((Transform::default(), probe)).id()).collect();
    update(&mut world);
    assert_eq!(world.resource_mut::<SpatialIndex>().nearest(Kind::ReflectionProbe, DVec3::ZERO, 2), [(probes[0], 0.0), (probes[1], 0.0)]);
    // Those that are taken out and put back stand elsewhere in the tree.
    for seconds in [0, 1] {
        *world.get_mut::<Transform>(probes[0]).unwrap() = if seconds == 0 { ring(1) } else { Transform::default() };
        update(&mut world);
        let found = world.resource_mut::<SpatialIndex>().nearest(Kind::ReflectionProbe, DVec3::ZERO, 1);
        assert_eq!(found, [(probes[1 - seconds], 0.0)]);
    }
    // Inside of several, the one whose middle is nearest.
    let near = probes[200];
    world.get_mut::<Transform>(near).unwrap().0.translation.x = 0.5;
    update(&mut world);
    assert_eq!(world.resource_mut::<SpatialIndex>().nearest(Kind::ReflectionProbe, DVec3::X * 0.6, 1), [(near, 0.0)]);
}
