//! Tests of publishing as a whole.

use bevy_ecs::prelude::{Entity, World};
use bytemuck::Pod;
use glam::{Affine3A, Mat4, Quat, Vec2, Vec3};
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::published::{CascadeSplit, CascadeView, DrawBatch, DrawFilter, Positive, TableKind, ViewKind, ViewRequest};

use super::*;
use crate::asset::{AlphaMode, Material, Projection};
use crate::primitive::{cuboid, sphere};
use crate::world::{
    Camera, ChildOf, Cone, DirectionalLight, Exposure, Hidden, LocalLight, Materials, MeshInstance, Meshes, Name, RectangleLight,
    ReflectionProbe, Transform, new_world, set_translation,
};

mod captures;

const CAMERA_VIEW: ViewRequest = ViewRequest { kind: ViewKind::Camera, width: 64, height: 48 };
const SUN_VIEW: ViewRequest = ViewRequest { kind: ViewKind::DirectionalLight(0), width: 512, height: 512 };

const PROBE_VIEW: ViewRequest = ViewRequest { kind: ViewKind::ReflectionProbe(0, 4), width: 16, height: 16 };

fn request<'a>(views: &'a [ViewRequest], draw_lists: &'a [(DrawFilter, ViewKind)]) -> PublishRequest<'a> {
    PublishRequest { camera: None, extent: [64, 48], views, draw_lists, max_texture_2d: 8192 }
}

/// A camera at (0, 0, 5) that looks along -z, a sun from above, and a lamp. Materials: 0 and 1 opaque, 2 masked and double
/// sided, 3 blended. Meshes: 0 box, 1 sphere.
fn stage() -> World {
    let mut world = new_world();
    let masked = Material { alpha_mode: AlphaMode::Mask { cutoff: 0.5 }, double_sided: true, ..Material::default() };
    let blended = Material { alpha_mode: AlphaMode::Blend, ..Material::default() };
    world.resource_mut::<Materials>().0 = vec![Material::default(), Material::default(), masked, blended];
    world.resource_mut::<Meshes>().0 = vec![cuboid("box", Vec3::ONE, 0), sphere("ball", 0.5, 8, 4, 0)];
    let projection = Projection::Perspective { yfov: 0.8, near: 0.1, far: None };
    world.spawn((
        Transform(Affine3A::from_translation(Vec3::Z * 5.0)),
        Camera { name: "main".to_owned(), projection, exposure: Exposure::Unchanged },
    ));
    let down = Affine3A::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    world.spawn((Transform(down), DirectionalLight { color: Vec3::ONE, illuminance: 100_000.0 }));
    let lamp = LocalLight { color: Vec3::ONE, intensity: 10.0, range: None, cone: None };
    world.spawn((Transform(Affine3A::from_translation(Vec3::Y * 3.0)), lamp));
    world
}

fn place(world: &mut World, mesh: usize, material: usize, at: Vec3, scale: Vec3) {
    let transform = Affine3A::from_scale_rotation_translation(scale, Quat::IDENTITY, at);
    world.spawn((Transform(transform), MeshInstance { mesh, material }));
}

/// A rectangle of light that faces down.
fn panel(at: Vec3) -> (Transform, RectangleLight) {
    let light = RectangleLight { color: Vec3::ONE, luminance: 5.0, size: Vec2::new(2.0, 1.0), two_sided: false };
    (Transform(Affine3A::from_rotation_translation(Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2), at)), light)
}

fn probe(place: Affine3A) -> (Transform, ReflectionProbe) {
    (Transform(place), ReflectionProbe { size: Vec3::new(4.0, 2.0, 4.0), near: 0.1, far: 8.0 })
}

/// What somebody publishes who has published nothing before.
fn publish(world: &mut World, request: &PublishRequest<'_>) -> Result<Published, Vec<Diagnostic>> {
    Publisher::default().publish(world, request)
}

