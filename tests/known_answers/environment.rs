//! What surrounds a scene: its cube, diffuse light and means over lobes against closed forms, a white furnace, and what a change runs.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use libtest_mimic::Failed;
use luminaire::scenes::World;
use luminaire::scenes::linear_image::LinearImage;
use luminaire::scenes::world::{SkyImage, SkyShape};

use crate::Case;
use crate::support::picture::{Eye, Shot, near, places, settle, shown, texel, world};

pub const CASES: &[Case] = &[
    ("environment::a constant sky stays what it is", constant),
    ("environment::diffuse light of a clamped cosine has its closed form", clamped_cosine),
    ("environment::one bright texel keeps its light wherever it is", one_bright_texel),
    ("environment::six faces show what one image shows", six_faces),
    ("environment::white surfaces in white light are white", white_furnace),
    ("environment::compensation has its closed form", closed_form),
    ("environment::a change runs what it reaches", changes),
];

type Pictures = std::collections::BTreeMap<String, luminaire::image_file::LinearImage>;

const PARTS: &str = "tests/fixtures/gpu/environment.ron";
const IBL: &str = "pipelines/ibl.ron";
const NO_SCENE: &str = "(cameras: { \"eye\": (position: (0, 0, 1), target: (0, 0, 0)) })";

/// An equirectangular image of something by direction.
fn image(width: u32, of: impl Fn(DVec3) -> f32) -> LinearImage {
    let height = width / 2;
    let direction = |x: u32, y: u32| {
        let (around, down) = (((f64::from(x) + 0.5) / f64::from(width) - 0.5) * 2.0 * PI, (f64::from(y) + 0.5) / f64::from(height) * PI);
        DVec3::new(down.sin() * around.cos(), down.cos(), down.sin() * around.sin())
    };
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| {
        let value = of(direction(x, y));
        [value, 0.5 * value, 2.0 * value, 1.0]
    });
    LinearImage { width, height, texels: texels.collect() }
}

fn under(sky: LinearImage, shape: SkyShape, scene: &str) -> Result<World, Failed> {
    let mut world = world(scene)?;
    world.insert_resource(SkyImage { image: Arc::new(sky), shape, rotation: 0.0, strength: 1.0 });
    Ok(world)
}

/// Of the parts at a small size, where the size does not matter.
fn parts(outputs: &[&str]) -> Shot {
    Shot::of(PARTS, [64, 32], outputs).set("texels", 64)
}

fn constant() -> Result<(), Failed> {
    let mut world = under(image(64, |_| 0.7), SkyShape::Equirectangular, NO_SCENE)?;
    for (name, image) in parts(&["radiance", "irradiance_sh", "irradiance_cube", "lobes"]).take_world(&mut world)? {
        for (x, y) in places(&image) {
            for (channel, expected) in [0.7, 0.35, 1.4].into_iter().enumerate() {
                // Half floats, on both sides: measured 0.0002.
                near(&format!("{name} at {x}, {y}"), texel(&image, x, y)[channel], expected, 0.0005)?;
            }
        }
    }
    Ok(())
}

/// Of max(0, y): pi/4 + pi/3 c + 5 pi/64 (3 c^2 - 1) / 2.
fn clamped_cosine() -> Result<(), Failed> {
    let mut world = under(image(1024, |direction| direction.y.max(0.0) as f32), SkyShape::Equirectangular, NO_SCENE)?;
    let shot = Shot::of(PARTS, [64, 32], &["irradiance_sh", "irradiance_cube"]);
    let images = shot.take_world(&mut world)?;
    let (mut worst, mut apart) = (0.0f64, 0.0f64);
    for (x, y) in places(&images["irradiance_sh"]) {
        let c = ((f64::from(y) + 0.5) / 32.0 * PI).cos();
        let expected = PI / 4.0 + PI / 3.0 * c + 5.0 * PI / 64.0 * (3.0 * c * c - 1.0) / 2.0;
        worst = worst.max((PI * texel(&images["irradiance_sh"], x, y)[0] - expected.max(0.0)).abs());
        apart = apart.max((PI * texel(&images["irradiance_cube"], x, y)[0] - convolved_cosine(c)).abs());
    }
    // Measured: 0.00001, and 0.0082 by the texels of the convolved cube.
    println!("worst error {worst:.6} of the coefficients, {apart:.6} of the cube");
    if worst < 1e-4 && apart < 0.01 { Ok(()) } else { Err(format!("{worst}, {apart}").into()) }
}

