//! Surfaces cut out by alpha: holes in the picture and in the shadow, the cutoff, and how they look from afar.

use libtest_mimic::Failed;
use serde_json::json;

use crate::Case;
use crate::support::gltf::Gltf;
use crate::support::picture::{Shot, places, texel};

pub const CASES: &[Case] = &[
    ("masks::holes in the picture", holes_in_the_picture),
    ("masks::holes in the shadow", holes_in_the_shadow),
    ("masks::distance thins nothing out", distance_thins_nothing_out),
];

/// Alphas of the columns of a texture of 4 texels.
const COLUMNS: [u8; 4] = [255, 102, 153, 0];

fn striped(scene: &mut Gltf, cutoff: f64) -> usize {
    let texture = scene.texture(4, true, |x, _| [255, 255, 255, COLUMNS[x as usize]]);
    let material = scene.material(json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": texture }, "metallicFactor": 0 },
        "alphaMode": "MASK", "alphaCutoff": cutoff, "doubleSided": true
    }));
    scene.quad(material, None)
}

/// Which columns stay, by cutoff: alphas are 1, 0.4, 0.6 and 0.
const CUTOFFS: [(f64, [bool; 4]); 4] =
    [(0.5, [true, false, true, false]), (0.3, [true, true, true, false]), (0.7, [true, false, false, false]), (1.5, [false; 4])];

fn holes_in_the_picture() -> Result<(), Failed> {
    for (cutoff, stays) in CUTOFFS {
        let mut scene = Gltf::default();
        let quad = striped(&mut scene, cutoff);
        scene.node(json!({ "mesh": quad }));
        // x from -1 to 1 fills the picture, which a hair more than the quad would not.
        scene.camera([0.0, 0.0, 3.0], 2.0 * (0.999f64 / 3.0).atan().to_degrees());
        for pipeline in ["pipelines/pbr.ron", "pipelines/albedo.ron"] {
            let output = if pipeline.ends_with("pbr.ron") { "albedo" } else { "color" };
            let images = Shot::of(pipeline, [64, 16], &[output]).take_world(&mut scene.world()?)?;
            let image = &images[output];
            // As high as wide is what the camera sees: the middle 16 columns of 64 show x from -1 to 1.
            for x in 24..40 {
                let column = (x - 24) / 4;
                let drawn = texel(image, x, 8)[3] == 1.0;
                let on_edge = [0, 3].contains(&((x - 24) % 4));
                if !on_edge && drawn != stays[column as usize] {
                    return Err(format!("{pipeline}, cutoff {cutoff}: column {column} is drawn: {drawn}").into());
                }
            }
        }
    }
    Ok(())
}

/// A lamp at z = 2, the striped quad at z = 1, a wall at z = 0 which the camera sees from between: the shadow is twice as large.
fn holes_in_the_shadow() -> Result<(), Failed> {
    for directional in [false, true] {
        for (cutoff, stays) in CUTOFFS {
            let mut scene = Gltf::default();
            let quad = striped(&mut scene, cutoff);
            let wall = scene.material(json!({ "pbrMetallicRoughness": { "metallicFactor": 0 } }));
            let wall = scene.quad(wall, None);
            scene.node(json!({ "mesh": wall, "scale": [4, 4, 1] }));
            scene.node(json!({ "mesh": quad, "translation": [0, 0, 1] }));
            scene.camera([0.0, 0.0, 0.9], 2.0 * (2.0f64 / 0.9).atan().to_degrees());
            if directional {
                scene.sun(3.0);
            } else {
                scene.point_light(10.0, [0.0, 0.0, 2.0]);
            }
            let images = Shot::pbr(64, &["radiance"]).take_world(&mut scene.world()?)?;
            // The picture shows x from -2 to 2.
            let width = if directional { 8 } else { 16 };
            let start = 32 - 2 * width;
            for x in 0..64u32 {
                let column = (x >= start).then(|| (x - start) / width).filter(|column| *column < 4);
                let dark = column.is_some_and(|column| stays[column as usize]);
                let on_edge = [0, width - 1].contains(&((x + 64 - start) % width));
                let found = texel(&images["radiance"], x, 32)[0] == 0.0;
                if !on_edge && found != dark {
                    return Err(format!("cutoff {cutoff}: x = {x} is dark: {found} (sun: {directional})").into());
                }
            }
        }
    }
    Ok(())
}

/// Leaves of two texels, some thinner than others: as many pixels at 16 times the distance.
fn distance_thins_nothing_out() -> Result<(), Failed> {
    // Alphas 0 to 255 by a hash, about a third of them at the cutoff or above; squares make the many low ones.
    let alpha = |x: u32, y: u32| {
        let mut hash = (x / 2).wrapping_mul(0x9e37_79b1) ^ (y / 2).wrapping_mul(0x85eb_ca77);
        hash = (hash ^ (hash >> 15)).wrapping_mul(0x2c1b_3c6d);
        hash = (hash ^ (hash >> 12)).wrapping_mul(0x297a_2d39);
        let evenly = f64::from(hash >> 16) / 65536.0;
        (evenly * evenly * 256.0) as u8
    };
    let truth = (0..128 * 128).filter(|index| alpha(index % 128, index / 128) >= 128).count() as f64 / (128.0 * 128.0);
    for distance in [1.0f64, 2.0, 4.0, 8.0, 16.0] {
        let mut scene = Gltf::default();
        let leaves = scene.texture(128, false, |x, y| [40, 160, 40, alpha(x, y)]);
        let material = scene.material(json!({
            "pbrMetallicRoughness": { "baseColorTexture": { "index": leaves } }, "alphaMode": "MASK", "alphaCutoff": 0.5
        }));
        let quad = scene.quad(material, None);
        scene.node(json!({ "mesh": quad }));
        // At 1 m the quad fills the picture, of 128 pixels.
        scene.camera([0.0, 0.0, distance], 90.0);
        let images = Shot::pbr(128, &["albedo"]).take_world(&mut scene.world()?)?;
        let edge = 128.0 / distance;
        let drawn = places(&images["albedo"]).filter(|(x, y)| texel(&images["albedo"], *x, *y)[3] == 1.0).count() as f64;
        let coverage = drawn / (edge * edge);
        println!("{distance} m: {coverage:.3} of {truth:.3}");
        // Measured: 0.006 at 1 m to 0.057 at 16 m, where the quad has 64 pixels in all.
        let tolerance = if distance < 16.0 { 0.045 } else { 0.08 };
        if (coverage - truth).abs() > tolerance {
            return Err(format!("at {distance} m {coverage} of the quad is drawn, and {truth} of the texture is opaque").into());
        }
    }
    Ok(())
}