fn table_rows<Row: Pod>(published: &Published, table: &str) -> Vec<Row> {
    bytemuck::pod_collect_to_vec(&published.scene.tables[table].bytes())
}

fn slots(published: &Published, batch: &DrawBatch) -> Vec<u32> {
    let table: Vec<u32> = table_rows(published, "instance_slots");
    table[batch.first_instance as usize..][..batch.instance_count as usize].to_vec()
}

fn crowd() -> World {
    let mut world = stage();
    place(&mut world, 0, 1, Vec3::ZERO, Vec3::ONE);
    place(&mut world, 1, 0, Vec3::X, Vec3::ONE);
    place(&mut world, 0, 0, Vec3::Y, Vec3::ONE);
    place(&mut world, 0, 0, Vec3::NEG_X, Vec3::new(-1.0, 1.0, 1.0));
    place(&mut world, 0, 0, Vec3::NEG_Y, Vec3::ONE);
    place(&mut world, 1, 2, Vec3::ZERO, Vec3::ONE);
    place(&mut world, 0, 3, Vec3::new(0.0, 0.0, 1.0), Vec3::ONE);
    place(&mut world, 0, 3, Vec3::new(0.0, 0.0, -3.0), Vec3::ONE);
    place(&mut world, 1, 3, Vec3::new(0.0, 0.0, -1.0), Vec3::ONE);
    place(&mut world, 0, 3, Vec3::new(0.0, 0.0, 2.0), Vec3::ONE);
    world
}

#[test]
fn solid_objects_share_a_call_per_material_mesh_and_orientation() {
    let mut world = crowd();
    let published = publish(&mut world, &request(&[], &[(DrawFilter::Solid, ViewKind::Camera)])).unwrap();
    let batches = &published.scene.draw_lists[0].batches;
    let seen: Vec<(usize, u32, bool, bool, Vec<u32>)> = batches
        .iter()
        .map(|batch| (batch.material, batch.first_index, batch.mirrored, batch.double_sided, slots(&published, batch)))
        .collect();
    let expected = [
        // Boxes are solids, whose backs are drawn.
        (0, 0, false, true, vec![2, 4]),
        (0, 0, true, true, vec![3]),
        (0, 36, false, true, vec![1]),
        (1, 0, false, true, vec![0]),
        (2, 36, false, true, vec![5]),
    ];
    assert_eq!(seen, expected);
    assert_eq!(batches[2].base_vertex, 24);
}

#[test]
fn blended_objects_go_back_to_front_from_their_view() {
    let mut world = crowd();
    let lists =
        [(DrawFilter::Blended, ViewKind::Camera), (DrawFilter::All, ViewKind::PointLight(0, 3)), (DrawFilter::Opaque, ViewKind::Camera)];
    let published = publish(&mut world, &request(&[], &lists)).unwrap();
    let order =
        |list: usize| -> Vec<u32> { published.scene.draw_lists[list].batches.iter().flat_map(|batch| slots(&published, batch)).collect() };
    assert_eq!(order(0), [7, 8, 6, 9]);
    assert_eq!(published.scene.draw_lists[0].batches.len(), 3, "neighbours that agree share a call");
    // The lamp stands at (0, 3, 0); ties go by slot.
    assert_eq!(order(1)[6..], [7, 9, 6, 8]);
    assert_eq!(order(2), [2, 4, 3, 1, 0]);
    assert!(published.scene.draw_lists[1].batches.iter().all(|batch| batch.mirrored != slots(&published, batch).contains(&3)));
}

