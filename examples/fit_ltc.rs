//! Fits the tables by which rectangles light glossy surfaces, and writes them as `shaders/area/ltc_matrix.exr` and `ltc_magnitude.exr`:
//!
//! ```sh
//! cargo run --release --example fit_ltc -- shaders/area
//! ```
//!
//! A linearly transformed cosine (Heitz, Dupuy, Hill and Neubelt 2016, "Real-Time Polygonal-Light Shading with Linearly Transformed
//! Cosines") is what a clamped cosine over pi becomes when directions are multiplied by a matrix M and normalised. For each roughness and
//! view direction, M is sought for which it is most like the lobe of `shaders/shared/brdf.wgsl` times the cosine, both brought to the
//! norm 1 over the upper hemisphere: the least integral of the cubed difference, by the simplex search of Nelder and Mead.
//!
//! Column c of 64 is roughness c / 63, row r is sqrt(1 - cosine) = r / 63 of the angle between normal and eye. The tables hold:
//!
//! - matrix: (a, b, c, d) of M^-1 = [a 0 b; 0 1 0; c 0 d], in a frame with the normal along z and the eye in the plane of x and z;
//! - magnitude: what the lobe reflects of white light from everywhere, without Fresnel's factor and with Schlick's weight (1 - v.h)^5 in its
//!   place, each over the part of the transformed cosine that lies above the surface.
//!
//! Everything is computed in 64 bits at fixed places, so that each run gives the same bytes. It takes a minute or two.

#![allow(clippy::print_stdout, reason = "a program for people")]

use std::f64::consts::{PI, TAU};
use std::path::Path;

use glam::{DMat3, DVec3};
use image::{Rgba, Rgba32FImage};

/// Rows and columns of the tables.
const EDGE: usize = 64;
/// Places along each of the two axes that samples are drawn by.
const SAMPLES: usize = 32;
/// The width below which `shaders/shared/brdf.wgsl` does not go.
const LEAST_ALPHA: f64 = 0.001;
/// The cosine of the last row, in place of 0, where nothing can be integrated.
const LEAST_COSINE: f64 = 8.0e-4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "shaders/area".to_owned());
    let mut matrices = Rgba32FImage::new(EDGE as u32, EDGE as u32);
    let mut magnitudes = matrices.clone();
    let mut from_above = Shape { across: 1.0, along: 1.0, skew: 0.0 };
    for column in (0..EDGE).rev() {
        let roughness = column as f64 / (EDGE - 1) as f64;
        let alpha = (roughness * roughness).max(LEAST_ALPHA);
        let mut shape = from_above;
        for row in 0..EDGE {
            let place = row as f64 / (EDGE - 1) as f64;
            let cosine = (1.0 - place * place).max(LEAST_COSINE);
            let lobe = Lobe::new(alpha, DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine));
            shape = fit(&lobe, shape, row == 0);
            if row == 0 {
                from_above = shape;
            }
            let transformed = lobe.transformed(shape);
            let inverse = transformed.inverse * (1.0 / transformed.inverse.y_axis.y);
            let (x, z) = (inverse.x_axis, inverse.z_axis);
            let at = (column as u32, row as u32);
            matrices.put_pixel(at.0, at.1, Rgba([x.x, z.x, x.z, z.z].map(|value| value as f32)));
            let magnitude = [lobe.albedo / transformed.above, lobe.weighted / transformed.above, 0.0, 1.0];
            magnitudes.put_pixel(at.0, at.1, Rgba(magnitude.map(|value| value as f32)));
        }
        println!("roughness {roughness:.3}");
    }
    matrices.save(Path::new(&folder).join("ltc_matrix.exr"))?;
    magnitudes.save(Path::new(&folder).join("ltc_magnitude.exr"))?;
    Ok(())
}

/// The free numbers of a matrix, in a frame that stands on the lobe's mean direction: [across 0 skew; 0 along 0; 0 0 1].
#[derive(Debug, Clone, Copy)]
struct Shape {
    across: f64,
    along: f64,
    skew: f64,
}

/// A transformed cosine.
struct Transformed {
    matrix: DMat3,
    inverse: DMat3,
    /// The part of it that lies above the surface: a half disc and half an ellipse, seen from above.
    above: f64,
}

