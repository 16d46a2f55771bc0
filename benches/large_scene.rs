//! A large scene: what a change costs the CPU, beside everything anew.
//!
//! Run with `cargo bench -p luminaire`. 10,000 objects of 100 meshes in 10 materials, eight lamps with shadow cubes and a sun; an update of
//! one object, of a hundred, and of all. `publish` is the world's share, and the same by a publisher that remembers nothing; `frame` is
//! publishing, taking the scene over and a frame of `pbr` on wgpu's noop device, so that nothing is computed.

#![allow(clippy::expect_used, clippy::print_stdout, reason = "a bench stops where it can't go on, and says what it measured")]

use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use bevy_ecs::prelude::{Entity, World};
use criterion::{Criterion, criterion_group, criterion_main};
use glam::{Affine3A, Vec3};
use luminaire::files::DiskFiles;
use luminaire::graph::compile::CompileInput;
use luminaire::graph::device::DeviceFacts;
use luminaire::graph::plan::Plan;
use luminaire::passes::{Executor, Gpu, GpuOptions};
use luminaire::scenes::asset::{Material, Projection};
use luminaire::scenes::primitive::cuboid;
use luminaire::scenes::publish::{PublishRequest, Publisher, counts, schema};
use luminaire::scenes::world::{
    Camera, DirectionalLight, Exposure, LocalLight, Materials, MeshInstance, Meshes, Transform, assign_slots, new_world,
};
use luminaire::session::compile_pipeline;

const OBJECTS: usize = 10_000;
const MESHES: usize = 100;
const MATERIALS: usize = 10;
const LAMPS: u32 = 8;
const MOVED: [usize; 4] = [0, 1, 100, OBJECTS];

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

/// Lifts the first objects a little, to another height than before.
fn lift(world: &mut World, objects: &[Entity], height: &mut f32) {
    *height = (*height + 0.001) % 0.1;
    for (index, object) in objects.iter().enumerate() {
        if let Some(mut transform) = world.get_mut::<Transform>(*object) {
            transform.0.translation = (place(index) + Vec3::Y * *height).into();
        }
    }
}

/// The plan of `pbr` for the world, and a device that computes nothing.
fn plan(world: &mut World) -> (Gpu, Arc<Plan>) {
    let facts = DeviceFacts::webgpu_defaults();
    let gpu = Gpu::open(&GpuOptions { noop: Some(facts.clone()), ..GpuOptions::default() }).expect("the noop device needs no driver");
    assign_slots(world);
    let sets = [("shadowed_point_lights".to_owned(), LAMPS.to_string()), ("local_shadow_texels".to_owned(), "256".to_owned())];
    let compilation = compile_pipeline(&CompileInput {
        pipeline: "pbr",
        files: &DiskFiles::for_pipeline(Path::new("pbr")),
        published: &schema(),
        counts: &counts(world),
        device: &facts,
        output: [1280, 720],
        sets: &sets,
        outputs: Some(&["color".to_owned()]),
    });
    (gpu, Arc::new(compilation.plan.expect("a plan")))
}

fn large_scene(criterion: &mut Criterion) {
    let (mut world, objects) = scene();
    let (gpu, plan) = plan(&mut world);
    let (views, draw_lists) = (&plan.views, &plan.draw_lists);
    let request = PublishRequest { camera: None, extent: plan.extent, views, draw_lists, max_texture_2d: 8192 };
    let mut group = criterion.benchmark_group("publish");
    group.sample_size(20).measurement_time(Duration::from_secs(3)).warm_up_time(Duration::from_secs(1));
    let mut publisher = Publisher::default();
    let mut height = 0.0;
    for moved in MOVED {
        group.bench_function(format!("{moved} of {OBJECTS} objects moved"), |bencher| {
            bencher.iter(|| {
                lift(&mut world, &objects[..moved], &mut height);
                black_box(publisher.publish(&mut world, &request).expect("a scene"))
            });
        });
    }
    group.bench_function("by a publisher that remembers nothing", |bencher| {
        bencher.iter(|| black_box(Publisher::default().publish(&mut world, &request).expect("a scene")));
    });
    group.finish();

    let mut group = criterion.benchmark_group("frame");
    group.sample_size(20).measurement_time(Duration::from_secs(3)).warm_up_time(Duration::from_secs(1));
    let first = publisher.publish(&mut world, &request).expect("a scene").scene;
    let mut executor = Executor::new(&gpu, Arc::clone(&plan), &schema(), Arc::new(first)).expect("an executor");
    let mut frame = |world: &mut World, moved: usize| {
        lift(world, &objects[..moved], &mut height);
        let scene = publisher.publish(world, &request).expect("a scene").scene;
        executor.update_scene(Arc::new(scene)).expect("the same plan");
        executor.render_frame().expect("a frame").counts
    };
    println!("draw calls of the first frame: {}", frame(&mut world, 0).draw_calls);
    for moved in MOVED {
        let counts = frame(&mut world, moved);
        println!("{moved} of {OBJECTS} objects moved: {} draw calls in {} passes", counts.draw_calls, counts.steps);
    }
    for moved in MOVED {
        group.bench_function(format!("{moved} of {OBJECTS} objects moved"), |bencher| {
            bencher.iter(|| black_box(frame(&mut world, moved)));
        });
    }
    group.finish();
}

criterion_group!(benches, large_scene);
criterion_main!(benches);
