//! Light on a white Lambert plane, against the formulas of KHR_lights_punctual.

use std::f64::consts::PI;

use glam::DVec3;
use libtest_mimic::Failed;
use luminaire::image_file::LinearImage;

use crate::Case;
use crate::support::picture::{Eye, Shot, near, places, texel};

pub const CASES: &[Case] = &[
    ("irradiance::point light", point_light),
    ("irradiance::directional light", directional_light),
    ("irradiance::spot cone", spot_cone),
    ("irradiance::range window", range_window),
    ("irradiance::lights add up", lights_add_up),
    ("irradiance::twice the light is twice the radiance", linear_in_light),
    ("irradiance::a mirrored scene gives the mirrored picture", mirrored),
];

/// Of the plane.
const ALBEDO: f64 = 0.5;
/// The driver rounds half floats towards zero, which is 2^-10 or 0.098 %. Measured: 0.096 % at most.
const TOLERANCE: f64 = 0.0012;

fn eye() -> Eye {
    Eye::new([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 50.0)
}

/// The plane z = 0 under some lights.
fn plane(lights: &str) -> Result<LinearImage, Failed> {
    let scene = format!(
        "({} lights: {{ {lights} }}, objects: {{ \"plane\": (shape: Plane(size: (20, 20)), rotation: (90, 0, 0),
            surface: (base_color: ({ALBEDO}, {ALBEDO}, {ALBEDO}), specular: 0)) }})",
        eye().ron()
    );
    Shot::pbr(64, &["radiance"]).one(&scene)
}

/// Compares each pixel with the illuminance that a point of the plane should get. Returns how many got light.
fn check(image: &LinearImage, lux: impl Fn(DVec3) -> f64) -> Result<usize, Failed> {
    let (mut worst, mut lit) = (0.0f64, 0);
    for place in places(image) {
        let point = eye().on_plane(image, place, DVec3::ZERO, DVec3::Z).ok_or("the plane fills the picture")?;
        let expected = ALBEDO / PI * lux(point);
        let found = texel(image, place.0, place.1);
        for channel in &found[..3] {
            // Where a cone or a window fades out, half floats have an absolute end.
            if (channel - expected).abs() > 1e-5 {
                worst = worst.max((channel - expected).abs() / expected.max(1e-3));
                near(&format!("{place:?}"), *channel, expected, TOLERANCE)?;
            }
        }
        lit += usize::from(found[0] > 0.0);
    }
    println!("worst relative error {worst:.5}");
    Ok(lit)
}

/// Lux on the plane from a point light, without window or cone.
fn inverse_square(point: DVec3, light: DVec3, candela: f64) -> f64 {
    let to_light = light - point;
    candela * (to_light.z / to_light.length()).max(0.0) / to_light.length_squared()
}

fn point_light() -> Result<(), Failed> {
    let image = plane("\"lamp\": Point(candela: 7, position: (0.7, 0.4, 1.1))")?;
    let lit = check(&image, |point| inverse_square(point, DVec3::new(0.7, 0.4, 1.1), 7.0))?;
    if lit == 64 * 64 { Ok(()) } else { Err(format!("{lit} pixels are lit").into()) }
}

fn directional_light() -> Result<(), Failed> {
    let image = plane("\"sun\": Directional(lux: 3, direction: (1, -2, -2))")?;
    check(&image, |_| 3.0 * 2.0 / 3.0)?;
    let behind = plane("\"sun\": Directional(lux: 3, direction: (1, -2, 0.2))")?;
    if check(&behind, |_| 0.0)? == 0 { Ok(()) } else { Err("light from behind arrives".into()) }
}

