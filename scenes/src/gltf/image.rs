//! Images: PNG and JPEG, decoded to 8-bit RGBA.
//!
//! Guarantees: the size that a header gives is held against the limits and against what the bytes could hold at the formats' best
//! compression before anything is allocated; only images that a material uses are decoded, each once, on two threads.
//! Downside: 16-bit images lose their lower bits.

use std::io::Cursor;
use std::sync::atomic::{AtomicUsize, Ordering};

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::buffer::View;
use super::json::Json;
use super::report::Report;
use super::uri::Folder;
use crate::asset::Image;

/// Pixels along a side: what every desktop GPU takes.
const LONGEST_SIDE: u32 = 16384;
/// Pixels of all images of a file together: 1 GiB as RGBA.
const MOST_PIXELS: u64 = 1 << 28;
/// Bytes of all image files together.
const LARGEST_FILE: u64 = 1 << 30;
const THREADS: usize = 2;

/// Deflate's best compression is 1032 to 1.
const PNG_RATIO: u64 = 1032;
/// A JPEG spends at least one bit on a block of 64 pixels, or 6 bits on 256 where colour is subsampled; twice that is allowed here.
const JPEG_PIXELS_PER_BYTE: u64 = 1024;
/// Headers and rounding.
const SLACK: u64 = 4096;

/// A checked image.
pub(super) struct ImageSource<'a> {
    name: String,
    place: String,
    bytes: Bytes<'a>,
}

enum Bytes<'a> {
    Uri(&'a str),
    View(&'a [u8]),
}

/// Checks every image. A broken one is reported, and `None`.
pub(super) fn read_images<'a>(root: &Json<'a>, views: &[Option<View<'a>>]) -> Vec<Option<ImageSource<'a>>> {
    root.objects("images").iter().enumerate().map(|(index, image)| read_image(image, index, views)).collect()
}

fn read_image<'a>(json: &Json<'a>, index: usize, views: &[Option<View<'a>>]) -> Option<ImageSource<'a>> {
    let place = json.place_of(if json.has("uri") { "uri" } else { "bufferView" });
    let bytes = match (json.has("uri"), json.has("bufferView")) {
        (true, false) => Bytes::Uri(json.text("uri")?),
        (false, true) => Bytes::View((*views.get(json.index("bufferView", "bufferViews", views.len())?)?)?.bytes),
        (true, true) => {
            json.error("gltf::image-source", "has both `uri` and `bufferView`");
            return None;
        }
        (false, false) => {
            json.error("gltf::image-source", "has neither `uri` nor `bufferView`");
            return None;
        }
    };
    Some(ImageSource { name: json.name_or("image", index), place, bytes })
}

/// Bytes whose header was read.
struct Encoded<'a> {
    source: &'a ImageSource<'a>,
    bytes: std::borrow::Cow<'a, [u8]>,
    format: ImageFormat,
}

/// Decodes the images, in their order. Those that fail are reported; the result is complete only if none did.
pub(super) fn decode(used: &[&ImageSource<'_>], folder: &Folder, report: &Report) -> Vec<Image> {
    let (mut pixels, mut bytes) = (0_u64, 0_u64);
    let mut encoded = Vec::new();
    for source in used {
        match open(source, folder) {
            Ok((image, size)) => {
                pixels = pixels.saturating_add(size);
                bytes = bytes.saturating_add(image.bytes.len() as u64);
                encoded.push(image);
            }
            Err((problem, hint)) => report.error("gltf::image", &source.place, problem, hint),
        }
        if pixels > MOST_PIXELS || bytes > LARGEST_FILE {
            let problem = format!("the images together have more than {MOST_PIXELS} pixels or {LARGEST_FILE} bytes");
            report.error("gltf::too-large", "images", problem, "scale the textures down");
            break;
        }
    }
    if report.has_errors() {
        return Vec::new();
    }
    let results = decode_all(&encoded);
    let mut images = Vec::new();
    for (image, result) in encoded.iter().zip(results) {
        match result {
            Ok(image) => images.push(image),
            Err(problem) => report.error("gltf::image", &image.source.place, problem, "the image is damaged; save it again"),
        }
    }
    images
}

/// Reads the bytes and the header; the second value is the number of pixels.
fn open<'a>(source: &'a ImageSource<'a>, folder: &Folder) -> Result<(Encoded<'a>, u64), (String, &'static str)> {
    let bytes: std::borrow::Cow<'a, [u8]> = match source.bytes {
        Bytes::View(bytes) => bytes.into(),
        Bytes::Uri(uri) => folder.read(uri, LARGEST_FILE).map_err(|problem| (problem, "keep the image beside the glTF file"))?.into(),
    };
    let format = recognise(&bytes).map_err(|problem| (problem, "save it as PNG or JPEG"))?;
    let pixels = measure(&bytes, format).map_err(|problem| (problem, "save the image again, no larger than the limits"))?;
    Ok((Encoded { source, bytes, format }, pixels))
}

fn recognise(bytes: &[u8]) -> Result<ImageFormat, String> {
    match bytes {
        [0x89, b'P', b'N', b'G', 0x0D, 0x0A, 0x1A, 0x0A, ..] => Ok(ImageFormat::Png),
        [0xFF, 0xD8, 0xFF, ..] => Ok(ImageFormat::Jpeg),
        other => Err(format!("is neither PNG nor JPEG{}", guess(other))),
    }
}

/// Decodes the bytes of a PNG or JPEG file that stands for itself: width, height, and RGBA as sRGB has it. The error is the end of a
/// sentence: `the image is ..`, `the image has ..`.
pub(crate) fn decode_picture(bytes: &[u8]) -> Result<(u32, u32, Vec<u8>), String> {
    let format = recognise(bytes)?;
    measure(bytes, format)?;
    let rgba = reader(bytes, format).decode().map_err(|error| undecodable(&error))?.into_rgba8();
    Ok((rgba.width(), rgba.height(), rgba.into_raw()))
}

fn guess(bytes: &[u8]) -> &'static str {
    match bytes {
        [b'R', b'I', b'F', b'F', ..] => ", but WebP",
        [0xAB, b'K', b'T', b'X', ..] => ", but KTX",
        [b'G', b'I', b'F', ..] => ", but GIF",
        [b'D', b'D', b'S', b' ', ..] => ", but DDS",
        [b'B', b'M', ..] => ", but BMP",
        [] => ", but empty",
        _ => "",
    }
}

