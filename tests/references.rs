//! Direct light against path-traced references: rendered at four times the size and box-filtered, since a reference's pixel is the
//! mean over its area.

#![allow(clippy::print_stdout, reason = "the figures are worth seeing")]

#[path = "support/mod.rs"]
mod support;

use libtest_mimic::{Arguments, Failed, Trial};
use luminaire::image_file::LinearImage;
use luminaire::passes::Adapter;
use luminaire::session::{RenderRequest, Session, load_scene};
use support::{box_filter, compare, read_exr, shared, trial};

const FACTOR: u32 = 4;

struct Case {
    scene: &'static str,
    reference: &'static str,
    /// Seconds that the scene's first animation has played; without it everything stands at rest.
    time: Option<f64>,
    /// The largest relMSE that passes.
    rel_mse: f64,
}

/// What edges of shadows and silhouettes leave at four times the size.
const REL_MSE: f64 = 0.002;
/// In the sealed room a silhouette runs along a column of pixels beside black, where a quarter of a pixel costs most: measured 0.0026.
const REL_MSE_SEALED: f64 = 0.003;

const CASES: &[Case] = &[
    Case { scene: "cornell/cornell_point.gltf", reference: "cornell/cornell_point.direct.exr", time: None, rel_mse: REL_MSE },
    Case {
        scene: "cornell/cornell_point_gltfbrdf.gltf",
        reference: "cornell/cornell_point.direct_gltfbrdf.exr",
        time: None,
        rel_mse: REL_MSE,
    },
    Case { scene: "dynamic/dynamic.gltf", reference: "dynamic/dynamic_a.direct.exr", time: Some(0.0), rel_mse: REL_MSE },
    Case { scene: "dynamic/dynamic.gltf", reference: "dynamic/dynamic_b.direct.exr", time: Some(1.0), rel_mse: REL_MSE },
    Case { scene: "leak/leak_door.gltf", reference: "leak/leak_door.direct.exr", time: None, rel_mse: REL_MSE },
    Case { scene: "leak/leak_sealed.gltf", reference: "leak/leak_sealed.direct.exr", time: None, rel_mse: REL_MSE_SEALED },
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
    let request = RenderRequest {
        pipeline: "pipelines/pbr.ron",
        size: [reference.width * FACTOR, reference.height * FACTOR],
        camera: None,
        sets: &[],
        outputs: Some(&outputs),
        timing: false,
        memory_budget: None,
    };
    let shown = |(problems, sources): luminaire::session::Problems| luminaire::graph::diagnostic::render(&problems, &sources, false);
    let mut session = Session::new(&mut loaded.world, &request).map_err(shown)?;
    session.render_frame().map_err(shown)?;
    let image = session.read_output("radiance").map_err(shown)?;
    Ok((reference, box_filter(&image, FACTOR)))
}

fn agrees(case: &Case) -> Result<(), Failed> {
    let (reference, image) = render(case)?;
    let difference = compare(&reference, &image);
    println!("{}: {difference:?}", case.reference);
    if difference.rel_mse > case.rel_mse || difference.rel_mse_trim1 > 0.0003 || (difference.lum_ratio - 1.0).abs() > 0.005 {
        return Err(format!("{}: {difference:?}", case.reference).into());
    }
    Ok(())
}

/// A wall two centimetres thick lets nothing through: not little, nothing.
fn sealed_room_is_black() -> Result<(), Failed> {
    let (_, image) = render(&CASES[5])?;
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
    let mut trials: Vec<Trial> = CASES.iter().map(|case| trial(case.reference, missing, || agrees(case))).collect();
    trials.push(trial("leak_sealed is black behind the wall", missing, sealed_room_is_black));
    libtest_mimic::run(&arguments, trials).exit();
}
