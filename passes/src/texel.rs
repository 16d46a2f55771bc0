//! Texels as bytes: encoding clear values, decoding what comes back from the GPU.
//!
//! Sources: WebGPU "Texture Formats"; IEC 61966-2-1 for sRGB; the OpenGL extension EXT_texture_shared_exponent for
//! `rgb9e5ufloat`. Small floats are rounded toward zero when encoded.

use half::f16;
use luminaire_graph::format::Format;

/// Linear to sRGB, both 0..1.
pub(crate) fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// sRGB to linear, both 0..1.
pub(crate) fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// How a component lies in memory.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Unorm,
    Snorm,
    Uint,
    Sint,
    Float,
}

/// Bytes of a component and its kind, of formats whose components are alike.
fn layout(format: Format) -> (usize, Kind) {
    let info = format.info();
    let name = info.name.trim_end_matches("-srgb");
    let kinds = [("unorm", Kind::Unorm), ("snorm", Kind::Snorm), ("uint", Kind::Uint), ("sint", Kind::Sint)];
    let kind = kinds.iter().find(|(ending, _)| name.ends_with(ending)).map_or(Kind::Float, |(_, kind)| *kind);
    ((info.texel_bytes / info.components.max(1)).max(1) as usize, kind)
}

fn is_srgb(format: Format) -> bool {
    format.name().ends_with("-srgb")
}

/// Position in memory of red, green, blue and alpha.
fn order(format: Format) -> [usize; 4] {
    if format.name().starts_with("bgra") { [2, 1, 0, 3] } else { [0, 1, 2, 3] }
}

/// A texel of linear components. Values are clamped to what the format holds.
pub(crate) fn encode(format: Format, value: [f64; 4]) -> Vec<u8> {
    match format.name() {
        "rgb10a2unorm" => {
            let [r, g, b, a] = value.map(|component| component.clamp(0.0, 1.0));
            let [r, g, b] = [r, g, b].map(|component| (component * 1023.0).round() as u32);
            (r | g << 10 | b << 20 | ((a * 3.0).round() as u32) << 30).to_le_bytes().to_vec()
        }
        "rgb10a2uint" => {
            let [r, g, b, a] = value.map(|component| component as u32);
            (r.min(1023) | g.min(1023) << 10 | b.min(1023) << 20 | a.min(3) << 30).to_le_bytes().to_vec()
        }
        "rg11b10ufloat" => {
            let [r, g, b] = [value[0], value[1], value[2]].map(|component| u32::from(f16::from_f64(component.max(0.0)).to_bits()));
            (r >> 4 | (g >> 4) << 11 | (b >> 5) << 22).to_le_bytes().to_vec()
        }
        "rgb9e5ufloat" => encode_shared_exponent(value).to_le_bytes().to_vec(),
        _ => {
            let (bytes, kind) = layout(format);
            let order = order(format);
            let components = format.info().components as usize;
            let mut texel = vec![0; components * bytes];
            for (index, component) in value.into_iter().enumerate().take(components) {
                let component = if is_srgb(format) && index < 3 { srgb_from_linear(component.clamp(0.0, 1.0)) } else { component };
                let start = order[index] * bytes;
                texel[start..start + bytes].copy_from_slice(&encode_component(bytes, kind, component)[..bytes]);
            }
            texel
        }
    }
}

/// Little endian, in the first `bytes` bytes.
fn encode_component(bytes: usize, kind: Kind, value: f64) -> [u8; 4] {
    let bits = bytes as u32 * 8;
    match kind {
        Kind::Unorm => ((value.clamp(0.0, 1.0) * (2f64.powi(bits as i32) - 1.0)).round() as u32).to_le_bytes(),
        Kind::Snorm => ((value.clamp(-1.0, 1.0) * (2f64.powi(bits as i32 - 1) - 1.0)).round() as i32).to_le_bytes(),
        Kind::Uint => ((value as u32).min(u32::MAX >> (32 - bits))).to_le_bytes(),
        Kind::Sint => ((value as i32).clamp(i32::MIN >> (32 - bits), i32::MAX >> (32 - bits))).to_le_bytes(),
        Kind::Float if bytes == 2 => {
            let [low, high] = f16::from_f64(value).to_le_bytes();
            [low, high, 0, 0]
        }
        Kind::Float => (value as f32).to_le_bytes(),
    }
}

fn encode_shared_exponent(value: [f64; 4]) -> u32 {
    let [r, g, b, _] = value.map(|component| component.clamp(0.0, 65408.0));
    let largest = r.max(g).max(b);
    let mut exponent = if largest > 0.0 { (largest.log2().floor() as i32).max(-16) + 16 } else { 0 };
    if (largest / 2f64.powi(exponent - 24) + 0.5).floor() >= 512.0 {
        exponent += 1;
    }
    let unit = 2f64.powi(exponent - 24);
    let [r, g, b] = [r, g, b].map(|component| (component / unit + 0.5).floor() as u32);
    r | g << 9 | b << 18 | exponent.cast_unsigned() << 27
}

