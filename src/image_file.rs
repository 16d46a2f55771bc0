//! Rendered images as files: `.png` for what is shown, `.exr` for what was computed.
//!
//! A file appears whole or not at all: it is written beside its place under another name, and moved there at the end.

use std::io::Write;
use std::path::Path;

use image::codecs::openexr::OpenExrEncoder;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use luminaire_graph::diagnostic::Diagnostic;

/// A linear image: RGBA, row 0 on top.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearImage {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` texels, scene-linear Rec.709 for colours.
    pub texels: Vec<[f32; 4]>,
    /// 1 for data such as depth, 3 or 4 for colours and normals.
    pub components: u32,
}

/// The file formats of rendered images.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageFormat {
    /// 8 bits per channel, sRGB.
    Png,
    /// 32-bit floats, linear.
    Exr,
}

impl ImageFormat {
    /// The format that a path's extension names.
    pub fn of_path(path: &Path) -> Result<ImageFormat, Diagnostic> {
        let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
        match extension.as_deref() {
            Some("png") => Ok(ImageFormat::Png),
            Some("exr") => Ok(ImageFormat::Exr),
            _ => Err(Diagnostic::error("output::format", format!("can't tell the format of `{}`", path.display()))
                .hint("end the path in .png (what is shown) or .exr (linear values)")),
        }
    }
}

/// The sRGB transfer function (IEC 61966-2-1), for values from 0 to 1.
pub fn srgb_encode(linear: f32) -> f32 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Writes an image; the extension decides the format. Values that are not numbers become black in a PNG and stay in an EXR.
pub fn write_image(path: &Path, picture: &LinearImage) -> Result<(), Diagnostic> {
    let mut bytes = Vec::new();
    let (width, height) = (picture.width, picture.height);
    let encoded = match ImageFormat::of_path(path)? {
        ImageFormat::Png => {
            let spread = |texel: &[f32; 4]| if picture.components == 1 { [texel[0]; 3] } else { [texel[0], texel[1], texel[2]] };
            let rgb: Vec<u8> =
                picture.texels.iter().flat_map(spread).map(|value| (srgb_encode(value.max(0.0)) * 255.0).round() as u8).collect();
            PngEncoder::new(&mut bytes).write_image(&rgb, width, height, ExtendedColorType::Rgb8)
        }
        ImageFormat::Exr => {
            let rgb: Vec<u8> = picture
                .texels
                .iter()
                .flat_map(|texel| if picture.components == 1 { [texel[0]; 3] } else { [texel[0], texel[1], texel[2]] })
                .flat_map(f32::to_ne_bytes)
                .collect();
            OpenExrEncoder::new(std::io::Cursor::new(&mut bytes)).write_image(&rgb, width, height, ExtendedColorType::Rgb32F)
        }
    };
    encoded.map_err(|error| Diagnostic::error("output::encode", format!("can't encode `{}`: {error}", path.display())))?;
    write_file(path, &bytes)
}

/// Writes a file whole or not at all.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let failed = |error: std::io::Error| unwritable(path, folder, &error);
    let mut file = tempfile::Builder::new().prefix(".luminaire-").tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).map_err(failed)?;
    file.as_file().sync_all().map_err(failed)?;
    make_readable(&file).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Temporary files are private; results have the usual permissions.
#[cfg(unix)]
fn make_readable(file: &tempfile::NamedTempFile) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_: &tempfile::NamedTempFile) -> std::io::Result<()> {
    Ok(())
}

/// Checks that a path can be written before anything is rendered for it.
pub fn check_writable(path: &Path) -> Result<(), Diagnostic> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if path.is_dir() {
        return Err(
            Diagnostic::error("output::write", format!("can't write `{}`: it is a folder", path.display())).hint("name a file in it")
        );
    }
    tempfile::Builder::new().prefix(".luminaire-").tempfile_in(folder).map(|_| ()).map_err(|error| unwritable(path, folder, &error))
}

/// Says why in terms of the path that was asked for: the temporary file's name means nothing to its reader.
fn unwritable(path: &Path, folder: &Path, error: &std::io::Error) -> Diagnostic {
    let shown = folder.display();
    let reason = if folder.is_dir() {
        format!("the folder `{shown}` takes no file ({})", error.kind())
    } else if folder.exists() {
        format!("`{shown}` is no folder")
    } else {
        format!("there is no folder `{shown}`")
    };
    Diagnostic::error("output::write", format!("can't write `{}`: {reason}", path.display()))
        .hint("choose a path in a folder that exists and may be written to")
}