/// The number of pixels, if it is within the limits and the bytes could hold them.
fn measure(bytes: &[u8], format: ImageFormat) -> Result<u64, String> {
    let decoder = reader(bytes, format).into_decoder().map_err(|error| undecodable(&error))?;
    let (width, height) = decoder.dimensions();
    if width == 0 || height == 0 {
        return Err(format!("has {width}x{height} pixels"));
    }
    if width > LONGEST_SIDE || height > LONGEST_SIDE {
        return Err(format!("has {width}x{height} pixels; a side may have {LONGEST_SIDE}"));
    }
    let pixels = u64::from(width) * u64::from(height);
    let length = bytes.len() as u64;
    let possible = match format {
        ImageFormat::Png => pixels * png_bits_per_pixel(bytes) / 8 <= length * PNG_RATIO + SLACK,
        _ => pixels <= length * JPEG_PIXELS_PER_BYTE + SLACK,
    };
    if possible { Ok(pixels) } else { Err(format!("promises {width}x{height} pixels, which {length} bytes can't hold")) }
}

/// From the header chunk, whose place is fixed: bytes 24 and 25 are bit depth and colour type. A palette has one channel.
fn png_bits_per_pixel(bytes: &[u8]) -> u64 {
    let depth = u64::from(bytes.get(24).copied().unwrap_or(1)).max(1);
    let channels = match bytes.get(25) {
        Some(2) => 3,
        Some(4) => 2,
        Some(6) => 4,
        _ => 1,
    };
    depth * channels
}

/// Some decoders end their messages with a line break.
fn undecodable(error: &image::ImageError) -> String {
    format!("can't be decoded: {}", error.to_string().trim())
}

fn reader(bytes: &[u8], format: ImageFormat) -> ImageReader<Cursor<&[u8]>> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(u32::MAX);
    limits.max_image_height = Some(u32::MAX);
    // The largest picture with 16 bits and four channels, and as much again for the decoder.
    limits.max_alloc = Some(u64::from(LONGEST_SIDE) * u64::from(LONGEST_SIDE) * 16);
    reader.limits(limits);
    reader
}

/// Decodes on a few threads, which take the next image in turn.
fn decode_all(encoded: &[Encoded<'_>]) -> Vec<Result<Image, String>> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while let Some(image) = encoded.get(next.fetch_add(1, Ordering::Relaxed)) {
            done.push((image.source.place.as_str(), decode_one(image)));
        }
        done
    };
    let finished = match encoded.len() {
        0 | 1 => work(),
        _ => std::thread::scope(|scope| {
            let others: Vec<_> = (1..THREADS).map(|_| scope.spawn(work)).collect();
            let mut all = work();
            all.extend(others.into_iter().filter_map(|other| other.join().ok()).flatten());
            all
        }),
    };
    let mut by_place: std::collections::BTreeMap<&str, Result<Image, String>> = finished.into_iter().collect();
    let missing = || Err("its decoder failed".to_owned());
    encoded.iter().map(|image| by_place.remove(image.source.place.as_str()).unwrap_or_else(missing)).collect()
}

fn decode_one(image: &Encoded<'_>) -> Result<Image, String> {
    let decoded: DynamicImage = reader(&image.bytes, image.format).decode().map_err(|error| undecodable(&error))?;
    let rgba = decoded.into_rgba8();
    let (width, height) = rgba.dimensions();
    Ok(Image { name: image.source.name.clone(), width, height, rgba: rgba.into_raw().into() })
}
