//! Light for a glTF file that is shown by itself and has none. Scene files are left as their author wrote them.

use std::f32::consts::PI;

use bevy_ecs::prelude::World;
use glam::{Affine3A, DVec3, Mat3, Vec3};
use luminaire_graph::diagnostic::Diagnostic;

use crate::asset::Asset;
use crate::world::{
    Aabb, DirectionalLight, Environment, LocalLight, Name, Transform, assign_slots, camera_inside, camera_pose, glowing_rectangles,
    look_at, propagate_transforms, scene_bounds, update_bounds,
};

/// A white diffuse surface that faces it shows a radiance of 1.
const ILLUMINANCE: f32 = PI;
/// From a thing to the sun, seen from its camera: to the left, up, and towards the viewer. What the camera sees is lit.
const TO_SUN: DVec3 = DVec3::new(-0.5, 1.0, 0.8);
/// The same inside of a room: steep, so that it reaches the ground of a court, and from behind, a little to the left.
const TO_SUN_OF_ROOM: DVec3 = DVec3::new(-0.15, 1.0, 0.45);
/// What is seen where nothing stands, nits.
const SKY: Vec3 = Vec3::new(0.25, 0.37, 0.55);

/// Whether the asset shows something that stays black without a light.
pub(super) fn is_missing(asset: &Asset) -> bool {
    let takes_light = |mesh: &crate::asset::Mesh| asset.materials.get(mesh.material).is_some_and(|material| !material.unlit);
    asset.lights.is_empty() && !glowing_rectangles(asset) && asset.meshes.iter().any(takes_light)
}

/// Illuminance that the lamp of a room gives at half of the room's smaller width, lux.
const LAMP_ILLUMINANCE: f32 = 0.5;

/// Adds a sun and a sky, and a lamp to a room, and says so.
pub(super) fn add(world: &mut World, file: &str) -> Diagnostic {
    propagate_transforms(world);
    update_bounds(world);
    let bounds = scene_bounds(world);
    let room = bounds.filter(|bounds| camera_inside(world, *bounds).is_some());
    let (right, up, back) = look_at(-to_sun(world, bounds, room.is_some()));
    let axes = Mat3::from_cols(right.as_vec3(), up.as_vec3(), back.as_vec3());
    let sun = DirectionalLight { color: Vec3::ONE, illuminance: ILLUMINANCE };
    world.spawn((Name::new("default sun"), Transform(Affine3A::from_mat3(axes)), sun));
    world.insert_resource(Environment { sky_radiance: SKY, ..Environment::default() });
    let mut added = format!("a sun of {ILLUMINANCE:.2} lx");
    if let Some(room) = room {
        let half_width = 0.5 * (room.max.x - room.min.x).min(room.max.z - room.min.z);
        let intensity = LAMP_ILLUMINANCE * half_width * half_width;
        let lamp = LocalLight { color: Vec3::ONE, intensity, range: None, cone: None };
        world.spawn((Name::new("default lamp"), Transform(Affine3A::from_translation(room.center())), lamp));
        added.push_str(&format!(", a lamp of {intensity:.1} cd in its middle"));
    }
    assign_slots(world);
    Diagnostic::warning("scene::default-light", format!("`{file}` has no lights: {added} and a sky were added"))
        .hint("name the file in a scene .ron that has lights of its own")
}

/// Where the sun stands, which follows the default camera's heading but not its tilt.
fn to_sun(world: &mut World, bounds: Option<Aabb>, is_room: bool) -> DVec3 {
    let back = camera_pose(world, None, bounds, 1.0).map_or(DVec3::Z, |pose| pose.back);
    let back = DVec3::new(back.x, 0.0, back.z).try_normalize().unwrap_or(DVec3::Z);
    let sun = if is_room { TO_SUN_OF_ROOM } else { TO_SUN };
    DVec3::Y.cross(back) * sun.x + DVec3::Y * sun.y + back * sun.z
}

#[cfg(test)]
mod tests {
    use luminaire_graph::source::SourceMap;

    use super::*;
    use crate::publish::counts;
    use crate::scene_file::load_scene;
    use crate::world::GlobalTransform;

    /// A triangle that faces +Z, with these members besides.
    fn load(members: &str) -> (World, Vec<Diagnostic>) {
        let folder = tempfile::tempdir().unwrap();
        // Positions (0, 0, 0), (1, 0, 0), (0, 1, 0).
        let buffer = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"buffers":[{{"byteLength":36,"uri":"{buffer}"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0}}]}}], {members} }}"#
        );
        let path = folder.path().join("file.gltf");
        std::fs::write(&path, text).unwrap();
        let loaded = load_scene(&path, None, &mut SourceMap::default()).unwrap();
        (loaded.world, loaded.warnings)
    }

    #[test]
    fn a_dark_file_gets_a_sun_that_lights_what_is_seen() {
        let (mut world, warnings) = load(r#""materials":[{}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]"#);
        let codes: Vec<_> = warnings.iter().map(|warning| warning.code).collect();
        assert_eq!(codes, ["scene::default-light"]);
        propagate_transforms(&mut world);
        let (sun, place) = world.query::<(&DirectionalLight, &GlobalTransform)>().single(&world).unwrap();
        assert!((sun.illuminance / PI - 1.0).abs() < 1e-6);
        // Light goes along -Z of the light: down, and onto the front.
        let to_sun = Vec3::from(place.0.matrix3.z_axis);
        assert!(to_sun.y > 0.6 && to_sun.z > 0.2, "{to_sun}");
        assert!(world.resource::<Environment>().sky_radiance.min_element() > 0.0);
    }

    #[test]
    fn a_file_with_light_or_without_need_of_it_is_left_as_it_is() {
        let unlit = r#""materials":[{"extensions":{"KHR_materials_unlit":{}}}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]"#;
        let lit = r#""materials":[{}],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},
            "nodes":[{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}}}],"scenes":[{"nodes":[0,1]}]"#;
        let empty = r#""materials":[{}],"nodes":[{}],"scenes":[{"nodes":[0]}]"#;
        for members in [unlit, lit, empty] {
            let (world, warnings) = load(members);
            assert!(!warnings.iter().any(|warning| warning.code == "scene::default-light"), "{warnings:?}");
            assert_eq!(counts(&world)["directional_lights"], 0);
        }
    }
}