/// What a shader gets when it samples the texel, sRGB decoded: red, green, blue, alpha. Missing components are 0, alpha 1.
/// Integers above 2^24 are rounded. Zero if the bytes are too few.
pub(crate) fn decode(format: Format, texel: &[u8]) -> [f32; 4] {
    let word = || texel.get(..4).and_then(|bytes| bytes.try_into().ok()).map_or(0, u32::from_le_bytes);
    match format.name() {
        "rgb10a2unorm" | "rgb10a2uint" => {
            let scale = if format.name() == "rgb10a2unorm" { [1023.0, 3.0] } else { [1.0, 1.0] };
            let word = word();
            let color = |shift: u32| (word >> shift & 1023) as f32 / scale[0];
            [color(0), color(10), color(20), (word >> 30) as f32 / scale[1]]
        }
        "rg11b10ufloat" => {
            let word = word();
            let small = |bits: u32, shift: u32| f16::from_bits((bits << shift) as u16).to_f32();
            [small(word & 2047, 4), small(word >> 11 & 2047, 4), small(word >> 22, 5), 1.0]
        }
        "rgb9e5ufloat" => {
            let word = word();
            let unit = 2f32.powi((word >> 27) as i32 - 24);
            let [r, g, b] = [0, 9, 18].map(|shift| (word >> shift & 511) as f32 * unit);
            [r, g, b, 1.0]
        }
        _ => {
            let (bytes, kind) = layout(format);
            let order = order(format);
            let mut value = [0.0, 0.0, 0.0, 1.0];
            for index in 0..(format.info().components as usize).min(4) {
                let start = order[index] * bytes;
                let component = texel.get(start..start + bytes).map_or(0.0, |bytes| decode_component(kind, bytes));
                value[index] = if is_srgb(format) && index < 3 { linear_from_srgb(component) as f32 } else { component as f32 };
            }
            value
        }
    }
}

fn decode_component(kind: Kind, bytes: &[u8]) -> f64 {
    let mut word = [0; 4];
    word[..bytes.len()].copy_from_slice(bytes);
    let bits = bytes.len() as u32 * 8;
    let unsigned = u32::from_le_bytes(word);
    // Shifting up and down again spreads the sign.
    let signed = (unsigned << (32 - bits)).cast_signed() >> (32 - bits);
    match kind {
        Kind::Unorm => f64::from(unsigned) / (2f64.powi(bits as i32) - 1.0),
        Kind::Snorm => (f64::from(signed) / (2f64.powi(bits as i32 - 1) - 1.0)).max(-1.0),
        Kind::Uint => f64::from(unsigned),
        Kind::Sint => f64::from(signed),
        Kind::Float if bits == 16 => f16::from_bits(unsigned as u16).to_f64(),
        Kind::Float => f64::from(f32::from_bits(unsigned)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire_graph::format::{FORMATS, SampleKind};

    #[test]
    fn what_is_encoded_decodes_again() {
        for info in FORMATS.iter().filter(|info| info.name != "depth24plus") {
            let format = Format::from_name(info.name).unwrap();
            let integer = matches!(info.sample, SampleKind::Uint | SampleKind::Sint);
            let value = if integer { [1.0, 2.0, 3.0, 3.0] } else { [1.0, 0.25, 0.5, 1.0] };
            let texel = encode(format, value);
            assert_eq!(texel.len(), info.texel_bytes as usize, "{}", info.name);
            let back = decode(format, &texel);
            for index in 0..info.components as usize {
                let error = (f64::from(back[index]) - value[index]).abs();
                assert!(error < 0.01, "{}: {back:?} for {value:?}", info.name);
            }
        }
    }

    #[test]
    fn values_are_clamped() {
        let byte = Format::from_name("r8sint").unwrap();
        assert_eq!(encode(byte, [-1000.0; 4]), [0x80]);
        assert_eq!(decode(byte, &[0xff])[0], -1.0);
        assert_eq!(encode(Format::from_name("rgb9e5ufloat").unwrap(), [f64::INFINITY; 4]), [0xff; 4]);
        assert_eq!(encode(Format::from_name("rg11b10ufloat").unwrap(), [-1.0; 4]), [0; 4]);
        assert_eq!(decode(Format::from_name("rgba8unorm").unwrap(), &[]), [0.0; 4]);
    }

    #[test]
    fn bgra_is_turned() {
        let format = Format::from_name("bgra8unorm").unwrap();
        assert_eq!(encode(format, [1.0, 0.0, 0.0, 1.0]), [0, 0, 255, 255]);
    }
}
