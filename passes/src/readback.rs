//! Results on their way back: a part of a texture or buffer as bytes and numbers.
//!
//! Guarantee: the same plan and scene give the same bytes; rows come back without the padding that copies need.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::expand::types::Dimension;
use luminaire_graph::format::Format;
use luminaire_graph::plan::{PartView, Plan};

use crate::convert;
use crate::device::Gpu;
use crate::errors::{Subject, catch};
use crate::texel;
use crate::textures::Memories;

/// An image that was read back. Row 0 is the top.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadImage {
    /// Texels.
    pub width: u32,
    /// Texels, of one layer.
    pub height: u32,
    /// Layers, cube faces or slices of a volume; they follow each other in `bytes` and `pixels`.
    pub layers: u32,
    /// The texture's format.
    pub format: Format,
    /// The texels as they stand in memory, rows tightly packed.
    pub bytes: Vec<u8>,
    /// Red, green, blue and alpha of each texel as a shader would sample them (sRGB decoded); components that the format
    /// lacks are 0, alpha 1.
    pub pixels: Vec<f32>,
}

impl ReadImage {
    /// One texel of layer 0; `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[f32; 4]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let start = (y as usize * self.width as usize + x as usize) * 4;
        self.pixels.get(start..start + 4)?.try_into().ok()
    }

    /// Red, green, blue and alpha as stored (not decoded), for formats of four 8-bit unorm components; else `None`. What a PNG
    /// file holds.
    pub fn rgba8(&self) -> Option<Vec<u8>> {
        match self.format.name() {
            "rgba8unorm" | "rgba8unorm-srgb" => Some(self.bytes.clone()),
            "bgra8unorm" | "bgra8unorm-srgb" => {
                Some(self.bytes.chunks_exact(4).flat_map(|texel| [texel[2], texel[1], texel[0], texel[3]]).collect())
            }
            _ => None,
        }
    }
}

/// Reads a part of a texture: one mip level, all its layers. Waits for the GPU.
pub(crate) fn read_texture(gpu: &Gpu, plan: &Plan, memories: &Memories, name: &str, part: &PartView) -> Result<ReadImage, Diagnostic> {
    let subject = Subject::nowhere(format!("output `{name}`"));
    let resource = &plan.resources[part.resource.index()];
    let Some((texture, shape, format)) = memories.texture(plan, part.resource) else {
        return Err(subject.error("execute::unreadable-output", format!("`{}` is no texture", resource.name)));
    };
    if shape.samples != 1 || format.name() == "depth24plus" {
        let why = if shape.samples == 1 { "depth24plus can't be copied" } else { "it has several samples per texel" };
        return Err(subject
            .error("execute::unreadable-output", format!("`{}` can't be read back: {why}", resource.name))
            .hint("let a pass write what is wanted into another texture"));
    }
    let [width, height, depth] = convert::mip_size(shape, part.mips.start);
    let layers = match shape.dimension {
        Dimension::D3 => depth,
        _ => part.layers.end.saturating_sub(part.layers.start),
    };
    let row = u64::from(width) * u64::from(format.info().texel_bytes);
    let pitch = row.next_multiple_of(u64::from(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT));
    let rows = u64::from(height) * u64::from(layers);
    let size = pitch * rows;
    let limit = gpu.device.limits().max_buffer_size;
    if size > limit {
        let message = format!("reading it back takes {size} bytes at once; this device takes {limit}");
        return Err(subject.error("execute::too-large", message));
    }
    let (buffer, errors) = catch(&gpu.device, || {
        let buffer = read_buffer(gpu, size);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read back") });
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: part.mips.start,
                origin: wgpu::Origin3d { x: 0, y: 0, z: part.layers.start },
                aspect: wgpu::TextureAspect::All,
            },
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(pitch as u32), rows_per_image: Some(height) },
            },
            wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        );
        gpu.queue.submit([encoder.finish()]);
        buffer
    });
    subject.check(&errors)?;
    let padded = map(gpu, &buffer, size)?;
    let bytes: Vec<u8> = padded.chunks(pitch.max(1) as usize).flat_map(|line| line.iter().copied().take(row as usize)).collect();
    let pixels = bytes.chunks(format.info().texel_bytes.max(1) as usize).flat_map(|texel| texel::decode(format, texel)).collect();
    Ok(ReadImage { width, height, layers, format, bytes, pixels })
}

/// Reads a buffer resource. Waits for the GPU.
pub(crate) fn read_bytes(gpu: &Gpu, plan: &Plan, memories: &Memories, name: &str, part: &PartView) -> Result<Vec<u8>, Diagnostic> {
    let subject = Subject::nowhere(format!("output `{name}`"));
    let Some(range) = memories.buffer(plan, part.resource) else {
        let resource = &plan.resources[part.resource.index()].name;
        return Err(subject.error("execute::unreadable-output", format!("`{resource}` is no buffer")));
    };
    let (buffer, errors) = catch(&gpu.device, || {
        let buffer = read_buffer(gpu, range.size);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read back") });
        encoder.copy_buffer_to_buffer(&range.buffer, range.offset, &buffer, 0, range.size);
        gpu.queue.submit([encoder.finish()]);
        buffer
    });
    subject.check(&errors)?;
    map(gpu, &buffer, range.size)
}

fn read_buffer(gpu: &Gpu, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    })
}

/// Waits for the GPU and copies a mappable buffer's first bytes.
pub(crate) fn map(gpu: &Gpu, buffer: &wgpu::Buffer, bytes: u64) -> Result<Vec<u8>, Diagnostic> {
    let failed = |why: String| Diagnostic::error("execute::readback", format!("results can't be read back: {why}"));
    let (sender, receiver) = std::sync::mpsc::channel();
    let slice = buffer.slice(..bytes);
    slice.map_async(wgpu::MapMode::Read, move |result| {
        // The receiver lives until the end of this function; a later answer interests nobody.
        let _ = sender.send(result);
    });
    gpu.wait()?;
    match receiver.try_recv() {
        Ok(Ok(())) => {}
        Ok(Err(error)) => return Err(failed(error.to_string())),
        Err(_) => return Err(failed("the device did not answer".to_owned())),
    }
    let content = slice.get_mapped_range().map(|view| view.to_vec()).map_err(|error| failed(error.to_string()));
    buffer.unmap();
    content
}
