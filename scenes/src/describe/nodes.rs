//! The tree of nodes, and what each of them is.

use bevy_ecs::prelude::{Entity, Without, World};
use glam::Vec3;

use super::Node;
use super::text::{color, number, seconds, vector};
use crate::asset::Projection;
use crate::world::{
    AnimationPlayer, Camera, CameraPath, ChildOf, Children, DirectionalLight, Exposure, Fly, GlobalTransform, Hidden, LocalLight,
    Materials, MeshInstance, Meshes, Name, Orbit, ProbeVolume, RectangleLight, ReflectionProbe, Repeat, Transform, Volume,
};

/// All nodes, each behind its parent; siblings in the order in which they came.
pub(super) fn nodes(world: &mut World) -> Vec<Node> {
    let mut roots: Vec<Entity> =
        world.query_filtered::<Entity, (bevy_ecs::prelude::With<Transform>, Without<ChildOf>)>().iter(world).collect();
    roots.sort_unstable_by_key(|entity| entity.index_u32());
    let mut stack: Vec<(Entity, Option<usize>, usize)> = roots.into_iter().rev().map(|root| (root, None, 0)).collect();
    let mut nodes = Vec::new();
    while let Some((entity, parent, depth)) = stack.pop() {
        let name = world.get::<Name>(entity).map(|name| name.as_str().to_owned());
        let position = world.get::<GlobalTransform>(entity).map_or(Vec3::ZERO, |place| place.0.translation.into()).to_array();
        nodes.push(Node { name, parent, depth, position, parts: parts(world, entity) });
        let index = nodes.len() - 1;
        if let Some(children) = world.get::<Children>(entity) {
            stack.extend(children.iter().rev().map(|child| (*child, Some(index), depth + 1)));
        }
    }
    nodes
}

fn parts(world: &World, entity: Entity) -> Vec<String> {
    let mut parts = Vec::new();
    if world.get::<Hidden>(entity).is_some() {
        parts.push("hidden".to_owned());
    }
    if let Some(camera) = world.get::<Camera>(entity) {
        parts.push(camera_text(camera));
    }
    if let Some(path) = world.get::<CameraPath>(entity) {
        parts.push(format!("travels until {} s", seconds(path.end())));
    }
    if world.get::<Fly>(entity).is_some() {
        parts.push("flies by command".to_owned());
    }
    if world.get::<Orbit>(entity).is_some() {
        parts.push("orbits by command".to_owned());
    }
    if let Some(player) = world.get::<AnimationPlayer>(entity) {
        parts.push(clips(player));
    }
    if let Some(light) = world.get::<DirectionalLight>(entity) {
        parts.push(format!("directional light, {} lx{}", number(light.illuminance), color(light.color)));
    }
    if let Some(light) = world.get::<LocalLight>(entity) {
        parts.push(local_light(light));
    }
    if let Some(light) = world.get::<RectangleLight>(entity) {
        let sides = if light.two_sided { ", two-sided" } else { "" };
        let (width, height) = (number(light.size.x), number(light.size.y));
        parts.push(format!("rectangle light, {} nits{}, {width} x {height} m{sides}", number(light.luminance), color(light.color)));
    }
    if let Some(instance) = world.get::<MeshInstance>(entity) {
        let mesh = world.get_resource::<Meshes>().and_then(|meshes| meshes.0.get(instance.mesh));
        let material = world.get_resource::<Materials>().and_then(|materials| materials.0.get(instance.material));
        let triangles = mesh.map_or(0, |mesh| mesh.indices.len() / 3);
        parts.push(format!("{triangles} triangles of `{}`", material.map_or("", |material| &material.name)));
    }
    if let Some(volume) = world.get::<ProbeVolume>(entity) {
        let [x, y, z] = volume.counts.to_array();
        parts.push(format!("probe volume, {x} x {y} x {z} probes, {} m apart", vector(volume.spacing)));
    }
    if let Some(probe) = world.get::<ReflectionProbe>(entity) {
        parts.push(format!("reflection probe, {} m, from {} to {} m", vector(probe.size), number(probe.near), number(probe.far)));
    }
    if let Some(volume) = world.get::<Volume>(entity) {
        parts.push(format!("box volume, {} m", vector(volume.size)));
    }
    parts
}

/// All clips of a file, those that play first.
fn clips(player: &AnimationPlayer) -> String {
    let clip = |index: usize| {
        let clip = player.clips().get(index)?;
        Some(format!("`{}` of {} s", clip.name, number(clip.duration)))
    };
    let list = |indices: &mut dyn Iterator<Item = usize>| indices.filter_map(clip).collect::<Vec<_>>().join(", ");
    let playing = list(&mut player.playing.iter().copied());
    let others = list(&mut (0..player.clips().len()).filter(|index| !player.playing.contains(index)));
    let speed = if player.speed == 1.0 { String::new() } else { format!(" at speed {}", seconds(player.speed)) };
    let start = if player.start == 0.0 { String::new() } else { format!(" from {} s", seconds(player.start)) };
    let again = match player.repeat {
        Repeat::Once => " once",
        Repeat::Loop => "",
        Repeat::PingPong => " to and fro",
    };
    let others = if others.is_empty() { others } else { format!(", has {others}") };
    if playing.is_empty() { format!("plays nothing{others}") } else { format!("plays {playing}{speed}{start}{again}{others}") }
}

fn camera_text(camera: &Camera) -> String {
    let (kind, near, far) = match camera.projection {
        Projection::Perspective { yfov, near, far } => (format!("perspective {} degrees", number(yfov.to_degrees())), near, far),
        Projection::Orthographic { ymag, near, far, .. } => (format!("orthographic {} m", number(2.0 * ymag)), near, Some(far)),
    };
    let far = far.map_or_else(String::new, |far| format!(" to {} m", number(far)));
    let exposure = match camera.exposure {
        Exposure::Unchanged => String::new(),
        Exposure::Ev100(ev100) => format!(", EV100 {}", number(ev100)),
        Exposure::Factor(factor) => format!(", exposed {} times", number(factor)),
    };
    format!("camera, {kind}, from {} m{far}{exposure}", number(near))
}

fn local_light(light: &LocalLight) -> String {
    let kind = if light.cone.is_some() { "spot" } else { "point" };
    let cone = light.cone.map_or_else(String::new, |cone| {
        format!(", cone {} to {} degrees", number(cone.inner.to_degrees()), number(cone.outer.to_degrees()))
    });
    let range = light.range.map_or_else(String::new, |range| format!(", range {} m", number(range)));
    format!("{kind} light, {} cd{}{cone}{range}", number(light.intensity), color(light.color))
}
