//! Floors beside walls, whose visibility has closed forms.
//!
//! A direction is hidden by a wall of height h, at distance d from a point of the floor and without end to both sides, if it lies in the
//! lune between the floor and the plane through the point and the wall's upper edge. Each closed form is checked by an integration, too.

use std::f64::consts::PI;

use glam::DVec3;
use libtest_mimic::Failed;
use luminaire::image_file::LinearImage;

use super::fine;
use crate::support::picture::{Eye, Series, places, texel};

const EDGE: u32 = 256;

/// The part of a floor's hemisphere, weighted by the cosine, that a wall hides: it stands at distance `d`, is `height` high, and goes on for
/// `width` to one side. Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-4.
fn hidden_by_side(d: f64, height: f64, width: f64) -> f64 {
    let slant = d.hypot(height);
    ((width / d).atan() - d / slant * (width / slant).atan()) / (2.0 * PI)
}

/// By the wall on both sides without end.
fn along_wall(d: f64, height: f64) -> f64 {
    0.5 * (1.0 + d / d.hypot(height))
}

/// The mean direction of what is seen beside a wall at z = 0: its tilt from +Y towards +Z, radians.
///
/// With angles a in the plane across the wall, from +Z upwards, the lune ends at PI - b with tan b = h / d. The integral of the direction
/// times the cosine over it is 4/3 of that of sin a (cos a, sin a) over a.
fn tilt(d: f64, height: f64) -> f64 {
    let b = (height / d).atan();
    (0.5 * b.sin().powi(2)).atan2(0.5 * (PI - b) + 0.25 * (2.0 * b).sin())
}

/// Visibility and mean direction over the hemisphere around +Y, by midpoints.
fn integrate(hidden: impl Fn(DVec3) -> bool) -> (f64, DVec3) {
    let (rings, sectors) = (600, 1200);
    let mut sums = (0.0, DVec3::ZERO);
    for ring in 0..rings {
        // Equal parts of the cosine's square are equal parts of the whole.
        let y = ((f64::from(ring) + 0.5) / f64::from(rings)).sqrt();
        for sector in 0..sectors {
            let (sine, cosine) = ((f64::from(sector) + 0.5) / f64::from(sectors) * 2.0 * PI).sin_cos();
            let across = (1.0 - y * y).sqrt();
            let direction = DVec3::new(across * cosine, y, across * sine);
            if !hidden(direction) {
                sums = (sums.0 + 1.0, sums.1 + direction);
            }
        }
    }
    (sums.0 / f64::from(rings * sectors), sums.1.normalize())
}

/// Whether a wall hides a direction: it stands at distance `d` towards `to_wall`.
fn behind_wall(direction: DVec3, to_wall: DVec3, d: f64, height: f64) -> bool {
    direction.y * d < height * direction.dot(to_wall)
}

#[derive(Clone, Copy)]
enum View {
    Perspective(Eye),
    /// An orthographic one, with the height of what is seen.
    Parallel(Eye, f64),
}

impl View {
    fn ron(&self) -> String {
        match self {
            View::Perspective(eye) => eye.ron(),
            View::Parallel(eye, height) => eye.ron().replace(&format!("fov: {}", eye.fov), &format!("ortho: {height}, far: 100")),
        }
    }

    /// Where a pixel shows the floor, if nothing stands before it.
    fn on_floor(&self, image: &LinearImage, (x, y): (u32, u32)) -> Option<DVec3> {
        match self {
            View::Perspective(eye) => eye.on_plane(image, (x, y), DVec3::ZERO, DVec3::Y),
            View::Parallel(eye, height) => {
                let forward = (eye.target - eye.position).normalize();
                let right = forward.cross(DVec3::Y).normalize();
                let [u, v] = [f64::from(x), f64::from(y)].map(|place| (place + 0.5) / f64::from(EDGE) - 0.5);
                let from = eye.position + (right * u - right.cross(forward) * v) * *height;
                Some(from - forward * (from.y / forward.y))
            }
        }
    }
}