#[test]
fn tables_fit_the_schema_and_follow_slots() {
    let mut world = crowd();
    let published = publish(&mut world, &request(&[CAMERA_VIEW, SUN_VIEW], &[])).unwrap();
    for (name, table) in schema().tables {
        match table.kind {
            TableKind::View => assert!(published.scene.views.iter().all(|view| view.len() == table.stride as usize)),
            TableKind::Uniform => assert_eq!(published.scene.tables[&name].len(), table.stride as usize, "{name}"),
            TableKind::Storage => {
                let bytes = published.scene.tables[&name].len();
                assert!(bytes > 0 && bytes.is_multiple_of(table.stride as usize), "{name}");
            }
        }
    }
    let rows: Vec<InstanceRow> = table_rows(&published, "instances");
    assert_eq!(rows.len(), 10);
    assert_eq!((rows[3].normal_from_object_0[3], rows[3].object, rows[5].material), (-1.0, 3, 2));
    let environment: Vec<EnvironmentTable> = table_rows(&published, "environment");
    assert_eq!((environment[0].light_unit, environment[0].directional_count, environment[0].local_count), (512.0, 1, 1));
    let suns: Vec<DirectionalRow> = table_rows(&published, "directional_lights");
    let view: &ViewTable = bytemuck::from_bytes(&published.scene.views[1]);
    assert_eq!(suns[0].shadow_from_world, view.projection_from_world);
    assert!((suns[0].shadow_depth_range - view.far).abs() < 1e-6 && suns[0].shadow_texel_size > 0.0);
    assert!(Vec3::from(suns[0].direction_to_light).distance(Vec3::Y) < 1e-6);
}

#[test]
fn a_light_without_a_shadow_view_has_zeros_there() {
    let published = publish(&mut stage(), &request(&[], &[])).unwrap();
    let suns: Vec<DirectionalRow> = table_rows(&published, "directional_lights");
    assert_eq!((suns[0].shadow_texel_size, suns[0].shadow_from_world), (0.0, [[0.0; 4]; 4]));
}

#[test]
fn cube_views_reach_what_their_light_shines_on() {
    let mut world = crowd();
    let views: Vec<ViewRequest> = (0..6).map(|face| ViewRequest { kind: ViewKind::PointLight(0, face), width: 64, height: 64 }).collect();
    let published = publish(&mut world, &request(&views, &[])).unwrap();
    let lamps: Vec<PointRow> = table_rows(&published, "point_lights");
    let down: &ViewTable = bytemuck::from_bytes(&published.scene.views[3]);
    assert_eq!((lamps[0].near, lamps[0].far, lamps[0].light), (down.near, down.far, 0));
    let at_origin = Mat4::from_cols_array_2d(&down.projection_from_world).project_point3(Vec3::ZERO);
    assert!(at_origin.x.abs() < 1e-5 && at_origin.y.abs() < 1e-5 && (0.0..1.0).contains(&at_origin.z));
}

#[test]
fn equal_worlds_publish_equal_bytes_and_a_second_time_changes_nothing() {
    let lists = [(DrawFilter::All, ViewKind::Camera)];
    let wanted = request(&[CAMERA_VIEW, SUN_VIEW], &lists);
    let dump = |published: Published| format!("{:?}", published.scene);
    let mut world = crowd();
    let first = dump(publish(&mut world, &wanted).unwrap());
    assert_eq!(first, dump(publish(&mut world, &wanted).unwrap()));
    assert_eq!(first, dump(publish(&mut crowd(), &wanted).unwrap()));
}

#[test]
fn textures_follow_changes_of_materials() {
    let mut world = stage();
    assert_eq!(publish(&mut world, &request(&[], &[])).unwrap().scene.materials.bindings.len(), 4);
    world.resource_mut::<Materials>().0.push(Material::default());
    assert_eq!(publish(&mut world, &request(&[], &[])).unwrap().scene.materials.bindings.len(), 5);
}

