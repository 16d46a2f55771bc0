//! Shadows against what rays to the light say: edges, acne, leaks, seams, with every filter for which they hold.

use std::f64::consts::PI;

use glam::DVec3;
use libtest_mimic::Failed;
use luminaire::image_file::LinearImage;

use crate::Case;
use crate::support::picture::{Eye, Series, Shot, near, places, texel};

pub const CASES: &[Case] = &[
    ("shadows::edge of a square under a point light", || square_shadow(Light::Lamp)),
    ("shadows::edge of a square under the sun", || square_shadow(Light::Sun)),
    ("shadows::no acne at grazing angles", no_acne_at_grazing_angles),
    ("shadows::a ball does not shadow itself", ball_does_not_shadow_itself),
    ("shadows::a thin wall leaks nothing", thin_walls),
    ("shadows::faces of the cube show no seam", no_seams),
];

/// What a shadow map may take from a ball, as a share of the light, with a filter one texel wide and with wider ones, and up to which cosine
/// against it. Measured: 0.0055, 0.0185, 0.62.
const MOST_LOST: f64 = 0.007;
const MOST_LOST_BY_WIDE: f64 = 0.022;
const MOST_COSINE: f64 = 0.65;

/// All filters.
pub const FILTERS: [&str; 5] = ["plane", "hardware", "pcf3", "poisson", "pcss"];

#[derive(Clone, Copy)]
enum Light {
    Lamp,
    Sun,
}

/// A square of 1 m hovers 1 m above a floor. Exactly dark inside of its shadow and exactly lit outside, but for one texel of the
/// map on each side of the edge.
fn square_shadow(light: Light) -> Result<(), Failed> {
    let eye = Eye::new([0.0, 9.0, 4.0], [0.2, 0.0, 0.0], 22.0);
    let lamp = DVec3::new(0.6, 3.0, 0.2);
    let to_sun = DVec3::new(0.5, 1.0, 0.3).normalize();
    let source = match light {
        Light::Lamp => "\"lamp\": Point(candela: 20, position: (0.6, 3, 0.2))",
        Light::Sun => "\"sun\": Directional(lux: 3, direction: (-0.5, -1, -0.3))",
    };
    let scene = format!(
        "({} lights: {{ {source} }}, objects: {{
            \"floor\": (shape: Plane(size: (6, 6)), surface: (base_color: (0.5, 0.5, 0.5), specular: 0)),
            \"square\": (shape: Plane(size: (1, 1)), translation: (0.1, 1, 0.05), surface: (specular: 0)) }})",
        eye.ron()
    );
    let image = Shot::pbr(192, &["radiance"]).set("sun_shadow_texels", 256).one(&scene)?;
    // A texel on the floor: 2 / 256 of the lamp's 3 m of height. The sun's map holds at most the whole floor, whose diagonal is
    // 8.5 m, in 254 texels; they lie aslant on the floor, and the square's edges aslant to them.
    let margin = match light {
        Light::Lamp => 2.0 / 256.0 * 3.0,
        Light::Sun => 6.0 * 2.0 / 254.0 / to_sun.y,
    };
    let (mut dark, mut lit) = (0, 0);
    for place in places(&image) {
        let Some(point) = eye.on_plane(&image, place, DVec3::ZERO, DVec3::Y) else { continue };
        // How far beyond the square's edge a ray passes its plane, metres; negative inside.
        let beyond = |at: DVec3| (at.x - 0.1).abs().max((at.z - 0.05).abs()) - 0.5;
        let seen = eye.position + (point - eye.position) * ((eye.position.y - 1.0) / eye.position.y);
        if beyond(seen) < 0.02 || point.x.abs().max(point.z.abs()) > 2.9 {
            continue;
        }
        let (crossing, shrink, lux) = match light {
            Light::Lamp => {
                let to_light = lamp - point;
                let lux = 20.0 * to_light.y / to_light.length().powi(3);
                (point + to_light / 3.0, 2.0 / 3.0, lux)
            }
            Light::Sun => (point + to_sun / to_sun.y, 1.0, 3.0 * to_sun.y),
        };
        let found = texel(&image, place.0, place.1)[0];
        let distance = beyond(crossing);
        if distance < -margin * shrink {
            dark += 1;
            if found != 0.0 {
                return Err(format!("{found} at {place:?}, {:.4} m inside of the shadow", -distance / shrink).into());
            }
        } else if distance > margin * shrink {
            lit += 1;
            // Half floats, and depth; measured: 0.15 %.
            near(&format!("{place:?}, {:.4} m outside of the shadow", distance / shrink), found, 0.5 / PI * lux, 0.002)?;
        }
    }
    println!("{dark} dark, {lit} lit");
    if dark > 600 && lit > 20000 { Ok(()) } else { Err(format!("{dark} dark, {lit} lit").into()) }
}

