//! The BRDF that shaders import, integrated on the GPU by a pipeline of this test.

use libtest_mimic::Failed;
use serde_json::Value;

use crate::Case;
use crate::support::picture::{Shot, near, places, texel};
use crate::support::shared;

pub const CASES: &[Case] = &[
    ("brdf::loses light and never adds any", loses_light),
    ("brdf::facets cover the surface once", distribution_is_normalised),
    ("brdf::light and eye may be swapped", reciprocal),
    ("brdf::metallic mixes two surfaces", metallic_mixes),
];

const PIPELINE: &str = "tests/fixtures/gpu/brdf.ron";
const COSINES: [f64; 6] = [0.1, 0.3, 0.5, 0.7, 0.9, 1.0];
const ROUGHNESSES: [f64; 7] = [0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0];

fn shot(outputs: &[&str]) -> Shot {
    Shot::of(PIPELINE, [8, 8], outputs)
}

const NO_SCENE: &str = "(cameras: { \"eye\": (position: (0, 0, 1), target: (0, 0, 0)) })";

/// A metal's albedo is F0 A + B, a dielectric's 0.04 A + B + 0.96 C; a third of metal mixes both.
pub fn agrees_with_the_tables() -> Result<(), Failed> {
    let path = shared().ok_or("the reference data is missing")?.join("references/tables/dfg.json");
    let tables: Value = serde_json::from_str(&std::fs::read_to_string(path)?)?;
    let images = shot(&["albedos", "furnaces"]).take(NO_SCENE)?;
    let rows = tables["rows"].as_array().ok_or("no rows")?;
    let mut worst = 0.0f64;
    for row in rows {
        let number = |value: &Value| value.as_f64().ok_or("no number");
        let (roughness, cosine) = (number(&row["roughness"])?, number(&row["NdotV"])?);
        let place = |known: &[f64], value: f64| known.iter().position(|known| (known - value).abs() < 1e-6).ok_or("not in the grid");
        let (x, y) = (place(&COSINES, cosine)? as u32, place(&ROUGHNESSES, roughness)? as u32);
        let (a, b) = (number(&row["A"])?, number(&row["B"])?);
        let albedo = texel(&images["albedos"], x, y);
        let dielectric = texel(&images["albedos"], x + 6, y)[0] + texel(&images["furnaces"], x, y)[0];
        let white = &row["furnace_white"];
        let pairs = [
            ("B", albedo[0], b),
            ("A + B", albedo[1], a + b),
            ("A / 2 + B", albedo[2], 0.5 * a + b),
            ("dielectric", dielectric, number(&white["metallic_0.000"])?),
            ("third", (2.0 * dielectric + albedo[1]) / 3.0, number(&white["metallic_0.333"])?),
            ("metal", albedo[1], number(&white["metallic_1.000"])?),
        ];
        for (what, found, expected) in pairs {
            worst = worst.max((found - expected).abs());
            // Measured: 0.00023, from the midpoint rule.
            if (found - expected).abs() > 0.001 {
                return Err(format!("{what} at roughness {roughness}, n.v {cosine}: {found} and not {expected}").into());
            }
        }
    }
    println!("worst error {worst:.6} in {} rows", rows.len());
    if rows.len() == 42 { Ok(()) } else { Err(format!("{} rows", rows.len()).into()) }
}

fn loses_light() -> Result<(), Failed> {
    let image = shot(&["albedos"]).one(NO_SCENE)?;
    for (x, y) in places(&image).filter(|(x, _)| *x < 6) {
        let [black, white, gray, _] = texel(&image, x, y);
        // A white metal keeps 30 % at least (roughness 1, seen from above) and 100 % at most.
        if !(black >= 0.0 && white <= 1.0 + 1e-5 && white > 0.3) || (gray - 0.5 * (black + white)).abs() > 1e-4 {
            return Err(format!("albedos {black}, {gray}, {white} at {x}, {y}").into());
        }
    }
    Ok(())
}

fn distribution_is_normalised() -> Result<(), Failed> {
    let image = shot(&["albedos"]).one(NO_SCENE)?;
    // Measured: 1.8e-6.
    places(&image).try_for_each(|(x, y)| near(&format!("roughness {}", ROUGHNESSES[y as usize]), texel(&image, x, y)[3], 1.0, 1e-5))
}

fn reciprocal() -> Result<(), Failed> {
    let image = shot(&["pairs"]).one(NO_SCENE)?;
    let mut bright = 0;
    for (x, y) in places(&image) {
        let [there, back, ..] = texel(&image, x, y);
        // Measured: 2.8e-6.
        near(&format!("{x}, {y}"), there, back, 1e-5)?;
        bright += usize::from(there > 0.0);
    }
    if bright == 64 * 64 { Ok(()) } else { Err(format!("only {bright} pairs reflect").into()) }
}

fn metallic_mixes() -> Result<(), Failed> {
    let image = shot(&["furnaces"]).one(NO_SCENE)?;
    // Measured: 2.4e-7.
    places(&image).try_for_each(|(x, y)| near(&format!("{x}, {y}"), texel(&image, x, y)[1], 1.0, 2e-6))
}