/// Irradiance under max(0, y) on a surface whose normal has this cosine to +Y, by a sum over directions.
fn convolved_cosine(c: f64) -> f64 {
    let (s, rings, spokes) = ((1.0 - c * c).sqrt(), 200, 200);
    let part = |index: u32, count: u32| (f64::from(index) + 0.5) / f64::from(count);
    (0..rings * spokes)
        .map(|i| {
            let (y, around) = (part(i / spokes, rings), part(i % spokes, spokes) * 2.0 * PI);
            let level = (1.0 - y * y).sqrt();
            y * (c * y + s * level * around.cos()).max(0.0)
        })
        .sum::<f64>()
        * 2.0
        * PI
        / f64::from(rings * spokes)
}

/// Of the sines of the angles from the pole that a row's tent covers, by its height there; the outermost rows go on to the poles.
fn height_integral(row: u32, height: u32) -> f64 {
    let steps = 2000;
    (0..steps)
        .map(|step| {
            let down = (f64::from(step) + 0.5) / f64::from(steps);
            let at = (down * f64::from(height) - 0.5).clamp(0.0, f64::from(height - 1));
            (1.0 - (at - f64::from(row)).abs()).max(0.0) * (down * PI).sin() * PI / f64::from(steps)
        })
        .sum()
}

/// The light of all directions, from the first coefficient.
fn flux(images: &Pictures) -> f64 {
    texel(&images["coefficients"], 0, 0)[0] * (4.0 * PI).sqrt()
}

fn one_bright_texel() -> Result<(), Failed> {
    let (width, height) = (128u32, 64u32);
    let mut world = under(image(width, |_| 0.0), SkyShape::Equirectangular, NO_SCENE)?;
    let mut session = Shot::of(PARTS, [64, 32], &["coefficients"]).session(&mut world)?;
    let mut worst = 0.0f64;
    for index in 0..64u32 {
        // Columns and rows by turns. Next to the poles a texel is a wedge that is thinner than those of the cube.
        let (x, y) = (index * 37 % width, 3 + index * 57 / 63);
        let mut sky = image(width, |_| 0.0);
        sky.texels[(y * width + x) as usize] = [60_000.0, 0.0, 0.0, 1.0];
        world.resource_mut::<SkyImage>().image = Arc::new(sky);
        session.update(&mut world).map_err(shown)?;
        settle(&mut session)?;
        let images = [("coefficients".to_owned(), session.read_output("coefficients").map_err(shown)?)].into_iter().collect();
        let expected = 60_000.0 * 2.0 * PI / f64::from(width) * height_integral(y, height);
        let error = (flux(&images) / expected - 1.0).abs();
        worst = worst.max(error);
        if error > 0.01 {
            return Err(format!("the light of texel {x}, {y} is off by {error}").into());
        }
    }
    println!("worst {worst:.5} of its light");
    Ok(())
}

/// A cube of directions, and the same as an equirectangular image.
fn six_faces() -> Result<(), Failed> {
    let of = |d: DVec3| (0.5 + 0.3 * d.x + 0.15 * d.y - 0.2 * d.z + 0.1 * d.x * d.z) as f32;
    let edge = 64u32;
    // As WebGPU has faces: right, down and outwards of each.
    let frames = [
        (DVec3::NEG_Z, DVec3::NEG_Y, DVec3::X),
        (DVec3::Z, DVec3::NEG_Y, DVec3::NEG_X),
        (DVec3::X, DVec3::Z, DVec3::Y),
        (DVec3::X, DVec3::NEG_Z, DVec3::NEG_Y),
        (DVec3::X, DVec3::NEG_Y, DVec3::Z),
        (DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z),
    ];
    let faces = LinearImage {
        width: 2 * edge,
        height: 3 * edge,
        texels: (0..3 * edge)
            .flat_map(|y| (0..2 * edge).map(move |x| (x, y)))
            .map(|(x, y)| {
                let (right, down, out) = frames[(2 * (y / edge) + x / edge) as usize];
                let place = |at: u32| (f64::from(at % edge) + 0.5) * 2.0 / f64::from(edge) - 1.0;
                let value = of((out + right * place(x) + down * place(y)).normalize());
                [value, 0.5 * value, 2.0 * value, 1.0]
            })
            .collect(),
    };
    let shot = parts(&["radiance", "irradiance_sh"]);
    let one = shot.take_world(&mut under(image(512, of), SkyShape::Equirectangular, NO_SCENE)?)?;
    let six = shot.take_world(&mut under(faces, SkyShape::Faces, NO_SCENE)?)?;
    for (name, image) in &one {
        // Measured: 0.0006 of the radiance, by the bends of bilinear filters.
        places(image)
            .try_for_each(|(x, y)| near(&format!("{name} at {x}, {y}"), texel(&six[name], x, y)[0], texel(image, x, y)[0], 0.003))?;
    }
    Ok(())
}

