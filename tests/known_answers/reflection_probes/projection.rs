//! The parallax of a box against planes that rays meet.

use glam::DVec3;
use libtest_mimic::Failed;
use luminaire::scenes::world::{GlobalTransform, find_by_name};

use crate::support::picture::{Shot, places, settle, shown, texel, world};

const SIZE: DVec3 = DVec3::new(3.0, 2.0, 4.0);
const MARGIN: f64 = 0.75;

/// Where three pairs of planes stand: the middle, and from there to one of each pair.
struct Planes {
    middle: DVec3,
    halves: [DVec3; 3],
}

impl Planes {
    /// Outwards unit normals of one of each pair, and how far they are from the middle.
    fn normals(&self) -> [(DVec3, f64); 3] {
        let [x, y, z] = self.halves;
        [(y.cross(z), x), (z.cross(x), y), (x.cross(y), z)].map(|(normal, half)| {
            let normal = normal.normalize() * normal.dot(half).signum();
            (normal, normal.dot(half))
        })
    }

    /// How far a point is beyond the planes; negative inside of all.
    fn outside(&self, point: DVec3) -> f64 {
        self.normals().map(|(normal, half)| normal.dot(point - self.middle).abs() - half).into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Where a ray that starts inside leaves.
    fn exit(&self, point: DVec3, ray: DVec3) -> DVec3 {
        let lengths = self.normals().into_iter().flat_map(|(normal, half)| [(normal, half), (-normal, half)]).map(|(normal, half)| {
            let towards = normal.dot(ray);
            if towards > 0.0 { (half - normal.dot(point - self.middle)) / towards } else { f64::INFINITY }
        });
        point + ray * lengths.fold(f64::INFINITY, f64::min)
    }
}

/// Upright, turned, and sheared by a parent that stretches something turned.
pub fn rays_end_on_the_box() -> Result<(), Failed> {
    let mut series_of = Vec::new();
    for (outer, inner) in [
        ("translation: (1, 2, 3)", "translation: (0, 0, 0)"),
        ("translation: (1, 2, 3), rotation: (20, 35, -50)", "rotation: (0, 0, 0)"),
        ("translation: (-40, 1, 7), scale: (1, 1.5, 0.6)", "rotation: (10, -35, 25)"),
    ] {
        let text = format!(
            "(cameras: {{ \"eye\": (position: (0, 0, 1), target: (0, 0, 0)) }},
            groups: {{ \"outer\": ({outer}), \"inner\": ({inner}, parent: \"outer\") }},
            markers: {{ \"probe\": ReflectionProbe(position: (0, 0, 0), size: ({}, {}, {}), parent: \"inner\") }})",
            SIZE.x, SIZE.y, SIZE.z
        );
        let mut world = world(&text)?;
        let shot = Shot::of("tests/fixtures/gpu/box_projection.ron", [8, 8], &["points", "rays", "found"]).set("margin", MARGIN);
        let mut session = shot.session(&mut world)?;
        settle(&mut session)?;
        let [points, rays, found] = ["points", "rays", "found"].map(|name| session.read_output(name).map_err(shown));
        let (points, rays, found) = (points?, rays?, found?);

        let entity = find_by_name(&mut world, "probe").map_err(|problem| problem.message)?;
        let place = world.get::<GlobalTransform>(entity).ok_or("the probe has a place")?.0;
        let column = |axis: usize| place.matrix3.col(axis).as_dvec3() * (SIZE[axis] * 0.5);
        let planes = Planes { middle: place.translation.as_dvec3(), halves: [column(0), column(1), column(2)] };
        let (mut inside, mut worst, mut worst_weight) = (0, 0.0_f64, 0.0_f64);
        for (x, y) in places(&found) {
            let vector = |image| DVec3::from_slice(&texel(image, x, y)[..3]);
            let (point, ray, direction) = (vector(&points), vector(&rays), vector(&found));
            let outside = planes.outside(point);
            let weight = (1.0 - outside / MARGIN).clamp(0.0, 1.0);
            worst_weight = worst_weight.max((texel(&found, x, y)[3] - weight).abs());
            if outside <= 0.0 {
                inside += 1;
                // As seen from the middle.
                let expected = planes.exit(point, ray) - planes.middle;
                worst = worst.max((direction.normalize() - expected.normalize()).length());
            }
        }
        println!("{inside} rays from inside, directions off by {worst:.1e}, weights by {worst_weight:.1e}");
        series_of.push((inside, worst, worst_weight));
    }
    // Single precision, 40 m from the origin for the last one.
    let good = |(inside, worst, weight): &(u32, f64, f64)| *inside > 300 && *worst < 1e-4 && *weight < 1e-4;
    if series_of.iter().all(good) { Ok(()) } else { Err(format!("{series_of:?}").into()) }
}
