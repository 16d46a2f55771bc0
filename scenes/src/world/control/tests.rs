//! Controllers against trigonometry.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec3, Vec3A};
use proptest::prelude::*;

use super::*;
use crate::world::{Transform, new_world};

fn facing(position: Vec3, yaw: f64, pitch: f64) -> Affine3A {
    let rotation = Quat::from_rotation_y(yaw as f32) * Quat::from_rotation_x(pitch as f32);
    Affine3A::from_rotation_translation(rotation, position)
}

fn close(found: Affine3A, expected: Affine3A) {
    assert!(found.abs_diff_eq(expected, 1e-5), "{found:?}, not {expected:?}");
}

/// The transform of a new entity with a controller after these commands, each for so many seconds.
fn after(controller: impl bevy_ecs::prelude::Bundle, commands: &[(Command, f64)]) -> Affine3A {
    let mut world = new_world();
    let entity = world.spawn(controller).id();
    for (command, seconds) in commands {
        control(&mut world, entity, &[*command], *seconds).unwrap();
    }
    world.get::<Transform>(entity).unwrap().0
}

#[test]
fn flying_goes_where_it_looks_at_its_speed() {
    let start = facing(Vec3::new(1.0, 2.0, 3.0), 0.0, 0.0);
    let fly = Fly::at(start);
    close(after(fly, &[(Command::Move(Axis::Forward, 1.0), 2.0)]), facing(Vec3::new(1.0, 2.0, -3.0), 0.0, 0.0));
    close(after(fly, &[(Command::Move(Axis::Right, -0.5), 2.0)]), facing(Vec3::new(-2.0, 2.0, 3.0), 0.0, 0.0));
    // A quarter to the left looks along -X.
    let turned = [(Command::Turn { yaw: 1.0, pitch: 0.0 }, FRAC_PI_2), (Command::Move(Axis::Forward, 1.0), 1.0)];
    close(after(fly, &turned), facing(Vec3::new(-2.0, 2.0, 3.0), FRAC_PI_2, 0.0));
    // Up is up wherever it looks.
    let up = [(Command::Look { yaw: 0.0, pitch: -1.0 }, 0.0), (Command::Move(Axis::Up, 1.0), 1.0)];
    close(after(fly, &up), facing(Vec3::new(1.0, 5.0, 3.0), 0.0, -1.0));
    // Panning is in the plane of the image.
    let pan = [(Command::Look { yaw: 0.0, pitch: 0.5 }, 0.0), (Command::Pan { right: 2.0, up: 1.0 }, 0.0)];
    let [sin, cos] = [0.5_f32.sin(), 0.5_f32.cos()];
    close(after(fly, &pan), facing(Vec3::new(3.0, 2.0 + cos, 3.0 + sin), 0.0, 0.5));
    close(after(fly, &[turned[0], pan[1], up[0], up[1], (Command::Reset, 0.0)]), start);
}

#[test]
fn what_is_held_counts_by_its_whole_duration() {
    let fly = Fly::at(Affine3A::IDENTITY);
    let once = after(fly, &[(Command::Move(Axis::Forward, 1.0), 3.0)]);
    close(after(fly, &[(Command::Move(Axis::Forward, 1.0), 0.75); 4]), once);
}

#[test]
fn flying_stops_short_of_straight_up_and_is_level() {
    let up = after(Fly::at(Affine3A::IDENTITY), &[(Command::Turn { yaw: 0.0, pitch: 1.0 }, 100.0)]);
    close(up, facing(Vec3::ZERO, 0.0, 89_f64.to_radians()));
    let rolled = Affine3A::from_rotation_y(0.3) * Affine3A::from_rotation_z(1.0);
    close(after(Fly::at(rolled), &[(Command::Zoom(1.0), 0.0)]), facing(Vec3::ZERO, f64::from(0.3_f32), 0.0));
    close(after(Fly::at(facing(Vec3::X, 2.0, -0.7)), &[(Command::Reset, 0.0)]), facing(Vec3::X, 2.0, -0.7));
}

#[test]
fn wheel_steps_change_the_speed_within_limits() {
    let mut fly = Fly::at(Affine3A::IDENTITY);
    assert_eq!((fly.speed, fly.turn), (3.0, 1.0));
    fly.obey(Command::Zoom(2.0), 0.0);
    assert!((fly.speed - 3.63).abs() < 1e-12);
    fly.obey(Command::Zoom(1e300), 0.0);
    assert_eq!(fly.speed, 30.0);
    fly.obey(Command::Zoom(-1e300), 0.0);
    assert_eq!(fly.speed, 0.1);
}

