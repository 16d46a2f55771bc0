//! `luminaire sheet`: images side by side in one, row by row, to see a sequence at a glance.
//!
//! Guarantees: the means of `--shrink` are of light, not of sRGB values, so that a sheet is as bright as its images; without it every
//! pixel keeps its value. Downside: images are PNG files of one size; shrinking is by whole factors, and what does not fill a block
//! at the right and the lower edge is left out.

use std::path::Path;

use luminaire_graph::diagnostic::Diagnostic;

use super::arguments::SheetArguments;
use super::render::nowhere;
use super::report;
use crate::image_file::{ImageFormat, LinearImage, check_writable, srgb_decode, write_image};

/// Pixels between two images, white.
const GAP: u32 = 4;

/// The longest edge of a sheet, pixels.
const LONGEST: u32 = 16_384;

pub(super) fn run(arguments: &SheetArguments) -> bool {
    match sheet(arguments) {
        Ok(()) => true,
        Err(problems) => {
            let (problems, sources) = nowhere(problems);
            report(&problems, &sources)
        }
    }
}

fn sheet(arguments: &SheetArguments) -> Result<(), Vec<Diagnostic>> {
    let mut problems = Vec::new();
    match ImageFormat::of_path(&arguments.file) {
        Ok(ImageFormat::Png) => problems.extend(check_writable(&arguments.file).err()),
        Ok(ImageFormat::Exr) => {
            let message = format!("a sheet shows pictures, and `{}` is for linear values", arguments.file.display());
            problems.push(Diagnostic::error("output::format", message).hint("end the path in .png"));
        }
        Err(problem) => problems.push(problem),
    }
    let mut tiles: Vec<LinearImage> = Vec::new();
    let mut first: Option<(&Path, [u32; 2])> = None;
    for path in &arguments.images {
        match tile(path, arguments.shrink, &mut first) {
            Ok(tile) => tiles.push(tile),
            Err(problem) => problems.push(problem),
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let columns = arguments.columns.unwrap_or_else(|| usual_columns(tiles.len() as u32));
    let sheet = side_by_side(&tiles, columns).map_err(|problem| vec![problem])?;
    write_image(&arguments.file, &sheet).map_err(|problem| vec![problem])
}

/// A PNG file as light.
fn read(path: &Path) -> Result<LinearImage, Diagnostic> {
    let failed = |why: String| {
        Diagnostic::error("sheet::unreadable", format!("can't read `{}`: {why}", path.display()))
            .hint("a sheet is made of .png files, as `luminaire render` writes them")
    };
    let bytes = std::fs::read(path).map_err(|error| failed(error.kind().to_string()))?;
    let image = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png).map_err(|error| failed(error.to_string()))?;
    let rgb = image.into_rgb8();
    let light = |value: u8| srgb_decode(f32::from(value) / 255.0);
    let texels = rgb.pixels().map(|pixel| [light(pixel[0]), light(pixel[1]), light(pixel[2]), 1.0]).collect();
    Ok(LinearImage { width: rgb.width(), height: rgb.height(), texels, components: 3 })
}

/// An image as it stands in the sheet; it has to be as large as the first.
fn tile<'a>(path: &'a Path, shrink: u32, first: &mut Option<(&'a Path, [u32; 2])>) -> Result<LinearImage, Diagnostic> {
    let image = read(path)?;
    let size = [image.width, image.height];
    let (model, expected) = *first.get_or_insert((path, size));
    if size != expected {
        let message = format!("`{}` is not as large as `{}`", path.display(), model.display());
        return Err(Diagnostic::error("sheet::sizes", message).hint("render all of them with the same --size"));
    }
    if image.width.min(image.height) < shrink {
        let message = format!("`{}` has {} x {} pixels, and nothing would be left of it", path.display(), image.width, image.height);
        return Err(Diagnostic::error("sheet::too-small", message).hint(format!("shrink it by less than {shrink}")));
    }
    Ok(shrunk(&image, shrink))
}

/// As wide as high, or one row more.
fn usual_columns(count: u32) -> u32 {
    (1..count).find(|columns| columns * columns >= count).unwrap_or(count)
}

/// The mean over blocks of `factor` by `factor` pixels.
fn shrunk(image: &LinearImage, factor: u32) -> LinearImage {
    let (width, height) = (image.width / factor, image.height / factor);
    let mut texels = vec![[0.0; 4]; width as usize * height as usize];
    let share = 1.0 / (factor as f32 * factor as f32);
    for (row, y) in image.texels.chunks_exact(image.width as usize).zip(0..height * factor) {
        let start = (y / factor) as usize * width as usize;
        for (block, sum) in row.chunks_exact(factor as usize).zip(&mut texels[start..]) {
            for texel in block {
                for (sum, value) in sum.iter_mut().zip(texel) {
                    *sum += value * share;
                }
            }
        }
    }
    LinearImage { width, height, texels, components: image.components }
}

/// Images of one size in rows of so many. Errors: `sheet::too-large`.
fn side_by_side(tiles: &[LinearImage], columns: u32) -> Result<LinearImage, Diagnostic> {
    let count = tiles.len() as u32;
    let columns = columns.min(count);
    let (tile_width, tile_height) = tiles.first().map_or((0, 0), |tile| (tile.width, tile.height));
    let edge = |tiles: u32, pixels: u32| u64::from(tiles) * u64::from(pixels + GAP) - u64::from(GAP);
    let (width, height) = (edge(columns, tile_width), edge(count.div_ceil(columns), tile_height));
    if width.max(height) > u64::from(LONGEST) {
        let message = format!("the sheet would have {width} x {height} pixels, and may have {LONGEST} along an edge");
        return Err(Diagnostic::error("sheet::too-large", message).hint("shrink the images, --shrink 4, or choose other --columns"));
    }
    let mut texels = vec![[1.0; 4]; width as usize * height as usize];
    for (index, tile) in (0..).zip(tiles) {
        let left = (index % columns * (tile_width + GAP)) as usize;
        let top = (index / columns * (tile_height + GAP)) as usize;
        for (row, line) in tile.texels.chunks_exact(tile_width as usize).zip(texels.chunks_exact_mut(width as usize).skip(top)) {
            line[left..left + row.len()].copy_from_slice(row);
        }
    }
    Ok(LinearImage { width: width as u32, height: height as u32, texels, components: 3 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(width: u32, height: u32, value: f32) -> LinearImage {
        LinearImage { width, height, texels: vec![[value; 4]; (width * height) as usize], components: 3 }
    }

    #[test]
    fn shrinking_takes_means_of_light() {
        let texels = (0..15).map(|place| [place as f32; 4]).collect();
        let small = shrunk(&LinearImage { width: 5, height: 3, texels, components: 3 }, 2);
        // (0 + 1 + 5 + 6) / 4 and (2 + 3 + 7 + 8) / 4; the last column and row fill no block.
        assert_eq!((small.width, small.height, small.texels), (2, 1, vec![[3.0; 4], [5.0; 4]]));
    }

    #[test]
    fn images_stand_row_by_row() {
        let tiles: Vec<LinearImage> = (0..3).map(|tile| plain(2, 1, tile as f32 / 4.0)).collect();
        let sheet = side_by_side(&tiles, 2).unwrap();
        assert_eq!((sheet.width, sheet.height), (8, 6));
        let row = |y: usize| sheet.texels[y * 8..(y + 1) * 8].iter().map(|texel| texel[0]).collect::<Vec<_>>();
        assert_eq!(row(0), [0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.25, 0.25]);
        assert!((1..5).all(|y| row(y) == [1.0; 8]));
        assert_eq!(row(5), [0.5, 0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
        assert_eq!(side_by_side(&tiles, 9).unwrap().width, 14);
        assert_eq!([1, 2, 4, 5, 8, 9, 10].map(usual_columns), [1, 2, 2, 3, 3, 3, 4]);
    }

    #[test]
    fn sheets_have_an_end() {
        let tiles = vec![plain(200, 1, 0.0); 100];
        assert_eq!(side_by_side(&tiles, 100).unwrap_err().code, "sheet::too-large");
        assert!(side_by_side(&tiles, 10).is_ok());
    }
}
