//! Publishing a large scene: what a change costs, beside publishing everything.
//!
//! Run with `cargo bench -p luminaire-scenes`. 10,000 objects of 100 meshes in 10 materials, eight lamps with shadow cubes and a sun; an
//! update of one object, of a hundred, and of all, and the same scene by a publisher that remembers nothing.

#![allow(clippy::expect_used, reason = "a bench stops where it can't go on")]

use std::hint::black_box;
use std::time::Duration;

use bevy_ecs::prelude::{Entity, World};
use criterion::{Criterion, criterion_group, criterion_main};
use glam::{Affine3A, Vec3};
use luminaire_graph::published::{DrawFilter, ViewKind, ViewRequest};
use luminaire_scenes::asset::{Material, Projection};
use luminaire_scenes::primitive::cuboid;
use luminaire_scenes::publish::{PublishRequest, Publisher};
use luminaire_scenes::world::{Camera, DirectionalLight, Exposure, LocalLight, Materials, MeshInstance, Meshes, Transform, new_world};

const OBJECTS: usize = 10_000;
const MESHES: usize = 100;
const MATERIALS: usize = 10;
const LAMPS: u32 = 8;

/// Places on a square grid, a metre and a half apart.
fn place(index: usize) -> Vec3 {
    Vec3::new((index % 100) as f32, 0.0, (index / 100) as f32) * 1.5
}

fn scene() -> (World, Vec<Entity>) {
    let mut world = new_world();
    world.resource_mut::<Meshes>().0 = (0..MESHES).map(|mesh| cuboid("box", Vec3::splat(0.5 + mesh as f32 * 0.005), 0)).collect();
    world.resource_mut::<Materials>().0 = vec![Material::default(); MATERIALS];
    // Without a camera, changed bounds would start a search for one.
    let projection = Projection::Perspective { yfov: 0.8, near: 0.1, far: None };
    let camera = Camera { name: "main".to_owned(), projection, exposure: Exposure::Unchanged };
    world.spawn((Transform(Affine3A::from_translation(Vec3::new(75.0, 20.0, 170.0))), camera));
    world.spawn((Transform(Affine3A::from_rotation_x(-1.0)), DirectionalLight { color: Vec3::ONE, illuminance: 10_000.0 }));
    for lamp in 0..LAMPS {
        let at = Vec3::new(20.0 * lamp as f32, 4.0, 70.0);
        let light = LocalLight { color: Vec3::ONE, intensity: 100.0, range: Some(15.0), cone: None };
        world.spawn((Transform(Affine3A::from_translation(at)), light));
    }
    let object = |index: usize| {
        (Transform(Affine3A::from_translation(place(index))), MeshInstance { mesh: index % MESHES, material: index / MESHES % MATERIALS })
    };
    let objects = (0..OBJECTS).map(|index| world.spawn(object(index)).id()).collect();
    (world, objects)
}

fn publishing(criterion: &mut Criterion) {
    let mut lists = vec![(DrawFilter::Opaque, ViewKind::Camera), (DrawFilter::Opaque, ViewKind::DirectionalLight(0))];
    lists.extend((0..LAMPS * 6).map(|face| (DrawFilter::Opaque, ViewKind::LocalLight(face / 6, face % 6))));
    let views: Vec<ViewRequest> = lists.iter().map(|(_, kind)| ViewRequest { kind: *kind, width: 1024, height: 1024 }).collect();
    let request = PublishRequest { camera: None, extent: [1280, 720], views: &views, draw_lists: &lists, max_texture_2d: 8192 };
    let mut group = criterion.benchmark_group("publish");
    group.sample_size(20).measurement_time(Duration::from_secs(3)).warm_up_time(Duration::from_secs(1));
    let (mut world, objects) = scene();
    let mut publisher = Publisher::default();
    publisher.publish(&mut world, &request).expect("a scene");
    let mut height = 0.0;
    for moved in [0, 1, 100, OBJECTS] {
        group.bench_function(format!("{moved} of {OBJECTS} objects moved"), |bencher| {
            bencher.iter(|| {
                height = (height + 0.001_f32) % 0.1;
                for (index, object) in objects.iter().enumerate().take(moved) {
                    if let Some(mut transform) = world.get_mut::<Transform>(*object) {
                        transform.0.translation = (place(index) + Vec3::Y * height).into();
                    }
                }
                black_box(publisher.publish(&mut world, &request).expect("a scene"))
            });
        });
    }
    group.bench_function("by a publisher that remembers nothing", |bencher| {
        bencher.iter(|| black_box(Publisher::default().publish(&mut world, &request).expect("a scene")));
    });
    group.finish();
}

criterion_group!(benches, publishing);
criterion_main!(benches);
