//! The image of the sky: one equirectangular file, or six files for the faces of a cube.
//!
//! Guarantees: what comes out is finite and not negative; what had to be mended is told, with the share of the light that went with it.
//! Accepted: pictures of 8 bits end at 1; `strength` makes daylight of them.

use std::path::Path;
use std::sync::Arc;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::syntax::document::Text;

use super::assets::{Place, locate};
use super::check::SkyUse;
use super::checks::Problems;
use crate::gltf::image::decode_picture;
use crate::linear_image::{LinearImage, decode_linear};
use crate::world::{SkyImage, SkyShape};

/// Bytes of a file.
const LARGEST_FILE: u64 = 1 << 30;
/// Columns and rows of faces in the image that is made of them.
const FACE_COLUMNS: u32 = 2;
const FACE_ROWS: u32 = 3;

/// Reads the image of the sky. `None` where that failed, which is among the problems then.
pub(super) fn load_sky(sky: &SkyUse, place: Option<Place<'_>>, problems: &mut Problems) -> Option<SkyImage> {
    let read: Vec<Option<LinearImage>> = sky.files.iter().map(|file| load_file(file, place, problems)).collect();
    let mut images: Vec<LinearImage> = read.into_iter().collect::<Option<_>>()?;
    let (image, shape) = match (images.len(), images.pop()) {
        (1, Some(image)) => {
            warn_of_shape(&sky.files[0], &image, problems);
            (image, SkyShape::Equirectangular)
        }
        (_, Some(last)) => {
            images.push(last);
            (join_faces(&sky.files, &images, problems)?, SkyShape::Faces)
        }
        (_, None) => return None,
    };
    Some(SkyImage { image: Arc::new(image), shape, rotation: sky.rotation, strength: sky.strength })
}

fn load_file(file: &Text, place: Option<Place<'_>>, problems: &mut Problems) -> Option<LinearImage> {
    let path = locate(file, place).map_err(|problem| problems.add(problem)).ok()?;
    let unreadable = |reason: String| {
        Diagnostic::error("scene::sky-image", format!("can't read the image of the sky `{}`: {reason}", file.value))
            .at(file.span, "this file")
            .hint("it must be a Radiance HDR, OpenEXR, PNG or JPEG file")
    };
    let mut image = read_image(&path).map_err(|reason| problems.add(unreadable(reason))).ok()?;
    mend(&mut image, file, problems);
    Some(image)
}

fn read_image(path: &Path) -> Result<LinearImage, String> {
    let bytes = std::fs::metadata(path).map_err(|error| error.to_string())?.len();
    if bytes > LARGEST_FILE {
        return Err(format!("it is larger than {} MiB", LARGEST_FILE >> 20));
    }
    let bytes = std::fs::read(path).map_err(|error| error.to_string())?;
    if !matches!(bytes[..], [0x89, b'P', b'N', b'G', ..] | [0xFF, 0xD8, 0xFF, ..]) {
        return decode_linear(&bytes);
    }
    let (width, height, rgba) = decode_picture(&bytes).map_err(|reason| format!("it {reason}"))?;
    let texels = rgba.chunks_exact(4).map(|texel| [linear(texel[0]), linear(texel[1]), linear(texel[2]), 1.0]).collect();
    Ok(LinearImage { width, height, texels })
}

/// IEC 61966-2-1.
fn linear(value: u8) -> f32 {
    let value = f32::from(value) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// What is negative or no number becomes 0, and what is infinite the brightest number of the file.
fn mend(image: &mut LinearImage, file: &Text, problems: &mut Problems) {
    let channels = |image: &LinearImage| image.texels.iter().flat_map(|texel| [texel[0], texel[1], texel[2]]).collect::<Vec<f32>>();
    let before = channels(image);
    let most = before.iter().copied().filter(|value| value.is_finite()).fold(0.0, f32::max);
    let mut mended = 0;
    for texel in &mut image.texels {
        let light = [texel[0], texel[1], texel[2]];
        // Not a clamp: what is no number becomes 0.
        let [r, g, b] = light.map(|value| if value > 0.0 { value.min(most) } else { 0.0 });
        mended += usize::from([r, g, b] != light);
        *texel = [r, g, b, 1.0];
    }
    if mended == 0 {
        return;
    }
    let finite = |values: &[f32]| values.iter().filter(|value| value.is_finite()).map(|value| f64::from(*value)).collect::<Vec<f64>>();
    let light: f64 = finite(&before).iter().map(|value| value.abs()).sum();
    let lost: f64 = finite(&before).iter().map(|value| (-value).max(0.0)).sum();
    let infinite = before.iter().filter(|value| value.is_infinite() && **value > 0.0).count();
    let mut message = format!("{mended} texels of `{}` were no light: negative, infinite or no number", file.value);
    if light > 0.0 {
        message += &format!("; {:.3} % of the image's numbers by size were negative", 100.0 * lost / light);
    }
    if infinite > 0 {
        message += &format!("; {infinite} numbers were infinite, whose light is lost");
    }
    problems.0.push(
        Diagnostic::warning("scene::sky-texels", message)
            .at(file.span, "they were brought to 0, and what was infinite to the brightest number of the file")
            .hint("save it again"),
    );
}

fn warn_of_shape(file: &Text, image: &LinearImage, problems: &mut Problems) {
    if image.width != 2 * image.height {
        let message =
            format!("`{}` has {} x {} texels: an equirectangular image is twice as wide as high", file.value, image.width, image.height);
        problems.0.push(Diagnostic::warning("scene::sky-shape", message).at(file.span, "it is stretched over the sky"));
    }
}

/// One image of six faces.
fn join_faces(files: &[Text], faces: &[LinearImage], problems: &mut Problems) -> Option<LinearImage> {
    let edge = faces.first()?.width;
    let odd: Vec<_> = files.iter().zip(faces).filter(|(_, face)| (face.width, face.height) != (edge, edge)).collect();
    for (file, face) in &odd {
        let message = format!("`{}` has {} x {} texels", file.value, face.width, face.height);
        problems.add(
            Diagnostic::error("scene::sky-faces", message)
                .at(file.span, "this face")
                .hint(format!("all six faces must be squares of one size; the first one is {edge} texels wide")),
        );
    }
    if !odd.is_empty() {
        return None;
    }
    let (width, height) = (edge * FACE_COLUMNS, edge * FACE_ROWS);
    let mut texels = Vec::with_capacity(width as usize * height as usize);
    for row in faces.chunks(FACE_COLUMNS as usize) {
        for y in 0..edge as usize {
            let line = y * edge as usize..(y + 1) * edge as usize;
            row.iter().for_each(|face| texels.extend_from_slice(&face.texels[line.clone()]));
        }
    }
    Some(LinearImage { width, height, texels })
}