#[test]
fn moving_a_node_moves_its_row() {
    let mut world = stage();
    world.spawn((Name::new("moving_box"), Transform::default(), MeshInstance { mesh: 0, material: 0 }));
    publish(&mut world, &request(&[], &[])).unwrap();
    set_translation(&mut world, "moving_box", Vec3::new(-1.6, 0.6, -1.4)).unwrap();
    let published = publish(&mut world, &request(&[], &[])).unwrap();
    let rows: Vec<InstanceRow> = table_rows(&published, "instances");
    assert_eq!(rows[0].world_from_object[3], [-1.6, 0.6, -1.4, 1.0]);
}

#[test]
fn an_empty_world_publishes_without_nan() {
    let published = publish(&mut new_world(), &request(&[CAMERA_VIEW], &[(DrawFilter::All, ViewKind::Camera)])).unwrap();
    assert!(published.scene.tables.values().all(|table| !table.is_empty()));
    assert!(published.scene.draw_lists[0].batches.is_empty());
    let camera = table_rows::<CameraTable>(&published, "camera")[0];
    assert!(Mat4::from_cols_array_2d(&camera.world_from_projection).is_finite() && camera.exposure == 1.0);
    assert!(counts(&new_world()).values().all(|count| *count == 0));
}

#[test]
fn degenerate_worlds_publish_finite_numbers() {
    let transforms = [
        Affine3A::from_scale(Vec3::ZERO),
        Affine3A::from_scale(Vec3::splat(1e30)),
        Affine3A::from_scale(Vec3::splat(f32::MAX)),
        Affine3A::from_translation(Vec3::splat(1e37)),
        Affine3A::from_scale(Vec3::splat(f32::NAN)),
        Affine3A::from_translation(Vec3::splat(f32::INFINITY)),
    ];
    let views = [CAMERA_VIEW, SUN_VIEW, ViewRequest { kind: ViewKind::PointLight(1, 5), width: 8, height: 8 }, PROBE_VIEW];
    for transform in transforms {
        let mut world = stage();
        let lamp = LocalLight { color: Vec3::ONE, intensity: f32::INFINITY, range: Some(f32::NAN), cone: None };
        world.spawn((Transform(transform), lamp));
        world.spawn(probe(transform));
        world.spawn((Transform(transform), MeshInstance { mesh: 0, material: 3 }));
        let published = publish(&mut world, &request(&views, &[(DrawFilter::All, ViewKind::PointLight(1, 0))])).unwrap();
        for (name, table) in published.scene.tables.iter().filter(|(name, _)| *name != "instance_slots") {
            let bytes = table.bytes();
            let numbers: &[f32] = bytemuck::cast_slice(&bytes);
            assert!(numbers.iter().all(|number| !number.is_nan()), "{name} of {transform:?}");
        }
        for view in &published.scene.views {
            let numbers: &[f32] = bytemuck::cast_slice(view);
            assert!(numbers.iter().all(|number| !number.is_nan()), "a view of {transform:?}");
        }
    }
}

/// A spot from above, with a half angle of 0.5.
fn spot(at: Vec3) -> (Transform, LocalLight) {
    let cone = Some(Cone { inner: 0.2, outer: 0.5 });
    let down = Affine3A::from_rotation_translation(Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2), at);
    (Transform(down), LocalLight { color: Vec3::ONE, intensity: 10.0, range: None, cone })
}

#[test]
fn a_spot_has_one_map_over_its_cone() {
    let mut world = crowd();
    world.spawn(spot(Vec3::new(0.0, 4.0, 0.0)));
    let views = [ViewRequest { kind: ViewKind::SpotLight(0), width: 64, height: 64 }];
    let published = publish(&mut world, &request(&views, &[(DrawFilter::Opaque, ViewKind::SpotLight(0))])).unwrap();
    let view: &ViewTable = bytemuck::from_bytes(&published.scene.views[0]);
    let lamps: Vec<LocalRow> = table_rows(&published, "local_lights");
    let row = table_rows::<SpotRow>(&published, "spot_lights")[0];
    assert_eq!(lamps.iter().map(|lamp| lamp.shadow).collect::<Vec<_>>(), [0, -1]);
    assert_eq!((row.shadow_from_world, row.near, row.far, row.light), (view.projection_from_world, view.near, view.far, 1));
    let matrix = Mat4::from_cols_array_2d(&view.projection_from_world);
    let rim = matrix.project_point3(Vec3::new(0.0, 2.0, 2.0 * 0.5_f32.tan()));
    assert!(rim.x.abs() < 1e-4 && rim.y.abs() < 1.0 && rim.y.abs() > 0.95, "the cone's rim is near the map's edge: {rim}");
    assert!((row.half_width * 1.0 - 0.5_f32.tan() / rim.y.abs()).abs() < 1e-3);
}

