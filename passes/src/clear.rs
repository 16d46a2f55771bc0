//! The pass kind Clear, and the clears that other passes need first.
//!
//! A flat texture that can be drawn into is cleared by attaching it; another one gets its bytes from a filled buffer, one row
//! of slices for all clears of the same size and value, made before the first frame. Buffers can only be zeroed.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::expand::types::{ClearValue, Dimension};
use luminaire_graph::plan::{PartView, Plan};
use luminaire_graph::reflect::interface::ViewDimension;

use crate::convert;
use crate::device::Gpu;
use crate::errors::Subject;
use crate::kept::Kept;
use crate::store::Store;
use crate::targets::{ClearTo, clear_view};
use crate::texel;
use crate::textures::{BufferRange, clears_by_attachment};

/// A clear that is ready to run.
#[derive(Debug)]
pub(crate) enum ClearStep {
    /// Each view is attached once.
    Attach { views: Vec<wgpu::TextureView>, value: ClearTo },
    /// Slices are copied from filled buffers.
    Copy { texture: wgpu::Texture, slices: Vec<Slices> },
    /// Bytes are zeroed.
    Zero(BufferRange),
}

/// The slices (layers, or depth of a volume) of one mip level.
#[derive(Debug)]
pub(crate) struct Slices {
    fill: Fill,
    mip: u32,
    slices: std::ops::Range<u32>,
    width: u32,
    height: u32,
}

/// A buffer that holds one slice of equal texels.
#[derive(Debug, Clone)]
struct Fill {
    buffer: wgpu::Buffer,
    bytes_per_row: u32,
}

/// The filled buffers of a plan and the one before, by texel, width and height.
#[derive(Debug, Default)]
pub(crate) struct Fills {
    made: Kept<(Vec<u8>, u32, u32), Fill>,
}

impl Fills {
    /// A buffer of equal texels, without gaps if a row is a multiple of what copies need.
    pub(crate) fn buffer(&mut self, gpu: &Gpu, texel: &[u8], width: u32, height: u32) -> wgpu::Buffer {
        self.get(gpu, texel, width, height).buffer
    }

    fn get(&mut self, gpu: &Gpu, texel: &[u8], width: u32, height: u32) -> Fill {
        let key = (texel.to_vec(), width, height);
        if let Some(made) = self.made.get(&key) {
            return made;
        }
        let made = fill(gpu, texel, width, height);
        self.made.insert(key, made.clone());
        made
    }

    /// For the next plan.
    pub(crate) fn successor(&self) -> Fills {
        Fills { made: self.made.successor() }
    }
}

impl ClearStep {
    /// Runs in the caller's error scope.
    pub(crate) fn prepare(
        store: &mut Store,
        plan: &Plan,
        subject: &Subject,
        part: &PartView,
        value: ClearValue,
    ) -> Result<ClearStep, Diagnostic> {
        if let Some(range) = store.memories.buffer(plan, part.resource) {
            return match value {
                ClearValue::Zero => Ok(ClearStep::Zero(range)),
                _ => Err(subject.error("execute::clear-value", "a buffer can only be cleared to `Zero`")),
            };
        }
        let Some((texture, shape, format)) = store.memories.texture(plan, part.resource) else {
            let name = &plan.resources[part.resource.index()].name;
            return Err(subject.error("execute::no-texture", format!("`{name}` lives nowhere and can't be cleared")));
        };
        if clears_by_attachment(shape, format) {
            let value = if format.is_depth() {
                ClearTo::Depth(convert::clear_depth(value, format))
            } else {
                ClearTo::Color(convert::clear_color(value, format))
            };
            let mut views = Vec::new();
            for (mip, layer) in part.mips.clone().flat_map(|mip| part.layers.clone().map(move |layer| (mip, layer))) {
                let one = PartView { resource: part.resource, mips: mip..mip + 1, layers: layer..layer + 1, dimension: ViewDimension::D2 };
                views.extend(store.memories.view(plan, &one));
            }
            return Ok(ClearStep::Attach { views, value });
        }
        let texture = texture.clone();
        let texel = texel::encode(format, convert::clear_components(value, format));
        let mut slices = Vec::new();
        for mip in part.mips.clone() {
            let [width, height, depth] = convert::mip_size(shape, mip);
            let range = if shape.dimension == Dimension::D3 { 0..depth } else { part.layers.clone() };
            slices.push(Slices { fill: store.fills.get(&store.gpu, &texel, width, height), mip, slices: range, width, height });
        }
        Ok(ClearStep::Copy { texture, slices })
    }

    pub(crate) fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
        match self {
            ClearStep::Attach { views, value } => {
                for view in views {
                    clear_view(encoder, view, *value);
                }
            }
            ClearStep::Copy { texture, slices } => {
                for level in slices {
                    let layout = wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(level.fill.bytes_per_row),
                        rows_per_image: Some(level.height),
                    };
                    for slice in level.slices.clone() {
                        let origin = wgpu::Origin3d { x: 0, y: 0, z: slice };
                        encoder.copy_buffer_to_texture(
                            wgpu::TexelCopyBufferInfo { buffer: &level.fill.buffer, layout },
                            wgpu::TexelCopyTextureInfo { texture, mip_level: level.mip, origin, aspect: wgpu::TextureAspect::All },
                            wgpu::Extent3d { width: level.width, height: level.height, depth_or_array_layers: 1 },
                        );
                    }
                }
            }
            ClearStep::Zero(range) => encoder.clear_buffer(&range.buffer, range.offset, Some(range.size)),
        }
    }
}

/// The texel's bytes, at the pitch that copies need. Textures were checked against the device's limits, so that a slice fits
/// in memory.
fn fill(gpu: &Gpu, texel: &[u8], width: u32, height: u32) -> Fill {
    let row_bytes = width as usize * texel.len();
    let pitch = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
    let mut row = texel.repeat(width as usize);
    row.resize(pitch, 0);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("fill"),
        size: pitch as u64 * u64::from(height),
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    // New buffers are zero.
    if texel.iter().any(|byte| *byte != 0) {
        gpu.queue.write_buffer(&buffer, 0, &row.repeat(height as usize));
    }
    Fill { buffer, bytes_per_row: pitch as u32 }
}
