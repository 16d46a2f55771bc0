//! Camera paths against their definitions.

use std::f32::consts::FRAC_PI_2;

use super::*;
use crate::world::{Transform, new_world, set_time};

fn key(time: f64, position: Vec3, facing: Facing) -> PathKey {
    PathKey { time, position, facing, yfov: None, ev100: None }
}

fn path(keys: &[PathKey], interpolation: PathInterpolation, repeat: Repeat) -> CameraPath {
    CameraPath::new(keys.to_vec(), interpolation, repeat).unwrap()
}

/// Keys that look at a point which stands still.
fn around(points: &[(f64, Vec3)]) -> Vec<PathKey> {
    points.iter().map(|(time, position)| key(*time, *position, Facing::Target(Vec3::new(0.0, 0.0, -100.0)))).collect()
}

fn position(path: &CameraPath, time: f64) -> Vec3 {
    path.local(time).translation.into()
}

/// Barry and Goldman 1988, "A Recursive Evaluation Algorithm for a Class of Catmull-Rom Splines", with centripetal knots.
fn pyramid(points: [Vec3; 4], fraction: f64) -> Vec3 {
    let points = points.map(Vec3::as_dvec3);
    let mut knots = [0.0; 4];
    for index in 1..4 {
        knots[index] = knots[index - 1] + points[index].distance(points[index - 1]).sqrt();
    }
    let at = knots[1] + (knots[2] - knots[1]) * fraction;
    let mix = |a: DVec3, b: DVec3, from: usize, to: usize| (a * (knots[to] - at) + b * (at - knots[from])) / (knots[to] - knots[from]);
    let [a, b, c] = [0, 1, 2].map(|index| mix(points[index], points[index + 1], index, index + 1));
    let (d, e) = (mix(a, b, 0, 2), mix(b, c, 1, 3));
    mix(d, e, 1, 2).as_vec3()
}

const POINTS: [(f64, Vec3); 5] = [
    (1.0, Vec3::new(0.0, 0.0, 0.0)),
    (2.0, Vec3::new(4.0, 1.0, 0.0)),
    (5.0, Vec3::new(4.5, 3.0, -2.0)),
    (6.0, Vec3::new(0.0, 3.0, 8.0)),
    (8.0, Vec3::new(-3.0, -1.0, 2.0)),
];

#[test]
fn straight_paths_go_straight() {
    let path = path(&around(&POINTS), PathInterpolation::Linear, Repeat::Once);
    assert_eq!(position(&path, 0.0), POINTS[0].1);
    assert!((position(&path, 3.5) - Vec3::new(4.25, 2.0, -1.0)).length() < 1e-6);
    assert_eq!(position(&path, 99.0), POINTS[4].1);
    assert_eq!(path.end(), 8.0);
}

#[test]
fn smooth_paths_are_centripetal_splines() {
    let path = path(&around(&POINTS), PathInterpolation::Smooth, Repeat::Once);
    let [p0, p1, p2, p3, p4] = POINTS.map(|point| point.1);
    let segments =
        [(1.0, [2.0 * p0 - p1, p0, p1, p2]), (2.0, [p0, p1, p2, p3]), (5.0, [p1, p2, p3, p4]), (6.0, [p2, p3, p4, 2.0 * p4 - p3])];
    for ((start, points), (end, _)) in segments.into_iter().zip(&POINTS[1..]) {
        for fraction in [0.0, 0.1, 0.5, 0.93] {
            let found = position(&path, start + (end - start) * fraction);
            let expected = pyramid(points, fraction);
            assert!((found - expected).length() < 1e-5, "{fraction} after {start}: {found}, not {expected}");
        }
    }
}

#[test]
fn a_closed_smooth_loop_has_no_corner_where_it_closes() {
    let mut points = POINTS;
    points[4].1 = points[0].1;
    let direction = |repeat, time: f64| {
        let path = path(&around(&points), PathInterpolation::Smooth, repeat);
        ((path.local(time + 1e-4).translation - path.local(time).translation).as_dvec3()).normalize()
    };
    let (arriving, leaving) = (8.0 - 1e-4, 1.0);
    assert!(direction(Repeat::Loop, arriving).dot(direction(Repeat::Loop, leaving)) > 0.999);
    assert!(direction(Repeat::Once, arriving).dot(direction(Repeat::Once, leaving)) < 0.9);
}

#[test]
fn keys_in_one_place_are_no_division_by_zero() {
    let same = [(0.0, Vec3::X), (1.0, Vec3::X), (2.0, Vec3::Y), (3.0, Vec3::Y), (4.0, Vec3::Y)];
    let path = path(&around(&same), PathInterpolation::Smooth, Repeat::Loop);
    for step in 0..=40 {
        let time = f64::from(step) * 0.1;
        assert!(path.local(time).is_finite(), "at {time}");
    }
    assert_eq!(position(&path, 0.5), Vec3::X);
}

