//! Time and animation over worlds in memory.

use bevy_ecs::prelude::{Changed, Entity, With};
use glam::{Affine3A, DVec3, Quat, Vec3, Vec4};
use proptest::prelude::*;

use super::*;
use crate::asset::{Animation, Asset, Channel, Interpolation, Node, Pose, Projection, Property};
use crate::world::{
    AnimationPlayer, Axis, Camera, CameraPath, Command, Exposure, Facing, Fly, Name, Orbit, PathInterpolation, PathKey, Repeat, RestPose,
    Transform, clips, control, find_by_name, new_world, play_clips, set_translation, spawn_asset, spawn_stored, store_asset,
};

const REST: Pose = Pose { translation: Vec3::new(0.0, 7.0, 0.0), rotation: Quat::IDENTITY, scale: Vec3::new(1.0, 2.0, 3.0) };

fn channel(node: usize, property: Property, interpolation: Interpolation, times: &[f32], values: &[Vec4]) -> Channel {
    Channel { node, property, interpolation, times: times.into(), values: values.into() }
}

/// Three nodes: `a` slides in the clip `slide` (4 s) and grows in `grow` (1 s), its child `b` turns in `slide`, `c` stands still.
fn asset() -> Asset {
    let node = |name: &str, parent: Option<usize>| Node {
        name: name.to_owned(),
        parent,
        local: REST.matrix(),
        pose: Some(REST),
        meshes: Vec::new(),
        light: None,
        camera: None,
    };
    let turn = |degrees: f32| Vec4::from(Quat::from_rotation_z(degrees.to_radians()));
    let slide = vec![
        channel(0, Property::Translation, Interpolation::Linear, &[0.0, 4.0], &[Vec4::ZERO, Vec4::X * 8.0]),
        channel(1, Property::Rotation, Interpolation::Linear, &[0.0, 2.0, 4.0], &[turn(0.0), turn(90.0), turn(0.0)]),
    ];
    let grow = vec![channel(0, Property::Scale, Interpolation::Step, &[0.0, 0.5, 1.0], &[Vec4::ONE, Vec4::ONE * 2.0, Vec4::ONE * 2.0])];
    Asset {
        nodes: vec![node("a", None), node("b", Some(0)), node("c", None)],
        animations: vec![
            Animation { name: "slide".to_owned(), duration: 4.0, channels: slide },
            Animation { name: "grow".to_owned(), duration: 1.0, channels: grow },
        ],
        ..Asset::default()
    }
}

fn local(world: &mut World, name: &str) -> Affine3A {
    let entity = find_by_name(world, name).unwrap();
    world.get::<Transform>(entity).unwrap().0
}

fn slid(x: f32) -> Affine3A {
    Pose { translation: Vec3::X * x, ..REST }.matrix()
}

fn player(world: &mut World) -> bevy_ecs::prelude::Mut<'_, AnimationPlayer> {
    let entity = world.query_filtered::<Entity, With<AnimationPlayer>>().single(world).unwrap();
    world.get_mut::<AnimationPlayer>(entity).unwrap()
}

#[test]
fn the_first_clip_plays_in_a_loop_once_time_is_set() {
    let mut world = new_world();
    spawn_asset(&mut world, &asset(), Affine3A::IDENTITY);
    assert_eq!(local(&mut world, "a"), REST.matrix(), "at rest until then");
    for (time, x) in [(0.0, 0.0), (1.0, 2.0), (3.5, 7.0), (4.5, 1.0), (41.0, 2.0), (-3.0, 0.0)] {
        set_time(&mut world, time).unwrap();
        assert_eq!(local(&mut world, "a"), slid(x), "at {time}");
        assert_eq!(local(&mut world, "c"), REST.matrix());
        assert_eq!(world.resource::<Time>().0, time);
    }
    set_time(&mut world, 1.0).unwrap();
    let expected = Pose { rotation: Quat::from_rotation_z(45_f32.to_radians()), ..REST }.matrix();
    assert!(local(&mut world, "b").abs_diff_eq(expected, 1e-6));
    set_time(&mut world, 2.0).unwrap();
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(set_time(&mut world, bad).unwrap_err()[0].code, "world::bad-time");
        assert_eq!((world.resource::<Time>().0, local(&mut world, "a")), (2.0, slid(4.0)));
    }
}