/// A floor, lit from almost the side: every pixel as the formula says.
fn no_acne_at_grazing_angles() -> Result<(), Failed> {
    let eye = Eye::new([0.0, 3.0, 6.0], [0.0, 0.0, 0.0], 60.0);
    let floor = "\"floor\": (shape: Plane(size: (40, 40)), surface: (base_color: (0.5, 0.5, 0.5), specular: 0))";
    let direction = DVec3::new(-1.0, 0.03, 0.4).normalize();
    let scenes = [
        "\"lamp\": Point(candela: 50, position: (-1, 0.15, 1))",
        "\"spot\": Spot(candela: 50, position: (-1, 0.15, 1), direction: (1, -0.05, -0.6), inner: 50, outer: 60)",
        "\"sun\": Directional(lux: 100, direction: (1, -0.03, -0.4))",
    ];
    let mut series = Series::default();
    for (filter, index) in FILTERS.into_iter().flat_map(|filter| (0..3).map(move |light| (filter, light))) {
        let scene = format!("({} lights: {{ {} }}, objects: {{ {floor} }})", eye.ron(), scenes[index]);
        let image = series.one(&Shot::pbr(128, &["radiance"]).set("shadow_filter", filter), &scene)?;
        for place in places(&image) {
            let Some(point) = eye.on_plane(&image, place, DVec3::ZERO, DVec3::Y) else { continue };
            if point.x.abs().max(point.z.abs()) > 19.9 {
                continue;
            }
            let to_lamp = DVec3::new(-1.0, 0.15, 1.0) - point;
            // Where the spot is at its full strength.
            if index == 1 && (-to_lamp).normalize().dot(DVec3::new(1.0, -0.05, -0.6).normalize()) < 49.5_f64.to_radians().cos() {
                continue;
            }
            let lux = if index < 2 { 50.0 * to_lamp.y / to_lamp.length().powi(3) } else { 100.0 * direction.y };
            let (found, expected) = (texel(&image, place.0, place.1)[0], 0.5 / PI * lux);
            // Depth rounds the distance to the floor, which the cosine shows. Measured: 0.14 %.
            if (found - expected).abs() > 0.002 * expected + 1e-5 {
                return Err(format!("{filter}: {found} at {place:?}, {point}, not {expected}").into());
            }
        }
    }
    Ok(())
}

/// How many pixels a shadow map makes darker by more than the last bit of a half float, of how many that are lit.
fn darkened(with: &LinearImage, without: &LinearImage) -> [usize; 2] {
    let mut count = [0, 0];
    for (x, y) in places(without) {
        let (a, b) = (texel(with, x, y)[0], texel(without, x, y)[0]);
        // Four weights need not add up to 1 exactly.
        count[0] += usize::from((a - b).abs() > 0.001 * b);
        count[1] += usize::from(b > 0.0);
    }
    count
}

/// A convex body hides nothing of itself that faces the light: the picture should be the one without shadow maps. Near the
/// terminator, where facets are seen by the light almost edge on, it is not quite: this test bounds how much is lost, and where.
fn ball_does_not_shadow_itself() -> Result<(), Failed> {
    let eye = Eye::new([0.0, 0.5, 5.0], [0.0, 0.0, 0.0], 30.0);
    let shot = Shot::pbr(192, &["radiance", "normal"]);
    let mut series = Series::default();
    // Facets coarser than the map's texels, about as fine, and finer.
    for (sectors, stacks) in [(24, 12), (128, 64), (512, 256)] {
        let scene = |lights: &str| {
            format!(
                "({} lights: {{ {lights} }}, objects: {{
                    \"ball\": (shape: Sphere(radius: 1, sectors: {sectors}, stacks: {stacks}), surface: (specular: 0)) }})",
                eye.ron()
            )
        };
        let lamp = scene("\"lamp\": Point(candela: 30, position: (3, 1, 1))");
        let sun = "\"sun\": Directional(lux: 3, direction: (-3, -1, -1))";
        let without = shot.clone().set("shadowed_point_lights", 0).set("shadowed_directional_lights", 0);
        let lights = [("lamp", lamp), ("sun", scene(sun))];
        // All filters with the coarsest facets, where most is lost.
        let filters = if sectors == 24 { &FILTERS[..] } else { &FILTERS[..1] };
        for (filter, (name, scene)) in filters.iter().flat_map(|filter| lights.iter().map(move |light| (*filter, light))) {
            let most_lost = if ["pcf3", "poisson"].contains(&filter) { MOST_LOST_BY_WIDE } else { MOST_LOST };
            let with = series.take(&shot.clone().set("shadow_filter", filter), scene)?;
            let without = series.take(&without.clone().set("shadow_filter", filter), scene)?;
            let (mut lost, mut light, mut steepest) = (0.0, 0.0, 0.0f64);
            for (x, y) in places(&with["radiance"]) {
                let (a, b) = (texel(&with["radiance"], x, y)[0], texel(&without["radiance"], x, y)[0]);
                light += b;
                lost += (b - a).abs();
                if b - a > 0.001 * b {
                    // The lamp is near enough to its direction from the middle of the ball.
                    let [nx, ny, nz, _] = texel(&without["normal"], x, y);
                    let place = DVec3::new(nx, ny, nz);
                    let to_light = if *name == "sun" { DVec3::new(3.0, 1.0, 1.0) } else { DVec3::new(3.0, 1.0, 1.0) - place };
                    steepest = steepest.max(place.dot(to_light.normalize()));
                }
            }
            println!("{name}, {filter}, {sectors} sectors: {:.5} of the light is lost, up to cosine {steepest:.3}", lost / light);
            if light < 500.0 || lost > most_lost * light || steepest > MOST_COSINE {
                return Err(format!("{name}, {filter}, {sectors} sectors: {lost} of {light} is lost, up to cosine {steepest}").into());
            }
        }
    }
    Ok(())
}