const ROUGHNESSES: [f64; 4] = [0.1, 0.35, 0.65, 1.0];
const METALLICS: [f64; 4] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];

/// Spheres in rows of one metallic and columns of one roughness, with the same light from everywhere.
fn spheres(base_color: [f64; 3]) -> (Eye, String) {
    let eye = Eye::new([0.0, 0.0, 12.0], [0.0, 0.0, 0.0], 22.0);
    let [r, g, b] = base_color;
    let mut objects = String::new();
    for (row, metallic) in METALLICS.iter().enumerate() {
        for (column, roughness) in ROUGHNESSES.iter().enumerate() {
            let (x, y) = (column as f64 * 1.1 - 1.65, row as f64 * 1.1 - 1.65);
            objects += &format!(
                "\"s{row}{column}\": (shape: Sphere(radius: 0.5, sectors: 64, stacks: 32), translation: ({x}, {y}, 0),
                 surface: (base_color: ({r}, {g}, {b}), metallic: {metallic}, roughness: {roughness})),"
            );
        }
    }
    let ron = eye.ron();
    (eye, format!("({ron} environment: (sky_radiance: (1, 1, 1)), objects: {{ {objects} }})"))
}

/// A pixel of a sphere: which row and column of spheres, the cosine to the eye, and its light.
type Pixel = (usize, usize, f64, [f64; 3]);

/// Every pixel of the spheres.
fn of_spheres(eye: &Eye, images: &Pictures) -> Vec<Pixel> {
    let mut found = Vec::new();
    for (x, y) in places(&images["normal"]) {
        let [nx, ny, nz, there] = texel(&images["normal"], x, y);
        if there != 1.0 {
            continue;
        }
        let ray = eye.ray(&images["normal"], x, y).normalize();
        let at = eye.position - ray * (eye.position.z / ray.z);
        let place = |along: f64| ((along + 1.65) / 1.1).round().clamp(0.0, 3.0) as usize;
        let [r, g, b, _] = texel(&images["indirect"], x, y);
        found.push((place(at.y), place(at.x), -ray.dot(DVec3::new(nx, ny, nz)), [r, g, b]));
    }
    found
}

fn furnace(base_color: [f64; 3]) -> Result<Vec<Pixel>, Failed> {
    let (eye, scene) = spheres(base_color);
    let shot = Shot::of(IBL, [192, 192], &["indirect", "normal"]).set("environment_texels", 16).set("occlusion", "none");
    Ok(of_spheres(&eye, &shot.take(&scene)?))
}

fn white_furnace() -> Result<(), Failed> {
    let mut means = [[(0.0, 0u32); 4]; 4];
    for (row, column, cosine, light) in furnace([1.0; 3])? {
        let mean = &mut means[row][column];
        *mean = (mean.0 + light[0], mean.1 + 1);
        if cosine > 0.2 && (light[0] - 1.0).abs() > 0.005 {
            return Err(format!("{light:?} at roughness {}, metallic {}, n.v {cosine}", ROUGHNESSES[column], METALLICS[row]).into());
        }
    }
    let worst = means.iter().flatten().map(|(sum, count)| (sum / f64::from(*count) - 1.0).abs()).fold(0.0, f64::max);
    let seen = means.iter().flatten().all(|(_, count)| *count > 200);
    println!("worst mean of a sphere is off by {worst:.5}");
    if worst < 0.002 && seen { Ok(()) } else { Err(format!("a mean is off by {worst}, all spheres seen: {seen}").into()) }
}