impl Transformed {
    /// Its density in a unit direction, over the whole sphere. 1/sr.
    fn density(&self, direction: DVec3) -> f64 {
        let back = self.inverse * direction;
        let length = back.length();
        (back.z / length).max(0.0) / PI * self.inverse.determinant() / (length * length * length)
    }
}

/// The lobe of a surface that is seen from one direction.
struct Lobe {
    alpha: f64,
    view: DVec3,
    /// Directions distributed like what the lobe reflects, with the density of each.
    samples: Vec<(DVec3, f64)>,
    /// What it reflects of white light from everywhere.
    albedo: f64,
    /// The same with Schlick's weight.
    weighted: f64,
    /// Where most of it goes, in the plane of normal and eye.
    mean: DVec3,
}

impl Lobe {
    fn new(alpha: f64, view: DVec3) -> Lobe {
        let mut lobe = Lobe { alpha, view, samples: Vec::new(), albedo: 0.0, weighted: 0.0, mean: DVec3::ZERO };
        // The integrals are finer than the fit needs them.
        let fine = 4 * SAMPLES;
        for (u, v) in grid(fine) {
            let facet = lobe.visible_facet(u, v);
            let light = facet * (2.0 * view.dot(facet)) - view;
            if light.z > 0.0 {
                // Reflected over drawn: the masking of the light's side alone.
                let weight = lobe.reflected(light) / lobe.density(light) / (fine * fine) as f64;
                lobe.albedo += weight;
                lobe.weighted += weight * (1.0 - view.dot(facet)).powi(5);
                lobe.mean += light * weight;
            }
        }
        lobe.mean = DVec3::new(lobe.mean.x, 0.0, lobe.mean.z).normalize();
        for (u, v) in grid(SAMPLES) {
            let facet = lobe.visible_facet(u, v);
            let light = facet * (2.0 * view.dot(facet)) - view;
            lobe.samples.push((light, lobe.density(light)));
        }
        lobe
    }

    /// The lobe times the cosine, as `shaders/shared/brdf.wgsl` has it, without Fresnel's factor. 1/sr.
    fn reflected(&self, light: DVec3) -> f64 {
        if light.z <= 0.0 {
            return 0.0;
        }
        let facet = (light + self.view).normalize();
        let squared = self.alpha * self.alpha;
        let masking = |a: f64, b: f64| a * (b * b * (1.0 - squared) + squared).sqrt();
        let visibility = 0.5 / (masking(light.z, self.view.z) + masking(self.view.z, light.z));
        self.facets(facet) * visibility * light.z
    }

    /// GGX (Walter et al. 2007).
    fn facets(&self, facet: DVec3) -> f64 {
        let spread = (self.alpha * facet.z).powi(2) + facet.x * facet.x + facet.y * facet.y;
        (self.alpha / spread).powi(2) / PI
    }

    /// The density of directions that [`Self::visible_facet`] reflects to. 1/sr.
    fn density(&self, light: DVec3) -> f64 {
        let facet = (light + self.view).normalize();
        let tangent = (1.0 - self.view.z * self.view.z) / (self.view.z * self.view.z);
        let seen = 2.0 / (1.0 + (1.0 + self.alpha * self.alpha * tangent).sqrt());
        self.facets(facet) * seen / (4.0 * self.view.z)
    }

    /// A facet, distributed as the eye sees them (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
    fn visible_facet(&self, u: f64, v: f64) -> DVec3 {
        let stretched = DVec3::new(self.alpha * self.view.x, 0.0, self.view.z).normalize();
        let first = DVec3::Y;
        let second = stretched.cross(first);
        let (radius, angle) = (u.sqrt(), TAU * v);
        let x = radius * angle.cos();
        let lift = 0.5 * (1.0 + stretched.z);
        let y = (1.0 - lift) * (1.0 - x * x).sqrt() + lift * radius * angle.sin();
        let up = (1.0 - x * x - y * y).max(0.0).sqrt();
        let facet = first * x + second * y + stretched * up;
        DVec3::new(self.alpha * facet.x, self.alpha * facet.y, facet.z.max(1.0e-12)).normalize()
    }