/// A closed room of 2 m with walls of 2 cm, lights outside, the camera inside: not little light, none. Two filters promise nothing here:
/// hardware follows the receiver's plane however steep, and pcss takes the roof's outline, which is all that the map shows, for the
/// occluder of what stands far below it.
fn thin_walls() -> Result<(), Failed> {
    let mut walls = String::new();
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        for side in [-1.0, 1.0] {
            let (mut place, mut size) = ([0.0; 3], [2.04; 3]);
            (place[axis], size[axis]) = (side * 1.01, 0.02);
            walls += &format!("\"{name}{side}\": (shape: Box(size: {size:?}), translation: {place:?}, surface: (specular: 0)),")
                .replace('[', "(")
                .replace(']', ")");
        }
    }
    let lights = [
        ([1.0, 0.2, 0.3], "\"lamp\": Point(candela: 1000, position: (2.5, 1.7, 1.2))"),
        ([-0.3, -1.0, 0.4], "\"lamp\": Point(candela: 1000, position: (1.3, 0, 0))"),
        ([-0.6, -0.9, -0.5], "\"sun\": Directional(lux: 1000, direction: (-1, -2, -0.7))"),
    ];
    let mut series = Series::default();
    // The wall next to the lamp is 1.7 texels thick, and the corners behind it are in sight. Filters that look farther need finer maps.
    for (filter, texels) in [("plane", 256), ("pcf3", 768), ("poisson", 768)] {
        let shot = Shot::pbr(256, &["radiance"]).set("local_shadow_texels", texels).set("sun_shadow_texels", texels);
        for (target, light) in lights {
            let eye = Eye::new([0.1, 0.2, 0.3], target, 100.0);
            let scene = format!("({} lights: {{ {light} }}, objects: {{ {walls} }})", eye.ron());
            let image = series.one(&shot.clone().set("shadow_filter", filter), &scene)?;
            let leaks: Vec<_> = places(&image).filter(|(x, y)| texel(&image, *x, *y)[..3] != [0.0; 3]).take(5).collect();
            if !leaks.is_empty() {
                return Err(format!("{light} shines into the room at {leaks:?} with the filter {filter}").into());
            }
        }
    }
    Ok(())
}

/// How far from the next wall of a room of 4 by 3 by 5 m a ray meets a wall, metres.
fn from_corner(eye: DVec3, ray: DVec3) -> f64 {
    let half = DVec3::new(2.0, 1.5, 2.5);
    let along = ((half * ray.signum() - eye) / ray).min_element();
    let mut gaps = (half - (eye + ray * along).abs()).to_array();
    gaps.sort_unstable_by(f64::total_cmp);
    gaps[1]
}

/// A lamp within a room, off its middle, so that the edges of the cube's faces run across the walls: as bright as without maps.
fn no_seams() -> Result<(), Failed> {
    let targets = [[1.0, 0.9, 0.8], [-1.0, -0.8, 0.9], [0.9, -0.7, -1.0]];
    let mut series = Series::default();
    for (filter, target) in FILTERS.into_iter().flat_map(|filter| targets.map(|target| (filter, target))) {
        let eye = Eye::new([0.0, 0.1, 0.0], target, 110.0);
        let scene = format!(
            "({} lights: {{ \"lamp\": Point(candela: 10, position: (0.3, -0.2, 0.4)) }},
            objects: {{ \"room\": (shape: Box(size: (4, 3, 5)), surface: (specular: 0)) }})",
            eye.ron()
        );
        let shot = Shot::pbr(128, &["radiance"]).set("shadow_filter", filter);
        let without = series.one(&shot.clone().set("shadowed_point_lights", 0), &scene)?;
        let with = series.one(&shot, &scene)?;
        let [_, lit] = darkened(&with, &without);
        // Where walls meet, a filter that looks farther finds one of them before the other.
        let counts = |place: &(u32, u32)| filter == "plane" || from_corner(eye.position, eye.ray(&with, place.0, place.1)) > 0.15;
        let differs = |(x, y): &(u32, u32)| (texel(&with, *x, *y)[0] / texel(&without, *x, *y)[0] - 1.0).abs() > 0.001;
        let wrong = places(&with).filter(counts).filter(differs).count();
        if wrong > 0 || lit != 128 * 128 {
            return Err(format!("{filter}: {wrong} of {lit} pixels are darker, looking to {target:?}").into());
        }
    }
    Ok(())
}
