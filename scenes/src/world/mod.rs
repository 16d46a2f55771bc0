//! The world: components and resources of a scene, and small systems over them.
//!
//! Guarantees: slots (the rows of published tables) never change while their entity lives; degenerate transforms give no NaN
//! in bounds or cameras, since whatever is not finite is left out. [`update`] brings everything derived up to date, and looks only at
//! what changed.

mod animation;
mod bounds;
mod camera;
mod camera_path;
mod clock;
mod components;
mod control;
mod edit;
mod glow;
mod interior;
mod repeat;
mod resources;
mod sample;
mod slots;
mod solid;
mod spatial;
mod spawn;
mod transform;
mod triangles;
mod update;
mod visibility;

pub use animation::{AnimationPlayer, Clip, RestPose, clips, play_clips};
pub use bevy_ecs::hierarchy::{ChildOf, Children};
pub use bevy_ecs::name::Name;
pub use bevy_ecs::world::World;
pub use bounds::{Aabb, WorldBounds, scene_bounds, update_bounds};
pub(crate) use camera::camera_inside;
pub use camera::{CameraPose, camera_pose, framing_camera, look_at, rigid_axes, select_camera};
pub use camera_path::{CameraPath, Facing, PathInterpolation, PathKey};
pub use clock::{Time, set_time};
pub use components::{
    Camera, CameraSlot, Cone, DirectionalLight, DirectionalSlot, Exposure, GlobalTransform, LocalLight, LocalSlot, MeshInstance,
    ObjectSlot, PointSlot, ProbeSlot, ProbeVolume, RectangleLight, RectangleSlot, ReflectionProbe, SpotSlot, Transform, Volume,
};
pub use control::{Axis, Command, Fly, Orbit, control};
pub use edit::{find_by_name, set_translation};
pub(crate) use glow::glowing_rectangles;
pub use interior::interior_camera;
pub use repeat::Repeat;
pub use resources::{Environment, Images, Materials, Meshes, SkyImage, SkyShape, new_world};
pub use slots::assign_slots;
pub(crate) use solid::solid_meshes;
pub use spatial::{Holds, Kind, OrientedBox, SpatialIndex};
pub use spawn::{StoredAsset, spawn_asset, spawn_stored, store_asset};
pub use transform::propagate_transforms;
pub use triangles::{Hit, Triangles};
pub use update::update;
pub use visibility::{Hidden, Shown, propagate_visibility};