/// What a lobe reflects, single and with what bounces (Turquin 2019, eq. 16), from A and B of the table; then both lobes mixed, and the
/// diffuse part with what the dielectric's leaves.
fn closed_form() -> Result<(), Failed> {
    let table = Shot::of(PARTS, [64, 32], &["table"]).set("texels", 16).one(NO_SCENE)?;
    // Rows stand at (j + 1/2) / 32 of the roughness, from the bottom.
    let factors = |cosine: f64, roughness: f64| {
        let (x, y) = ((cosine * 32.0 - 0.5).clamp(0.0, 31.0), (31.0 - (roughness * 32.0 - 0.5)).clamp(0.0, 31.0));
        let at = |x: f64, y: f64| texel(&table, x as u32, y as u32);
        let (left, top) = (x.floor().min(30.0), y.floor().min(30.0));
        let (fx, fy) = (x - left, y - top);
        [0, 1].map(|c| {
            (at(left, top)[c] * (1.0 - fx) + at(left + 1.0, top)[c] * fx) * (1.0 - fy)
                + (at(left, top + 1.0)[c] * (1.0 - fx) + at(left + 1.0, top + 1.0)[c] * fx) * fy
        })
    };
    let mut worst = 0.0f64;
    for base_color in [[0.5; 3], [0.9, 0.55, 0.2]] {
        for (row, column, cosine, light) in furnace(base_color)? {
            // Near the edge and where the lobe is narrow the table of 32 texels that is read here is too coarse.
            if cosine < 0.3 || column == 0 {
                continue;
            }
            let [a, b] = factors(cosine, ROUGHNESSES[column]);
            let lobe = |f0: f64| (f0 * a + b) * (1.0 + f0 * (1.0 / (a + b) - 1.0));
            for channel in 0..3 {
                let base = base_color[channel];
                let dielectric = lobe(0.04);
                let expected = METALLICS[row] * lobe(base) + (1.0 - METALLICS[row]) * (dielectric + base * (1.0 - dielectric));
                worst = worst.max((light[channel] - expected).abs());
                if (light[channel] - expected).abs() > 0.006 {
                    let what = format!("roughness {}, metallic {}, n.v {cosine}", ROUGHNESSES[column], METALLICS[row]);
                    return Err(format!("{} and not {expected} at {what}", light[channel]).into());
                }
            }
        }
    }
    println!("worst error {worst:.5}");
    Ok(())
}

fn changes() -> Result<(), Failed> {
    let eye = Eye::new([0.0, 0.0, 3.0], [0.0, 0.0, 0.0], 40.0);
    let scene = |eye: &Eye| format!("({} objects: {{ \"ball\": (shape: Sphere(radius: 0.5), surface: (roughness: 0.4)) }})", eye.ron());
    let sky = image(64, |direction| 1.0 + direction.y as f32);
    let mut world = under(sky.clone(), SkyShape::Equirectangular, &scene(&eye))?;
    let shot = Shot::of(IBL, [32, 32], &["color"]).set("environment_texels", 16);
    let mut session = shot.session(&mut world)?;
    let first = settle(&mut session)?.concat();
    let parts = ["environment.", "irradiance.", "prefilter.", "brdf_lut.", "ibl_resolve."];
    let of = |ran: &[String]| parts.map(|part| ran.iter().any(|pass| pass.starts_with(part)));
    if of(&first) != [true; 5] {
        return Err(format!("at first {first:?}").into());
    }
    world.resource_mut::<SkyImage>().rotation = 1.0;
    session.update(&mut world).map_err(shown)?;
    let turned = settle(&mut session)?.concat();
    world.resource_mut::<SkyImage>().strength = 2.0;
    session.update(&mut world).map_err(shown)?;
    let brighter = settle(&mut session)?.concat();
    let mut other = sky;
    other.texels.iter_mut().for_each(|texel| texel[0] *= 0.5);
    world.resource_mut::<SkyImage>().image = Arc::new(other);
    session.update(&mut world).map_err(shown)?;
    let changed = settle(&mut session)?.concat();
    let sky = world.remove_resource::<SkyImage>().ok_or("no sky")?;
    let mut moved = under((*sky.image).clone(), sky.shape, &scene(&Eye::new([0.2, 0.1, 3.0], [0.0, 0.0, 0.0], 40.0)))?;
    moved.insert_resource(sky);
    session.update(&mut moved).map_err(shown)?;
    let looked = settle(&mut session)?.concat();
    let resolve = [false, false, false, false, true];
    for (what, ran, expected) in [
        ("a turn", &turned, resolve),
        ("another strength", &brighter, resolve),
        ("another image", &changed, [true, true, true, false, true]),
        ("another camera", &looked, resolve),
    ] {
        let extra = what.starts_with("another image") && ran.iter().any(|pass| pass.starts_with("gbuffer") || pass.contains("shadows"));
        if of(ran) != expected || extra {
            return Err(format!("{what} ran {ran:?}").into());
        }
    }
    // Nothing else was in the way of the pictures: they are those of a session that starts there.
    let kept = session.read_output("color").map_err(shown)?;
    let fresh = shot.take_world(&mut moved)?;
    if kept == fresh["color"] { Ok(()) } else { Err("the picture is not that of a new session".into()) }
}
