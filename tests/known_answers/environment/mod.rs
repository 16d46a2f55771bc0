//! What surrounds a scene: its cube, diffuse light and means over lobes against closed forms, a white furnace, and what a change runs.

mod furnace;
mod light;
mod runs;

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use libtest_mimic::Failed;
use luminaire::scenes::World;
use luminaire::scenes::linear_image::LinearImage;
use luminaire::scenes::world::{SkyImage, SkyShape};

use crate::Case;
use crate::support::picture::world;

pub const CASES: &[Case] = &[
    ("environment::a constant sky stays what it is", light::constant),
    ("environment::diffuse light of a clamped cosine has its closed form", light::clamped_cosine),
    ("environment::one bright texel keeps its light wherever it is", light::one_bright_texel),
    ("environment::six faces show what one image shows", light::six_faces),
    ("environment::white surfaces in white light are white", furnace::white),
    ("environment::each lobe and their mixtures have their closed forms", furnace::closed_forms),
    ("environment::a change runs what it reaches", runs::changes),
    ("environment::a day runs the sky and what it lights", runs::day),
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
