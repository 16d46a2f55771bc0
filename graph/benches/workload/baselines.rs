//! Planners as they are commonly written, to compare with: names in hash maps, edges, culling, the declared order, and then memory
//! in one of four ways. Placing ones put everything transient in one heap.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};

use super::declared::{Declared, DeclaredResource, UNIT};

/// How a baseline gives out memory.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Baseline {
    /// A free memory of exactly the same descriptor, or a new one.
    ExactGreedy,
    /// In the order of first use, the lowest bytes that are free all the time.
    ActivationFirstFit,
    /// The same from the longest in use to the shortest.
    LifetimeFirstFit,
    /// From the largest to the smallest, the tightest hole.
    SizeBestFit,
}

pub const BASELINES: [(Baseline, &str); 4] = [
    (Baseline::ExactGreedy, "exact greedy"),
    (Baseline::ActivationFirstFit, "activation first-fit"),
    (Baseline::LifetimeFirstFit, "lifetime first-fit"),
    (Baseline::SizeBestFit, "size best-fit"),
];

/// A finished plan. Benchmarks look at the memories alone.
#[allow(dead_code)]
pub struct BaselinePlan {
    pub order: Vec<usize>,
    /// By resource: memory and first byte.
    pub places: Vec<Option<(usize, u64)>>,
    /// Bytes of each memory.
    pub memories: Vec<u64>,
}

/// When a resource is in use: first and last step.
type Life = (usize, usize);

/// From declarations to a plan.
pub fn plan(declared: &Declared, baseline: Baseline) -> BaselinePlan {
    let ids: HashMap<&str, usize> = declared.resources.iter().enumerate().map(|(index, it)| (it.name.as_str(), index)).collect();
    let resolve = |names: &[String]| names.iter().map(|name| ids[name.as_str()]).collect::<Vec<usize>>();
    let outputs: HashSet<usize> = resolve(&declared.outputs).into_iter().collect();
    let order = order(declared, &resolve, &outputs);
    let mut lives: Vec<Option<Life>> = vec![None; declared.resources.len()];
    for (step, pass) in order.iter().enumerate() {
        let pass = &declared.passes[*pass];
        for resource in resolve(&pass.reads).into_iter().chain(resolve(&pass.writes)).chain(resolve(&pass.modifies)) {
            if !outputs.contains(&resource) {
                lives[resource] = Some((lives[resource].map_or(step, |life| life.0), step));
            }
        }
    }
    let mut wanted: Vec<(usize, Life)> = lives.iter().enumerate().filter_map(|(index, life)| Some((index, (*life)?))).collect();
    let bytes = |index: usize| declared.resources[index].bytes;
    match baseline {
        Baseline::ExactGreedy | Baseline::ActivationFirstFit => wanted.sort_by_key(|(_, life)| life.0),
        Baseline::LifetimeFirstFit => wanted.sort_by_key(|(index, life)| (Reverse(life.1 - life.0), Reverse(bytes(*index)), life.0)),
        Baseline::SizeBestFit => wanted.sort_by_key(|(index, life)| (Reverse(bytes(*index)), Reverse(life.1 - life.0), life.0)),
    }
    let mut places = vec![None; declared.resources.len()];
    let memories = match baseline {
        Baseline::ExactGreedy => exact(declared, &wanted, &mut places),
        _ => vec![heap(declared, &wanted, baseline == Baseline::SizeBestFit, order.len(), &mut places)],
    };
    BaselinePlan { order, places, memories }
}

