//! Images of linear light or numbers: OpenEXR and Radiance HDR, decoded to 32-bit floats.
//!
//! Guarantees: the size that a header gives is held against the limits and against what the bytes could hold at the formats' best
//! compression before anything is allocated. Values come as they stand in the file, those that are not finite included.
//! Accepted: of an OpenEXR file the first layer that has red, green and blue is read; Radiance's XYZE colours are refused.

use std::io::Cursor;

use image::{ImageDecoder, ImageFormat, ImageReader, Limits};

/// Texels along a side: what every desktop GPU takes.
const LONGEST_SIDE: u32 = 16384;
/// Texels of an image: 1 GiB as 32-bit floats.
const MOST_TEXELS: u64 = 1 << 26;
/// A run of 127 equal bytes takes two, in each of Radiance's four channels.
const HDR_TEXELS_PER_BYTE: u64 = 16;
/// Deflate's best compression is 1032 to 1, and a texel has six bytes at least.
const EXR_TEXELS_PER_BYTE: u64 = 172;
/// Headers and rounding.
const SLACK: u64 = 4096;

/// A decoded image.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearImage {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row by row from the top: red, green, blue, alpha (1 where the file has none).
    pub texels: Vec<[f32; 4]>,
}

/// Decodes the bytes of a file. The error is the end of a sentence: `can't read it: ...`.
pub fn decode_linear(bytes: &[u8]) -> Result<LinearImage, String> {
    let format = match bytes {
        [0x76, 0x2F, 0x31, 0x01, ..] => ImageFormat::OpenExr,
        [b'#', b'?', ..] => ImageFormat::Hdr,
        _ => return Err("it is neither OpenEXR nor Radiance HDR".to_owned()),
    };
    if format == ImageFormat::Hdr && has_xyz_colors(bytes) {
        return Err("its colours are XYZE; save it with RGBE colours".to_owned());
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(u32::MAX);
    limits.max_image_height = Some(u32::MAX);
    limits.max_alloc = Some(MOST_TEXELS * 32);
    reader.limits(limits);
    let undecodable = |error: image::ImageError| format!("it can't be decoded: {}", error.to_string().trim());
    let decoder = reader.into_decoder().map_err(undecodable)?;
    let (width, height) = decoder.dimensions();
    let texels = u64::from(width) * u64::from(height);
    if texels == 0 || width > LONGEST_SIDE || height > LONGEST_SIDE || texels > MOST_TEXELS {
        let most = MOST_TEXELS >> 20;
        return Err(format!("it has {width} x {height} texels; a side may have 1 to {LONGEST_SIDE}, and an image {most} Mi"));
    }
    let per_byte = if format == ImageFormat::Hdr { HDR_TEXELS_PER_BYTE } else { EXR_TEXELS_PER_BYTE };
    if texels > bytes.len() as u64 * per_byte + SLACK {
        return Err(format!("it promises {width} x {height} texels, which {} bytes can't hold", bytes.len()));
    }
    let decoded = image::DynamicImage::from_decoder(decoder).map_err(undecodable)?.into_rgba32f();
    Ok(LinearImage { width, height, texels: decoded.pixels().map(|pixel| pixel.0).collect() })
}

/// The header of a Radiance file ends with an empty line.
fn has_xyz_colors(bytes: &[u8]) -> bool {
    let header = bytes.split(|byte| *byte == b'\n').take_while(|line| !line.is_empty()).take(1000);
    header.into_iter().any(|line| line.starts_with(b"FORMAT=") && line.windows(4).any(|part| part.eq_ignore_ascii_case(b"xyze")))
}