#[test]
fn cameras_look_at_their_targets_on_the_way() {
    let target = Vec3::new(1.0, 0.5, -2.0);
    let keys = POINTS.map(|(time, position)| key(time, position, Facing::Target(target)));
    for interpolation in [PathInterpolation::Linear, PathInterpolation::Smooth] {
        let path = path(&keys, interpolation, Repeat::Once);
        for time in [1.0, 1.3, 4.0, 5.5, 7.9] {
            let local = path.local(time);
            let seen = local.inverse().transform_point3(target);
            assert!(seen.x.abs() < 1e-4 && seen.y.abs() < 1e-4 && seen.z < 0.0, "at {time} the target is at {seen}");
            assert!(local.matrix3.x_axis.y.abs() < 1e-6, "upright");
        }
    }
}

#[test]
fn rotations_take_the_shorter_way_and_may_stand_beside_targets() {
    // From a target along -Z to a turn by 90 degrees, written at twice its length and with the other sign.
    let turned = Quat::from_rotation_y(FRAC_PI_2) * -2.0;
    let keys = [key(0.0, Vec3::ZERO, Facing::Target(Vec3::NEG_Z)), key(1.0, Vec3::X, Facing::Rotation(turned))];
    let half = path(&keys, PathInterpolation::Linear, Repeat::Once).local(0.5);
    assert!(half.abs_diff_eq(Affine3A::from_rotation_translation(Quat::from_rotation_y(FRAC_PI_2 / 2.0), Vec3::X * 0.5), 1e-6));
    // The same three turns of 30 degrees, whatever the signs are: the middle of the middle stretch is at 45.
    for signs in [[1.0, 1.0, 1.0, 1.0], [1.0, -1.0, 1.0, -1.0], [-1.0, -1.0, 1.0, 1.0]] {
        let turn = |index: usize| Quat::from_rotation_x((index as f32 * 30.0).to_radians()) * signs[index];
        let keys = [0, 1, 2, 3].map(|index| key(index as f64, Vec3::ZERO, Facing::Rotation(turn(index))));
        let middle = path(&keys, PathInterpolation::Smooth, Repeat::Once).local(1.5);
        assert!(middle.abs_diff_eq(Affine3A::from_rotation_x(45_f32.to_radians()), 1e-6), "{signs:?}: {middle:?}");
    }
}

#[test]
fn time_moves_entities_and_their_cameras() {
    let mut keys = around(&POINTS);
    (keys[0].yfov, keys[3].yfov) = (Some(1.0), Some(2.0));
    (keys[1].ev100, keys[2].ev100) = (Some(4.0), Some(7.0));
    let mut world = new_world();
    let projection = Projection::Perspective { yfov: 0.5, near: 0.1, far: None };
    let camera = Camera { name: "c".to_owned(), projection, exposure: Exposure::Factor(3.0) };
    let travelling = world.spawn((path(&keys, PathInterpolation::Linear, Repeat::PingPong), camera.clone())).id();
    let own = world.spawn((path(&around(&POINTS), PathInterpolation::Linear, Repeat::Loop), camera)).id();
    let state = |world: &World, entity| {
        let camera = world.get::<Camera>(entity).unwrap();
        let Projection::Perspective { yfov, .. } = camera.projection else { panic!("a perspective camera") };
        (Vec3::from(world.get::<Transform>(entity).unwrap().0.translation), yfov, camera.exposure)
    };
    // 3.5 lies halfway between the first two keys that have a field of view, and between those that have an exposure.
    for time in [3.5, 11.5 + 1.0, 3.5 + 14.0] {
        set_time(&mut world, time).unwrap();
        let (place, yfov, exposure) = state(&world, travelling);
        assert!((place - Vec3::new(4.25, 2.0, -1.0)).length() < 1e-6, "at {time}: {place}");
        assert!((yfov - 1.5).abs() < 1e-6, "at {time}: {yfov}");
        assert_eq!(exposure, Exposure::Ev100(5.5), "at {time}");
    }
    set_time(&mut world, 7.0 * 3.0 + 3.5).unwrap();
    let (place, yfov, exposure) = state(&world, own);
    assert!((place - Vec3::new(4.25, 2.0, -1.0)).length() < 1e-6);
    assert_eq!((yfov, exposure), (0.5, Exposure::Factor(3.0)), "a path without them leaves the camera's own");
}

#[test]
fn everything_wrong_with_a_path_is_told() {
    let target = Facing::Target(Vec3::ONE);
    let keys = vec![
        key(0.0, Vec3::NAN, target),
        key(0.0, Vec3::ONE, target),
        key(1.0, Vec3::ZERO, Facing::Rotation(Quat::from_xyzw(0.0, 0.0, 0.0, 0.0))),
        PathKey { yfov: Some(4.0), ..key(f64::INFINITY, Vec3::ZERO, target) },
        PathKey { ev100: Some(f32::NAN), ..key(3.0, Vec3::ZERO, target) },
    ];
    let problems = CameraPath::new(keys, PathInterpolation::Smooth, Repeat::Once).unwrap_err();
    assert!(problems.iter().all(|problem| problem.code == "world::camera-path"));
    let starts: Vec<String> = problems.iter().map(|problem| problem.message.chars().take(5).collect()).collect();
    assert_eq!(starts, ["key 0", "key 1", "key 1", "key 2", "key 3", "key 3", "key 4", "key 4"], "{problems:?}");
    assert_eq!(CameraPath::new(Vec::new(), PathInterpolation::Smooth, Repeat::Once).unwrap_err().len(), 1);
}
