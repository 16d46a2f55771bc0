//! Poison for tests: what memories hold before anything that the plan wants is in them.
//!
//! Floats become NaN, or huge where a format has none; normalised colors magenta; depth 0.375, which is neither near nor far;
//! integers and buffers all ones. wgpu hands out zeroed memory, which looks right too often.
//!
//! Accepted downside: poisoned memories are made for more uses than the plan asks for, and frames take more copies.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::expand::types::{ClearValue, ResourceId};
use luminaire_graph::format::{Format, SampleKind};
use luminaire_graph::plan::{PartView, Plan, PlannedShape};
use luminaire_graph::reflect::interface::ViewDimension;

use crate::clear::ClearStep;
use crate::errors::Subject;
use crate::store::Store;
use crate::textures::BufferRange;

/// Rows and columns of the words that buffers are filled from.
const WORDS: [u32; 2] = [64, 256];

/// Fills a resource. Runs in the caller's error scope.
pub(crate) fn encode(store: &mut Store, encoder: &mut wgpu::CommandEncoder, plan: &Plan, resource: ResourceId) -> Result<(), Diagnostic> {
    let planned = &plan.resources[resource.index()];
    if let Some(BufferRange { buffer, offset, size }) = store.memories.buffer(plan, resource) {
        let [width, height] = WORDS;
        let words = store.fills.buffer(&store.gpu, &[0xff; 4], width, height);
        for start in (0..size).step_by(words.size() as usize) {
            encoder.copy_buffer_to_buffer(&words, 0, &buffer, offset + start, words.size().min(size - start));
        }
        return Ok(());
    }
    let PlannedShape::Texture(shape, format) = &planned.shape else { return Ok(()) };
    let subject = Subject::nowhere(format!("the poison of `{}`", planned.name));
    let whole = PartView { resource, mips: 0..shape.mips, layers: 0..shape.layers, dimension: ViewDimension::D2 };
    ClearStep::prepare(store, plan, &subject, &whole, value(*format))?.encode(encoder);
    Ok(())
}

fn value(format: Format) -> ClearValue {
    let info = format.info();
    match info.sample {
        SampleKind::Depth => ClearValue::Depth(0.375),
        SampleKind::Sint => ClearValue::Uint([u32::MAX; 4]),
        SampleKind::Uint if format.name() == "rgb10a2uint" => ClearValue::Uint([1023, 1023, 1023, 3]),
        SampleKind::Uint => ClearValue::Uint([u32::MAX >> (32 - 8 * info.texel_bytes / info.components.max(1)).min(31); 4]),
        SampleKind::Float | SampleKind::UnfilterableFloat => match format.name() {
            "rg11b10ufloat" | "rgb9e5ufloat" => ClearValue::Color([60_000.0; 4]),
            name if name.ends_with("float") => ClearValue::Color([f64::NAN; 4]),
            _ => ClearValue::Color([1.0, 0.0, 1.0, 1.0]),
        },
    }
}
