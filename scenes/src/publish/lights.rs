//! Lights of the world, in the order of their slots, and their tables.
//!
//! A slot that nobody holds, or something hidden, is a light without strength, so that the lights after it keep their index.

use bevy_ecs::prelude::World;
use glam::{DVec3, Vec3};
use luminaire_graph::published::{ViewKind, ViewRequest};

use super::casters::Center;
use super::layout::{DirectionalRow, LocalRow, PointRow, SpotRow};
use super::projection::{single, vector};
use super::reach::{Reach, reach};
use super::spot::SpotView;
use super::sun::SunView;
use crate::world::{
    Aabb, Cone, DirectionalLight, DirectionalSlot, Environment, GlobalTransform, LocalLight, LocalSlot, PointSlot, Shown, SpotSlot,
    rigid_axes,
};

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
    pub(super) cone: Option<Cone>,
    pub(super) reach: Reach,
    shadow: Shadow,
}

impl Lamp {
    /// From where its shadow cube is drawn.
    pub(super) fn center(&self) -> Center {
        let planes = self.reach.planes;
        Center { position: self.position, radius: 0.0, planes, reach: planes[1] }
    }
}

/// Which shadow map a point or spot light has, by its slot among those of the kind.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shadow {
    Cube(u32),
    Map(u32),
}

/// Lights by slot.
#[derive(Debug, Default)]
pub(super) struct Lights {
    pub(super) suns: Vec<Option<Sun>>,
    pub(super) lamps: Vec<Option<Lamp>>,
    /// Indices into `lamps` of those with a shadow cube, and of those with a map.
    points: Vec<Option<u32>>,
    spots: Vec<Option<u32>>,
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
    type Local<'a> = (&'a LocalLight, &'a LocalSlot, Option<&'a PointSlot>, Option<&'a SpotSlot>, &'a GlobalTransform, &'a Shown);
    for (light, slot, point, spot, transform, shown) in world.query::<Local<'_>>().iter(world) {
        let (.., back) = rigid_axes(transform.0.matrix3);
        let position = Vec3::from(transform.0.translation);
        let finite = position.is_finite() && light.cone.is_none_or(|cone| cone.inner.is_finite() && cone.outer.is_finite());
        let position = if finite { position.as_dvec3() } else { DVec3::ZERO };
        let intensity = if finite { strength(light.color, light.intensity) } else { Vec3::ZERO };
        let range = light.range.filter(|range| range.is_finite() && *range > 0.0);
        let reach = reach(position, intensity, range, least, bounds, solid);
        let shadow = match (point, spot) {
            (_, Some(spot)) => {
                place(&mut lights.spots, spot.0, Some(slot.0));
                Shadow::Map(spot.0)
            }
            (point, None) => {
                let point = point.map_or(0, |point| point.0);
                place(&mut lights.points, point, Some(slot.0));
                Shadow::Cube(point)
            }
        };
        let lamp = Lamp { position, axis: -back, intensity, range, cone: light.cone, reach, shadow };
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
    /// How many rows `point_lights` has, and `spot_lights`.
    pub(super) fn cubes_and_maps(&self) -> [usize; 2] {
        [self.points.len(), self.spots.len()]
    }

    /// The light with a shadow cube of this slot.
    pub(super) fn point(&self, slot: u32) -> Option<Lamp> {
        self.lamp(self.points.get(slot as usize))
    }

    /// The light with a shadow map of this slot.
    pub(super) fn spot(&self, slot: u32) -> Option<Lamp> {
        self.lamp(self.spots.get(slot as usize))
    }

    fn lamp(&self, lamp: Option<&Option<u32>>) -> Option<Lamp> {
        self.lamps.get(lamp.copied().flatten()? as usize).copied().flatten()
    }

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
            row.cascades = views
                .iter()
                .find_map(|view| match view.kind {
                    ViewKind::Cascade(cascade) if cascade.light as usize == index => Some(cascade.split.count),
                    _ => None,
                })
                .unwrap_or(0);
            row
        };
        self.suns.iter().enumerate().map(row).collect()
    }

    /// The table `local_lights`.
    pub(super) fn local_rows(&self) -> Vec<LocalRow> {
        let row = |lamp: &Option<Lamp>| {
            let Some(lamp) = lamp else { return <LocalRow as bytemuck::Zeroable>::zeroed() };
            let [spot_scale, spot_offset] = cone_factors(lamp.cone);
            LocalRow {
                position: vector(lamp.position),
                range: lamp.range.unwrap_or(0.0),
                intensity: lamp.intensity.to_array(),
                reach: single(lamp.reach.end),
                direction: vector(lamp.axis),
                shadow: match lamp.shadow {
                    Shadow::Cube(slot) => slot as i32,
                    Shadow::Map(slot) => -1 - slot as i32,
                },
                spot_scale,
                spot_offset,
                pad: [0.0; 2],
            }
        };
        self.lamps.iter().map(row).collect()
    }

    /// The table `point_lights`.
    pub(super) fn point_rows(&self) -> Vec<PointRow> {
        let row = |slot: u32| {
            let Some(lamp) = self.point(slot) else { return <PointRow as bytemuck::Zeroable>::zeroed() };
            let [near, far] = lamp.reach.planes.map(single);
            let light = self.points.get(slot as usize).copied().flatten().unwrap_or(0);
            PointRow { position: vector(lamp.position), near, far, light, pad: [0; 2] }
        };
        (0..self.points.len() as u32).map(row).collect()
    }

    /// The table `spot_lights`.
    pub(super) fn spot_rows(&self) -> Vec<SpotRow> {
        let row = |slot: u32| {
            let Some(lamp) = self.spot(slot) else { return <SpotRow as bytemuck::Zeroable>::zeroed() };
            let view = SpotView::of(&lamp);
            let [near, far] = lamp.reach.planes.map(single);
            let light = self.spots.get(slot as usize).copied().flatten().unwrap_or(0);
            SpotRow { shadow_from_world: view.table.projection_from_world, near, far, half_width: single(view.half), light }
        };
        (0..self.spots.len() as u32).map(row).collect()
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
    if scale.is_finite() && offset.is_finite() { [scale, offset] } else { [1.0, 0.0] }
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
