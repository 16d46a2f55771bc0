//! Any number of point and spot lights: what tiles list adds up to what all lights add up to, bit for bit.

use std::fmt::Write;

use libtest_mimic::Failed;

use crate::Case;
use crate::support::picture::{Eye, Series, Shot, places, texel};

pub const CASES: &[Case] = &[
    ("many_lights::a thousand lights are a thousand lights", a_thousand_lights),
    ("many_lights::a camera inside of a light's volume changes nothing", inside_of_volumes),
    ("many_lights::samples and tiles of any size agree", samples_and_tiles),
];

/// More lights than this are listed.
const ALL: u32 = 100_000_000;

/// SplitMix64 (Steele et al. 2014): the same lamps in every run.
struct Random(u64);

impl Random {
    fn between(&mut self, least: f64, most: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        least + ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1u64 << 53) as f64 * (most - least)
    }
}

/// Lamps over a floor with pillars and a pane of glass; a quarter are spots, from narrow to wider than a hemisphere's half.
fn lamps(count: u32, eye: &Eye, more: &str) -> Result<String, Failed> {
    let mut random = Random(5);
    let mut lights = String::new();
    for index in 0..count {
        let place: [f64; 3] = [random.between(-10.0, 10.0), random.between(0.2, 3.0), random.between(-10.0, 10.0)];
        let color: [f64; 3] = std::array::from_fn(|_| random.between(0.1, 1.0));
        let range: f64 = random.between(0.8, 3.0);
        if index % 4 == 3 {
            let (x, z): (f64, f64) = (random.between(-1.0, 1.0), random.between(-1.0, 1.0));
            let outer: f64 = random.between(5.0, 85.0);
            writeln!(
                lights,
                "\"{index}\": Spot(candela: 1, color: {color:?}, position: {place:?}, direction: ({x}, -1, {z}), inner: {}, outer: {outer}, range: {range}),",
                outer * 0.6
            )?;
        } else {
            writeln!(lights, "\"{index}\": Point(candela: 0.3, color: {color:?}, position: {place:?}, range: {range}),")?;
        }
    }
    let lights = lights.replace('[', "(").replace(']', ")");
    Ok(format!(
        "({} lights: {{ {lights} {more} }}, objects: {{
            \"floor\": (shape: Plane(size: (24, 24)), surface: (roughness: 0.5)),
            \"tall\": (shape: Box(size: (0.8, 3, 0.8)), translation: (-3, 1.5, 1), surface: (roughness: 0.4)),
            \"low\": (shape: Box(size: (2, 0.8, 0.8)), translation: (3, 0.4, -2), surface: (roughness: 0.4)),
            \"glass\": (shape: Plane(size: (6, 3)), rotation: (90, 0, 0), translation: (0, 1.5, 4), surface: (alpha: 0.4)) }})",
        eye.ron()
    ))
}

/// Renders with all lights and with lists, each in its own series; fails unless they are the same. Returns the mean.
fn agree(what: &str, both: &mut [Series; 2], shot: &Shot, scene: &str) -> Result<f64, Failed> {
    let all = both[0].one(&shot.clone().set("unlisted_lights", ALL), scene)?;
    let listed = both[1].one(&shot.clone().set("unlisted_lights", 0), scene)?;
    let differ: Vec<_> = places(&all).filter(|(x, y)| texel(&all, *x, *y) != texel(&listed, *x, *y)).collect();
    if let Some((x, y)) = differ.first() {
        let (all, listed) = (texel(&all, *x, *y), texel(&listed, *x, *y));
        return Err(format!("{what}: {} pixels differ; {listed:?} instead of {all:?} at {x}, {y}", differ.len()).into());
    }
    Ok(all.texels.iter().map(|texel| f64::from(texel[1])).sum::<f64>() / all.texels.len() as f64)
}

fn above() -> Eye {
    Eye::new([0.0, 9.0, 16.0], [0.0, 0.0, 0.0], 45.0)
}

fn a_thousand_lights() -> Result<(), Failed> {
    let shot = Shot::pbr(192, &["radiance"]).set("shadowed_point_lights", 8).set("local_shadow_texels", 128);
    let mean = agree("a thousand lights", &mut Default::default(), &shot, &lamps(1000, &above(), "")?)?;
    println!("a thousand lights: a mean of {mean:.4} nits");
    if mean > 0.01 { Ok(()) } else { Err(format!("it is dark: {mean}").into()) }
}

/// In a sphere, in a cone, with one that has no end, and where the far plane cuts a volume.
fn inside_of_volumes() -> Result<(), Failed> {
    let eye = Eye::new([1.0, 1.2, 6.0], [0.0, 0.8, 0.0], 60.0);
    let more = [
        ("a sphere", "\"around\": Point(candela: 5, position: (1, 1.5, 6.5), range: 6)"),
        ("a cone", "\"along\": Spot(candela: 50, position: (1, 1.4, 9), direction: (-0.1, -0.1, -1), inner: 10, outer: 30, range: 14)"),
        (
            "a cone seen from its mouth",
            "\"against\": Spot(candela: 50, position: (0, 1, -4), direction: (0.1, 0, 1), inner: 30, outer: 50, range: 14)",
        ),
        ("no end", "\"endless\": Point(candela: 5000, position: (1, 30, 6.5))"),
        ("far away", "\"far\": Spot(candela: 5000, position: (0, 90, -10), direction: (0, -1, 0), inner: 2, outer: 12, range: 200)"),
    ];
    let (mut both, shot) = (Default::default(), Shot::pbr(96, &["radiance"]));
    let without = agree("without", &mut both, &shot, &lamps(40, &eye, "")?)?;
    for (what, light) in more {
        let with = agree(what, &mut both, &shot, &lamps(40, &eye, light)?)?;
        if with < without * 1.01 {
            return Err(format!("{what}: the light gives nothing: {with} after {without}").into());
        }
    }
    Ok(())
}

fn samples_and_tiles() -> Result<(), Failed> {
    let (mut both, scene) = (Default::default(), lamps(100, &above(), "")?);
    agree("samples", &mut both, &Shot { size: [75, 53], ..Shot::pbr(64, &["radiance"]) }.set("samples", 4), &scene)?;
    agree("another size", &mut both, &Shot { size: [75, 53], ..Shot::pbr(64, &["radiance"]) }, &scene)?;
    Ok(())
}
