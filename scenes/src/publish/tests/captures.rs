//! Views that no camera changes: faces of reflection probes, and the whole scene along a light.

use bevy_ecs::prelude::With;

use super::*;

/// Up to the far plane, and in its corners beyond its distance.
#[test]
fn faces_of_a_probe_see_up_to_its_far_plane() {
    let mut world = stage();
    world.spawn(probe(Affine3A::from_translation(Vec3::Y)));
    place(&mut world, 0, 0, Vec3::new(0.0, 1.0, 7.0), Vec3::splat(0.2));
    place(&mut world, 0, 0, Vec3::new(-7.0, 1.0, 6.0), Vec3::splat(0.2));
    place(&mut world, 0, 0, Vec3::new(0.0, -20.0, 0.0), Vec3::splat(0.2));
    let lists: Vec<(DrawFilter, ViewKind)> = (0..6).map(|face| (DrawFilter::Solid, ViewKind::ReflectionProbe(0, face))).collect();
    let published = publish(&mut world, &request(&[PROBE_VIEW], &lists)).unwrap();
    let seen =
        |face: usize| -> Vec<u32> { published.scene.draw_lists[face].batches.iter().flat_map(|batch| slots(&published, batch)).collect() };
    assert_eq!([0, 1, 2, 3, 4, 5].map(seen), [vec![], vec![1], vec![], vec![], vec![0], vec![]]);
    assert!(published.scene.draw_lists[4].batches.iter().all(|batch| batch.mirrored), "the frames of faces are left-handed");
    let rows: Vec<ProbeRow> = table_rows(&published, "reflection_probes");
    let view: ViewTable = bytemuck::pod_read_unaligned(&published.scene.views[0]);
    assert_eq!((view.position, view.near, view.far), (rows[0].position, rows[0].near, rows[0].far));
    assert_eq!(Vec3::from(view.forward), Vec3::Z);
}

/// Another camera is another fit of the map for what the camera sees, and none of the one for all of the scene.
#[test]
fn the_whole_scene_is_the_same_for_every_camera() {
    let mut world = crowd();
    place(&mut world, 0, 0, Vec3::new(300.0, 0.0, 0.0), Vec3::ONE);
    place(&mut world, 0, 0, Vec3::new(-300.0, 0.0, 0.0), Vec3::ONE);
    let views = [ViewRequest { kind: ViewKind::WholeScene(0), ..SUN_VIEW }, SUN_VIEW];
    let lists = [(DrawFilter::Opaque, ViewKind::WholeScene(0))];
    let published = publish(&mut world, &request(&views, &lists)).unwrap();
    let rows: Vec<CascadeRow> = table_rows(&published, "whole_scenes");
    let view: ViewTable = bytemuck::pod_read_unaligned(&published.scene.views[0]);
    assert_eq!((rows.len(), rows[0].shadow_from_world, rows[0].depth_range), (1, view.projection_from_world, view.far));
    assert_eq!(published.scene.draw_lists[0].batches.iter().map(|batch| batch.instance_count).sum::<u32>(), 7);
    for x in [-300.0, 300.0] {
        let edge = Mat4::from_cols_array_2d(&view.projection_from_world).project_point3(Vec3::new(x, 0.0, 0.0));
        assert!(edge.truncate().abs().max_element() < 1.0 && rows[0].texel_size > 600.0 / 512.0, "{edge}");
    }
    for mut transform in world.query_filtered::<&mut Transform, With<Camera>>().iter_mut(&mut world) {
        transform.0 = Affine3A::from_rotation_translation(Quat::from_rotation_y(0.4), Vec3::new(2.0, 1.0, 4.0));
    }
    let moved = publish(&mut world, &request(&views, &lists)).unwrap();
    assert_eq!(moved.scene.views[0], published.scene.views[0]);
    assert_eq!(table_rows::<CascadeRow>(&moved, "whole_scenes"), rows);
    assert_ne!(moved.scene.views[1], published.scene.views[1]);
}
