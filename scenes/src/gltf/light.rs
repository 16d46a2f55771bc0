//! Lights of KHR_lights_punctual.
//!
//! Guarantees: what stands in [`Light`] is finite and in range. A negative intensity becomes 0, a range of 0 or less is ignored
//! and cones are forced into order, each with a warning.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use super::json::{Json, clip};
use crate::asset::{Light, LightKind};

/// The inner cone ends at least this share below the outer one, so that the fall-off between them has a width.
const WIDEST_INNER: f32 = 0.999;

/// Checks every light. A broken one is reported, and `None`.
pub(super) fn read_lights(root: &Json<'_>) -> Vec<Option<Light>> {
    let Some(extension) = root.extension("KHR_lights_punctual") else { return Vec::new() };
    extension.objects("lights").iter().enumerate().map(|(index, light)| read_light(light, index)).collect()
}

fn read_light(json: &Json<'_>, index: usize) -> Option<Light> {
    let kind = json.required("type").and_then(|_| json.text("type"));
    let kind = match kind? {
        "directional" => LightKind::Directional,
        "point" => LightKind::Point,
        "spot" => read_spot(json),
        other => {
            json.error_at("type", "gltf::light-type", format_args!("expected directional, point or spot, found `{}`", clip(other)));
            return None;
        }
    };
    let color = json.numbers("color").unwrap_or([1.0; 3]).map(|channel: f32| {
        if channel < 0.0 {
            json.warning_at("color", "gltf::light-color", format_args!("{channel} is negative, and taken as 0"));
        }
        channel.max(0.0)
    });
    let mut intensity = json.number("intensity").unwrap_or(1.0);
    if intensity < 0.0 {
        json.warning_at("intensity", "gltf::light-intensity", format_args!("{intensity} is negative, and taken as 0"));
        intensity = 0.0;
    }
    let range = json.number("range").filter(|range| {
        let usable = *range > 0.0;
        if !usable {
            json.warning_at("range", "gltf::light-range", format_args!("{range} is not greater than 0, and taken as no limit"));
        }
        usable && kind != LightKind::Directional
    });
    Some(Light { name: json.name_or("light", index), kind, color, intensity, range })
}

fn read_spot(json: &Json<'_>) -> LightKind {
    let spot = json.object("spot");
    let angle = |key: &str, default: f32| spot.as_ref().and_then(|spot| spot.number(key)).unwrap_or(default);
    let (given_inner, given_outer) = (angle("innerConeAngle", 0.0), angle("outerConeAngle", FRAC_PI_4));
    let outer = if given_outer > 0.0 { given_outer.min(FRAC_PI_2) } else { FRAC_PI_4 };
    let inner = given_inner.clamp(0.0, outer * WIDEST_INNER);
    // An inner angle equal to the outer one is a hard edge that exporters write; it needs no warning.
    if given_inner > given_outer || given_inner < 0.0 || given_outer != outer {
        let problem = format!("expected 0 <= inner <= outer <= pi/2, found {given_inner} and {given_outer}; taken as {inner} and {outer}");
        json.warning_at("spot", "gltf::light-cone", problem);
    }
    LightKind::Spot { inner, outer }
}
