//! Lights of the world, in the order of their slots, and their tables.
//!
//! A slot that nobody holds, or something hidden, is a light without strength, so that the lights after it keep their index.

use bevy_ecs::prelude::World;
use glam::{DVec3, Vec3};
use luminaire_graph::published::{ViewKind, ViewRequest};

use super::layout::{DirectionalRow, LocalRow};
use super::projection::{single, vector};
use super::reach::{Reach, reach};
use super::sun::SunView;
use crate::world::{Aabb, Cone, DirectionalLight, DirectionalSlot, Environment, GlobalTransform, LocalLight, LocalSlot, Shown, rigid_axes};

/// A directional light in world space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sun {
    /// Unit length.
    pub(super) to_light: DVec3,
    /// Lux.
    pub(super) illuminance: Vec3,
}

/// A point or spot light in world space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lamp {
    pub(super) position: DVec3,
    /// Along the light, unit length.
    pub(super) axis: DVec3,
    /// Candela.
    pub(super) intensity: Vec3,
    /// Metres.
    range: Option<f32>,
    cone: Option<Cone>,
    pub(super) reach: Reach,
}

/// Lights by slot.
#[derive(Debug, Default)]
pub(super) struct Lights {
    pub(super) suns: Vec<Option<Sun>>,
    pub(super) lamps: Vec<Option<Lamp>>,
}

/// Reads the lights. What is not finite gives no light. `bounds` are those of all objects, `solid` of those that throw shadows.
pub(super) fn collect(world: &mut World, bounds: Option<Aabb>, solid: Option<Aabb>) -> Lights {
    let mut lights = Lights::default();
    let least = world.get_resource_or_init::<Environment>().least_illuminance;
    for (light, slot, transform, shown) in world.query::<(&DirectionalLight, &DirectionalSlot, &GlobalTransform, &Shown)>().iter(world) {
        let (.., back) = rigid_axes(transform.0.matrix3);
        let sun = Sun { to_light: back, illuminance: strength(light.color, light.illuminance) };
        place(&mut lights.suns, slot.0, Some(sun).filter(|_| shown.0));
    }
    for (light, slot, transform, shown) in world.query::<(&LocalLight, &LocalSlot, &GlobalTransform, &Shown)>().iter(world) {
        let (.., back) = rigid_axes(transform.0.matrix3);
        let position = Vec3::from(transform.0.translation);
        let finite = position.is_finite();
        let position = if finite { position.as_dvec3() } else { DVec3::ZERO };
        let intensity = if finite { strength(light.color, light.intensity) } else { Vec3::ZERO };
        let range = light.range.filter(|range| range.is_finite() && *range > 0.0);
        let reach = reach(position, intensity, range, least, bounds, solid);
        let lamp = Lamp { position, axis: -back, intensity, range, cone: light.cone, reach };
        place(&mut lights.lamps, slot.0, Some(lamp).filter(|_| shown.0));
    }
    lights
}

/// Puts something at a slot of a list.
pub(super) fn place<T: Clone>(list: &mut Vec<Option<T>>, slot: u32, light: Option<T>) {
    let slot = slot as usize;
    if list.len() <= slot {
        list.resize(slot + 1, None);
    }
    list[slot] = light;
}

/// Color times intensity; none where that is no number.
pub(super) fn strength(color: Vec3, intensity: f32) -> Vec3 {
    let strength = color * intensity;
    if strength.is_finite() { strength.max(Vec3::ZERO) } else { Vec3::ZERO }
}

impl Lights {
    /// Where a directional light comes from; a light that is not there shines down.
    pub(super) fn to_sun(&self, light: u32) -> DVec3 {
        self.suns.get(light as usize).copied().flatten().map_or(DVec3::Y, |sun| sun.to_light)
    }

    /// The table `directional_lights`; shadow members come from the first requested view of a light.
    pub(super) fn directional_rows(&self, views: &[ViewRequest], fitted: &[Option<SunView>]) -> Vec<DirectionalRow> {
        let row = |(index, sun): (usize, &Option<Sun>)| {
            let Some(sun) = sun else { return DirectionalRow::default_row() };
            let mut row = DirectionalRow {
                direction_to_light: vector(sun.to_light),
                illuminance: sun.illuminance.to_array(),
                ..DirectionalRow::default_row()
            };
            let wanted = |view: &ViewRequest| matches!(view.kind, ViewKind::DirectionalLight(light) if light as usize == index);
            if let Some(fitted) = views.iter().zip(fitted).find_map(|(view, fitted)| fitted.as_ref().filter(|_| wanted(view))) {
                row.shadow_texel_size = single(fitted.texel_size);
                row.shadow_depth_range = single(fitted.depth_range);
                row.shadow_from_world = fitted.table.projection_from_world;
            }
            row
        };
        self.suns.iter().enumerate().map(row).collect()
    }

    /// The table `local_lights`.
    pub(super) fn local_rows(&self) -> Vec<LocalRow> {
        let row = |lamp: &Option<Lamp>| {
            let Some(lamp) = lamp else { return <LocalRow as bytemuck::Zeroable>::zeroed() };
            let [near, far] = lamp.reach.planes;
            let [spot_scale, spot_offset] = cone_factors(lamp.cone);
            LocalRow {
                position: vector(lamp.position),
                range: lamp.range.unwrap_or(0.0),
                intensity: lamp.intensity.to_array(),
                shadow_near: single(near),
                direction: vector(lamp.axis),
                shadow_far: single(far),
                spot_scale,
                spot_offset,
                reach: single(lamp.reach.end),
                pad: 0.0,
            }
        };
        self.lamps.iter().map(row).collect()
    }
}

impl DirectionalRow {
    /// No light, from above.
    fn default_row() -> DirectionalRow {
        DirectionalRow { direction_to_light: [0.0, 1.0, 0.0], ..<DirectionalRow as bytemuck::Zeroable>::zeroed() }
    }
}

/// Scale and offset of the cone's attenuation, from KHR_lights_punctual ("Inner and Outer Cone Angles").
fn cone_factors(cone: Option<Cone>) -> [f32; 2] {
    let Some(cone) = cone else { return [0.0, 1.0] };
    let scale = 1.0 / (cone.inner.cos() - cone.outer.cos()).max(0.001);
    let offset = -cone.outer.cos() * scale;
    if scale.is_finite() && offset.is_finite() { [scale, offset] } else { [0.0, 1.0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_is_full_inside_and_dark_outside() {
        let [scale, offset] = cone_factors(Some(Cone { inner: 0.3, outer: 0.5 }));
        let factor = |angle: f32| (angle.cos() * scale + offset).clamp(0.0, 1.0).powi(2);
        assert!((factor(0.2) - 1.0).abs() < 1e-6 && (factor(0.3) - 1.0).abs() < 1e-4);
        assert!(factor(0.4) > 0.0 && factor(0.4) < 1.0);
        assert!(factor(0.5) < 1e-6 && factor(2.0) == 0.0);
        assert_eq!(cone_factors(None), [0.0, 1.0]);
    }

    #[test]
    fn strength_is_never_negative_or_nan() {
        assert_eq!(strength(Vec3::new(1.0, -1.0, 0.5), 2.0), Vec3::new(2.0, 0.0, 1.0));
        assert_eq!(strength(Vec3::ONE, f32::NAN), Vec3::ZERO);
        assert_eq!(strength(Vec3::splat(1e38), 1e38), Vec3::ZERO);
    }
}