/// Wide, since what lies beyond the image's edge hides nothing.
fn views() -> [(&'static str, View); 4] {
    [
        ("from before it", View::Perspective(Eye::new([0.0, 3.0, 4.5], [0.0, 0.4, 0.2], 90.0))),
        ("from the left", View::Perspective(Eye::new([-3.0, 3.5, 4.5], [0.0, 0.4, 0.2], 90.0))),
        ("from above", View::Perspective(Eye::new([0.0, 4.5, 1.3], [0.0, 0.0, 0.5], 90.0))),
        ("in parallel", View::Parallel(Eye::new([2.0, 5.5, 5.0], [0.0, 0.4, 0.2], 60.0), 10.0)),
    ]
}

const FLOOR: &str = "\"floor\": (shape: Plane(size: (60, 60)), surface: ()),";

/// A wall whose face is z = 0.
fn wall(view: &View, height: f64) -> String {
    let wall = format!("\"wall\": (shape: Box(size: (60, {height}, 0.2)), translation: (0, {}, -0.1), surface: ())", height / 2.0);
    format!("({} objects: {{ {FLOOR} {wall} }})", view.ron())
}

const HEIGHTS: [f64; 3] = [0.3, 0.8, 1.5];
/// Ranges of distances for which errors are told.
const DISTANCES: [f64; 5] = [0.15, 0.25, 0.5, 1.0, 2.0];

/// The places of an image at which a floor beside something is seen: those near x = 0, from which the image shows enough to both sides.
fn floor(view: &View, image: &LinearImage) -> Vec<((u32, u32), DVec3)> {
    let at = |place| view.on_floor(image, place).map(|point| (place, point));
    let counts = |(_, point): &((u32, u32), DVec3)| point.x.abs() < 0.4 && (DISTANCES[0]..DISTANCES[4]).contains(&point.z);
    places(image).filter_map(at).filter(counts).collect()
}

/// The largest of some errors in each range of distances, and how many there are.
fn by_distance(errors: impl Iterator<Item = (f64, f64)>) -> [(f64, usize); 4] {
    let mut worst = [(0.0, 0); 4];
    for (distance, off) in errors {
        let band = &mut worst[DISTANCES[1..4].iter().filter(|end| distance >= **end).count()];
        *band = (if off.abs() > f64::abs(band.0) { off } else { band.0 }, band.1 + 1);
    }
    worst
}

/// Fails unless there are enough errors, all of them within a bound.
fn within(what: &str, worst: [(f64, usize); 4], bound: f64) -> Result<(), Failed> {
    println!("{what}: {worst:.4?} at {DISTANCES:?} m");
    let counts: usize = worst.iter().map(|(_, count)| count).sum();
    if counts > 100 && worst.iter().all(|(off, _)| off.abs() < bound) { Ok(()) } else { Err(format!("{what}: {worst:?}").into()) }
}

/// Measured: 0.0136 from before it, 0.0239 from the left, 0.0234 from above, 0.0231 in parallel; always too bright, since steps and pixels miss
/// the wall's very edge, and most where few pixels lie between the wall and the point.
pub fn floor_along_a_wall() -> Result<(), Failed> {
    for (d, height) in HEIGHTS.iter().flat_map(|height| DISTANCES.map(|d| (d, *height))) {
        let (integrated, _) = integrate(|direction| behind_wall(direction, DVec3::NEG_Z, d, height));
        if (integrated - along_wall(d, height)).abs() > 0.002 {
            return Err(format!("{integrated} and not {} at {d}, {height}", along_wall(d, height)).into());
        }
    }
    let mut series = Series::default();
    for ((name, view), height) in views().iter().flat_map(|view| HEIGHTS.map(|height| (view, height))) {
        let image = series.one(&fine(EDGE, &["occlusion"]), &wall(view, height))?;
        let errors = floor(view, &image).into_iter().map(|((x, y), point)| (point.z, texel(&image, x, y)[3] - along_wall(point.z, height)));
        within(&format!("{name}, {height} m high"), by_distance(errors), 0.03)?;
    }
    Ok(())
}

/// Measured: 1.5 degrees.
pub fn bent_normals() -> Result<(), Failed> {
    for (d, height) in HEIGHTS.iter().flat_map(|height| DISTANCES.map(|d| (d, *height))) {
        let (_, mean) = integrate(|direction| behind_wall(direction, DVec3::NEG_Z, d, height));
        if (mean.z.atan2(mean.y) - tilt(d, height)).abs() > 0.002 {
            return Err(format!("{mean} is not tilted by {} at {d}, {height}", tilt(d, height)).into());
        }
    }
    let mut series = Series::default();
    for ((name, view), height) in views().iter().step_by(2).flat_map(|view| HEIGHTS.map(|height| (view, height))) {
        let image = series.one(&fine(EDGE, &["occlusion"]), &wall(view, height))?;
        let errors = floor(view, &image).into_iter().map(|((x, y), point)| {
            let [bx, by, bz, _] = texel(&image, x, y);
            let (sine, cosine) = tilt(point.z, height).sin_cos();
            let angle = DVec3::new(bx, by, bz).normalize().angle_between(DVec3::new(0.0, cosine, sine)).to_degrees();
            // All of them must lean away.
            (point.z, if bz > 0.0 { angle } else { 90.0 })
        });
        within(&format!("{name}, {height} m high, degrees"), by_distance(errors), 3.0)?;
    }
    Ok(())
}

/// Measured: 0.0241.
pub fn corner() -> Result<(), Failed> {
    let view = View::Perspective(Eye::new([2.0, 2.8, 2.4], [0.5, 0.0, 0.5], 75.0));
    let mut series = Series::default();
    for height in [0.3, 0.8] {
        let seen = |x: f64, z: f64| {
            let end = 1000.0;
            let along = |d: f64, near: f64| hidden_by_side(d, height, near) + hidden_by_side(d, height, end);
            1.0 - along(x, z) - along(z, x)
        };
        let (integrated, _) =
            integrate(|direction| behind_wall(direction, DVec3::NEG_X, 0.4, height) || behind_wall(direction, DVec3::NEG_Z, 0.7, height));
        if (integrated - seen(0.4, 0.7)).abs() > 0.002 {
            return Err(format!("{integrated} and not {} in the corner", seen(0.4, 0.7)).into());
        }
        let wall =
            |name: &str, size: &str, place: &str| format!("\"{name}\": (shape: Box(size: ({size})), translation: ({place}), surface: ()),");
        let scene = format!(
            "({} objects: {{ {FLOOR} {} {} }})",
            view.ron(),
            wall("a", &format!("0.2, {height}, 30"), &format!("-0.1, {}, 15", height / 2.0)),
            wall("b", &format!("30, {height}, 0.2"), &format!("15, {}, -0.1", height / 2.0)),
        );
        let image = series.one(&fine(EDGE, &["occlusion"]), &scene)?;
        let shown = places(&image).filter_map(|place| Some((place, view.on_floor(&image, place)?)));
        let errors = shown
            .filter(|(_, point)| point.x.min(point.z) >= DISTANCES[0] && point.x.max(point.z) < 1.2)
            .map(|((x, y), point)| (point.x.min(point.z), texel(&image, x, y)[3] - seen(point.x, point.z)));
        within(&format!("a corner, {height} m high"), by_distance(errors), 0.03)?;
    }
    Ok(())
}

/// Measured: 0.0182.
pub fn pit() -> Result<(), Failed> {
    let half = 1.0;
    let mut series = Series::default();
    for (height, from) in [(0.5, [0.01, 4.0, 0.0]), (1.0, [0.3, 4.0, -0.2])] {
        let view = View::Perspective(Eye::new(from, [from[0], 0.0, from[2] - 0.001], 60.0));
        let ways = |point: DVec3| [half - point.x, half + point.x, half - point.z, half + point.z];
        let seen = |point: DVec3| {
            let [right, left, near, far] = ways(point);
            let wall = |d: f64, sides: [f64; 2]| sides.map(|side| hidden_by_side(d, height, side)).iter().sum::<f64>();
            1.0 - wall(right, [near, far]) - wall(left, [near, far]) - wall(near, [right, left]) - wall(far, [right, left])
        };
        let (integrated, _) = integrate(|direction| {
            [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z].into_iter().any(|to_wall| behind_wall(direction, to_wall, half, height))
        });
        if (integrated - seen(DVec3::ZERO)).abs() > 0.002 {
            return Err(format!("{integrated} and not {} in the pit", seen(DVec3::ZERO)).into());
        }
        let wall = |name: &str, size: [f64; 2], place: [f64; 2]| {
            let ([sx, sz], [x, z]) = (size, place);
            format!("\"{name}\": (shape: Box(size: ({sx}, {height}, {sz})), translation: ({x}, {}, {z}), surface: ()),", height / 2.0)
        };
        let scene = format!(
            "({} objects: {{ {FLOOR} {} {} {} {} }})",
            view.ron(),
            wall("right", [0.4, 2.8], [1.2, 0.0]),
            wall("left", [0.4, 2.8], [-1.2, 0.0]),
            wall("near", [2.0, 0.4], [0.0, 1.2]),
            wall("far", [2.0, 0.4], [0.0, -1.2]),
        );
        let image = series.one(&fine(EDGE, &["occlusion"]), &scene)?;
        let nearest = |point: DVec3| ways(point).into_iter().fold(half, f64::min);
        let errors = places(&image)
            .filter_map(|place| Some((place, view.on_floor(&image, place)?)))
            .filter(|(_, point)| nearest(*point) >= DISTANCES[0])
            .map(|((x, y), point)| (nearest(point), texel(&image, x, y)[3] - seen(point)));
        within(&format!("a pit, {height} m deep"), by_distance(errors), 0.03)?;
    }
    Ok(())
}