    /// The transformed cosine of a shape.
    fn transformed(&self, shape: Shape) -> Transformed {
        let frame = DMat3::from_cols(DVec3::new(self.mean.z, 0.0, -self.mean.x), DVec3::Y, self.mean);
        let own = DMat3::from_cols(
            DVec3::new(shape.across.max(1.0e-7), 0.0, 0.0),
            DVec3::new(0.0, shape.along.max(1.0e-7), 0.0),
            DVec3::new(shape.skew, 0.0, 1.0),
        );
        let matrix = frame * own;
        // Where the surface comes to lie when the lobe is brought back to a cosine.
        let normal = matrix.row(2).normalize();
        Transformed { matrix, inverse: matrix.inverse(), above: 0.5 * (1.0 + normal.z) }
    }

    /// The integral of the cubed difference, by samples of both densities (Veach and Guibas 1995, the balance heuristic).
    fn difference(&self, shape: Shape) -> f64 {
        let transformed = self.transformed(shape);
        let term = |light: DVec3, drawn: f64, density: f64| {
            if light.z <= 0.0 {
                return 0.0;
            }
            let apart = self.reflected(light) / self.albedo - density / transformed.above;
            apart.abs().powi(3) / (drawn + density)
        };
        let own = self.samples.iter().map(|(light, drawn)| term(*light, *drawn, transformed.density(*light)));
        let others = grid(SAMPLES).map(|(u, v)| {
            let (radius, angle) = (u.sqrt(), TAU * v);
            let light = (transformed.matrix * DVec3::new(radius * angle.cos(), radius * angle.sin(), (1.0 - u).sqrt())).normalize();
            term(light, self.density(light), transformed.density(light))
        });
        own.sum::<f64>() + others.sum::<f64>()
    }
}

/// The middles of the squares of a grid over 0 to 1.
fn grid(edge: usize) -> impl Iterator<Item = (f64, f64)> {
    let place = move |index: usize| (index as f64 + 0.5) / edge as f64;
    (0..edge * edge).map(move |index| (place(index / edge), place(index % edge)))
}

/// The best shape, sought from another one. A lobe that is seen from above is round.
fn fit(lobe: &Lobe, from: Shape, from_above: bool) -> Shape {
    if from_above {
        let round = |[width]: [f64; 1]| Shape { across: width.exp(), along: width.exp(), skew: 0.0 };
        round(least([from.across.ln()], |point| lobe.difference(round(point))))
    } else {
        // Widths span three powers of ten, and are above 0: they are sought by their logarithms, and the skew in widths.
        let shape = |[across, along, skew]: [f64; 3]| Shape { across: across.exp(), along: along.exp(), skew: skew * across.exp() };
        shape(least([from.across.ln(), from.along.ln(), from.skew / from.across], |point| lobe.difference(shape(point))))
    }
}

/// Nelder and Mead 1965, "A Simplex Method for Function Minimization": where a function is least, near a place.
fn least<const N: usize>(from: [f64; N], value: impl Fn([f64; N]) -> f64) -> [f64; N] {
    let mut corners: Vec<([f64; N], f64)> = vec![(from, value(from))];
    for axis in 0..N {
        let mut point = from;
        point[axis] += 0.1;
        corners.push((point, value(point)));
    }
    for _ in 0..200 {
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (best, worst) = (corners[0], corners[N]);
        if worst.1 - best.1 <= 1.0e-9 * best.1 {
            break;
        }
        let mut middle = [0.0; N];
        for (point, _) in &corners[..N] {
            (0..N).for_each(|axis| middle[axis] += point[axis] / N as f64);
        }
        let along = |factor: f64| {
            let point: [f64; N] = std::array::from_fn(|axis| middle[axis] + factor * (worst.0[axis] - middle[axis]));
            (point, value(point))
        };
        let reflected = along(-1.0);
        if reflected.1 < best.1 {
            let expanded = along(-2.0);
            corners[N] = if expanded.1 < reflected.1 { expanded } else { reflected };
        } else if reflected.1 < corners[N - 1].1 {
            corners[N] = reflected;
        } else {
            let contracted = if reflected.1 < worst.1 { along(-0.5) } else { along(0.5) };
            if contracted.1 < worst.1.min(reflected.1) {
                corners[N] = contracted;
            } else {
                for corner in &mut corners[1..] {
                    let point: [f64; N] = std::array::from_fn(|axis| 0.5 * (best.0[axis] + corner.0[axis]));
                    *corner = (point, value(point));
                }
            }
        }
    }
    corners.sort_by(|a, b| a.1.total_cmp(&b.1));
    corners[0].0
}
