//! From checked parts to entities.

use bevy_ecs::prelude::{Entity, World};
use glam::Affine3A;

use super::checked::{Checked, Light, Shape};
use crate::asset::Mesh;
use crate::primitive;
use crate::world::{Environment, Materials, MeshInstance, Meshes, Name, Transform, assign_slots};

/// Spawns cameras, lights and objects, in this order. Objects of one shape share their mesh.
pub(super) fn spawn(world: &mut World, checked: &Checked) {
    world.insert_resource(Environment { sky_radiance: checked.sky_radiance, ..Environment::default() });
    for (name, camera, transform) in &checked.cameras {
        world.spawn((Name::new(name.clone()), Transform(*transform), camera.clone()));
    }
    for (name, light, transform) in &checked.lights {
        let mut entity = world.spawn((Name::new(name.clone()), Transform(*transform)));
        match light {
            Light::Directional(light) => entity.insert(*light),
            Light::Local(light) => entity.insert(*light),
        };
    }
    let materials = &mut world.get_resource_or_init::<Materials>().0;
    let first_material = materials.len();
    materials.extend(checked.materials.iter().cloned());
    let mut shapes: Vec<(Shape, usize)> = Vec::new();
    for (name, object, transform) in &checked.objects {
        let material = first_material + object.material;
        let known = shapes.iter().find(|(shape, _)| *shape == object.shape).map(|(_, mesh)| *mesh);
        let mesh = known.unwrap_or_else(|| {
            let meshes = &mut world.get_resource_or_init::<Meshes>().0;
            meshes.push(build(name, object.shape, material));
            shapes.push((object.shape, meshes.len() - 1));
            meshes.len() - 1
        });
        world.spawn((Name::new(name.clone()), Transform(*transform), MeshInstance { mesh, material }));
    }
    assign_slots(world);
}

/// An entity that places what is spawned below it.
pub(super) fn group(world: &mut World, name: &str, transform: Affine3A) -> Entity {
    world.spawn((Name::new(name.to_owned()), Transform(transform))).id()
}

fn build(name: &str, shape: Shape, material: usize) -> Mesh {
    match shape {
        Shape::Box(size) => primitive::cuboid(name, size, material),
        Shape::Sphere { radius, sectors, stacks } => primitive::sphere(name, radius, sectors, stacks, material),
        Shape::Plane(size) => primitive::plane(name, size, material),
    }
}
