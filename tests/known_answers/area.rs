//! Rectangles that light surfaces: integrated, and by points of them, against integrals in 64 bits that are worked out here.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use libtest_mimic::Failed;

use crate::Case;
use crate::support::picture::{Shot, near, places, texel};

pub const CASES: &[Case] = &[
    ("area::matt surfaces get what Lambert's formula says", matt),
    ("area::horizons of triangle and shading normal cut the light", cut),
    ("area::points of a rectangle have the mean of the whole", points),
    ("area::rough metal reflects what its points say", rough),
    ("area::a floor below a lamp has the closed form", floor),
    ("area::a screen throws the penumbra of a rectangle", penumbra),
    ("area::a lamp that is hidden, turned away or in the plane gives nothing", dark),
];

const LUMINANCE: f64 = 3.0;
/// Width along z and height along x: it faces down, turned by the direction.
const LAMP: &str = "(
    cameras: { \"eye\": (position: (0, 0, 9), target: (0, 0, 0)) },
    lights: { \"lamp\": Rectangle(luminance: 3, size: (2, 1), position: (0, 1.5, 0.3), direction: (0.2, -1, 0.1)) },
)";

fn shot() -> Shot {
    Shot::of("tests/fixtures/gpu/area.ron", [16, 16], &["integrated", "sampled"])
}

fn turned(angle: f64) -> DVec3 {
    DVec3::new(angle.sin(), angle.cos(), 0.0)
}

/// Points of the lamp with their area over the number of points, and its front.
fn lamp(across: usize) -> (Vec<DVec3>, f64, DVec3) {
    let front = DVec3::new(0.2, -1.0, 0.1).normalize();
    // As scene files turn things: -Z along the direction, X level.
    let back = -front;
    let right = DVec3::Y.cross(back).normalize();
    let up = back.cross(right);
    let place = |index: usize| (index as f64 + 0.5) / across as f64 - 0.5;
    let at = |i: usize| DVec2::new(2.0 * place(i % across), place(i / across));
    let point = |i: usize| DVec3::new(0.0, 1.5, 0.3) + right * at(i).x + up * at(i).y;
    ((0..across * across).map(point).collect(), 2.0 / (across * across) as f64, front)
}

/// Radiance of a white matt surface: the sum over points of the lamp. What `geometric` or `normal` turn away from gives nothing.
fn matt_radiance(x: u32, geometric: DVec3, normal: DVec3) -> f64 {
    let position = DVec3::new((f64::from(x) - 7.5) * 0.4, 0.0, 0.0);
    let (points, area, front) = lamp(200);
    let sent = |point: &DVec3| {
        let away = *point - position;
        let to_light = away.normalize();
        let above = if geometric.dot(to_light) > 0.0 { normal.dot(to_light).max(0.0) } else { 0.0 };
        above * (-front.dot(to_light)).max(0.0) * area / away.length_squared()
    };
    LUMINANCE / PI * points.iter().map(sent).sum::<f64>()
}

fn angle(y: u32) -> f64 {
    (f64::from(y) - 7.5) * 0.2
}

/// Compares a channel over all configurations; differences are told over the brightest of them.
fn agrees(output: &str, channel: usize, shading_turn: f64, most: f64) -> Result<(), Failed> {
    let image = &shot().take(LAMP)?[output];
    let expected = |x, y| matt_radiance(x, turned(angle(y)), turned(angle(y) + shading_turn));
    let pairs: Vec<(f64, f64)> = places(image).map(|(x, y)| (texel(image, x, y)[channel], expected(x, y))).collect();
    let brightest = pairs.iter().fold(0.0_f64, |most, pair| most.max(pair.1));
    let worst = pairs.iter().fold(0.0_f64, |most, pair| most.max((pair.0 - pair.1).abs())) / brightest;
    println!("{output}: worst {worst:.6} of the brightest, {brightest:.4}");
    let dark = pairs.iter().filter(|pair| pair.1 == 0.0).count();
    if dark < 16 || worst > most {
        return Err(format!("{output}: {worst} of the brightest, {dark} dark").into());
    }
    Ok(())
}

fn matt() -> Result<(), Failed> {
    // Measured: 0.000006.
    agrees("integrated", 0, 0.0, 5.0e-5)
}

fn cut() -> Result<(), Failed> {
    // Measured: 0.000034.
    agrees("integrated", 1, 0.5, 1.0e-4)
}

fn points() -> Result<(), Failed> {
    // Measured: 0.000015.
    agrees("sampled", 0, 0.0, 5.0e-5)
}

/// Transformed cosines are near the lobe and not it: the mean over all configurations, and the worst of them, over the brightest.
fn rough() -> Result<(), Failed> {
    let images = shot().take(LAMP)?;
    // Measured: 0.036 and 0.0002, 0.088 and 0.023.
    for (channel, roughness, most, most_mean) in [(2, 1.0, 0.04, 0.001), (3, 0.5, 0.1, 0.03)] {
        let pairs = places(&images["sampled"])
            .map(|(x, y)| (texel(&images["integrated"], x, y)[channel], texel(&images["sampled"], x, y)[channel]));
        let pairs: Vec<(f64, f64)> = pairs.collect();
        let brightest = pairs.iter().fold(0.0_f64, |most, pair| most.max(pair.1));
        let worst = pairs.iter().fold(0.0_f64, |most, pair| most.max((pair.0 - pair.1).abs())) / brightest;
        let sums = pairs.iter().fold((0.0, 0.0), |sum, pair| (sum.0 + pair.0, sum.1 + pair.1));
        let mean = (sums.0 / sums.1 - 1.0).abs();
        println!("roughness {roughness}: worst {worst:.5} of the brightest, mean {mean:.5}");
        if worst > most || mean > most_mean {
            return Err(format!("roughness {roughness}: {worst} of the brightest, mean {mean}").into());
        }
    }
    Ok(())
}

/// The form factor of a parallel rectangle above its corner, over one quarter of it (Siegel and Howell, configuration C-11).
fn floor() -> Result<(), Failed> {
    let scene = "(
        cameras: { \"eye\": (position: (0, 3, 0.001), target: (0, 0, 0), fov: 20) },
        materials: { \"white\": (base_color: (1, 1, 1), specular: 0) },
        objects: { \"floor\": (shape: Plane(size: (4, 4)), material: \"white\") },
        lights: { \"lamp\": Rectangle(luminance: 5, size: (2, 1), position: (0, 1.25, 0), direction: (0, -1, 0)) },
    )";
    // Seen through the lamp, which is drawn from its front alone.
    let image = Shot::pbr(32, &["direct"]).one(scene)?;
    let (a, b) = (1.0 / 1.25, 0.5 / 1.25);
    let half = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
    let expected = 5.0 * 4.0 * (half(a, b) + half(b, a)) / (2.0 * PI);
    let found = (15..17).flat_map(|y| (15..17).map(move |x| (x, y))).map(|(x, y)| texel(&image, x, y)[0]).sum::<f64>() / 4.0;
    // Half floats: 0.1 %.
    near("the middle", found / expected, 1.0, 1.5e-3)
}

fn dark() -> Result<(), Failed> {
    let lamp = |place: &str, more: &str| {
        format!(
            "(
                cameras: {{ \"eye\": (position: (0, 3, 0.001), target: (0, 0, 0), fov: 20) }},
                materials: {{ \"white\": (base_color: (1, 1, 1), roughness: 0.4) }},
                objects: {{ \"floor\": (shape: Plane(size: (4, 4)), material: \"white\") }},
                lights: {{ \"lamp\": Rectangle(luminance: 5, size: (1, 1), {place}) }},
                timeline: [{more}],
            )"
        )
    };
    for (what, scene, lit) in [
        ("shining down", lamp("position: (0, 4, 0), direction: (0, -1, 0)", ""), true),
        ("turned away", lamp("position: (0, 4, 0), direction: (0, 1, 0)", ""), false),
        ("turned away, with two sides", lamp("position: (0, 4, 0), direction: (0, 1, 0), two_sided: true", ""), true),
        ("in the plane", lamp("position: (3, 0, 0), direction: (0, -1, 0)", ""), false),
        ("below", lamp("position: (0, -1, 0), direction: (0, 1, 0)", ""), false),
        ("hidden", lamp("position: (0, 4, 0), direction: (0, -1, 0)", "(at: 0, do: Hide(node: \"lamp\"))"), false),
    ] {
        let image = Shot::pbr(16, &["direct"]).one(&scene)?;
        let light = texel(&image, 8, 8)[0];
        if (light > 0.0) != lit {
            return Err(format!("{what}: {light}").into());
        }
    }
    Ok(())
}

/// The form factor of a parallel rectangle for a point below it: `x` and `z` are the ends of the rectangle against the point over its height.
fn parallel_form_factor(x: [f64; 2], z: [f64; 2]) -> f64 {
    // From the point's foot to a corner (Siegel and Howell, configuration C-11), with the sign of the corner's place.
    let corner = |a: f64, b: f64| {
        let half = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
        (half(a, b) + half(b, a)) / (2.0 * PI)
    };
    corner(x[1], z[1]) - corner(x[0], z[1]) - corner(x[1], z[0]) + corner(x[0], z[0])
}

/// A wide screen below the lamp ends at x = 0: a point of the floor sees the part of the lamp beyond the line through the screen's edge.
fn penumbra() -> Result<(), Failed> {
    let (height, screen) = (2.0, 1.0);
    let scene = format!(
        "(
            cameras: {{ \"eye\": (position: (0, 0.9, 0.001), target: (0, 0, 0), fov: 100) }},
            materials: {{ \"white\": (base_color: (1, 1, 1), specular: 0) }},
            objects: {{
                \"floor\": (shape: Plane(size: (20, 20)), material: \"white\"),
                \"screen\": (shape: Box(size: (10, 0.001, 20)), material: \"white\", translation: (-5, {screen}, 0)),
            }},
            lights: {{ \"lamp\": Rectangle(luminance: 5, size: (0.8, 0.8), position: (0, {height}, 0), direction: (0, -1, 0)) }},
        )"
    );
    let expected = |x: f64| {
        // From the floor over the edge to the lamp's plane.
        let hidden = (x - x * height / screen).clamp(-0.4, 0.4);
        5.0 * parallel_form_factor([(hidden - x) / height, (0.4 - x) / height], [-0.4 / height, 0.4 / height])
    };
    for (area_lights, samples, most, most_mean) in [("ltc", 64, 0.05, 0.01), ("sampled", 256, 0.025, 0.006)] {
        let shot = Shot::pbr(64, &["radiance"]).set("samples", samples).set("area_lights", area_lights).set("local_shadow_texels", 1024);
        let image = shot.one(&scene)?;
        let full = expected(0.5);
        // A pixel's middle, metres.
        let place = |x: u32| ((f64::from(x) + 0.5) / 32.0 - 1.0) * 0.9 * 50.0_f64.to_radians().tan();
        let row: Vec<(f64, f64)> = (12..52).map(|x| (texel(&image, x, 32)[0], expected(place(x)))).collect();
        let worst = row.iter().fold(0.0_f64, |most, (found, expected)| most.max((found - expected).abs())) / full;
        let mean = row.iter().map(|(found, expected)| found - expected).sum::<f64>().abs() / full / row.len() as f64;
        println!("{area_lights}: worst {worst:.4}, mean {mean:.4}");
        let dark = row.iter().filter(|(_, expected)| *expected == 0.0).count();
        if worst > most || mean > most_mean || dark < 4 {
            return Err(format!("{area_lights}: worst {worst}, mean {mean} of the brightest, {dark} dark").into());
        }
    }
    Ok(())
}
