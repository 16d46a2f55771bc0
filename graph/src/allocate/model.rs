//! What memory planning needs to know of a pipeline, in flat tables that hold for every order of its passes.

use std::collections::{BTreeMap, HashMap};

use super::extent::{charged_bytes, format_of, resource_bytes};
use crate::bind::types::Bound;
use crate::expand::types::{ResourceId, Shape, TextureShape};
use crate::format::Format;
use crate::lifetime::Touches;
use crate::mixer::BuildMixer;
use crate::plan::{Access, Retained, Usage};
use crate::schedule::{Touch, Uses};

/// Everything of a texture's descriptor but usage and name: equal keys can share. One list of numbers, which is hashed fast.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Descriptor([u32; 8]);

impl Descriptor {
    /// The descriptor of a texture.
    pub(crate) fn of(shape: &TextureShape, format: Format) -> Descriptor {
        let TextureShape { dimension, width, height, depth, layers, mips, samples, .. } = *shape;
        Descriptor([dimension as u32, format.number(), width, height, depth, layers, mips, samples])
    }
}

/// Which pool a resource draws from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pool {
    /// Textures of one descriptor, by index into [`Model::descriptors`].
    Texture(u32),
    /// Arenas.
    Buffer,
}

/// The tables.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// By resource.
    pub(crate) pools: Vec<Pool>,
    /// By resource: tight bytes, if 64 bits can count them.
    pub(crate) tight: Vec<Option<u64>>,
    /// By resource: what it is charged for; saturated where it does not fit.
    pub(crate) charged: Vec<u64>,
    /// By resource.
    pub(crate) retained: Vec<bool>,
    /// By resource: what the uses of passes that run do to it.
    pub(crate) usages: Vec<Usage>,
    /// By descriptor: bytes of a texture.
    pub(crate) descriptors: Vec<u64>,
    /// For each buffer the buffers that it must not share an arena with, by id.
    pub(crate) conflicts: BTreeMap<u32, Vec<u32>>,
    /// By pass: resources.
    pub(crate) touches: Touches,
}

impl Model {
    /// Reads a pipeline. `alive` tells for each pass whether it runs.
    pub(crate) fn new(bound: &Bound, uses: &Uses, retained: &[Option<Retained>], alive: &[bool]) -> Model {
        // Looked up and never walked, so its order does not matter.
        let mut known: HashMap<Descriptor, u32, BuildMixer> = HashMap::default();
        let mut descriptors = Vec::new();
        let count = bound.expanded.resources.len();
        let (mut pools, mut tight, mut charged) = (Vec::with_capacity(count), Vec::with_capacity(count), Vec::with_capacity(count));
        for (index, resource) in bound.expanded.resources.iter().enumerate() {
            let format = format_of(bound, ResourceId(index as u32));
            let own = resource_bytes(resource, format);
            let bytes = own.and_then(|own| charged_bytes(resource, own)).unwrap_or(u64::MAX);
            tight.push(own);
            charged.push(bytes);
            pools.push(match (&resource.shape, format) {
                (Shape::Texture(shape), Some(format)) => Pool::Texture(*known.entry(Descriptor::of(shape, format)).or_insert_with(|| {
                    descriptors.push(bytes);
                    descriptors.len() as u32 - 1
                })),
                _ => Pool::Buffer,
            });
        }
        let mut conflicts = BTreeMap::new();
        let mut usages = vec![Usage::default(); count];
        for pass in (0..bound.steps.len()).filter(|pass| alive[*pass]) {
            enter_conflicts(uses.of_pass(pass), &pools, &mut conflicts);
            for touch in uses.of_pass(pass) {
                if let Some(usage) = usages.get_mut(touch.resource.index()) {
                    *usage = usage.union(touch.access.usage());
                }
            }
        }
        for others in conflicts.values_mut() {
            others.sort_unstable();
            others.dedup();
        }
        Model {
            pools,
            tight,
            charged,
            retained: retained.iter().map(Option::is_some).collect(),
            usages,
            descriptors,
            conflicts,
            touches: Touches::new(bound, uses),
        }
    }

    /// Whether a resource takes part in sharing.
    pub(crate) fn is_transient(&self, resource: usize) -> bool {
        !self.retained[resource]
    }
}

/// What the driver tracks a buffer as during a pass. Storage that is declared `read_write` is one usage, written or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Tracked {
    Uniform,
    StorageRead,
    StorageWrite,
    CopySource,
    CopyTarget,
    Indirect,
    Texture,
}

impl Tracked {
    /// The usage behind an access.
    pub(crate) fn of(access: Access) -> Tracked {
        match access {
            Access::Uniform => Tracked::Uniform,
            Access::StorageRead => Tracked::StorageRead,
            Access::StorageWrite | Access::StorageReadWrite => Tracked::StorageWrite,
            Access::CopySource => Tracked::CopySource,
            Access::CopyTarget | Access::Clear => Tracked::CopyTarget,
            Access::Indirect => Tracked::Indirect,
            Access::Sampled | Access::ColorAttachment | Access::DepthAttachment | Access::DepthReadOnly => Tracked::Texture,
        }
    }
}

fn enter_conflicts(uses: &[Touch], pools: &[Pool], conflicts: &mut BTreeMap<u32, Vec<u32>>) {
    let is_buffer = |resource: ResourceId| pools.get(resource.index()) == Some(&Pool::Buffer);
    let buffers: Vec<(Tracked, u32)> =
        uses.iter().filter(|used| is_buffer(used.resource)).map(|used| (Tracked::of(used.access), used.resource.0)).collect();
    for (tracked, buffer) in &buffers {
        for (other_tracked, other) in &buffers {
            if tracked != other_tracked && buffer != other {
                conflicts.entry(*buffer).or_default().push(*other);
            }
        }
    }
}
