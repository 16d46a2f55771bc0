//! Light for a glTF file that is shown by itself and has none. Scene files are left as their author wrote them.

use std::f32::consts::PI;

use bevy_ecs::prelude::World;
use glam::{Affine3A, DVec3, Mat3A, Vec3};
use luminaire_graph::diagnostic::Diagnostic;

use crate::asset::Asset;
use crate::world::{DirectionalLight, Environment, Name, Transform, assign_slots, look_at};

/// A white diffuse surface that faces it shows a radiance of 1.
const ILLUMINANCE: f32 = PI;
/// From the scene to the sun: steep, so that it reaches into courts, and to the left of the camera that frames a scene.
const TO_SUN: DVec3 = DVec3::new(-0.4, 1.0, 0.35);
/// What is seen where nothing stands, nits.
const SKY: Vec3 = Vec3::new(0.25, 0.37, 0.55);

/// Whether the asset shows something that stays black without a light.
pub(super) fn is_missing(asset: &Asset) -> bool {
    let takes_light = |mesh: &crate::asset::Mesh| asset.materials.get(mesh.material).is_some_and(|material| !material.unlit);
    asset.lights.is_empty() && asset.meshes.iter().any(takes_light)
}

/// Adds a sun and a sky, and says so.
pub(super) fn add(world: &mut World, file: &str) -> Diagnostic {
    let (right, up, back) = look_at(-TO_SUN);
    let axes = Mat3A::from_cols(right.as_vec3a(), up.as_vec3a(), back.as_vec3a());
    let sun = DirectionalLight { color: Vec3::ONE, illuminance: ILLUMINANCE };
    world.spawn((Name::new("default sun"), Transform(Affine3A::from_mat3(axes.into())), sun));
    world.insert_resource(Environment { sky_radiance: SKY });
    assign_slots(world);
    Diagnostic::warning("scene::default-light", format!("`{file}` has no lights: a sun of {ILLUMINANCE:.2} lx and a sky were added"))
        .hint("name the file in a scene .ron that has lights of its own")
}