#[test]
fn cascades_are_rows_by_light_and_index() {
    let mut world = crowd();
    world.spawn((Transform(Affine3A::from_rotation_x(-1.0)), DirectionalLight { color: Vec3::ONE, illuminance: 1.0 }));
    let split = CascadeSplit { count: 3, distance: Positive::new(8.0), lambda: Positive::new(0.5), snap: true };
    let view = |light, index| ViewRequest { kind: ViewKind::Cascade(CascadeView { light, index, split }), width: 256, height: 256 };
    let views = [view(1, 0), view(1, 1), view(1, 2), view(0, 1)];
    let published = publish(&mut world, &request(&views, &[])).unwrap();
    let rows: Vec<CascadeRow> = table_rows(&published, "cascades");
    let suns: Vec<DirectionalRow> = table_rows(&published, "directional_lights");
    assert_eq!((rows.len(), suns[0].cascades, suns[1].cascades), (6, 3, 3));
    assert_eq!((rows[0].texel_size, rows[2].texel_size), (0.0, 0.0), "views that nobody asked for");
    for (row, view) in [(3, 0), (4, 1), (5, 2), (1, 3)] {
        let table: &ViewTable = bytemuck::from_bytes(&published.scene.views[view]);
        assert_eq!(rows[row].shadow_from_world, table.projection_from_world);
    }
    assert!(rows[3].texel_size <= rows[4].texel_size && rows[3].end < rows[4].end && rows[5].end <= 8.0);
    let other = CascadeSplit { count: 2, ..split };
    let mixed = [view(0, 0), ViewRequest { kind: ViewKind::Cascade(CascadeView { light: 1, index: 0, split: other }), ..view(1, 0) }];
    let problems = publish(&mut world, &request(&mixed, &[])).unwrap_err();
    assert_eq!(problems.iter().map(|problem| problem.code).collect::<Vec<_>>(), ["publish::mixed-cascades"]);
}

/// The cube of a rectangle is drawn from its middle or from whatever point of it: a box is below the middle, and beside a corner. The lamp of the
/// stage is at the same place.
#[test]
fn faces_of_a_rectangle_see_what_any_point_of_it_sees() {
    let mut world = stage();
    world.spawn(panel(Vec3::Y * 3.0));
    place(&mut world, 0, 0, Vec3::new(0.8, 1.5, 0.0), Vec3::splat(0.2));
    let kinds = [ViewKind::PointLight, ViewKind::RectangleLight];
    let lists: Vec<(DrawFilter, ViewKind)> =
        kinds.iter().flat_map(|kind| (0..6).map(move |face| (DrawFilter::Opaque, kind(0, face)))).collect();
    let views = [ViewRequest { kind: ViewKind::RectangleLight(0, 3), width: 64, height: 64 }];
    let published = publish(&mut world, &request(&views, &lists)).unwrap();
    let seen: Vec<bool> = published.scene.draw_lists.iter().map(|list| !list.batches.is_empty()).collect();
    assert_eq!(seen[..6], [false, false, false, true, false, false]);
    assert_eq!(seen[6..], [true, true, false, true, true, true]);
    let rows: Vec<RectangleRow> = table_rows(&published, "rectangle_lights");
    let view: ViewTable = bytemuck::pod_read_unaligned(&published.scene.views[0]);
    assert_eq!((view.position, view.near, view.far), (rows[0].position, rows[0].near, rows[0].far));
    let farthest_corner = Vec3::new(0.9, 1.6, 0.1).length();
    assert!(rows[0].near > 0.0 && rows[0].far >= farthest_corner + rows[0].radius, "{:?}", rows[0]);
}

