//! The image of the sky: six faces in their order, and what is no light.

use image::{DynamicImage, ImageFormat, Rgb, Rgb32FImage, RgbImage};
use tempfile::TempDir;

use super::*;
use crate::world::{SkyImage, SkyShape};

const FACES: [&str; 6] = ["px", "nx", "py", "ny", "pz", "nz"];

fn load(folder: &TempDir, environment: &str) -> Result<super::super::LoadedScene, Vec<Diagnostic>> {
    let path = folder.path().join("scene.ron");
    std::fs::write(&path, format!("(environment: ({environment}))")).unwrap();
    load_scene(&path, None, &mut SourceMap::default())
}

fn refused(folder: &TempDir, environment: &str) -> Vec<(&'static str, String)> {
    let problems = load(folder, environment).err().unwrap_or_default();
    assert!(problems.iter().all(|problem| problem.hint.is_some()));
    problems.into_iter().map(|problem| (problem.code, problem.message)).collect()
}

fn faces(extension: &str) -> String {
    format!("faces: [{}]", FACES.map(|face| format!("\"{face}.{extension}\"")).join(", "))
}

#[test]
fn texels_that_are_no_light_are_mended_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut sky = Rgb32FImage::from_pixel(4, 2, Rgb([1.0, 1.0, 1.0]));
    sky.put_pixel(0, 0, Rgb([f32::NAN, 2.0, 3.0]));
    sky.put_pixel(1, 0, Rgb([-2.0, 1.0, 1.0]));
    sky.put_pixel(2, 1, Rgb([1.0, f32::INFINITY, f32::NEG_INFINITY]));
    sky.put_pixel(3, 1, Rgb([40_000.0, 100_000.0, 0.0]));
    DynamicImage::ImageRgb32F(sky).save_with_format(folder.path().join("sky.exr"), ImageFormat::OpenExr).unwrap();
    let loaded = load(&folder, "image: \"sky.exr\"").unwrap_or_else(|problems| panic!("{problems:?}"));
    let told: Vec<_> = loaded.warnings.iter().map(|warning| (warning.code, warning.message.as_str())).collect();
    // Of 140,025 by size 2 were negative.
    let expected = "3 texels of `sky.exr` were no light: negative, infinite or no number; 0.001 % of the image's numbers by size were negative; \
                    1 numbers were infinite, whose light is lost";
    assert_eq!(told, [("scene::sky-texels", expected)]);
    let image = &loaded.world.resource::<SkyImage>().image;
    assert_eq!(image.texels[0], [0.0, 2.0, 3.0, 1.0]);
    assert_eq!(image.texels[1], [0.0, 1.0, 1.0, 1.0]);
    assert_eq!(image.texels[6], [1.0, 100_000.0, 0.0, 1.0]);
    assert_eq!(image.texels[7], [40_000.0, 100_000.0, 0.0, 1.0]);
}

#[test]
fn six_files_are_faces_in_their_order() {
    let folder = tempfile::tempdir().unwrap();
    for (index, face) in FACES.iter().enumerate() {
        RgbImage::from_pixel(4, 4, Rgb([index as u8 * 51, 0, 255])).save(folder.path().join(format!("{face}.png"))).unwrap();
    }
    let loaded = load(&folder, &faces("png")).unwrap_or_else(|problems| panic!("{problems:?}"));
    let sky = loaded.world.resource::<SkyImage>();
    assert_eq!((sky.shape, sky.image.width, sky.image.height), (SkyShape::Faces, 8, 12));
    for (index, code) in [0.0f32, 0.2, 0.4, 0.6, 0.8, 1.0].into_iter().enumerate() {
        let [red, green, blue, _] = sky.image.texels[(index / 2 * 4 + 1) * 8 + index % 2 * 4 + 2];
        let linear = if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) };
        assert!((red - linear).abs() < 1e-6 && green == 0.0 && blue == 1.0, "{index}: {red} {green} {blue}");
    }
}

#[test]
fn faces_that_fit_no_cube_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (face, size) in FACES.iter().zip([[4, 4], [4, 4], [8, 8], [4, 4], [4, 3], [4, 4]]) {
        RgbImage::new(size[0], size[1]).save(folder.path().join(format!("{face}.png"))).unwrap();
    }
    assert_eq!(
        refused(&folder, &faces("png")),
        [("scene::sky-faces", "`py.png` has 8 x 8 texels".to_owned()), ("scene::sky-faces", "`pz.png` has 4 x 3 texels".to_owned())]
    );
    // All that are missing at once.
    assert_eq!(refused(&folder, &faces("exr")).len(), 6);
    let five = "faces: [\"px.png\", \"nx.png\", \"py.png\", \"ny.png\", \"nz.png\"]";
    assert_eq!(refused(&folder, five), [("scene::sky-faces", "the environment has 5 `faces`, and a cube has six".to_owned())]);
    let both = format!("image: \"px.png\", {}", faces("png"));
    assert_eq!(refused(&folder, &both), [("scene::two-skies", "the environment has `image` and `faces`".to_owned())]);
}
