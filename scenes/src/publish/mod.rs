//! What a scene publishes to passes: tables, textures, geometry and draw lists, by name.
//!
//! Guarantees: equal worlds and requests give equal bytes; tables follow stable slots, and none is empty; no published number
//! is NaN. Textures are filtered once and kept until the world's images or materials change.
//! Accepted downside: geometry and textures are copied into every result, and shadow views cull nothing.

mod counts;
mod coverage;
mod cube;
mod draws;
mod environment;
mod geometry;
mod layout;
mod lights;
mod materials;
mod mips;
mod objects;
mod projection;
mod request;
mod schema;
mod sun;
mod texture_cache;
mod textures;

#[cfg(test)]
mod tests;

use bevy_ecs::prelude::World;
use bytemuck::Pod;
use indexmap::IndexMap;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::published::{PublishedScene, ViewKind};

pub use counts::counts;
pub use layout::{CameraTable, Columns, DirectionalRow, EnvironmentTable, InstanceRow, LocalRow, MaterialRow, TEXTURES, ViewTable, flags};
pub use request::{PublishRequest, Published};
pub use schema::{COUNT_NAMES, TEXTURE_NAMES, schema};

use crate::world::{Environment, Materials, Meshes, assign_slots, camera_pose, propagate_transforms, scene_bounds, update_bounds};
use draws::Distance;
use projection::CameraView;

/// Publishes the world as it is now. Brings transforms, slots and bounds up to date first.
/// Errors: `world::unknown-camera`, `publish::unknown-light`, `publish::unknown-face`, `publish::too-much-geometry`.
pub fn publish(world: &mut World, request: &PublishRequest<'_>) -> Result<Published, Vec<Diagnostic>> {
    propagate_transforms(world);
    assign_slots(world);
    update_bounds(world);
    let bounds = scene_bounds(world);
    let lights = lights::collect(world);
    let mut problems = request::check(request, &lights);
    let pose = camera_pose(world, request.camera, bounds, request.aspect()).map_err(|problem| problems.push(problem)).ok();
    let meshes = world.get_resource_or_init::<Meshes>();
    let geometry = geometry::build(&meshes.0).map_err(|problem| problems.push(problem)).ok();
    let (Some(pose), Some(geometry), true) = (pose, geometry, problems.is_empty()) else { return Err(problems) };

    let camera = CameraView::new(pose, request.aspect());
    let materials = world.get_resource_or_init::<Materials>().0.clone();
    let objects = objects::collect(world, geometry.ranges.len(), &materials);
    let textures = texture_cache::textures(world, &materials, request.max_texture_2d);
    let environment = *world.get_resource_or_init::<Environment>();
    let environment = environment::table(environment, &lights, &materials, bounds);

    let (draw_lists, instance_slots) = draws::build(&objects, &geometry.ranges, request.draw_lists, |view| match view {
        ViewKind::Camera => Distance::from_camera(&camera),
        ViewKind::DirectionalLight(light) => {
            Distance::Along(lights.suns.get(light as usize).copied().flatten().map_or(-glam::DVec3::Y, |sun| -sun.to_light))
        }
        ViewKind::LocalLight(light, _) => {
            Distance::From(lights.lamps.get(light as usize).copied().flatten().map_or(glam::DVec3::ZERO, |lamp| lamp.position))
        }
    });
    let views = request.views.iter().map(|view| bytes(&[request::view_table(view, &camera, &lights, bounds)])).collect();
    let tables = IndexMap::from([
        ("camera".to_owned(), bytes(&[camera.table()])),
        ("environment".to_owned(), bytes(&[environment])),
        ("directional_lights".to_owned(), bytes(&lights.directional_rows(&camera, bounds, request.views))),
        ("local_lights".to_owned(), bytes(&lights.local_rows(bounds))),
        ("instances".to_owned(), bytes(&objects::rows(&objects))),
        ("instance_slots".to_owned(), bytes(&instance_slots)),
        ("materials".to_owned(), bytes(&materials::rows(&materials))),
    ]);
    let scene = PublishedScene {
        tables,
        views,
        vertices: geometry.vertices,
        indices: geometry.indices,
        textures: textures.textures,
        samplers: textures.samplers,
        materials: textures.bindings,
        draw_lists,
    };
    Ok(Published { scene, warnings: textures.warnings })
}

/// The bytes of a table; one zeroed row stands for none, since a storage binding must not be empty.
fn bytes<Row: Pod>(rows: &[Row]) -> Vec<u8> {
    if rows.is_empty() { vec![0; size_of::<Row>()] } else { bytemuck::cast_slice(rows).to_vec() }
}