#[test]
fn players_have_speed_start_and_repeat() {
    let mut world = new_world();
    spawn_asset(&mut world, &asset(), Affine3A::IDENTITY);
    let cases = [
        (0.5, 1.0, Repeat::Loop, 3.0, 2.0),
        (1.0, 2.0, Repeat::Loop, 1.0, 0.0),
        (-1.0, 0.0, Repeat::Loop, 1.0, 6.0),
        (1.0, 0.0, Repeat::Once, 9.0, 8.0),
        (-2.0, 0.0, Repeat::Once, 1.0, 4.0),
        (1.0, 0.0, Repeat::PingPong, 5.0, 6.0),
    ];
    for (speed, start, repeat, time, x) in cases {
        let mut player = player(&mut world);
        (player.speed, player.start, player.repeat) = (speed, start, repeat);
        set_time(&mut world, time).unwrap();
        assert_eq!(local(&mut world, "a"), slid(x), "speed {speed} from {start}, {repeat:?}, at {time}");
    }
}

#[test]
fn clips_are_chosen_by_name_or_index_and_leave_nothing_behind() {
    let mut world = new_world();
    spawn_asset(&mut world, &asset(), Affine3A::IDENTITY);
    let listed: Vec<_> = clips(&mut world).into_iter().map(|clip| (clip.index, clip.name, clip.duration)).collect();
    assert_eq!(listed, [(0, "slide".to_owned(), 4.0), (1, "grow".to_owned(), 1.0)]);
    set_time(&mut world, 2.75).unwrap();
    play_clips(&mut world, &["1"]).unwrap();
    set_time(&mut world, 2.75).unwrap();
    let grown = Pose { scale: Vec3::splat(2.0), ..REST };
    assert_eq!((local(&mut world, "a"), local(&mut world, "b")), (grown.matrix(), REST.matrix()));
    play_clips(&mut world, &["grow", "slide"]).unwrap();
    set_time(&mut world, 2.75).unwrap();
    assert_eq!(local(&mut world, "a"), Pose { translation: Vec3::X * 5.5, ..grown }.matrix(), "both, each for its own duration");
    let problems = play_clips(&mut world, &["slide", "grov", "2"]).unwrap_err();
    assert!(problems.iter().all(|problem| problem.code == "world::unknown-clip"));
    assert_eq!((problems.len(), problems[0].hint.as_deref()), (2, Some("did you mean `grow`?")));
    assert_eq!(player(&mut world).playing, [1, 0], "nothing changes if there is an error");
    player(&mut world).playing = vec![9];
    set_time(&mut world, 2.75).unwrap();
    assert_eq!(local(&mut world, "a"), REST.matrix());
}

#[test]
fn each_copy_of_an_asset_has_a_player() {
    let mut world = new_world();
    let stored = store_asset(&mut world, asset());
    let group = world.spawn((Name::new("group"), Transform::default())).id();
    let first = spawn_stored(&mut world, &stored, Some(group));
    let second = spawn_stored(&mut world, &stored, Some(group));
    assert!(world.get::<AnimationPlayer>(group).is_some(), "on the entity that it was spawned below");
    assert_eq!(clips(&mut world).len(), 4);
    world.get_mut::<AnimationPlayer>(group).unwrap().speed = 2.0;
    set_time(&mut world, 1.0).unwrap();
    let of = |entity: Entity| world.get::<Transform>(entity).unwrap().0;
    assert_eq!((of(first[0]), of(second[0])), (slid(4.0), slid(2.0)));
    world.despawn(first[1]);
    set_time(&mut world, 2.0).unwrap();
    assert!(world.get::<RestPose>(second[2]).is_none(), "only what moves");
}

