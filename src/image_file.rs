//! Rendered images as files: `.png` for what is shown, `.exr` for what was computed.
//!
//! A file appears whole or not at all: it is written beside its place under another name, and moved there at the end. What a program
//! that was killed left behind can be told from files that are being written: the latter are locked.

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

/// The inverse of [`srgb_encode`].
pub fn srgb_decode(encoded: f32) -> f32 {
    let encoded = encoded.clamp(0.0, 1.0);
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
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

/// How the names of files begin that are not whole yet.
const UNFINISHED: &str = ".luminaire-";

/// Writes a file whole or not at all.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
    let folder = folder_of(path);
    let failed = |error: std::io::Error| unwritable(path, folder, &error);
    let mut file = unfinished_in(folder).map_err(failed)?;
    // Where files can't be locked, nothing is swept either.
    let _ = file.as_file().lock();
    file.write_all(bytes).map_err(failed)?;
    file.as_file().sync_all().map_err(failed)?;
    make_readable(&file).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Removes the files that programs left in a folder which were killed while they wrote. What is being written stays, and what can't be
/// removed, too.
pub fn sweep_unfinished(folder: &Path) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten().filter(|entry| entry.file_name().to_string_lossy().starts_with(UNFINISHED)) {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && std::fs::File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// The folder that a path is in.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn unfinished_in(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    tempfile::Builder::new().prefix(UNFINISHED).tempfile_in(folder)
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
    if path.is_dir() {
        return Err(
            Diagnostic::error("output::write", format!("can't write `{}`: it is a folder", path.display())).hint("name a file in it")
        );
    }
    check_folder(path, folder_of(path))
}

/// The same where folders that are missing will be made.
pub fn check_creatable(path: &Path) -> Result<(), Diagnostic> {
    let nearest = path.ancestors().skip(1).find(|folder| folder.exists()).unwrap_or(Path::new("."));
    check_folder(path, nearest)
}

fn check_folder(path: &Path, folder: &Path) -> Result<(), Diagnostic> {
    unfinished_in(folder).map(|_| ()).map_err(|error| unwritable(path, folder, &error))
}

/// Makes the folder that a path is in, and those around it.
pub fn create_folder_of(path: &Path) -> Result<(), Diagnostic> {
    let folder = folder_of(path);
    std::fs::create_dir_all(folder).map_err(|error| unwritable(path, folder, &error))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_bits_come_back() {
        for value in 0..=255_u8 {
            let there = srgb_decode(f32::from(value) / 255.0);
            assert_eq!((srgb_encode(there) * 255.0).round() as u8, value);
        }
        // IEC 61966-2-1: the middle of the code is about a fifth of the light.
        assert!((srgb_decode(0.5) - 0.214_041).abs() < 1e-6);
    }

    #[test]
    fn what_nobody_writes_any_more_is_swept() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in [".luminaire-a1B2c3", ".luminaire-locked", "0001.png", ".hidden"] {
            std::fs::write(path(name), b"half").unwrap();
        }
        std::fs::create_dir(path(".luminaire-folder")).unwrap();
        let held = std::fs::File::open(path(".luminaire-locked")).unwrap();
        held.lock().unwrap();
        sweep_unfinished(folder.path());
        let left = |name: &str| path(name).exists();
        assert!(!left(".luminaire-a1B2c3"));
        assert!(left(".luminaire-locked") && left("0001.png") && left(".hidden") && left(".luminaire-folder"));
        drop(held);
        sweep_unfinished(folder.path());
        assert!(!left(".luminaire-locked"));
    }

    #[test]
    fn folders_that_are_missing_can_be_made_or_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b/0001.png");
        check_creatable(&path).unwrap();
        assert!(!folder.path().join("a").exists());
        assert!(check_writable(&path).is_err());
        create_folder_of(&path).unwrap();
        check_writable(&path).unwrap();
        std::fs::write(&path, b"").unwrap();
        assert!(check_creatable(&path.join("c/0001.png")).unwrap_err().message.contains("is no folder"));
    }
}
