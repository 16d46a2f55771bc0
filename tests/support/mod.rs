//! Shared by the tests: reference data, image metrics, and tests that say 'ignored' where something is missing.

#![allow(
    dead_code,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::needless_pass_by_value,
    reason = "each test file uses a part of it; broken reference data should stop the test"
)]

pub mod gltf;
pub mod picture;
pub mod program;

use std::path::{Path, PathBuf};

use libtest_mimic::{Failed, Trial};
use luminaire::image_file::LinearImage;

/// Whether a missing adapter or missing reference data is a failure.
pub fn in_ci() -> bool {
    std::env::var_os("CI").is_some()
}

/// The folder with reference scenes and images: `LUMINAIRE_SHARED`, or `shared` beside the repository.
pub fn shared() -> Option<PathBuf> {
    let folder = match std::env::var_os("LUMINAIRE_SHARED") {
        Some(folder) => PathBuf::from(folder),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
    };
    folder.is_dir().then_some(folder)
}

/// A test that says 'ignored' where something that it needs is missing, and fails in CI.
pub fn trial(name: &str, missing: Option<&str>, run: impl FnOnce() -> Result<(), Failed> + Send + 'static) -> Trial {
    match missing {
        None => Trial::test(name, run),
        Some(what) if in_ci() => {
            let message = format!("{what} is missing, and CI must have it");
            Trial::test(name, move || Err(message.into()))
        }
        Some(what) => Trial::test(format!("{name} ({what} is missing)"), || Ok(())).with_ignored_flag(true),
    }
}

/// Reads a linear EXR.
pub fn read_exr(path: &Path) -> LinearImage {
    let image = image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).into_rgb32f();
    let texels = image.pixels().map(|pixel| [pixel[0], pixel[1], pixel[2], 1.0]).collect();
    LinearImage { width: image.width(), height: image.height(), texels, components: 3 }
}

/// How far an image is from a reference; the definitions of relMSE with an epsilon of 0.01 times the squared mean.
#[derive(Debug, Clone, Copy)]
pub struct Difference {
    /// Mean of (t - r)^2 / (r^2 + epsilon) over texels and channels.
    pub rel_mse: f64,
    /// The same without the worst 1% of the texels, which edges rule.
    pub rel_mse_trim1: f64,
    /// Mean luminance of the image over that of the reference.
    pub lum_ratio: f64,
}

/// Compares an image with a reference of the same size.
pub fn compare(reference: &LinearImage, test: &LinearImage) -> Difference {
    assert_eq!((reference.width, reference.height), (test.width, test.height));
    let count = reference.texels.len() as f64;
    let rgb = |image: &LinearImage| {
        image.texels.iter().map(|texel| [f64::from(texel[0]), f64::from(texel[1]), f64::from(texel[2])]).collect::<Vec<_>>()
    };
    let (reference, test) = (rgb(reference), rgb(test));
    let mean = reference.iter().flatten().sum::<f64>() / (3.0 * count);
    let epsilon = 0.01 * mean * mean;
    let mut errors: Vec<f64> = reference
        .iter()
        .zip(&test)
        .map(|(r, t)| (0..3).map(|channel| (t[channel] - r[channel]).powi(2) / (r[channel].powi(2) + epsilon)).sum::<f64>() / 3.0)
        .collect();
    let rel_mse = errors.iter().sum::<f64>() / count;
    errors.sort_by(f64::total_cmp);
    let kept = ((count * 0.99).ceil() as usize).max(1);
    let rel_mse_trim1 = errors[..kept].iter().sum::<f64>() / kept as f64;
    let luminance = |image: &[[f64; 3]]| image.iter().map(|texel| 0.2126 * texel[0] + 0.7152 * texel[1] + 0.0722 * texel[2]).sum::<f64>();
    Difference { rel_mse, rel_mse_trim1, lum_ratio: luminance(&test) / luminance(&reference) }
}
