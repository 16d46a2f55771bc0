//! From a world to what it publishes, again and again.

use bevy_ecs::change_detection::Tick;
use bevy_ecs::prelude::World;
use bevy_ecs::world::WorldId;
use bytemuck::Pod;
use glam::DVec3;
use indexmap::IndexMap;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::published::{CascadeView, PublishedScene, Table, ViewKind};

use super::casters::Cube;
use super::draws::{Distance, DrawInput, Draws};
use super::frustum::Frustum;
use super::geometry::{self, Geometry};
use super::objects::Objects;
use super::projection::CameraView;
use super::request::{self, PublishRequest, Published};
use super::schema::SKY_IMAGE;
use super::sky_image::SkyTexture;
use super::spot::SpotView;
use super::sun::SunView;
use super::texture_cache::TextureCache;
use super::visible::Visible;
use super::{cascades, environment, lights, materials, probes, rectangles};
use crate::world::{Environment, Materials, Meshes, camera_pose, update};

/// Publishes a world, and remembers what it published.
#[derive(Debug, Default)]
pub struct Publisher {
    /// The world, and its tick when it was last published.
    seen: Option<(WorldId, Tick)>,
    /// When the materials changed last.
    materials: Option<Tick>,
    geometry: Geometry,
    textures: TextureCache,
    sky: SkyTexture,
    objects: Objects,
    visible: Visible,
    draws: Draws,
    tables: IndexMap<String, Table>,
}

