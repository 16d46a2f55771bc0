//! What passes make of what they see, and what else makes them the passes that they are. The interpreter and the simulated device
//! agree in nothing but this.

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};

use luminaire_graph::expand::types::Run;

use super::spec::{INPUTS, Part, PassSpec, Spec};

/// The declared value.
pub const DECLARED: u64 = 1;
/// The first value of histories.
pub const FIRST: u64 = 2;

pub fn hash(parts: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    parts.hash(&mut hasher);
    hasher.finish()
}

/// A pass, or one iteration of a batched one.
pub type Node = (usize, Option<u32>);

/// What a node makes of what it sees; both the interpreter and the simulation compute it.
#[allow(clippy::too_many_arguments, reason = "all that a value depends on")]
pub fn made(
    pass: &PassSpec,
    iteration: Option<u32>,
    accumulated: u32,
    frame: u64,
    revisions: &[u64],
    reads: &[u64],
    layer: u32,
    old: u64,
    ground: u64,
) -> u64 {
    // Whoever runs unasked makes something new each time.
    let frame = if pass.run == Run::OnChange { 0 } else { frame };
    let mut inputs: Vec<u64> = pass.inputs.iter().map(|input| revisions[*input as usize]).collect();
    inputs.extend(iteration.map(|iteration| revisions[(iteration % INPUTS) as usize]));
    hash((&pass.name, pass.salt, iteration, accumulated, frame, inputs, reads, layer, old, ground))
}

/// The shapes of all that a pass touches.
fn shapes(spec: &Spec, pass: &PassSpec) -> u64 {
    let shape = |part: &Part| {
        let resource = &spec.resources[part.resource];
        (resource.name.clone(), resource.edge, resource.layers, resource.buffer, resource.clear, part.layer)
    };
    hash(pass.reads.iter().chain(&pass.writes).chain(&pass.modifies).map(shape).collect::<Vec<_>>())
}

/// A value where only a part of the old one has a place.
pub fn cropped(old: u64) -> u64 {
    hash(("cropped", old))
}

/// What a node stands on: the shapes that it touches, and who makes what it sees. Two makers may leave the same by chance, as one that
/// has not run yet and none at all do; what is made from it is not the same.
pub fn ground(spec: &Spec, alive: &BTreeSet<String>, node: Node) -> u64 {
    let pass = &spec.passes[node.0];
    let mut makers = Vec::new();
    for part in pass.reads.iter().filter(|part| part.version.is_none()) {
        makers.extend(layers(spec, part, None).into_iter().map(|layer| maker(spec, alive, part.resource, layer, None)));
    }
    for part in &pass.modifies {
        makers.extend(layers(spec, part, node.1).into_iter().map(|layer| maker(spec, alive, part.resource, layer, Some(node.0))));
    }
    // Who remembers is another where others leave what is remembered.
    if let Some(of) = pass.remembers {
        makers.extend((0..spec.resources[of].layers).map(|layer| maker(spec, alive, of, layer, None)));
    }
    hash((shapes(spec, pass), makers))
}

/// Who leaves the last value of a cell, or the one before this pass.
fn maker(spec: &Spec, alive: &BTreeSet<String>, resource: usize, layer: u32, before: Option<usize>) -> Option<(String, u32)> {
    let writes = |parts: &[Part], batch: u32| {
        parts.iter().any(|part| part.resource == resource && (batch > 0 || part.layer.is_none_or(|own| own == layer)))
    };
    let passes = || spec.passes.iter().enumerate().filter(|(_, pass)| alive.contains(&pass.name));
    let producers = passes().filter(|(_, pass)| writes(&pass.writes, pass.batch));
    let chain: Vec<(usize, &PassSpec)> = producers.chain(passes().filter(|(_, pass)| writes(&pass.modifies, 0))).collect();
    let end = before.map_or(chain.len(), |before| chain.iter().position(|(index, _)| *index == before).unwrap_or(chain.len()));
    let (_, pass) = chain[..end].last()?;
    Some((pass.name.clone(), if pass.batch > 0 { layer } else { 0 }))
}

/// The layers of a part, or of an iteration's.
pub fn layers(spec: &Spec, part: &Part, iteration: Option<u32>) -> Vec<u32> {
    match part.layer.or(iteration) {
        Some(layer) => vec![layer],
        None => (0..spec.resources[part.resource].layers).collect(),
    }
}

/// What a reader of a part notices: a history is remembered whole.
pub fn noticed(spec: &Spec, part: &Part) -> Part {
    let whole = spec.resources[part.resource].history.is_some();
    Part { layer: part.layer.filter(|_| !whole), ..*part }
}
