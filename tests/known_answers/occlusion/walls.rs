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

const EDGE: u32 = 128;

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

fn views() -> [(&'static str, View); 4] {
    [
        ("from before it", View::Perspective(Eye::new([0.3, 3.0, 4.5], [0.0, 0.4, 0.2], 60.0))),
        ("from the left", View::Perspective(Eye::new([-3.5, 2.5, 3.0], [0.3, 0.4, 0.3], 60.0))),
        ("from above", View::Perspective(Eye::new([0.4, 5.0, 1.6], [0.0, 0.0, 0.5], 60.0))),
        ("in parallel", View::Parallel(Eye::new([2.0, 3.5, 4.0], [0.0, 0.4, 0.2], 60.0), 6.0)),
    ]
}

const FLOOR: &str = "\"floor\": (shape: Plane(size: (60, 60)), surface: ()),";

/// A wall whose face is z = 0.
fn wall(view: &View, height: f64) -> String {
    let wall = format!("\"wall\": (shape: Box(size: (60, {height}, 0.2)), translation: (0, {}, -0.1), surface: ())", height / 2.0);
    format!("({} objects: {{ {FLOOR} {wall} }})", view.ron())
}

/// Whether a pixel is so far from the sides of the image that the wall shows on for long to both sides.
fn is_inside((x, _): (u32, u32)) -> bool {
    (EDGE / 4..EDGE * 3 / 4).contains(&x)
}

const HEIGHTS: [f64; 3] = [0.3, 0.8, 1.5];
/// Ranges of distances for which errors are told.
const DISTANCES: [f64; 5] = [0.1, 0.25, 0.5, 1.0, 2.0];

pub fn floor_along_a_wall() -> Result<(), Failed> {
    let mut series = Series::default();
    for (d, height) in HEIGHTS.iter().flat_map(|height| DISTANCES.map(|d| (d, *height))) {
        let (integrated, _) = integrate(|direction| behind_wall(direction, DVec3::NEG_Z, d, height));
        if (integrated - along_wall(d, height)).abs() > 0.002 {
            return Err(format!("{integrated} and not {} at {d}, {height}", along_wall(d, height)).into());
        }
    }
    for ((name, view), height) in views().iter().flat_map(|view| HEIGHTS.map(|height| (view, height))) {
        let image = series.one(&fine(EDGE, &["occlusion"]), &wall(view, height))?;
        let mut worst = [0.0f64; 4];
        let mut counts = [0; 4];
        for place in places(&image).filter(|place| is_inside(*place)) {
            let Some(point) = view.on_floor(&image, place).filter(|point| (DISTANCES[0]..DISTANCES[4]).contains(&point.z)) else { continue };
            let band = DISTANCES[1..].iter().filter(|from| point.z >= **from).count();
            let off = texel(&image, place.0, place.1)[3] - along_wall(point.z, height);
            counts[band] += 1;
            worst[band] = if off.abs() > worst[band].abs() { off } else { worst[band] };
        }
        println!("{name}, {height} m high: {worst:.4?} of {counts:?} pixels at {DISTANCES:?} m");
    }
    Ok(())
}

pub fn corner() -> Result<(), Failed> {
    Ok(())
}

pub fn pit() -> Result<(), Failed> {
    Ok(())
}

pub fn bent_normals() -> Result<(), Failed> {
    Ok(())
}
