//! Pictures against path-traced references, whose pixels are means over their area: direct light here, that of the sky in `image_based`
//! and `environment_maps`.

#![allow(clippy::print_stdout, reason = "the figures are worth seeing")]

mod environment_maps;
mod image_based;
#[path = "../support/mod.rs"]
mod support;

use libtest_mimic::{Arguments, Failed, Trial};
use luminaire::image_file::LinearImage;
use luminaire::passes::Adapter;
use luminaire::session::{RenderRequest, Session, load_scene};
use support::{compare, read_exr, shared, trial};

/// Texels along an edge of a face of a shadow cube.
const FACE: &str = "2048";

struct Case {
    scene: &'static str,
    reference: &'static str,
    /// Seconds that the scene's first animation has played; without it everything stands at rest.
    time: Option<f64>,
    /// How rectangles light surfaces.
    area_lights: &'static str,
    /// In each pixel.
    samples: &'static str,
    /// The largest relMSE that passes.
    rel_mse: f64,
    /// The same without the worst hundredth of the pixels.
    trimmed: f64,
    /// How far the mean luminance may be from 1.
    luminance: f64,
}

const PLAIN: Case = Case {
    scene: "",
    reference: "",
    time: None,
    area_lights: "ltc",
    samples: "64",
    rel_mse: REL_MSE,
    trimmed: REL_MSE_TRIMMED,
    luminance: LUMINANCE,
};

/// Measured: 0.000013 to 0.000018.
const REL_MSE: f64 = 0.0001;
/// What the edges of shadows on curved meshes leave: measured 0.0010.
const REL_MSE_CURVED: f64 = 0.0015;
/// In the rooms a silhouette runs along a column of pixels beside black, where a part of a pixel costs most: measured 0.0004 and 0.0011.
const REL_MSE_BESIDE_BLACK: f64 = 0.0015;
/// What transformed cosines leave of the lobe, most of it where metal of roughness 0.5 is seen at 15 degrees: measured 0.0034.
const REL_MSE_COSINES: f64 = 0.004;
/// What is left by 128 points of a rectangle: measured 0.00015 and 0.00026, and 0.00003 and 0.00005 with 256.
const REL_MSE_POINTS: f64 = 0.0005;
/// Without the worst hundredth of the pixels: measured up to 0.0000059.
const REL_MSE_TRIMMED: f64 = 0.00002;
/// The soft shadow of a rectangle from what its middle sees: measured 0.0063 (0.0001 without the worst hundredth), nearly all of it at the
/// foot of a box where the truth is black.
const REL_MSE_SOFT: f64 = 0.01;
/// How far the mean luminance may be from 1: measured 0.9993 to 0.9998, since lavapipe rounds half floats towards zero.
const LUMINANCE: f64 = 0.001;
/// The same with rectangles in shadow: measured 1.0010 and 1.0012.
const LUMINANCE_RECTANGLES: f64 = 0.0015;

const SEALED: &str = "leak/leak_sealed.direct.exr";

const CASES: &[Case] = &[
    Case { scene: "cornell/cornell_point.gltf", reference: "cornell/cornell_point.direct.exr", ..PLAIN },
    Case { scene: "cornell/cornell_point_gltfbrdf.gltf", reference: "cornell/cornell_point.direct_gltfbrdf.exr", ..PLAIN },
    Case { scene: "dynamic/dynamic.gltf", reference: "dynamic/dynamic_a.direct.exr", time: Some(0.0), ..PLAIN },
    Case { scene: "dynamic/dynamic.gltf", reference: "dynamic/dynamic_b.direct.exr", time: Some(1.0), ..PLAIN },
    Case { scene: "leak/leak_door.gltf", reference: "leak/leak_door.direct.exr", rel_mse: REL_MSE_BESIDE_BLACK, ..PLAIN },
    Case {
        scene: "area/area_gloss.gltf",
        reference: "area/area_gloss.direct.exr",
        rel_mse: REL_MSE_COSINES,
        trimmed: REL_MSE_COSINES,
        ..PLAIN
    },
    Case {
        scene: "area/area_gloss.gltf",
        reference: "area/area_gloss.direct.exr",
        area_lights: "sampled",
        samples: "128",
        rel_mse: REL_MSE_POINTS,
        trimmed: REL_MSE_POINTS,
        ..PLAIN
    },
    Case {
        scene: "cornell/cornell_area.gltf",
        reference: "cornell/cornell_area.direct.exr",
        rel_mse: REL_MSE_SOFT,
        trimmed: 0.1 * REL_MSE_SOFT,
        luminance: LUMINANCE_RECTANGLES,
        ..PLAIN
    },
    Case {
        scene: "cornell/cornell_area.gltf",
        reference: "cornell/cornell_area.direct.exr",
        area_lights: "sampled",
        samples: "128",
        rel_mse: REL_MSE_POINTS,
        trimmed: REL_MSE_POINTS,
        luminance: LUMINANCE_RECTANGLES,
        ..PLAIN
    },
    Case { scene: "leak/leak_sealed.gltf", reference: SEALED, rel_mse: REL_MSE_BESIDE_BLACK, ..PLAIN },
    Case {
        scene: "../assets/seed_scenes_free/scene1.gltf",
        reference: "seed_scene1/seed_scene1_free.direct.exr",
        rel_mse: REL_MSE_CURVED,
        ..PLAIN
    },
];

