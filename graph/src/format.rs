//! Texture formats: what WebGPU says that each can do, and what it costs.
//!
//! Source: WebGPU, "Texture Format Capabilities". Stencil and compressed formats are left out: no pass kind uses them.

/// A texture format; an index into [`FORMATS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Format(u8);

/// How a shader sees a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SampleKind {
    /// `f32`, can be filtered.
    Float,
    /// `f32`, can be filtered only with the feature `float32-filterable`.
    UnfilterableFloat,
    /// `i32`
    Sint,
    /// `u32`
    Uint,
    /// `f32` through `texture_depth_*`.
    Depth,
}

/// What core WebGPU lets storage textures of a format do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StorageSupport {
    /// Nothing.
    None,
    /// Read or write, not both in one binding.
    ReadOrWrite,
    /// `read_write` too.
    ReadWrite,
}

/// What a format is and can do.
#[derive(Debug, Clone, Copy)]
pub struct FormatInfo {
    /// WebGPU's name.
    pub name: &'static str,
    /// Bytes of a texel in memory.
    pub texel_bytes: u32,
    /// How samples appear.
    pub sample: SampleKind,
    /// Usable as a color attachment.
    pub renderable: bool,
    /// Usable as a color attachment with blending.
    pub blendable: bool,
    /// Usable with 4 samples per texel.
    pub multisample: bool,
    /// Usable as a storage texture.
    pub storage: StorageSupport,
    /// What a color attachment counts against `maxColorAttachmentBytesPerSample`; 0 if it can't be one.
    pub attachment_bytes: u32,
    /// Components.
    pub components: u32,
}

const fn color(name: &'static str, texel_bytes: u32, components: u32, attachment_bytes: u32, storage: StorageSupport) -> FormatInfo {
    FormatInfo {
        name,
        texel_bytes,
        sample: SampleKind::Float,
        renderable: attachment_bytes > 0,
        blendable: attachment_bytes > 0,
        multisample: attachment_bytes > 0,
        storage,
        attachment_bytes,
        components,
    }
}

const fn integer(
    name: &'static str,
    texel_bytes: u32,
    components: u32,
    attachment_bytes: u32,
    sample: SampleKind,
    storage: StorageSupport,
) -> FormatInfo {
    // Integers of 32 bits have one sample per texel.
    let multisample = texel_bytes / components < 4;
    FormatInfo { sample, blendable: false, multisample, ..color(name, texel_bytes, components, attachment_bytes, storage) }
}

const fn float32(name: &'static str, texel_bytes: u32, components: u32, storage: StorageSupport) -> FormatInfo {
    FormatInfo {
        sample: SampleKind::UnfilterableFloat,
        blendable: false,
        multisample: components == 1,
        ..color(name, texel_bytes, components, texel_bytes, storage)
    }
}

const fn depth(name: &'static str, texel_bytes: u32) -> FormatInfo {
    FormatInfo {
        sample: SampleKind::Depth,
        renderable: false,
        blendable: false,
        multisample: true,
        ..color(name, texel_bytes, 1, 0, StorageSupport::None)
    }
}

use SampleKind::{Sint, Uint};
use StorageSupport::{None as NoStorage, ReadOrWrite, ReadWrite};

/// Every format that pipelines may name.
pub const FORMATS: &[FormatInfo] = &[
    color("r8unorm", 1, 1, 1, NoStorage),
    FormatInfo { renderable: false, blendable: false, ..color("r8snorm", 1, 1, 0, NoStorage) },
    integer("r8uint", 1, 1, 1, Uint, NoStorage),
    integer("r8sint", 1, 1, 1, Sint, NoStorage),
    integer("r16uint", 2, 1, 2, Uint, NoStorage),
    integer("r16sint", 2, 1, 2, Sint, NoStorage),
    color("r16float", 2, 1, 2, NoStorage),
    color("rg8unorm", 2, 2, 2, NoStorage),
    FormatInfo { renderable: false, blendable: false, ..color("rg8snorm", 2, 2, 0, NoStorage) },
    integer("rg8uint", 2, 2, 2, Uint, NoStorage),
    integer("rg8sint", 2, 2, 2, Sint, NoStorage),
    integer("r32uint", 4, 1, 4, Uint, ReadWrite),
    integer("r32sint", 4, 1, 4, Sint, ReadWrite),
    float32("r32float", 4, 1, ReadWrite),
    integer("rg16uint", 4, 2, 4, Uint, NoStorage),
    integer("rg16sint", 4, 2, 4, Sint, NoStorage),
    color("rg16float", 4, 2, 4, NoStorage),
    color("rgba8unorm", 4, 4, 8, ReadOrWrite),
    color("rgba8unorm-srgb", 4, 4, 8, NoStorage),
    FormatInfo { renderable: false, blendable: false, ..color("rgba8snorm", 4, 4, 0, ReadOrWrite) },
    integer("rgba8uint", 4, 4, 4, Uint, ReadOrWrite),
    integer("rgba8sint", 4, 4, 4, Sint, ReadOrWrite),
    color("bgra8unorm", 4, 4, 8, NoStorage),
    color("bgra8unorm-srgb", 4, 4, 8, NoStorage),
    integer("rgb10a2uint", 4, 4, 8, Uint, NoStorage),
    color("rgb10a2unorm", 4, 4, 8, NoStorage),
    FormatInfo { renderable: false, blendable: false, ..color("rg11b10ufloat", 4, 3, 0, NoStorage) },
    FormatInfo { renderable: false, blendable: false, ..color("rgb9e5ufloat", 4, 3, 0, NoStorage) },
    integer("rg32uint", 8, 2, 8, Uint, ReadOrWrite),
    integer("rg32sint", 8, 2, 8, Sint, ReadOrWrite),
    float32("rg32float", 8, 2, ReadOrWrite),
    integer("rgba16uint", 8, 4, 8, Uint, ReadOrWrite),
    integer("rgba16sint", 8, 4, 8, Sint, ReadOrWrite),
    color("rgba16float", 8, 4, 8, ReadOrWrite),
    integer("rgba32uint", 16, 4, 16, Uint, ReadOrWrite),
    integer("rgba32sint", 16, 4, 16, Sint, ReadOrWrite),
    float32("rgba32float", 16, 4, ReadOrWrite),
    depth("depth16unorm", 2),
    depth("depth24plus", 4),
    depth("depth32float", 4),
];

impl Format {
    /// The format of a WebGPU name.
    pub fn from_name(name: &str) -> Option<Format> {
        FORMATS.iter().position(|info| info.name == name).map(|index| Format(index as u8))
    }

    /// What it is and can do.
    pub fn info(self) -> &'static FormatInfo {
        &FORMATS[self.0 as usize]
    }

    /// Different for every format.
    pub(crate) fn number(self) -> u32 {
        u32::from(self.0)
    }

    /// WebGPU's name.
    pub fn name(self) -> &'static str {
        self.info().name
    }

    /// Whether it holds depth.
    pub fn is_depth(self) -> bool {
        self.info().sample == SampleKind::Depth
    }
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_of_32_bits_have_one_sample() {
        for (name, expected) in [("r32uint", false), ("rg32sint", false), ("rgba32uint", false), ("rgba16uint", true), ("r8sint", true)] {
            assert_eq!(Format::from_name(name).map(|format| format.info().multisample), Some(expected), "{name}");
        }
    }
}
