//! An order and byte offsets for memory in which resources can be placed: one heap, for a backend that has such.
//!
//! The executor's order is chosen for what it allocates, whole textures and arenas. This one is chosen for the largest sum of
//! live bytes, which no placement can go below, and then everything transient is packed by time and bytes. Nothing that runs
//! depends on it, so it is computed when somebody asks: dumps and statistics do, a recompilation does not.
//!
//! Orders: from the declared order two sweeps ([`crate::schedule::sweep`]); for up to 64 passes also a search over sets of passes
//! ([`search`]), which finds the best of all orders if its budget lasts. Offsets: [`pack`]. If the declared order takes fewer
//! bytes it is taken instead. The cost grows almost linearly; what it promises is no more than that.

mod pack;
mod search;

use crate::allocate::extent::ARENA_ALIGNMENT;
use crate::allocate::model::Pool;
use crate::expand::types::{PassId, ResourceId};
use crate::plan::Plan;
use crate::schedule::Schedule;
use crate::schedule::flow::Flow;
use crate::schedule::sweep::sink_and_hoist;

/// Of what the offsets are multiples; sizes are rounded up to the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Alignment {
    /// Textures: what drivers ask of them in heaps, 64 KiB.
    pub texture: u64,
    /// Buffers: WebGPU's default for bindings, 256, of which it is a multiple.
    pub buffer: u64,
}

impl Default for Alignment {
    fn default() -> Alignment {
        Alignment { texture: 64 << 10, buffer: ARENA_ALIGNMENT }
    }
}

/// All transient resources in one heap.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct HeapPlan {
    /// The passes that run, in the order in which the offsets hold.
    pub order: Vec<PassId>,
    /// Each transient resource with its first byte, by resource.
    pub offsets: Vec<(ResourceId, u64)>,
    /// Bytes of the heap.
    pub bytes: u64,
    /// The largest sum of live bytes at any pass of the order, in rounded sizes: no placement in this order takes less.
    pub bound: u64,
    /// The same for the declared order.
    pub declared_bound: u64,
}

impl Plan {
    /// The largest sum of live bytes at any pass of the declared order, as [`crate::plan::MemoryFigures::bound`] is of the chosen one.
    pub fn declared_bound(&self) -> u64 {
        self.flow.peak(&self.flow.declared, &self.flow.bytes)
    }

    /// What the transient resources would take if they could be placed by byte.
    pub fn placed(&self) -> HeapPlan {
        place(&self.flow, Alignment::default())
    }
}

impl Schedule {
    /// Places the transient resources of the passes that run.
    pub fn placed(&self, alignment: Alignment) -> HeapPlan {
        place(&self.flow, alignment)
    }
}

fn place(flow: &Flow, alignment: Alignment) -> HeapPlan {
    let units = |pool: &Pool| if *pool == Pool::Buffer { alignment.buffer } else { alignment.texture }.max(1);
    let units: Vec<u64> = flow.pools.iter().map(units).collect();
    let rounded: Vec<u64> =
        flow.bytes.iter().zip(&units).map(|(bytes, unit)| bytes.checked_next_multiple_of(*unit).unwrap_or(u64::MAX)).collect();
    let declared_bound = flow.peak(&flow.declared, &rounded);
    let (mut order, mut bound) = (flow.declared.clone(), declared_bound);
    let mut consider = |candidate: Vec<u32>| {
        let peak = flow.peak(&candidate, &rounded);
        if peak < bound {
            (order, bound) = (candidate, peak);
        }
    };
    consider(sink_and_hoist(flow, &rounded, &flow.declared));
    if let Some(found) = search::best_order(flow, &rounded, bound) {
        (order, bound) = found;
    }
    let mut packed = pack::pack(flow, &rounded, &units, &order, bound);
    if packed.bytes > declared_bound && order != flow.declared {
        let other = pack::pack(flow, &rounded, &units, &flow.declared, declared_bound);
        if other.bytes < packed.bytes {
            (packed, order, bound) = (other, flow.declared.clone(), declared_bound);
        }
    }
    let mut offsets: Vec<(ResourceId, u64)> = flow.resources.iter().copied().zip(packed.offsets).collect();
    offsets.sort_unstable();
    HeapPlan { order: flow.passes_of(&order), offsets, bytes: packed.bytes, bound, declared_bound }
}