#[test]
fn what_is_not_there_is_reported_at_once() {
    let missing = [
        ViewKind::DirectionalLight(3),
        ViewKind::PointLight(0, 6),
        ViewKind::RectangleLight(0, 6),
        ViewKind::RectangleLight(1, 0),
        ViewKind::WholeScene(1),
        ViewKind::ReflectionProbe(0, 6),
        ViewKind::ReflectionProbe(1, 0),
    ];
    let views = missing.map(|kind| ViewRequest { kind, ..SUN_VIEW });
    let wanted = PublishRequest { camera: Some("mian"), ..request(&views, &[(DrawFilter::All, ViewKind::PointLight(9, 0))]) };
    let mut world = stage();
    world.spawn(panel(Vec3::Y));
    world.spawn(probe(Affine3A::IDENTITY));
    let problems = publish(&mut world, &wanted).unwrap_err();
    let codes: Vec<&str> = problems.iter().map(|problem| problem.code).collect();
    let [light, face, probe] = ["publish::unknown-light", "publish::unknown-face", "publish::unknown-probe"];
    assert_eq!(codes, [light, face, light, face, light, light, face, probe, "world::unknown-camera"]);
    assert_eq!(problems[6].message, "a view asks for face 6 of reflection probe 0; a cube has the faces 0 to 5");
    assert_eq!(problems[7].message, "a view asks for reflection probe 1, and the scene has 1");
    assert_eq!(problems[8].hint.as_deref(), Some("did you mean `main`?"));
}

#[test]
fn counts_are_rows_of_lights_and_instances_of_surfaces() {
    let mut world = crowd();
    publish(&mut world, &request(&[], &[])).unwrap();
    let counts: Vec<(String, u32)> = counts(&world).into_iter().collect();
    let expected = [1, 1, 0, 1, 0, 0, 5, 1, 4];
    assert_eq!(counts, COUNT_NAMES.iter().zip(expected).map(|(name, count)| ((*name).to_owned(), count)).collect::<Vec<_>>());
}