fn render(case: &Case) -> Result<(LinearImage, LinearImage), Failed> {
    let folder = shared().ok_or("the reference data is missing")?.join("references");
    let reference = read_exr(&folder.join(case.reference));
    let scene = folder.join(case.scene);
    let mut loaded = load_scene(&scene.display().to_string(), None).map_err(|(problems, _)| format!("{problems:?}"))?;
    if let Some(seconds) = case.time {
        luminaire::scenes::world::set_time(&mut loaded.world, seconds).map_err(|problems| format!("{problems:?}"))?;
    }
    let outputs = ["radiance".to_owned()];
    let sets = [("samples", case.samples), ("local_shadow_texels", FACE), ("area_lights", case.area_lights)];
    let sets = sets.map(|(name, value)| (name.to_owned(), value.to_owned()));
    let request = RenderRequest {
        pipeline: "pipelines/pbr.ron",
        size: [reference.width, reference.height],
        camera: None,
        sets: &sets,
        outputs: Some(&outputs),
        timing: false,
        memory_budget: None,
    };
    let shown = |(problems, sources): luminaire::session::Problems| luminaire::graph::diagnostic::render(&problems, &sources, false);
    let mut session = Session::new(&mut loaded.world, &request).map_err(shown)?;
    while !session.render_frame().map_err(shown)?.settled {}
    Ok((reference, session.read_output("radiance").map_err(shown)?))
}

fn agrees(case: &Case) -> Result<(), Failed> {
    let (reference, image) = render(case)?;
    let difference = compare(&reference, &image);
    println!("{}: {difference:?}", case.reference);
    if case.reference == SEALED {
        is_black_behind_the_wall(&image)?;
    }
    if difference.rel_mse > case.rel_mse || difference.rel_mse_trim1 > case.trimmed || (difference.lum_ratio - 1.0).abs() > case.luminance {
        return Err(format!("{}: {difference:?}", case.reference).into());
    }
    Ok(())
}

/// A wall two centimetres thick lets nothing through: not little, nothing.
fn is_black_behind_the_wall(image: &LinearImage) -> Result<(), Failed> {
    let lit = (0..image.height).flat_map(|y| (257..image.width).map(move |x| (x, y))).filter(|(x, y)| {
        let texel = image.texels[(y * image.width + x) as usize];
        texel[..3].iter().any(|channel| *channel != 0.0)
    });
    let lit: Vec<_> = lit.take(10).collect();
    if lit.is_empty() { Ok(()) } else { Err(format!("light behind the wall at {lit:?}").into()) }
}

fn main() {
    let arguments = Arguments::from_args();
    let missing = match (Adapter::choose(None).is_ok(), shared().is_some()) {
        (false, _) => Some("a Vulkan adapter"),
        (true, false) => Some("the reference data"),
        (true, true) => None,
    };
    let mut trials: Vec<Trial> =
        CASES.iter().map(|case| trial(&format!("{}, {}", case.reference, case.area_lights), missing, || agrees(case))).collect();
    let by_the_sky = image_based::CASES.iter().chain(environment_maps::CASES);
    trials.extend(by_the_sky.map(|(name, run)| trial(name, missing, run)));
    libtest_mimic::run(&arguments, trials).exit();
}