#[test]
fn what_is_moved_by_name_stays_there_unless_its_translation_is_animated() {
    let mut world = new_world();
    spawn_asset(&mut world, &asset(), Affine3A::IDENTITY);
    set_translation(&mut world, "a", Vec3::ONE).unwrap();
    set_translation(&mut world, "b", Vec3::ONE).unwrap();
    set_time(&mut world, 0.0).unwrap();
    assert_eq!((local(&mut world, "a"), Vec3::from(local(&mut world, "b").translation)), (slid(0.0), Vec3::ONE));
}

/// Everything that moves: two copies of the asset, a controlled camera and one on a path.
fn moving_world() -> World {
    let mut world = new_world();
    spawn_asset(&mut world, &asset(), Affine3A::IDENTITY);
    spawn_asset(&mut world, &asset(), Affine3A::from_rotation_x(1.0));
    let mut players = world.query::<&mut AnimationPlayer>();
    for (mut player, speed) in players.iter_mut(&mut world).zip([-0.7, 1.3]) {
        (player.speed, player.repeat, player.playing) = (speed, Repeat::PingPong, vec![0, 1]);
    }
    let fly = world.spawn(Fly::at(Affine3A::from_rotation_y(0.3))).id();
    control(&mut world, fly, &[Command::Move(Axis::Forward, 0.3)], 0.7).unwrap();
    world.spawn(Orbit::around(DVec3::ONE, Affine3A::IDENTITY));
    let key = |time: f64, x: f32| {
        let facing = Facing::Target(Vec3::new(1.0, x, -3.0));
        PathKey { time, position: Vec3::new(x, 2.0 * x * x, 0.5), facing, yfov: Some(0.5 + 0.1 * x), ev100: Some(x) }
    };
    let path = CameraPath::new(vec![key(-1.0, 0.0), key(0.5, 1.0), key(2.0, -2.0)], PathInterpolation::Smooth, Repeat::Loop).unwrap();
    let projection = Projection::Perspective { yfov: 0.5, near: 0.1, far: None };
    world.spawn((path, Camera { name: "c".to_owned(), projection, exposure: Exposure::default() }));
    world
}

/// Bits of all transforms, and all cameras.
fn state(world: &mut World) -> (Vec<[u32; 12]>, Vec<Camera>) {
    let bits = |transform: &Transform| transform.0.to_cols_array().map(f32::to_bits);
    (world.query::<&Transform>().iter(world).map(bits).collect(), world.query::<&Camera>().iter(world).cloned().collect())
}

proptest! {
    #[test]
    fn the_world_is_a_function_of_the_time(times in proptest::collection::vec(-10.0..30.0_f64, 1..8)) {
        let mut world = moving_world();
        for time in times {
            set_time(&mut world, time).unwrap();
            let mut fresh = moving_world();
            set_time(&mut fresh, time).unwrap();
            prop_assert_eq!(state(&mut world), state(&mut fresh), "at {}", time);
        }
    }
}

#[test]
fn the_same_time_again_marks_nothing_as_changed() {
    let mut world = moving_world();
    set_time(&mut world, 1.7).unwrap();
    world.clear_trackers();
    set_time(&mut world, 1.7).unwrap();
    assert_eq!(world.query_filtered::<Entity, Changed<Transform>>().iter(&world).count(), 0);
    assert_eq!(world.query_filtered::<Entity, Changed<Camera>>().iter(&world).count(), 0);
    assert!(!world.is_resource_changed::<Time>());
    set_time(&mut world, 1.8).unwrap();
    assert!(world.query_filtered::<Entity, Changed<Transform>>().iter(&world).count() >= 5, "the test sees changes");
}
