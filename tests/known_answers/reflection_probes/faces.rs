//! What the faces of a cube show.

use glam::DVec3;
use libtest_mimic::Failed;
use luminaire::image_file::LinearImage;

use super::{direction, shot};
use crate::support::picture::{Eye, Series, places, settle, shown, texel, world};

const PROBE: DVec3 = DVec3::new(1.0, 2.0, 3.0);

/// Middles of boxes that stand around the probe, one or two before each face and none in the middle of it; edges, and colours.
const MARKERS: [([f64; 3], [f64; 3], [f64; 3]); 9] = [
    ([6.0, 3.5, 1.5], [1.0, 2.0, 1.0], [1.0, 0.0, 0.0]),
    ([5.0, 0.5, 5.0], [1.0, 0.5, 2.0], [0.5, 0.0, 0.0]),
    ([-4.0, 4.0, 4.0], [1.0, 1.0, 2.0], [0.0, 1.0, 0.0]),
    ([2.5, 7.0, 4.0], [2.0, 1.0, 1.0], [0.0, 0.0, 1.0]),
    ([-1.0, 6.0, 1.0], [1.0, 1.0, 0.5], [0.0, 0.0, 0.5]),
    ([2.0, -3.0, 5.0], [1.0, 1.0, 2.0], [1.0, 1.0, 0.0]),
    ([3.0, 3.0, 8.0], [1.0, 2.0, 1.0], [1.0, 0.0, 1.0]),
    ([-1.0, 1.0, -2.0], [2.0, 0.5, 1.0], [0.0, 1.0, 1.0]),
    ([2.5, 3.5, -3.0], [1.5, 1.5, 0.5], [0.5, 1.0, 0.5]),
];

/// What a ray from the probe meets first.
fn met(ray: DVec3) -> [f64; 3] {
    let along = |(middle, edges): ([f64; 3], [f64; 3])| {
        let (middle, half) = (DVec3::from(middle) - PROBE, DVec3::from(edges) * 0.5);
        let (a, b) = ((middle - half) / ray, (middle + half) / ray);
        let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
        (enters > 0.0 && enters <= leaves).then_some(enters)
    };
    let hits = MARKERS.iter().filter_map(|(middle, edges, color)| Some((along((*middle, *edges))?, *color)));
    hits.min_by(|a, b| a.0.total_cmp(&b.0)).map_or([0.0; 3], |(_, color)| color)
}

/// Whether a function of texels has one value on a texel and its neighbours.
fn even<T: PartialEq>(of: impl Fn(u32, u32) -> T, (x, y): (u32, u32), size: u32) -> bool {
    let middle = of(x, y);
    let around = |place: u32| place.saturating_sub(1)..=(place + 1).min(size - 1);
    around(y).all(|y| around(x).all(|x| of(x, y) == middle))
}

