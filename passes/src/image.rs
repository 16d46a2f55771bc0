//! The generated kind Image: what a file says, copied into its texture from a buffer that is filled once.
//!
//! Accepted: the buffer stays as long as the step, so that the texture can be filled again where its memory served another resource.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::plan::{PartView, Plan};
use luminaire_graph::source::LoadedImage;

use crate::errors::Subject;
use crate::store::Store;
use crate::texel;

/// An Image that is ready to run.
#[derive(Debug)]
pub(crate) struct ImageStep {
    buffer: wgpu::Buffer,
    bytes_per_row: u32,
    texture: wgpu::Texture,
    size: wgpu::Extent3d,
}

impl ImageStep {
    /// Runs in the caller's error scope.
    pub(crate) fn prepare(
        store: &Store,
        plan: &Plan,
        subject: &Subject,
        part: &PartView,
        image: &LoadedImage,
    ) -> Result<ImageStep, Diagnostic> {
        let Some((texture, shape, format)) = store.memories.texture(plan, part.resource) else {
            let name = &plan.resources[part.resource.index()].name;
            return Err(subject.error("execute::no-texture", format!("`{name}` lives nowhere and can't be filled")));
        };
        let row_bytes = shape.width as usize * format.info().texel_bytes as usize;
        let pitch = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
        let mut bytes = Vec::with_capacity(pitch * shape.height as usize);
        for row in image.texels.chunks(shape.width.max(1) as usize) {
            bytes.extend(row.iter().flat_map(|texel| texel::encode(format, texel.map(f64::from))));
            bytes.resize(bytes.len().next_multiple_of(pitch.max(1)), 0);
        }
        bytes.resize(pitch * shape.height as usize, 0);
        let buffer = store.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(&image.name),
            size: bytes.len() as u64,
            usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        store.gpu.queue.write_buffer(&buffer, 0, &bytes);
        let size = wgpu::Extent3d { width: shape.width, height: shape.height, depth_or_array_layers: 1 };
        Ok(ImageStep { buffer, bytes_per_row: pitch as u32, texture: texture.clone(), size })
    }

    pub(crate) fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(self.bytes_per_row), rows_per_image: None };
        encoder.copy_buffer_to_texture(wgpu::TexelCopyBufferInfo { buffer: &self.buffer, layout }, self.texture.as_image_copy(), self.size);
    }
}