/// The passes that outputs need; of those that are ready always the one that is declared first.
fn order(declared: &Declared, resolve: &dyn Fn(&[String]) -> Vec<usize>, outputs: &HashSet<usize>) -> Vec<usize> {
    let count = declared.passes.len();
    let (mut sources, mut needs) = (vec![Vec::new(); count], vec![HashSet::new(); count]);
    let (mut writers, mut readers) = (vec![Vec::new(); declared.resources.len()], vec![Vec::new(); declared.resources.len()]);
    let mut open = Vec::new();
    for (index, pass) in declared.passes.iter().enumerate() {
        for resource in resolve(&pass.reads) {
            sources[index].extend(&writers[resource]);
            readers[resource].push(index);
        }
        for resource in resolve(&pass.modifies) {
            sources[index].extend(&writers[resource]);
            needs[index].extend(readers[resource].drain(..));
            writers[resource].push(index);
        }
        for resource in resolve(&pass.writes) {
            needs[index].extend(readers[resource].drain(..));
            needs[index].extend(writers[resource].drain(..));
            writers[resource].push(index);
        }
        needs[index].extend(&sources[index]);
        if resolve(&pass.writes).iter().chain(&resolve(&pass.modifies)).any(|resource| outputs.contains(resource)) {
            open.push(index);
        }
    }
    let mut alive = vec![false; count];
    while let Some(pass) = open.pop() {
        if !std::mem::replace(&mut alive[pass], true) {
            open.extend(&sources[pass]);
        }
    }
    let mut waits = vec![0usize; count];
    let mut later = vec![Vec::new(); count];
    for pass in (0..count).filter(|pass| alive[*pass]) {
        for need in needs[pass].iter().filter(|need| alive[**need] && **need != pass) {
            waits[pass] += 1;
            later[*need].push(pass);
        }
    }
    let mut ready: BinaryHeap<Reverse<usize>> = (0..count).filter(|pass| alive[*pass] && waits[*pass] == 0).map(Reverse).collect();
    let mut order = Vec::new();
    while let Some(Reverse(pass)) = ready.pop() {
        order.push(pass);
        for next in &later[pass] {
            waits[*next] -= 1;
            if waits[*next] == 0 {
                ready.push(Reverse(*next));
            }
        }
    }
    order
}

/// Format, extent, mips and layers.
type Descriptor<'a> = (&'a str, [u32; 3], u32, u32);

fn exact(declared: &Declared, wanted: &[(usize, Life)], places: &mut [Option<(usize, u64)>]) -> Vec<u64> {
    let mut memories = Vec::new();
    // By descriptor: memories with the last step of their users.
    let mut pools: HashMap<Descriptor<'_>, Vec<(usize, usize)>> = HashMap::new();
    for (index, life) in wanted {
        let DeclaredResource { format, extent, mips, layers, bytes, .. } = &declared.resources[*index];
        let pool = pools.entry((format, *extent, *mips, *layers)).or_default();
        let slot = pool.iter().position(|(_, last)| *last < life.0).unwrap_or_else(|| {
            memories.push(*bytes);
            pool.push((memories.len() - 1, 0));
            pool.len() - 1
        });
        pool[slot].1 = life.1;
        places[*index] = Some((pool[slot].0, 0));
    }
    memories
}

/// Steps of a block: neighbours in time are looked for block by block.
const BLOCK: usize = 16;

fn heap(declared: &Declared, wanted: &[(usize, Life)], best: bool, steps: usize, places: &mut [Option<(usize, u64)>]) -> u64 {
    let mut blocks: Vec<Vec<(u64, u64, Life)>> = vec![Vec::new(); steps.div_ceil(BLOCK)];
    let mut size = 0;
    let mut near = Vec::new();
    for (index, life) in wanted {
        let bytes = declared.resources[*index].bytes.next_multiple_of(UNIT);
        near.clear();
        for block in &blocks[life.0 / BLOCK..=life.1 / BLOCK] {
            near.extend(block.iter().filter(|(.., other)| other.0 <= life.1 && life.0 <= other.1).map(|(start, end, _)| (*start, *end)));
        }
        near.sort_unstable();
        let (mut top, mut found) = (0, None);
        for (start, end) in &near {
            if *start >= top + bytes {
                let waste = start - top - bytes;
                if found.is_none_or(|(least, _)| best && waste < least) {
                    found = Some((waste, top));
                }
            }
            top = top.max(*end);
        }
        let offset = found.map_or(top, |(_, offset)| offset);
        for block in &mut blocks[life.0 / BLOCK..=life.1 / BLOCK] {
            block.push((offset, offset + bytes, *life));
        }
        places[*index] = Some((0, offset));
        size = size.max(offset + bytes);
    }
    size
}
