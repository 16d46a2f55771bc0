//! Every kind of change.
//!
//! Two lamps stand twenty metres apart and reach three metres, two spots farther away reach four. A box stands below each of the first
//! two and is seen by the face that looks down (3), a candle without a range stands alone and ends where it fades, another one between them
//! out of reach, a cut-out leaf and a blended pane below the first lamp. The cascades of the sun see everything. Objects have slots in the
//! order in which they stand here.

use glam::{Affine3A, Vec3};
use libtest_mimic::Failed;
use luminaire::scenes::asset::AlphaMode;
use luminaire::scenes::world::{Camera, Cone, DirectionalLight, Exposure, Hidden, LocalLight, Materials, Transform, World, find_by_name};

use super::{Change, check, edit, go_to, place, take_away};

const SCENE: &str = "(
    environment: (sky_radiance: (0.5, 0.5, 0.5)),
    materials: {
        \"grey\": (base_color: (0.5, 0.5, 0.5)), \"leaf\": (base_color: (0.2, 0.6, 0.1)), \"glass\": (alpha: 0.5),
        \"red\": (base_color: (0.8, 0.1, 0.1)),
    },
    cameras: { \"eye\": (position: (0, 1, 14), target: (0, 0, 0), fov: 90) },
    groups: { \"turntable\": (translation: (0, 5, 0)) },
    lights: {
        \"sun\": Directional(lux: 10, direction: (-1, -2, -1)),
        \"first\": Point(candela: 20, position: (-10, 2, 0), range: 3),
        \"second\": Point(candela: 20, position: (10, 2, 0), range: 3),
        \"spot\": Spot(candela: 20, position: (0, 2, -30), direction: (0, -1, 0), inner: 20, outer: 40, range: 4),
        \"other spot\": Spot(candela: 20, position: (-20, 2, -30), direction: (0, -1, 0.3), inner: 20, outer: 40, range: 4),
        \"candle\": Point(candela: 0.01, position: (0, 2, 30)),
    },
    objects: {
        \"below first\": (shape: Box(size: (1, 1, 1)), material: \"grey\", translation: (-10, 0, 0)),
        \"below second\": (shape: Box(size: (1, 1, 1)), material: \"grey\", translation: (10, 0, 0)),
        \"between\": (shape: Box(size: (1, 1, 1)), material: \"red\"),
        \"leaf\": (shape: Box(size: (0.4, 0.1, 0.4)), material: \"leaf\", translation: (-10, 0.8, 0)),
        \"pane\": (shape: Box(size: (0.5, 0.1, 0.5)), material: \"glass\", translation: (-10, 1.0, 0)),
        \"behind\": (shape: Box(size: (1, 1, 1)), material: \"grey\", translation: (0, 1, 150)),
        \"frame\": (shape: Box(size: (100, 0.1, 100)), material: \"grey\", translation: (0, -20, 0)),
    },
    timeline: [
        (at: 1, do: Rotate(node: \"below first\", to: (0, 90, 0), during: 2)),
        (at: 4, do: Spawn(objects: { \"new\": (shape: Box(size: (1, 1, 1)), material: \"grey\", translation: (-10, 0.2, 1)) })),
        (at: 5, do: Remove(node: \"new\")),
        (at: 6, do: Reparent(node: \"between\", parent: \"turntable\")),
        (at: 7, do: Reparent(node: \"between\", keep_place: false)),
        (at: 8, do: Sky(radiance: (0.1, 0.1, 0.2))),
        (at: 8, do: Turn(node: \"sun\", by: (0, 0, 20))),
    ],
)";

const CHANGES: &[Change] = &[
    ("nothing", |_| Ok(())),
    ("the same place once more", |world| place(world, "between", [0.0, 0.0, 0.0])),
    ("the same exposure once more", |world| edit(world, "eye", |camera: &mut Camera| camera.exposure = Exposure::Unchanged)),
    ("the camera", |world| place(world, "eye", [0.0, 1.0, 13.0])),
    ("the exposure", |world| edit(world, "eye", |camera: &mut Camera| camera.exposure = Exposure::Ev100(3.0))),
    ("the strength of the sun", |world| edit(world, "sun", |sun: &mut DirectionalLight| sun.illuminance = 20.0)),
    ("the color of the sun", |world| edit(world, "sun", |sun: &mut DirectionalLight| sun.color = Vec3::new(1.0, 0.9, 0.8))),
    ("the strength of a lamp", |world| edit(world, "second", |lamp: &mut LocalLight| lamp.intensity = 40.0)),
    ("the color of a lamp", |world| edit(world, "second", |lamp: &mut LocalLight| lamp.color = Vec3::new(0.5, 1.0, 1.0))),
    ("the range of a lamp", |world| edit(world, "second", |lamp: &mut LocalLight| lamp.range = Some(2.9))),
    ("the strength of a candle that ends where it fades", |world| edit(world, "candle", |lamp: &mut LocalLight| lamp.intensity = 0.0101)),
    ("the place of a lamp", |world| place(world, "second", [10.0, 2.1, 0.0])),
    ("the cone of a spot", |world| edit(world, "spot", |lamp: &mut LocalLight| lamp.cone = Some(Cone { inner: 0.1, outer: 0.5 }))),
    ("the color of a spot", |world| edit(world, "spot", |lamp: &mut LocalLight| lamp.color = Vec3::new(0.5, 1.0, 1.0))),
    ("a spot that turns", |world| turn(world, "spot", 0.1)),
    ("a spot that gets too wide for a map", |world| {
        edit(world, "spot", |lamp: &mut LocalLight| lamp.cone = Some(Cone { inner: 0.1, outer: 1.3 }))
    }),
    ("a spot that gets narrow again", |world| {
        edit(world, "spot", |lamp: &mut LocalLight| lamp.cone = Some(Cone { inner: 0.1, outer: 0.5 }))
    }),
    ("a box into the light of a spot", |world| place(world, "below second", [0.0, 0.0, -30.2])),
    ("a box that moves in the light of a spot", |world| place(world, "below second", [0.1, 0.0, -30.2])),
    ("a box out of the light of a spot", |world| place(world, "below second", [10.0, 0.0, 0.0])),
    ("a box that a lamp reaches", |world| place(world, "below first", [-10.1, 0.0, 0.0])),
    ("a box that no lamp reaches", |world| place(world, "between", [1.0, 0.0, 0.0])),
    ("a leaf that a lamp reaches", |world| place(world, "leaf", [-10.1, 0.8, 0.0])),
    ("a pane, which throws no shadow", |world| place(world, "pane", [-10.1, 1.0, 0.0])),
    ("a box out of a lamp's reach", |world| place(world, "below second", [10.0, 0.0, -9.0])),
    ("a box into another one's", |world| place(world, "below second", [-10.0, 0.0, 0.8])),
    ("a box behind the camera, which nothing sees", |world| place(world, "behind", [0.5, 1.0, 150.0])),
    ("a box that comes into view", |world| place(world, "behind", [0.0, 1.0, -8.0])),
    ("the color of a material", |world| material(world, "red", |material| material.base_color = [0.1, 0.1, 0.8, 1.0])),
    ("the roughness of a material", |world| material(world, "grey", |material| material.roughness = 0.4)),
    ("what a leaf's material cuts out", |world| material(world, "leaf", |material| material.alpha_mode = AlphaMode::Mask { cutoff: 0.25 })),
    ("a tick of an animation", |world| go_to(world, 2.0)),
    ("the end of the animation", |world| go_to(world, 3.0)),
    ("a time at which nothing moves", |world| go_to(world, 3.5)),
    ("a box that is spawned", |world| go_to(world, 4.0)),
    ("a box that is removed", |world| go_to(world, 5.0)),
    ("another parent, at the same place", |world| go_to(world, 6.0)),
    ("another parent's place", |world| go_to(world, 7.0)),
    ("a lamp that is hidden", |world| hide(world, "second")),
    ("a lamp that is shown", |world| show(world, "second")),
    ("a box that is hidden", |world| hide(world, "below first")),
    ("a box that is shown", |world| show(world, "below first")),
    ("the time of day", |world| go_to(world, 8.0)),
    ("a sun that is hidden", |world| hide(world, "sun")),
    ("a sun that is shown", |world| show(world, "sun")),
    ("a lamp that is taken away", |world| take_away(world, "first")),
    ("a box that is taken away", |world| take_away(world, "between")),
];

fn material(world: &mut World, name: &str, change: impl Fn(&mut luminaire::scenes::asset::Material)) -> Result<(), Failed> {
    let mut materials = world.resource_mut::<Materials>();
    let found = materials.0.iter_mut().find(|material| material.name == name).ok_or("no such material")?;
    change(found);
    Ok(())
}

fn turn(world: &mut World, name: &str, angle: f32) -> Result<(), Failed> {
    edit(world, name, |transform: &mut Transform| transform.0 *= Affine3A::from_rotation_x(angle))
}

fn hide(world: &mut World, name: &str) -> Result<(), Failed> {
    let entity = find_by_name(world, name).map_err(|problem| problem.message)?;
    world.entity_mut(entity).insert(Hidden);
    Ok(())
}

fn show(world: &mut World, name: &str) -> Result<(), Failed> {
    let entity = find_by_name(world, name).map_err(|problem| problem.message)?;
    world.entity_mut(entity).remove::<Hidden>();
    Ok(())
}

pub fn run_what_they_reach() -> Result<(), Failed> {
    let masked = |world: &mut World| {
        let mut materials = world.resource_mut::<Materials>();
        for leaf in materials.0.iter_mut().filter(|material| material.name == "leaf") {
            leaf.alpha_mode = AlphaMode::Mask { cutoff: 0.5 };
        }
    };
    check("kinds.txt", SCENE, masked, CHANGES)
}