#[test]
fn what_is_hidden_keeps_its_rows_and_neither_draws_nor_shines() {
    let mut world = crowd();
    let faces = [2, 3].map(|face| (DrawFilter::All, ViewKind::PointLight(0, face)));
    let lists = [(DrawFilter::All, ViewKind::Camera), faces[0], faces[1]];
    let wanted = request(&[], &lists);
    let mut publisher = Publisher::default();
    let seen = |published: &Published, list: usize| {
        let mut slots: Vec<u32> = published.scene.draw_lists[list].batches.iter().flat_map(|batch| slots(published, batch)).collect();
        slots.sort_unstable();
        slots
    };
    let group = world.spawn(Transform::default()).id();
    let entities: Vec<Entity> = world.query::<(Entity, &MeshInstance)>().iter(&world).map(|(entity, _)| entity).collect();
    let [lamp] = world.query_filtered::<Entity, bevy_ecs::prelude::With<LocalLight>>().iter(&world).collect::<Vec<_>>()[..] else {
        panic!()
    };
    let [sun] = world.query_filtered::<Entity, bevy_ecs::prelude::With<DirectionalLight>>().iter(&world).collect::<Vec<_>>()[..] else {
        panic!()
    };
    world.entity_mut(entities[2]).insert(ChildOf(group));
    let before = publisher.publish(&mut world, &wanted).unwrap();
    assert_eq!(seen(&before, 0), (0..10).collect::<Vec<u32>>());
    let counted = counts(&world);
    for hidden in [group, entities[9], sun] {
        world.entity_mut(hidden).insert(Hidden);
    }
    let hidden = publisher.publish(&mut world, &wanted).unwrap();
    assert_eq!(seen(&hidden, 0), [0, 1, 3, 4, 5, 6, 7, 8]);
    assert!((1..3).all(|list| !seen(&hidden, list).contains(&2)) && !seen(&hidden, 2).is_empty());
    let rows: Vec<InstanceRow> = table_rows(&hidden, "instances");
    assert_eq!((rows.len(), rows[2].world_from_object, rows[3].object), (9, [[0.0; 4]; 4], 3), "rows at the end are cut");
    let suns: Vec<DirectionalRow> = table_rows(&hidden, "directional_lights");
    assert_eq!((suns.len(), suns[0].illuminance), (1, [0.0; 3]));
    assert_eq!(counts(&world), counted);
    world.entity_mut(lamp).insert(Hidden);
    let dark = publisher.publish(&mut world, &wanted).unwrap();
    let lamps: Vec<LocalRow> = table_rows(&dark, "local_lights");
    assert_eq!((lamps.len(), lamps[0].intensity), (1, [0.0; 3]));
    assert!(seen(&dark, 1).is_empty() && seen(&dark, 2).is_empty());
    for shown in [group, entities[9], sun, lamp] {
        world.entity_mut(shown).remove::<Hidden>();
    }
    let shown = publisher.publish(&mut world, &wanted).unwrap().scene;
    assert!(shown.tables == before.scene.tables && shown.draw_lists == before.scene.draw_lists);
}

/// What was published before leaves no trace: random changes, published by one who remembers and by one who does not.
mod memory {
    use proptest::prelude::*;

    use super::*;

    /// Turns everything of a kind, and puts it elsewhere.
    fn turn<C: bevy_ecs::component::Component>(world: &mut World, by: Vec3) {
        for mut transform in world.query_filtered::<&mut Transform, bevy_ecs::prelude::With<C>>().iter_mut(world) {
            transform.0 = Affine3A::from_rotation_translation(Quat::from_euler(glam::EulerRot::XYZ, by.x, by.y, by.z), by);
        }
    }