/// The probe's parent is turned, and its cube is not.
pub fn show_what_stands_there() -> Result<(), Failed> {
    let objects: Vec<String> = MARKERS
        .iter()
        .enumerate()
        .map(|(index, (p, s, c))| {
            format!(
                "\"{index}\": (shape: Box(size: ({}, {}, {})), translation: ({}, {}, {}), surface: (unlit: true, base_color: ({}, {}, {})))",
                s[0], s[1], s[2], p[0], p[1], p[2], c[0], c[1], c[2]
            )
        })
        .collect();
    let scene = format!(
        "({} groups: {{ \"turned\": (translation: (1, 2, 3), rotation: (10, 40, 70)) }},
        markers: {{ \"probe\": ReflectionProbe(position: (0, 0, 0), size: (1, 1, 1), parent: \"turned\") }}, objects: {{ {} }})",
        Eye::new([0.0, 0.0, 1.0], [0.0; 3], 60.0).ron(),
        objects.join(",\n")
    );
    let (mut series, texels) = (Series::default(), 64);
    let mut seen = Vec::new();
    for face in 0..6 {
        let image = series.one(&shot(8, texels, &["face"]).set("face", face), &scene)?;
        let expected = |x, y| met(direction(face, [x, y], texels));
        let mut colors = std::collections::BTreeSet::new();
        for (x, y) in places(&image).filter(|place| even(expected, *place, texels)) {
            let (found, expected) = (texel(&image, x, y), expected(x, y));
            // Colours that half floats hold.
            if found[..3] != expected {
                return Err(format!("face {face} at {x}, {y}: {found:?} and not {expected:?}").into());
            }
            colors.insert(expected.map(|component| (component * 2.0) as u8));
        }
        seen.push(colors.len());
    }
    // Black, and what stands there.
    if seen.iter().any(|colors| *colors < 2) || seen.iter().sum::<usize>() < MARKERS.len() + 6 {
        return Err(format!("the faces show {seen:?} colours").into());
    }
    Ok(())
}

/// A room with every kind of light, and matt things in it. Shadows fall on the things.
fn room(eye: &Eye) -> String {
    format!(
        "({} markers: {{ \"probe\": ReflectionProbe(position: (0.2, 1.4, 0.1), size: (6, 3, 6), near: 0.05) }},
        lights: {{
            \"sun\": Directional(lux: 3, direction: (-1, -1.5, 0.5)),
            \"lamp\": Point(candela: 4, position: (-1, 2.6, 1)),
            \"spot\": Spot(candela: 8, position: (1.5, 2.5, 1), direction: (0.5, -1, -0.6), inner: 20, outer: 35),
            \"panel\": Rectangle(luminance: 4, size: (1, 0.5), position: (-0.5, 2.7, -1.5), direction: (0.2, -1, 0)) }},
        materials: {{ \"matt\": (base_color: (0.7, 0.5, 0.3), specular: 0) }},
        objects: {{
            \"floor\": (shape: Plane(size: (6, 6)), material: \"matt\"),
            \"east\": (shape: Box(size: (0.1, 1.5, 6)), translation: (3, 0.75, 0), material: \"matt\"),
            \"north\": (shape: Box(size: (6, 3, 0.1)), translation: (0, 1.5, -3), material: \"matt\"),
            \"box\": (shape: Box(size: (0.8, 1, 0.8)), translation: (1.8, 0.5, -0.6), rotation: (0, 25, 0), material: \"matt\"),
            \"ball\": (shape: Sphere(radius: 0.4, sectors: 128, stacks: 64), translation: (0.7, 0.5, -1.7), material: \"matt\") }})",
        eye.ron()
    )
}

/// A camera in the place of the probe whose image is a face: a face is the image of a mirror world.
pub fn are_as_bright_as_the_image() -> Result<(), Failed> {
    let size = 128;
    let mut series = Series::default();
    for (face, ahead) in [(0, [1.0, 0.0, 0.0]), (5, [0.0, 0.0, -1.0])] {
        let position = [0.2, 1.4, 0.1];
        let eye = Eye::new(position, [position[0] + ahead[0], position[1], position[2] + ahead[2]], 90.0);
        // Shadows of rectangles have a grain, and it is another one.
        let shot = shot(size, size, &["face", "direct"]).set("face", face).set("shadowed_rectangle_lights", 0);
        let images = series.take(&shot, &room(&eye))?;
        let seen = |x: u32, y: u32| texel(&images["direct"], size - 1 - x, y);
        let (mut worst, mut count) = (0.0_f64, 0);
        for (x, y) in places(&images["face"]) {
            // Where shadows end, maps of other sizes end them elsewhere.
            let smooth = (x.saturating_sub(3)..=(x + 3).min(size - 1)).all(|x| {
                let near = |y: u32| (seen(x, y)[0] / seen(x, y + 1)[0] - 1.0).abs() < 0.02;
                (y.saturating_sub(3)..(y + 3).min(size - 1)).all(near)
            });
            if !smooth {
                continue;
            }
            for (found, expected) in texel(&images["face"], x, y).iter().zip(seen(x, y)).take(3) {
                worst = worst.max((found / expected - 1.0).abs());
            }
            count += 1;
        }
        println!("face {face}: {count} texels, worst difference {:.3} %", 100.0 * worst);
        // Two half floats, and base colours of the G-buffer in a third. Measured: 0.13 %.
        if worst > 0.002 || count < 3000 {
            return Err(format!("face {face}: {count} texels, off by {:.3} %", 100.0 * worst).into());
        }
    }
    Ok(())
}

/// The sky is 1, 2, 3; half of each face is white.
pub fn show_the_sky() -> Result<(), Failed> {
    let scene = format!(
        "({} environment: (sky_radiance: (1, 2, 3)), markers: {{ \"probe\": ReflectionProbe(position: (0, 0, 0), size: (1, 1, 1), far: 40) }},
        objects: {{
            \"far\": (shape: Box(size: (1, 1, 1)), translation: (0, 0, -60), surface: (unlit: true, base_color: (1, 1, 1))),
            \"near\": (shape: Box(size: (1, 1, 1)), translation: (0, 0, 30), surface: (unlit: true, base_color: (1, 1, 1))) }})",
        Eye::new([0.0, 0.0, 1.0], [0.0; 3], 60.0).ron()
    );
    let mut series = Series::default();
    for face in 0..6 {
        let image = series.one(&shot(8, 64, &["face"]).set("face", face), &scene)?;
        for (x, y) in [(1, 1), (32, 32)] {
            let expected = if face == 4 && x == 32 { [1.0, 1.0, 1.0] } else { [1.0, 2.0, 3.0] };
            let found = texel(&image, x, y);
            if found[..3] != expected {
                return Err(format!("face {face} at {x}, {y}: {found:?} and not {expected:?}").into());
            }
        }
    }
    Ok(())
}

pub fn mips_are_means() -> Result<(), Failed> {
    let outputs = ["level0", "level1", "level3"];
    let shot = crate::support::picture::Shot::of("tests/fixtures/gpu/scene_cubes.ron", [8, 8], &outputs);
    let mut session = shot.session(&mut world(&room(&Eye::new([0.0, 1.0, 1.0], [0.0; 3], 60.0)))?)?;
    settle(&mut session)?;
    let [first, second, last] = outputs.map(|name| session.read_output(name).map_err(shown));
    let (first, second, last) = (first?, second?, last?);
    for (image, block) in [(&second, 2), (&last, 8)] {
        for (x, y) in places(image) {
            let (found, expected) = (texel(image, x, y), mean(&first, [x * block, y * block], block));
            for c in 0..3 {
                // Each level rounds.
                if (found[c] - expected[c]).abs() > 0.004 * expected[c] {
                    return Err(format!("{block} to one at {x}, {y}: {found:?} and not {expected:?}").into());
                }
            }
        }
    }
    if second.width * 2 != first.width || last.width * 8 != first.width || mean(&first, [0, 0], first.width)[0] == 0.0 {
        return Err(format!("levels of {}, {}, {} texels", first.width, second.width, last.width).into());
    }
    Ok(())
}

/// Of a part of a face, by solid angle.
fn mean(image: &LinearImage, [x, y]: [u32; 2], edge: u32) -> [f64; 3] {
    let place = |at: u32| (2.0 * f64::from(at) + 1.0) / f64::from(image.width) - 1.0;
    let (mut sum, mut weight) = ([0.0; 3], 0.0);
    for (x, y) in (y..y + edge).flat_map(|y| (x..x + edge).map(move |x| (x, y))) {
        let covered = (1.0 + place(x).powi(2) + place(y).powi(2)).powf(-1.5);
        let found = texel(image, x, y);
        (0..3).for_each(|c| sum[c] += covered * found[c]);
        weight += covered;
    }
    sum.map(|sum| sum / weight)
}