impl Publisher {
    /// Publishes the world as it is now, and brings it up to date first ([`update`]).
    /// Errors: `world::unknown-camera`, `publish::unknown-light`, `publish::unknown-probe`, `publish::unknown-face`,
    /// `publish::mixed-cascades`, `publish::too-much-geometry`.
    pub fn publish(&mut self, world: &mut World, request: &PublishRequest<'_>) -> Result<Published, Vec<Diagnostic>> {
        if self.seen.is_some_and(|(known, _)| known != world.id()) {
            *self = Publisher::default();
        }
        update(world);
        let materials = world.get_resource_or_init::<Materials>().0.clone();
        let of_materials = world.get_resource_change_ticks::<Materials>().map(|ticks| ticks.changed);
        let same_materials = self.materials == of_materials;
        let meshes = world.get_resource_or_init::<Meshes>();
        let (mesh_count, same_meshes) = (meshes.0.len(), self.geometry.ranges.len() == meshes.0.len());
        let mut problems = Vec::new();
        if !same_meshes {
            match geometry::build(&meshes.0) {
                Ok(geometry) => self.geometry = geometry,
                Err(problem) => problems.push(problem),
            }
        }
        let since = self.seen.map(|(_, tick)| tick).filter(|_| same_materials && same_meshes);
        let changed = self.objects.update(world, since, mesh_count, &materials);
        (self.seen, self.materials) = (Some((world.id(), world.last_change_tick())), of_materials);
        let bounds = self.objects.bounds;
        let lights = lights::collect(world, bounds, self.objects.solid_bounds);
        let rectangles = rectangles::rows(world, self.objects.solid_bounds);
        let probes = probes::rows(world);
        problems.extend(request::check(request, &lights, rectangles.len(), probes.len()));
        let pose = camera_pose(world, request.camera, bounds, request.aspect()).map_err(|problem| problems.push(problem)).ok();

        let wanted = request.draw_lists;
        let (Some(pose), true) = (pose, problems.is_empty()) else {
            // Lists were not brought up to date with what was taken over.
            *self = Publisher::default();
            return Err(problems);
        };
        let camera = CameraView::new(pose, request.aspect());
        let solid = self.objects.solid_bounds;
        let suns: Vec<Option<SunView>> = request.views.iter().map(|view| request::sun_view(view, &camera, &lights, solid)).collect();
        let frusta = |view| match view {
            ViewKind::DirectionalLight(light) | ViewKind::WholeScene(light) | ViewKind::Cascade(CascadeView { light, .. }) => {
                // A light that is not there has no shadows.
                let sun = lights.suns.get(light as usize).copied().flatten();
                let maps = request.views.iter().zip(&suns).filter(|(request, _)| request.kind == view && sun.is_some());
                maps.filter_map(|(_, map)| map.as_ref().map(|map| map.casters.clone())).collect()
            }
            ViewKind::SpotLight(light) => lights.spot(light).map(|lamp| SpotView::of(&lamp).casters).into_iter().collect(),
            ViewKind::Camera | ViewKind::PointLight(..) | ViewKind::RectangleLight(..) | ViewKind::ReflectionProbe(..) => {
                vec![Frustum::of_camera(&camera)]
            }
        };
        let center = |cube| match cube {
            Cube::Point(light) => lights.point(light).map(|lamp| lamp.center()),
            Cube::Rectangle(light) => rectangles::center(&rectangles, light),
            Cube::Probe(probe) => probes::center(&probes, probe),
        };
        let views = self.visible.update(world, &wanted.iter().map(|(_, view)| *view).collect(), frusta, center, &self.objects, &changed);
        let (visible, ranges) = (&self.visible, &self.geometry.ranges);
        let input = DrawInput { objects: &self.objects, changed: &changed, ranges, visible, views: &views };
        let draw_lists = self.draws.update(wanted, &input, |view| match view {
            ViewKind::Camera => Distance::from_camera(&camera),
            ViewKind::DirectionalLight(light) | ViewKind::WholeScene(light) | ViewKind::Cascade(CascadeView { light, .. }) => {
                Distance::Along(-lights.to_sun(light))
            }
            ViewKind::PointLight(..) | ViewKind::RectangleLight(..) | ViewKind::ReflectionProbe(..) => {
                Distance::From(Cube::of(view).and_then(|(cube, _)| center(cube)).map_or(DVec3::ZERO, |center| center.position))
            }
            ViewKind::SpotLight(light) => Distance::From(lights.spot(light).map_or(DVec3::ZERO, |lamp| lamp.position)),
        });
        let view_bytes = |(view, sun): (_, &Option<SunView>)| {
            let table = sun.as_ref().map_or_else(|| request::view_table(view, &camera, &lights, center), |sun| sun.table);
            bytemuck::bytes_of(&table).to_vec()
        };
        let views = request.views.iter().zip(&suns).map(view_bytes).collect();
        let environment = *world.get_resource_or_init::<Environment>();
        let (sky_image, sky) = self.sky.update(world, request.max_texture_2d);
        let environment = environment::table(environment, &lights, rectangles.len(), sky, &materials, bounds);
        self.set("camera", &[camera.table()]);
        self.set("environment", &[environment]);
        self.set("directional_lights", &lights.directional_rows(request.views, &suns));
        self.set("cascades", &cascades::rows(request.views, &suns, &camera, solid));
        self.set("whole_scenes", &cascades::whole_rows(request.views, &suns));
        self.set("local_lights", &lights.local_rows());
        self.set("point_lights", &lights.point_rows());
        self.set("spot_lights", &lights.spot_rows());
        self.set("rectangle_lights", &rectangles);
        self.set("reflection_probes", &probes);
        if !same_materials || !self.tables.contains_key("materials") {
            self.set("materials", &materials::rows(&materials));
        }
        self.tables.insert("instances".to_owned(), self.objects.table().clone());
        self.tables.insert("instance_slots".to_owned(), self.draws.table().clone());
        let (materials, warnings) = self.textures.update(world, &materials, request.max_texture_2d);
        let textures = [(SKY_IMAGE.to_owned(), sky_image)].into_iter().collect();
        let scene = PublishedScene {
            tables: self.tables.clone(),
            views,
            textures,
            geometry: self.geometry.published.clone(),
            materials,
            draw_lists,
        };
        Ok(Published { scene, warnings: warnings.to_vec() })
    }

    /// Sets a table; one zeroed row stands for none, since a storage binding must not be empty.
    fn set<Row: Pod>(&mut self, name: &str, rows: &[Row]) {
        let none = [Row::zeroed()];
        let bytes: &[u8] = bytemuck::cast_slice(if rows.is_empty() { &none } else { rows });
        match self.tables.get_mut(name) {
            Some(table) => table.set(bytes),
            None => _ = self.tables.insert(name.to_owned(), Table::new(size_of::<Row>(), bytes)),
        }
    }
}
