//! A floor that is a mirror, in a room that stands at an angle, against rays that are traced through the room.

use glam::{DVec2, DVec3};
use libtest_mimic::Failed;
use luminaire::scenes::world::{GlobalTransform, find_by_name};

use super::MIRROR;
use crate::support::picture::{Eye, Shot, places, settle, shown, texel, world};

const HALF: DVec3 = DVec3::new(2.0, 1.5, 2.5);

/// Colours of the walls: -X +X -Y +Y -Z +Z; the floor is the mirror.
const WALLS: [[f64; 3]; 6] = [[0.5, 0.25, 0.25], [0.25, 0.5, 0.25], [0.0; 3], [0.5, 0.5, 0.5], [0.25, 0.25, 0.5], [0.5, 0.5, 0.25]];

/// What hangs on the walls: axis, side, middle and half extent along the two other axes, colour.
type Patch = (usize, f64, [f64; 2], [f64; 2], [f64; 3]);
const PATCHES: [Patch; 8] = [
    (0, -1.0, [0.4, -0.8], [0.5, 0.6], [1.0, 0.0, 0.0]),
    (0, -1.0, [-0.6, 1.2], [0.3, 0.4], [0.0, 0.0, 1.0]),
    (0, 1.0, [0.2, 0.5], [0.7, 0.3], [1.0, 1.0, 0.0]),
    (2, -1.0, [-0.8, 0.5], [0.6, 0.4], [0.0, 1.0, 0.0]),
    (2, -1.0, [0.9, -0.7], [0.4, 0.5], [1.0, 0.0, 1.0]),
    (1, 1.0, [0.5, -1.0], [0.4, 0.8], [0.0, 1.0, 1.0]),
    (1, 1.0, [-1.0, 1.0], [0.6, 0.6], [1.0, 1.0, 1.0]),
    (2, 1.0, [0.3, 0.2], [0.8, 0.8], [0.0, 0.5, 1.0]),
];

/// The two axes across one.
fn across(axis: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}

/// Where a ray from inside meets the walls: the wall and the place.
fn exit(from: DVec3, ray: DVec3) -> (usize, DVec3) {
    let lengths =
        [0, 1, 2].map(|axis| if ray[axis] == 0.0 { f64::INFINITY } else { (HALF[axis] * ray[axis].signum() - from[axis]) / ray[axis] });
    let axis = (0..3).min_by(|a, b| lengths[*a].total_cmp(&lengths[*b])).unwrap_or(0);
    (2 * axis + usize::from(ray[axis] > 0.0), from + ray * lengths[axis])
}

fn color((wall, place): (usize, DVec3)) -> [f64; 3] {
    let axes = across(wall / 2);
    let side = if wall % 2 == 1 { 1.0 } else { -1.0 };
    let at = DVec2::new(place[axes[0]], place[axes[1]]);
    let covers = |(axis, of, middle, half, _): &&Patch| {
        (*axis, *of) == (wall / 2, side) && (at - DVec2::from(*middle)).abs().cmple(DVec2::from(*half)).all()
    };
    PATCHES.iter().find(covers).map_or(WALLS[wall], |patch| patch.4)
}

fn a_box(name: &str, middle: DVec3, size: DVec3, surface: &str) -> String {
    format!(
        "\"{name}\": (shape: Box(size: ({}, {}, {})), translation: ({}, {}, {}), parent: \"room\", surface: ({surface}))",
        size.x, size.y, size.z, middle.x, middle.y, middle.z
    )
}

fn unlit([r, g, b]: [f64; 3]) -> String {
    format!("unlit: true, base_color: ({r}, {g}, {b})")
}

