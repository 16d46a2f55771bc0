//! What entities share: meshes, materials, images and the environment.
//!
//! The lists only grow, so that an index stays valid, and a material's index is its row in the published table.

use std::sync::Arc;

use bevy_ecs::prelude::{Resource, World};
use glam::Vec3;

use crate::asset::{Image, Material, Mesh};
use crate::linear_image::LinearImage;

/// Every mesh, by [`super::MeshInstance::mesh`].
#[derive(Resource, Debug, Default)]
pub struct Meshes(pub Vec<Mesh>);

/// Every material, by [`super::MeshInstance::material`].
#[derive(Resource, Debug, Default)]
pub struct Materials(pub Vec<Material>);

/// Every decoded image, by the `image` of a material's texture uses.
#[derive(Resource, Debug, Default)]
pub struct Images(pub Vec<Image>);

/// What surrounds the scene.
#[derive(Resource, Debug, Clone, Copy, PartialEq)]
pub struct Environment {
    /// Radiance from every direction where nothing stands, nits, linear Rec.709.
    pub sky_radiance: Vec3,
    /// Lux: a point or spot light without a range ends where it gives less. Not positive is never.
    pub least_illuminance: f32,
}

impl Default for Environment {
    /// A black sky; lights end at a thousandth of a lux, the light of a clear night without a moon.
    fn default() -> Environment {
        Environment { sky_radiance: Vec3::ZERO, least_illuminance: 0.001 }
    }
}

/// How an image shows all directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SkyShape {
    /// u = atan2(z, x) / 2 pi + 1/2 and v = acos(y) / pi of a direction, the top row is up.
    Equirectangular,
    /// Six square faces of a cube, seen from within as WebGPU has them: two to a row, +X -X, +Y -Y, +Z -Z.
    Faces,
}

/// An image of the sky, which adds its light to [`Environment::sky_radiance`]. Not there unless a scene has one.
#[derive(Resource, Debug, Clone, PartialEq)]
pub struct SkyImage {
    /// Nits, finite and not negative.
    pub image: Arc<LinearImage>,
    /// What its texels show.
    pub shape: SkyShape,
    /// By how much it is turned about +Y, radians.
    pub rotation: f32,
    /// Factor on its radiance.
    pub strength: f32,
}

/// A world with nothing in it.
pub fn new_world() -> World {
    let mut world = World::new();
    world.init_resource::<Meshes>();
    world.init_resource::<Materials>();
    world.init_resource::<Images>();
    world.init_resource::<Environment>();
    world
}
