//! Small golden pictures of the shipped pipelines: whatever changes how things look must change a picture here, too.
//!
//! A picture may differ a little between drivers, so that means of differences count, not bytes. `LUMINAIRE_ACCEPT=1` takes what is
//! rendered as the new reference; look at it before it is committed. A picture that fails is kept beside its reference as
//! `NAME.actual.png`.

#![allow(clippy::print_stdout, clippy::panic, clippy::expect_used, reason = "a test says what it measured, and may panic")]

#[path = "support/mod.rs"]
mod support;

use std::path::{Path, PathBuf};

use libtest_mimic::{Arguments, Failed, Trial};
use luminaire::image_file::{LinearImage, srgb_encode, write_image};
use support::picture::{ALBEDO, PBR, Shot};

/// Name, pipeline, scene, parameters.
type Golden = (&'static str, &'static str, &'static str, &'static [(&'static str, &'static str)]);

const GOLDEN: &[Golden] = &[
    ("albedo_still_life", ALBEDO, "still_life", &[]),
    ("pbr_still_life", PBR, "still_life", &[]),
    ("pbr_still_life_neutral", PBR, "still_life", &[("tone_mapping", "neutral"), ("exposure", "0.5")]),
    ("pbr_night_room", PBR, "night_room", &[]),
    ("sky_low_sun", "pipelines/sky.ron", "low_sun", &[]),
    ("pbr_night_room_aces", PBR, "night_room", &[("tone_mapping", "aces"), ("shadowed_point_lights", "1")]),
];

/// Mean absolute difference of 8-bit values, in steps. On the same driver it is 0; edges that fall to other pixels make 0.1.
const MEAN_STEPS: f64 = 0.3;
/// How many of a picture's pixels may be off by more than `FAR_STEPS` steps in some channel. A highlight or a shadow that is lost
/// hardly moves the mean.
const FAR_SHARE: f64 = 0.005;
const FAR_STEPS: u8 = 12;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")
}

fn bytes(image: &LinearImage) -> Vec<[u8; 3]> {
    let encode = |value: f32| (srgb_encode(value.max(0.0)) * 255.0).round() as u8;
    image.texels.iter().map(|texel| [0, 1, 2].map(|channel| encode(texel[channel]))).collect()
}

fn agrees(golden: &Golden) -> Result<(), Failed> {
    let (name, pipeline, scene, sets) = golden;
    let scene = std::fs::read_to_string(folder().join(format!("fixtures/gpu/{scene}.ron")))?;
    let shot = sets.iter().fold(Shot::of(pipeline, [128, 72], &["color"]), |shot, (name, value)| shot.set(name, value));
    let image = shot.one(&scene)?;

    let reference = folder().join(format!("images/{name}.png"));
    let actual = reference.with_extension("actual.png");
    if std::env::var_os("LUMINAIRE_ACCEPT").is_some_and(|value| value == "1") {
        return write_image(&reference, &image).map_err(|problem| problem.message.into());
    }
    let failed = |why: String| -> Failed {
        match write_image(&actual, &image) {
            Ok(()) => format!("{why}; compare {}", actual.display()).into(),
            Err(problem) => format!("{why}; {}", problem.message).into(),
        }
    };
    if !reference.is_file() {
        return Err(failed(format!("there is no {}; LUMINAIRE_ACCEPT=1 makes it", reference.display())));
    }
    let expected = image::open(&reference)?.into_rgb8();
    if (expected.width(), expected.height()) != (image.width, image.height) {
        return Err(failed(format!("{} has another size", reference.display())));
    }
    let pairs = || expected.pixels().map(|pixel| pixel.0).zip(bytes(&image));
    let off = |(a, b): ([u8; 3], [u8; 3])| [0, 1, 2].map(|channel| a[channel].abs_diff(b[channel]));
    let count = f64::from(image.width * image.height);
    let mean = pairs().flat_map(off).map(f64::from).sum::<f64>() / (3.0 * count);
    let far = pairs().filter(|pair| off(*pair).iter().any(|steps| *steps > FAR_STEPS)).count() as f64 / count;
    println!("{name}: mean {mean:.4} steps, {far:.5} far off");
    if mean > MEAN_STEPS || far > FAR_SHARE {
        return Err(failed(format!("{name} differs from its reference by {mean:.3} steps, {:.2} % of it far", far * 100.0)));
    }
    // A picture of an earlier failure would mislead.
    match std::fs::remove_file(&actual) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error.into()),
        _ => Ok(()),
    }
}

fn main() {
    let arguments = Arguments::from_args();
    let missing = if support::picture::adapter().is_some() { None } else { Some("a Vulkan adapter") };
    let trials: Vec<Trial> = GOLDEN.iter().map(|golden| support::trial(golden.0, missing, || agrees(golden))).collect();
    libtest_mimic::run(&arguments, trials).exit();
}
