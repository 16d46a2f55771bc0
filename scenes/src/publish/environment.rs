//! The environment table, with the unit in which light is accumulated in half floats.

use std::f64::consts::PI;

use glam::Vec3;

use super::layout::EnvironmentTable;
use super::lights::Lights;
use super::sky_image::Sky;
use crate::asset::Material;
use crate::world::{Aabb, Environment};

/// Brightest radiance that is kept in units of 1. A half float ends at 65,504, which leaves ten octaves for highlights: the lobe of
/// GGX is 1 / (4 alpha^2) times as bright as white (roughness 0.125), and more where light grazes. Below, there are twenty octaves
/// until a half float loses digits.
const MODEST: f64 = 64.0;

/// The table for these lights.
pub(super) fn table(
    environment: Environment,
    lights: &Lights,
    rectangle_count: usize,
    image: Sky,
    materials: &[Material],
    bounds: Option<Aabb>,
) -> EnvironmentTable {
    let sky = if environment.sky_radiance.is_finite() { environment.sky_radiance.max(Vec3::ZERO) } else { Vec3::ZERO };
    let unit = light_unit(brightest(sky, lights, materials, bounds).max(image.brightest));
    EnvironmentTable {
        sky_radiance: sky.to_array(),
        light_unit: unit,
        inverse_light_unit: 1.0 / unit,
        directional_count: lights.suns.len() as u32,
        local_count: lights.lamps.len() as u32,
        rectangle_count: rectangle_count as u32,
        sky_strength: image.strength,
        sky_rotation: image.rotation,
        sky_unit: image.unit,
        sky_has_faces: u32::from(image.has_faces),
    }
}

/// An estimate of the brightest surface: white in full light of the strongest single source. That is E/pi for a directional
/// light, I/(pi d^2) for a local one with d a tenth of the scene's radius, the sky's radiance, and the strongest emission.
fn brightest(sky: Vec3, lights: &Lights, materials: &[Material], bounds: Option<Aabb>) -> f64 {
    let radius = bounds.map_or(1.0, |bounds| f64::from(bounds.radius()));
    let distance = (0.1 * radius).max(0.01);
    let suns = lights.suns.iter().flatten().map(|sun| f64::from(sun.illuminance.max_element()) / PI);
    let lamps = lights.lamps.iter().flatten().map(|lamp| f64::from(lamp.intensity.max_element()) / (PI * distance * distance));
    let emission = materials.iter().map(|material| f64::from(Vec3::from(material.emissive).max_element()));
    suns.chain(lamps).chain(emission).fold(f64::from(sky.max_element()), f64::max)
}

/// 1 up to a radiance of 64, beyond that the power of two that brings it down to 64 or less.
fn light_unit(brightest: f64) -> f32 {
    if brightest.is_nan() || brightest <= MODEST {
        return 1.0;
    }
    (brightest / MODEST).log2().ceil().clamp(0.0, 100.0).exp2() as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_is_a_power_of_two_that_leaves_headroom() {
        assert_eq!(light_unit(0.0), 1.0);
        assert_eq!((light_unit(64.0), light_unit(1000.0)), (1.0, 16.0));
        assert_eq!(light_unit(f64::NAN), 1.0);
        // The sun at noon, 100,000 lx.
        assert_eq!(light_unit(100_000.0 / PI), 512.0);
        for exponent in 0..30 {
            let brightest = 3.7 * f64::from(exponent).exp2();
            let unit = f64::from(light_unit(brightest));
            assert!(brightest / unit <= MODEST && unit.log2().fract() == 0.0);
        }
        assert!(light_unit(f64::INFINITY).is_finite());
    }
}