fn scene(eye: &Eye) -> String {
    let mut objects = Vec::new();
    for wall in 0..6 {
        let mut outwards = DVec3::ZERO;
        outwards[wall / 2] = if wall % 2 == 1 { 1.0 } else { -1.0 };
        let thick = DVec3::select(outwards.abs().cmpgt(DVec3::ZERO), DVec3::splat(0.2), HALF * 2.0);
        let surface = if wall == 2 { "base_color: (1, 1, 1), metallic: 1, roughness: 0".to_owned() } else { unlit(WALLS[wall]) };
        objects.push(a_box(&format!("wall {wall}"), outwards * (HALF + 0.1), thick, &surface));
    }
    for (index, (axis, side, middle, half, paint)) in PATCHES.iter().enumerate() {
        let [a, b] = across(*axis);
        let (mut place, mut size) = (DVec3::ZERO, DVec3::splat(0.002));
        place[*axis] = HALF[*axis] * side;
        (place[a], place[b]) = (middle[0], middle[1]);
        (size[a], size[b]) = (2.0 * half[0], 2.0 * half[1]);
        objects.push(a_box(&format!("patch {index}"), place, size, &unlit(*paint)));
    }
    format!(
        "({} groups: {{ \"room\": (translation: (3, 1.5, -2), rotation: (0, 30, 0)) }},
        markers: {{ \"probe\": ReflectionProbe(position: (0, 0, 0), size: (4, 3, 5), parent: \"room\") }},
        objects: {{ {} }})",
        eye.ron(),
        objects.join(",\n")
    )
}

/// Wherever the reflection is one colour around a pixel, the mirror shows it: edges are off by a pixel at most.
pub fn shows_the_room() -> Result<(), Failed> {
    let mut world_at = world(&scene(&Eye::new([0.0, 0.0, 1.0], [0.0; 3], 75.0)))?;
    luminaire::scenes::world::update(&mut world_at);
    let entity = find_by_name(&mut world_at, "room").map_err(|problem| problem.message)?;
    let world_from_room = world_at.get::<GlobalTransform>(entity).ok_or("the room has a place")?.0;
    let into_world = |point: DVec3| world_from_room.transform_point3(point.as_vec3()).as_dvec3();
    let room_from_world = world_from_room.inverse();

    let eye = Eye::new(into_world(DVec3::new(0.7, 0.5, 2.2)).into(), into_world(DVec3::new(-0.2, -1.5, -0.2)).into(), 75.0);
    let text = scene(&eye);
    let shot = Shot::of(MIRROR, [128, 128], &["radiance"]).set("cube_texels", 256);
    let mut session = shot.session(&mut world(&text)?)?;
    settle(&mut session)?;
    let image = session.read_output("radiance").map_err(shown)?;

    let from = room_from_world.transform_point3(eye.position.as_vec3()).as_dvec3();
    // What the floor reflects at a pixel, and what a cube without parallax would show there.
    let reflected = |x: u32, y: u32| {
        let ray = room_from_world.transform_vector3(eye.ray(&image, x, y).as_vec3()).as_dvec3();
        let (wall, place) = exit(from, ray);
        let mirrored = DVec3::new(ray.x, -ray.y, ray.z);
        (wall == 2).then(|| (color(exit(place, mirrored)), color(exit(DVec3::ZERO, mirrored))))
    };
    let (mut compared, mut moved, mut wrong) = (0, 0, Vec::new());
    for (x, y) in places(&image) {
        let Some((expected, without_parallax)) = reflected(x, y) else { continue };
        let around = |place: u32| place.saturating_sub(1)..=(place + 1).min(127);
        if !around(y).all(|y| around(x).all(|x| reflected(x, y).is_some_and(|(color, _)| color == expected))) {
            continue;
        }
        compared += 1;
        moved += i32::from(expected != without_parallax);
        let found = texel(&image, x, y);
        if (0..3).any(|c| (found[c] - expected[c]).abs() > 0.005) {
            wrong.push(format!("{found:?} at {x}, {y}, not {expected:?}"));
        }
    }
    println!("{compared} pixels of the mirror compared, {} differ; {moved} would without parallax", wrong.len());
    if compared < 4000 || moved < compared / 4 || !wrong.is_empty() {
        return Err(format!(
            "{compared} pixels, {moved} with parallax, {} wrong: {:?}",
            wrong.len(),
            wrong.iter().take(5).collect::<Vec<_>>()
        )
        .into());
    }
    Ok(())
}