fn spot_cone() -> Result<(), Failed> {
    let (inner, outer) = (15.0f64, 35.0f64);
    let lamp = "\"lamp\": Spot(candela: 9, position: (0.5, 0, 2), direction: (-0.2, 0.1, -1), inner: 15, outer: 35)";
    let (position, axis) = (DVec3::new(0.5, 0.0, 2.0), DVec3::new(-0.2, 0.1, -1.0).normalize());
    let image = plane(lamp)?;
    let strength = |point: DVec3| {
        let cosine = (point - position).normalize().dot(axis);
        let (from, to) = (outer.to_radians().cos(), inner.to_radians().cos());
        ((cosine - from) / (to - from)).clamp(0.0, 1.0).powi(2)
    };
    let lit = check(&image, |point| inverse_square(point, position, 9.0) * strength(point))?;
    // The picture must show the full cone, its fading edge and the dark outside.
    if (100..3000).contains(&lit) { Ok(()) } else { Err(format!("{lit} pixels are lit").into()) }
}

fn range_window() -> Result<(), Failed> {
    let image = plane("\"lamp\": Point(candela: 5, position: (0.3, 0.2, 1), range: 2)")?;
    let position = DVec3::new(0.3, 0.2, 1.0);
    let window = |point: DVec3| (1.0 - (point.distance(position) / 2.0).powi(4)).clamp(0.0, 1.0);
    let lit = check(&image, |point| inverse_square(point, position, 5.0) * window(point))?;
    if (300..3500).contains(&lit) { Ok(()) } else { Err(format!("{lit} pixels are lit").into()) }
}

const TWO: &str = "\"a\": Point(candela: 4, position: (1, 0.5, 1.5)), \"b\": Directional(lux: 1.5, direction: (0, -1, -1))";

fn lights_add_up() -> Result<(), Failed> {
    let image = plane(TWO)?;
    check(&image, |point| inverse_square(point, DVec3::new(1.0, 0.5, 1.5), 4.0) + 1.5 * 0.5f64.sqrt())?;
    Ok(())
}

/// Doubling is exact in floats: every pixel doubles to the bit, as long as the unit of light stays the same.
fn linear_in_light() -> Result<(), Failed> {
    let once = plane(TWO)?;
    let twice = plane(&TWO.replace("candela: 4", "candela: 8").replace("lux: 1.5", "lux: 3"))?;
    let wrong = once.texels.iter().zip(&twice.texels).filter(|(a, b)| (0..3).any(|channel| a[channel] * 2.0 != b[channel]));
    let wrong = wrong.count();
    if wrong == 0 { Ok(()) } else { Err(format!("{wrong} pixels are not doubled").into()) }
}

fn mirrored() -> Result<(), Failed> {
    let scene = |sign: f64| {
        format!(
            "({} lights: {{ \"lamp\": Point(candela: 30, position: ({}, 2, 2)) }}, objects: {{
                \"plane\": (shape: Plane(size: (20, 20)), rotation: (90, 0, 0), surface: (specular: 0)),
                \"ball\": (shape: Sphere(radius: 0.7), translation: ({}, 0.3, 0.7), surface: (roughness: 0.4)),
                \"box\": (shape: Box(size: (0.5, 1, 0.4)), translation: ({}, -0.6, 0.2), rotation: (0, {}, 0), surface: ()) }})",
            eye().ron(),
            1.3 * sign,
            -0.8 * sign,
            0.9 * sign,
            30.0 * sign,
        )
    };
    let shot = Shot::pbr(128, &["radiance"]);
    let (image, mirrored) = (shot.one(&scene(1.0))?, shot.one(&scene(-1.0))?);
    let (mut sum, mut difference, mut off) = (0.0, 0.0, 0);
    for (x, y) in places(&image) {
        let (a, b) = (texel(&image, x, y)[0], texel(&mirrored, 127 - x, y)[0]);
        sum += a;
        difference += (a - b).abs();
        off += usize::from((a - b).abs() > 0.01 * a.max(b));
    }
    println!("mean difference {:.6}, {off} pixels", difference / sum);
    // Pixels on edges may fall to the other side on other drivers; measured: none of 16,384.
    if difference < 0.002 * sum && off < 100 { Ok(()) } else { Err(format!("{difference} of {sum}, {off} pixels").into()) }
}