    fn change(world: &mut World, things: &mut Vec<Entity>, (what, which, at): (u8, usize, [f32; 3])) {
        let at = Vec3::from_array(at);
        let some = (!things.is_empty()).then(|| things[which % things.len().max(1)]);
        match (what, some) {
            (0, Some(thing)) => {
                things.retain(|other| *other != thing);
                world.despawn(thing);
                things.retain(|other| world.get_entity(*other).is_ok());
            }
            (1..=3, Some(thing)) => world.get_mut::<Transform>(thing).unwrap().0.translation = at.into(),
            (4, Some(thing)) => world.get_mut::<Transform>(thing).unwrap().0 = Affine3A::from_scale(at),
            (5, Some(thing)) if which % 2 == 0 => _ = world.entity_mut(thing).insert(MeshInstance { mesh: which % 2, material: which % 4 }),
            (6, Some(thing)) => {
                let above = things[0];
                if above == thing {
                    world.entity_mut(thing).remove::<ChildOf>();
                } else {
                    world.entity_mut(thing).insert(ChildOf(above));
                }
            }
            (11, Some(thing)) => _ = world.entity_mut(thing).insert(Hidden),
            (12, Some(thing)) => _ = world.entity_mut(thing).remove::<Hidden>(),
            (7, _) => world.resource_mut::<Materials>().0[which % 4].base_color[0] = at.x,
            (8, _) => {
                world.resource_mut::<Materials>().0[which % 4].alpha_mode = if at.x > 0.0 { AlphaMode::Blend } else { AlphaMode::Opaque }
            }
            (13, _) => turn::<Camera>(world, at),
            (14, _) => turn::<DirectionalLight>(world, at),
            (16, _) => turn::<ReflectionProbe>(world, at),
            (9, _) => world.resource_mut::<Meshes>().0.push(cuboid("more", at.abs() + 0.1, 0)),
            (10, _) => {
                let lamp = LocalLight { color: Vec3::ONE, intensity: at.x.abs() * 0.01, range: (at.y > 0.0).then_some(at.y), cone: None };
                things.push(world.spawn((Transform(Affine3A::from_translation(at)), lamp)).id());
            }
            _ => things
                .push(world.spawn((Transform(Affine3A::from_translation(at)), MeshInstance { mesh: which % 2, material: which % 4 })).id()),
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

        #[test]
        fn leaves_no_trace(steps in prop::collection::vec(prop::collection::vec((0_u8..19, 0_usize..40, prop::array::uniform3(-6.0_f32..6.0)), 0..6), 1..14)) {
            let mut world = crowd();
            let downwards = spot(Vec3::new(0.0, 4.0, 0.0));
            let lit = world.spawn(downwards).id();
            let split = CascadeSplit { count: 2, distance: Positive::new(9.0), lambda: Positive::new(0.5), snap: true };
            let cascades = [0, 1].map(|index| ViewKind::Cascade(CascadeView { light: 0, index, split }));
            let lamp = |face| ViewKind::PointLight(0, face);
            world.spawn(panel(Vec3::new(1.0, 3.0, 1.0)));
            world.spawn(probe(Affine3A::from_translation(Vec3::Y)));
            let mut lists: Vec<(DrawFilter, ViewKind)> = (0..6).map(|face| (DrawFilter::Opaque, lamp(face))).collect();
            lists.extend((0..6).map(|face| (DrawFilter::Masked, lamp(face))));
            lists.extend((0..6).map(|face| (DrawFilter::Opaque, ViewKind::RectangleLight(0, face))));
            lists.extend((0..6).map(|face| (DrawFilter::All, ViewKind::ReflectionProbe(0, face))));
            let views = [(DrawFilter::Solid, ViewKind::Camera), (DrawFilter::Opaque, ViewKind::DirectionalLight(0)), (DrawFilter::Blended, ViewKind::Camera), (DrawFilter::All, lamp(2))];
            lists.extend(views);
            lists.extend([ViewKind::SpotLight(0), ViewKind::WholeScene(0), cascades[0], cascades[1]].map(|view| (DrawFilter::Opaque, view)));
            let maps = cascades.map(|kind| ViewRequest { kind, ..SUN_VIEW });
            let views = [CAMERA_VIEW, SUN_VIEW, ViewRequest { kind: ViewKind::SpotLight(0), ..SUN_VIEW }, ViewRequest { kind: ViewKind::RectangleLight(0, 3), ..SUN_VIEW }, PROBE_VIEW, ViewRequest { kind: ViewKind::WholeScene(0), ..SUN_VIEW }, maps[0], maps[1]];
            let wanted = request(&views, &lists);
            let (mut publisher, mut things) = (Publisher::default(), Vec::new());
            for changes in steps {
                for entry in changes {
                    change(&mut world, &mut things, entry);
                    if entry.0 == 15 {
                        let [x, y, z] = entry.2;
                        let turned = Affine3A::from_rotation_translation(Quat::from_rotation_x(x), Vec3::new(x, y, z));
                        *world.get_mut::<Transform>(lit).unwrap() = Transform(turned);
                    }
                }
                let kept = publisher.publish(&mut world, &wanted).unwrap().scene;
                let fresh = publish(&mut world, &wanted).unwrap().scene;
                prop_assert_eq!(kept.tables, fresh.tables);
                prop_assert_eq!(kept.views, fresh.views);
                prop_assert_eq!(kept.draw_lists, fresh.draw_lists);
                prop_assert!(kept.geometry == fresh.geometry && kept.materials == fresh.materials);
            }
        }
    }
}
