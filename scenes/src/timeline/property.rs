//! Reading and writing what a timeline changes. Every value travels as four floats.

use bevy_ecs::prelude::{Entity, World};
use glam::{Affine3A, Mat3A, Quat, Vec3, Vec4};

use super::events::{Field, Property, Timeline};
use crate::asset::{Pose, Projection};
use crate::scene_file::glow;
use crate::world::{
    Camera, DirectionalLight, Environment, Exposure, LocalLight, Materials, MeshInstance, RectangleLight, RestPose, Transform, rigid_axes,
};

/// The present value; `None` where the node is gone, or is nothing that has such a value.
pub(super) fn read(world: &World, timeline: &Timeline, property: Property) -> Option<Vec4> {
    let scalar = |value: f32| Vec4::new(value, 0.0, 0.0, 0.0);
    match property {
        Property::Translation(node) => Some(Vec3::from(world.get::<Transform>(timeline.entity(node)?)?.0.translation).extend(0.0)),
        Property::Rotation(node) => Some(rotation_and_scale(world, timeline.entity(node)?)?.0.into()),
        Property::Scale(node) => Some(rotation_and_scale(world, timeline.entity(node)?)?.1.extend(0.0)),
        Property::Intensity(node) => Some(scalar(read_light(world, timeline.entity(node)?)?.0)),
        Property::Color(node) => Some(read_light(world, timeline.entity(node)?)?.1.extend(0.0)),
        Property::Exposure(node) => match world.get::<Camera>(timeline.entity(node)?)?.exposure {
            Exposure::Ev100(value) | Exposure::Factor(value) => Some(scalar(value)),
            Exposure::Unchanged => None,
        },
        Property::FieldOfView(node) => match world.get::<Camera>(timeline.entity(node)?)?.projection {
            Projection::Perspective { yfov, .. } => Some(scalar(yfov)),
            Projection::Orthographic { .. } => None,
        },
        Property::Sky => Some(world.get_resource::<Environment>()?.sky_radiance.extend(0.0)),
        Property::Material(row, field) => {
            let material = world.get_resource::<Materials>()?.0.get(row)?;
            Some(match field {
                Field::BaseColor => Vec4::from(material.base_color),
                Field::Metallic => scalar(material.metallic),
                Field::Roughness => scalar(material.roughness),
                Field::Emissive => Vec3::from(material.emissive).extend(0.0),
                Field::Specular => scalar(material.specular),
            })
        }
    }
}

/// Writes a value. `scale` belongs to a rotation. What is gone is left alone.
pub(super) fn write(world: &mut World, entity: Option<Entity>, property: Property, value: Vec4, scale: Vec3) {
    match (property, entity) {
        (Property::Sky, _) => {
            if let Some(mut environment) = world.get_resource_mut::<Environment>() {
                environment.sky_radiance = value.truncate();
            }
        }
        (Property::Material(row, field), _) => {
            let mut materials = world.get_resource_mut::<Materials>();
            let Some(material) = materials.as_mut().and_then(|materials| materials.0.get_mut(row)) else { return };
            match field {
                // Alpha stays.
                Field::BaseColor => material.base_color = value.truncate().extend(material.base_color[3]).to_array(),
                Field::Metallic => material.metallic = value.x,
                Field::Roughness => material.roughness = value.x,
                Field::Emissive => material.emissive = value.truncate().to_array(),
                Field::Specular => material.specular = value.x,
            }
        }
        (_, None) => {}
        (Property::Translation(_), Some(entity)) => {
            let place = |local: &mut Affine3A| local.translation = value.truncate().into();
            put(world, entity, place, |rest| rest.translation = value.truncate());
        }
        (Property::Rotation(_) | Property::Scale(_), Some(entity)) => {
            let rotation = Quat::from_vec4(value);
            let place = |local: &mut Affine3A| local.matrix3 = Mat3A::from_quat(rotation) * Mat3A::from_diagonal(scale);
            put(world, entity, place, |rest| (rest.rotation, rest.scale) = (rotation, scale));
        }
        (Property::Intensity(_), Some(entity)) => write_light(world, entity, Some(value.x), None),
        (Property::Color(_), Some(entity)) => write_light(world, entity, None, Some(value.truncate())),
        (Property::Exposure(_), Some(entity)) => {
            if let Some(mut camera) = world.get_mut::<Camera>(entity) {
                camera.exposure = match camera.exposure {
                    Exposure::Factor(_) => Exposure::Factor(value.x),
                    Exposure::Ev100(_) | Exposure::Unchanged => Exposure::Ev100(value.x),
                };
            }
        }
        (Property::FieldOfView(_), Some(entity)) => {
            if let Some(mut camera) = world.get_mut::<Camera>(entity)
                && let Projection::Perspective { yfov, .. } = &mut camera.projection
            {
                *yfov = value.x;
            }
        }
    }
}

/// Changes a node's transform, if that makes a difference, and where it rests while no animation moves it.
fn put(world: &mut World, entity: Entity, place: impl Fn(&mut Affine3A), rest: impl Fn(&mut Pose)) {
    if let Some(mut pose) = world.get_mut::<RestPose>(entity) {
        rest(&mut pose.0);
    }
    if let Some(mut transform) = world.get_mut::<Transform>(entity) {
        let mut local = transform.0;
        place(&mut local);
        if transform.0 != local {
            transform.0 = local;
        }
    }
}

/// A node's turn, and its size along its own axes, negative along x where it is mirrored. What its axes are not at right
/// angles for is lost.
pub(super) fn rotation_and_scale(world: &World, entity: Entity) -> Option<(Quat, Vec3)> {
    let matrix = world.get::<Transform>(entity)?.0.matrix3;
    let (x, y, z) = rigid_axes(matrix);
    let axes = [x, y, z].map(|axis| axis.as_vec3());
    let rotation = Quat::from_mat3(&glam::Mat3::from_cols(axes[0], axes[1], axes[2])).normalize();
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(Vec3::from);
    let sizes: [f32; 3] = std::array::from_fn(|axis| columns[axis].length().copysign(columns[axis].dot(axes[axis])));
    Some((rotation, Vec3::from(sizes)))
}

/// Intensity in the light's unit, and color.
fn read_light(world: &World, entity: Entity) -> Option<(f32, Vec3)> {
    if let Some(light) = world.get::<DirectionalLight>(entity) {
        return Some((light.illuminance, light.color));
    }
    if let Some(light) = world.get::<RectangleLight>(entity) {
        return Some((light.luminance, light.color));
    }
    world.get::<LocalLight>(entity).map(|light| (light.intensity, light.color))
}

fn write_light(world: &mut World, entity: Entity, intensity: Option<f32>, color: Option<Vec3>) {
    if let Some(mut light) = world.get_mut::<DirectionalLight>(entity) {
        light.illuminance = intensity.unwrap_or(light.illuminance);
        light.color = color.unwrap_or(light.color);
    }
    if let Some(mut light) = world.get_mut::<LocalLight>(entity) {
        light.intensity = intensity.unwrap_or(light.intensity);
        light.color = color.unwrap_or(light.color);
    }
    if let Some(mut light) = world.get_mut::<RectangleLight>(entity) {
        light.luminance = intensity.unwrap_or(light.luminance);
        light.color = color.unwrap_or(light.color);
        let emissive = glow(&light).to_array();
        let row = world.get::<MeshInstance>(entity).map(|instance| instance.material);
        let mut materials = world.get_resource_mut::<Materials>();
        if let Some(material) = row.and_then(|row| materials.as_mut()?.0.get_mut(row)) {
            material.emissive = emissive;
        }
    }
}