#[test]
fn orbiting_keeps_its_distance_and_looks_at_its_target() {
    let orbit = Orbit::around(DVec3::new(0.0, 1.0, 0.0), facing(Vec3::new(0.0, 1.0, 5.0), 2.0, 0.3));
    close(after(orbit, &[(Command::Turn { yaw: 0.0, pitch: 0.0 }, 1.0)]), facing(Vec3::new(0.0, 1.0, 5.0), 0.0, 0.0));
    // Looking along -X from the right, then from above.
    close(after(orbit, &[(Command::Turn { yaw: 0.5, pitch: 0.0 }, PI)]), facing(Vec3::new(5.0, 1.0, 0.0), FRAC_PI_2, 0.0));
    let steep = 89_f64.to_radians();
    let above = Vec3::new(0.0, 1.0 + 5.0 * steep.sin() as f32, 5.0 * steep.cos() as f32);
    close(after(orbit, &[(Command::Look { yaw: 0.0, pitch: -2.0 }, 0.0)]), facing(above, 0.0, -steep));
    // The distance is the speed, so that things pass by at the same pace from everywhere.
    close(after(orbit, &[(Command::Move(Axis::Right, 1.0), 0.5)]), facing(Vec3::new(2.5, 1.0, 5.0), 0.0, 0.0));
    close(after(orbit, &[(Command::Pan { right: 0.0, up: 2.0 }, 0.0)]), facing(Vec3::new(0.0, 3.0, 5.0), 0.0, 0.0));
    close(after(orbit, &[(Command::Zoom(2.0), 0.0)]), facing(Vec3::new(0.0, 1.0, 4.05), 0.0, 0.0));
    let mut near = orbit;
    (near.nearest, near.farthest) = (2.0, 6.0);
    close(after(near, &[(Command::Zoom(50.0), 0.0)]), facing(Vec3::new(0.0, 1.0, 2.0), 0.0, 0.0));
    close(after(near, &[(Command::Zoom(-50.0), 0.0)]), facing(Vec3::new(0.0, 1.0, 6.0), 0.0, 0.0));
    let moved = [(Command::Zoom(3.0), 0.0), (Command::Pan { right: 1.0, up: 1.0 }, 0.0), (Command::Reset, 0.0)];
    close(after(orbit, &moved), facing(Vec3::new(0.0, 1.0, 5.0), 0.0, 0.0));
    // At the target itself it steps back along its view.
    close(after(Orbit::around(DVec3::X, facing(Vec3::X, FRAC_PI_2, 0.0)), &[(Command::Reset, 0.0)]), facing(Vec3::X * 2.0, FRAC_PI_2, 0.0));
}

#[test]
fn everything_wrong_is_told_and_nothing_done() {
    let mut world = new_world();
    let plain = world.spawn(Transform::default()).id();
    let codes = |problems: Vec<Diagnostic>| problems.iter().map(|problem| problem.code).collect::<Vec<_>>();
    let bad = [Command::Move(Axis::Up, f64::NAN), Command::Reset, Command::Pan { right: 0.0, up: f64::INFINITY }];
    let problems = control(&mut world, plain, &bad, -1.0).unwrap_err();
    assert_eq!(codes(problems), ["world::no-controller", "world::bad-duration", "world::bad-command", "world::bad-command"]);
    let fly = Fly::at(facing(Vec3::X, 1.0, 0.0));
    let steered = world.spawn(fly).id();
    control(&mut world, steered, &[Command::Move(Axis::Up, 1.0), bad[0]], 1.0).unwrap_err();
    assert_eq!(*world.get::<Fly>(steered).unwrap(), fly);
}

proptest! {
    #[test]
    fn controllers_stay_finite_and_rigid(
        script in proptest::collection::vec((0..6_usize, any::<f64>(), any::<f64>(), 0.0..1e300_f64), 1..12), speed in any::<f64>(),
    ) {
        let mut world = new_world();
        let (mut fly, mut orbit) = (Fly::at(Affine3A::IDENTITY), Orbit::around(DVec3::ZERO, facing(Vec3::ONE, 0.0, 0.0)));
        (fly.speed, fly.turn, orbit.turn, orbit.nearest) = (speed, speed, speed, speed);
        let (fly, orbit) = (world.spawn(fly).id(), world.spawn(orbit).id());
        for (kind, a, b, seconds) in script {
            let axis = [Axis::Right, Axis::Up, Axis::Forward][kind % 3];
            let command = match kind {
                0..=2 => Command::Move(axis, a),
                3 => Command::Turn { yaw: a, pitch: b },
                4 => Command::Look { yaw: a, pitch: b },
                _ => Command::Zoom(a),
            };
            for entity in [fly, orbit] {
                let result = control(&mut world, entity, &[command, Command::Pan { right: b, up: a }], seconds);
                prop_assert_eq!(result.is_ok(), a.is_finite() && b.is_finite());
                let local = world.get::<Transform>(entity).unwrap().0;
                prop_assert!(local.is_finite(), "{local:?}");
                let [right, up, back] = [local.matrix3.x_axis, local.matrix3.y_axis, local.matrix3.z_axis];
                prop_assert!((right.cross(up) - back).length() < 1e-5 && right.y.abs() < 1e-6 && up.dot(Vec3A::Y) > 0.0);
            }
        }
    }
}
