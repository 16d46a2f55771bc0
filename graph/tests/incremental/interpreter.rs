//! What a pipeline means, told in the simplest way: every frame evaluates everything by plain recursion, no memory is shared, and
//! nothing is known of plans, orders or revisions. Only the rules of Accumulate and Spread are kept, by comparing values.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use luminaire_graph::expand::types::{OnResize, Run};

use super::spec::{INPUTS, Part, PassSpec, Spec};
use super::value::{DECLARED, FIRST, Node, cropped, ground, hash, layers, made, noticed};

type Shape = (u32, u32, bool);

/// A node by name, and what it sees: a cell by place among its parts, or all that comes from outside of the graph.
type Sight = (String, Option<u32>, Option<(usize, u32)>);

/// What outlasts a frame.
#[derive(Debug, Clone, Default)]
pub struct Interpreter {
    pub frames: u64,
    /// What amortised passes left, by resource and layer.
    kept: HashMap<(String, u32), u64>,
    gathered: HashMap<String, u32>,
    turns: BTreeMap<(u32, u32), (u32, u64)>,
    /// What each node saw.
    seen: HashMap<Sight, u64>,
    past: HashMap<String, (Shape, Vec<u64>)>,
}

/// A frame as it should be.
pub struct Meaning {
    values: HashMap<(usize, u32, Option<usize>), u64>,
    befores: HashMap<(usize, u32, usize), u64>,
    next: Interpreter,
    /// Amortised nodes that run, with the number of the run.
    pub amortised: BTreeMap<Node, u32>,
}

impl Meaning {
    /// The value of a cell, as a pass left it or in the end.
    pub fn at(&self, resource: usize, layer: u32, version: Option<usize>) -> Option<u64> {
        self.values.get(&(resource, layer, version)).copied()
    }
}

impl Interpreter {
    /// The device is lost.
    pub fn lose(&mut self) {
        *self = Interpreter { frames: self.frames, ..Interpreter::default() };
    }

    /// The content of these resources is lost, and of `past` what they held in the frame before.
    pub fn forget(&mut self, spec: &Spec, resources: &BTreeSet<String>, past: &BTreeSet<String>) {
        for name in past {
            self.past.remove(name);
        }
        for pass in spec.passes.iter().filter(|pass| !matches!(pass.run, Run::OnChange | Run::EveryFrame)) {
            if pass.writes.iter().chain(&pass.modifies).any(|part| resources.contains(&spec.resources[part.resource].name)) {
                self.seen.retain(|(name, ..), _| *name != pass.name);
            }
        }
        self.kept.retain(|(name, _), _| !resources.contains(name));
    }

    /// Passes that stand no more are forgotten.
    pub fn keep_only(&mut self, spec: &Spec, alive: &BTreeSet<String>) {
        let standing = |key: &(u32, u32)| {
            spec.passes.iter().filter(|pass| alive.contains(&pass.name)).any(|pass| match pass.run {
                Run::Spread { spread, iteration } => spread == key.0 && (pass.batch > 0 || iteration == key.1),
                _ => false,
            })
        };
        self.turns.retain(|key, _| standing(key));
        self.seen.retain(|(name, ..), _| alive.contains(name));
        self.gathered.retain(|name, _| alive.contains(name));
        self.past.retain(|name, _| alive.contains(&format!("previous({name})")));
        // So is what they left.
        let makes = |pass: &PassSpec, name: &str, layer: u32| {
            let mut parts = pass.writes.iter().chain(&pass.modifies);
            parts.any(|part| spec.resources[part.resource].name == name && part.layer.is_none_or(|own| own == layer))
        };
        self.kept.retain(|(name, layer), _| spec.passes.iter().any(|pass| alive.contains(&pass.name) && makes(pass, name, *layer)));
    }

    pub fn submitted(&mut self, meaning: Meaning) {
        *self = meaning.next;
    }

    /// Evaluates a frame in which the passes `alive` stand.
    pub fn frame(&self, spec: &Spec, alive: &BTreeSet<String>, revisions: &[u64]) -> Meaning {
        let graph = Graph::new(spec, alive);
        let mut runs: BTreeMap<Node, u32> = BTreeMap::new();
        let mut restarted: BTreeSet<Node> = BTreeSet::new();
        for node in graph.amortised() {
            let name = &spec.passes[node.0].name;
            if let Run::Accumulate(count) = spec.passes[node.0].run {
                let gathered = self.gathered.get(name).copied().unwrap_or(0);
                if gathered < count {
                    runs.insert(node, gathered);
                }
            }
        }
        let mut turns = self.turns.clone();
        self.restart(&graph, revisions, &mut runs, &mut restarted);
        for spread in 0..spec.spreads.len() as u32 {
            for node in &restarted {
                call(&mut turns, spec, *node, self.frames);
            }
            let mut waiting: Vec<(u64, u32)> = Vec::new();
            for ((own, iteration), (remaining, since)) in &turns {
                if *own == spread && *remaining > 0 {
                    waiting.push((*since, *iteration));
                }
            }
            waiting.sort_unstable();
            for (_, iteration) in waiting.into_iter().take(spec.spreads[spread as usize].0 as usize) {
                for node in graph.amortised().filter(|node| turn_of(spec, *node) == Some((spread, iteration))) {
                    runs.insert(node, 0);
                }
            }
            self.restart(&graph, revisions, &mut runs, &mut restarted);
        }
        for node in &restarted {
            call(&mut turns, spec, *node, self.frames);
        }
        let mut eval = Eval { graph: &graph, state: self, revisions, runs: &runs, memo: HashMap::new() };
        let mut next = self.clone();
        next.frames += 1;
        for ran in runs.keys().filter_map(|node| turn_of(spec, *node)).collect::<BTreeSet<_>>() {
            let turn = turns.entry(ran).or_default();
            turn.0 = turn.0.saturating_sub(1);
            turn.1 = self.frames + 1;
        }
        next.turns = turns;
        let (mut values, mut befores) = (HashMap::new(), HashMap::new());
        for (index, resource) in spec.resources.iter().enumerate() {
            let mut all = Vec::new();
            for layer in 0..resource.layers {
                let chain = graph.chain(index, layer);
                for (place, makers) in chain.iter().enumerate() {
                    let value = eval.version(index, layer, place);
                    values.insert((index, layer, Some(makers[0].0)), value);
                    if let Some(before) = place.checked_sub(1) {
                        befores.insert((index, layer, makers[0].0), eval.version(index, layer, before));
                    }
                }
                let last = eval.last(index, layer);
                values.insert((index, layer, None), last);
                all.push(last);
                if chain.iter().flatten().any(|node| graph.is_amortised(*node)) {
                    next.kept.insert((resource.name.clone(), layer), last);
                }
            }
            if alive.contains(&format!("previous({})", resource.name)) {
                next.past.insert(resource.name.clone(), ((resource.edge, resource.layers, resource.buffer), all));
            }
        }
        for node in &graph.nodes {
            next.seen.extend(eval.sees(*node).into_iter().map(|(sight, value, _)| (sight, value)));
        }
        for node in graph.amortised() {
            if matches!(spec.passes[node.0].run, Run::Accumulate(_)) {
                let gathered = self.gathered.get(&spec.passes[node.0].name).copied().unwrap_or(0);
                next.gathered.insert(spec.passes[node.0].name.clone(), runs.get(&node).map_or(gathered, |number| number + 1));
            }
        }
        Meaning { values, befores, next, amortised: runs }
    }

    /// Whoever sees something else enter its cycle starts again.
    fn restart(&self, graph: &Graph<'_>, revisions: &[u64], runs: &mut BTreeMap<Node, u32>, restarted: &mut BTreeSet<Node>) {
        loop {
            let mut eval = Eval { graph, state: self, revisions, runs, memo: HashMap::new() };
            let changed: Vec<Node> =
                graph.amortised().filter(|node| !restarted.contains(node)).filter(|node| eval.is_entered(*node)).collect();
            // All of a cycle start again together.
            let all: Vec<Node> = graph
                .amortised()
                .filter(|node| !restarted.contains(node) && changed.iter().any(|other| graph.same_cycle(*node, *other)))
                .collect();
            if all.is_empty() {
                return;
            }
            for node in all {
                restarted.insert(node);
                if let Run::Accumulate(count) = graph.spec.passes[node.0].run
                    && count > 0
                {
                    runs.insert(node, 0);
                }
            }
        }
    }
}

fn turn_of(spec: &Spec, node: Node) -> Option<(u32, u32)> {
    match spec.passes[node.0].run {
        Run::Spread { spread, iteration } => Some((spread, node.1.unwrap_or(iteration))),
        _ => None,
    }
}

fn call(turns: &mut BTreeMap<(u32, u32), (u32, u64)>, spec: &Spec, node: Node, now: u64) {
    if let Some(key) = turn_of(spec, node) {
        let turn = turns.entry(key).or_default();
        if turn.0 == 0 {
            turn.1 = now;
        }
        turn.0 = spec.spreads[key.0 as usize].1;
    }
}

/// Who makes what, from the words of the file alone.
struct Graph<'a> {
    spec: &'a Spec,
    alive: &'a BTreeSet<String>,
    nodes: Vec<Node>,
    chains: HashMap<(usize, u32), Vec<Vec<Node>>>,
    /// Whether one node reaches another, through the past too.
    reach: HashMap<Node, BTreeSet<Node>>,
}

impl<'a> Graph<'a> {
    fn new(spec: &'a Spec, alive: &'a BTreeSet<String>) -> Graph<'a> {
        let mut graph = Graph { spec, alive, nodes: Vec::new(), chains: HashMap::new(), reach: HashMap::new() };
        for (index, pass) in spec.passes.iter().enumerate().filter(|(_, pass)| !pass.off && alive.contains(&pass.name)) {
            match pass.batch {
                0 => graph.nodes.push((index, None)),
                count => graph.nodes.extend((0..count).map(|iteration| (index, Some(iteration)))),
            }
        }
        for modifies in [false, true] {
            for node in graph.nodes.clone() {
                let pass = &spec.passes[node.0];
                for part in if modifies { &pass.modifies } else { &pass.writes } {
                    for layer in layers(spec, part, node.1) {
                        graph.chains.entry((part.resource, layer)).or_default().push(vec![node]);
                    }
                }
            }
        }
        let mut edges: HashMap<Node, BTreeSet<Node>> = HashMap::new();
        for node in graph.nodes.clone() {
            let pass = &spec.passes[node.0];
            for part in &pass.reads {
                for layer in layers(spec, part, None) {
                    let makers = graph.seen(part, layer).map(|place| graph.chain(part.resource, layer)[place].clone());
                    for maker in makers.into_iter().flatten() {
                        edges.entry(maker).or_default().insert(node);
                    }
                }
            }
            if let Some(of) = pass.remembers {
                for layer in 0..spec.resources[of].layers {
                    for maker in graph.chain(of, layer).iter().flatten() {
                        edges.entry(*maker).or_default().insert(node);
                    }
                }
            }
            for other in graph.nodes.iter().filter(|other| turn_of(spec, node).is_some() && turn_of(spec, node) == turn_of(spec, **other)) {
                edges.entry(node).or_default().insert(*other);
            }
        }
        for chain in graph.chains.values() {
            for pair in chain.windows(2) {
                for before in &pair[0] {
                    edges.entry(*before).or_default().extend(&pair[1]);
                }
            }
        }
        for node in graph.nodes.clone() {
            let mut found = BTreeSet::new();
            let mut open = vec![node];
            while let Some(at) = open.pop() {
                for next in edges.get(&at).into_iter().flatten() {
                    if found.insert(*next) {
                        open.push(*next);
                    }
                }
            }
            graph.reach.insert(node, found);
        }
        graph
    }

    fn chain(&self, resource: usize, layer: u32) -> &[Vec<Node>] {
        self.chains.get(&(resource, layer)).map_or(&[], Vec::as_slice)
    }

    /// The place in the chain of what a part shows.
    fn seen(&self, part: &Part, layer: u32) -> Option<usize> {
        let chain = self.chain(part.resource, layer);
        match part.version {
            None => chain.len().checked_sub(1),
            Some(version) => chain.iter().position(|makers| makers[0].0 == version),
        }
    }

    fn is_amortised(&self, node: Node) -> bool {
        matches!(self.spec.passes[node.0].run, Run::Accumulate(_) | Run::Spread { .. })
    }

    fn amortised(&self) -> impl Iterator<Item = Node> + '_ {
        self.nodes.iter().copied().filter(|node| self.is_amortised(*node))
    }

    fn same_cycle(&self, a: Node, b: Node) -> bool {
        a == b || (self.reach[&a].contains(&b) && self.reach[&b].contains(&a))
    }
}

struct Eval<'a> {
    graph: &'a Graph<'a>,
    state: &'a Interpreter,
    revisions: &'a [u64],
    runs: &'a BTreeMap<Node, u32>,
    memo: HashMap<(usize, u32, usize), u64>,
}

impl Eval<'_> {
    fn last(&mut self, resource: usize, layer: u32) -> u64 {
        match self.graph.chain(resource, layer).len() {
            0 => DECLARED,
            count => self.version(resource, layer, count - 1),
        }
    }

    fn version(&mut self, resource: usize, layer: u32, place: usize) -> u64 {
        if let Some(known) = self.memo.get(&(resource, layer, place)) {
            return *known;
        }
        let graph = self.graph;
        let node = graph.chain(resource, layer)[place][0];
        let pass = &graph.spec.passes[node.0];
        let name = &graph.spec.resources[resource].name;
        let kept = self.state.kept.get(&(name.clone(), layer)).copied().unwrap_or(DECLARED);
        let value = if let Some(of) = pass.remembers {
            self.remembered(resource, of, layer)
        } else if graph.is_amortised(node) && !self.runs.contains_key(&node) {
            kept
        } else {
            let number = self.runs.get(&node).copied().unwrap_or(0);
            let accumulates = matches!(pass.run, Run::Accumulate(_));
            let modifies = pass.modifies.iter().any(|part| part.resource == resource);
            let old = match place.checked_sub(1) {
                Some(before) => self.version(resource, layer, before),
                None if modifies && accumulates && number > 0 => kept,
                None if modifies || pass.partial => DECLARED,
                None => 0,
            };
            let reads = self.reads(pass);
            made(pass, node.1, number, self.state.frames, self.revisions, &reads, layer, old, ground(graph.spec, graph.alive, node))
        };
        self.memo.insert((resource, layer, place), value);
        value
    }

    fn reads(&mut self, pass: &PassSpec) -> Vec<u64> {
        let mut found = Vec::new();
        for part in &pass.reads {
            for layer in layers(self.graph.spec, part, None) {
                found.push(match self.graph.seen(part, layer) {
                    Some(place) => self.version(part.resource, layer, place),
                    None => DECLARED,
                });
            }
        }
        found
    }

    fn remembered(&self, history: usize, of: usize, layer: u32) -> u64 {
        let (spec, of) = (self.graph.spec, &self.graph.spec.resources[of]);
        match self.state.past.get(&of.name) {
            Some((shape, cells)) if *shape == (of.edge, of.layers, of.buffer) => cells[layer as usize],
            Some((shape, cells)) if shape.2 == of.buffer => match spec.resources[history].history {
                Some((_, OnResize::Crop)) => cells.get(layer as usize).map_or(FIRST, |cell| cropped(*cell)),
                _ => FIRST,
            },
            _ => FIRST,
        }
    }

    /// Whether something from outside of the cycle of a node is another than in the frame before.
    fn is_entered(&mut self, node: Node) -> bool {
        let graph = self.graph;
        let members = graph.nodes.iter().copied().filter(|other| graph.same_cycle(node, *other));
        members.into_iter().any(|member| {
            self.sees(member).into_iter().any(|(sight, value, maker)| match self.state.seen.get(&sight) {
                Some(known) => *known != value && maker.is_none_or(|maker| !graph.same_cycle(maker, node)),
                // A pass that has not run; what a known pass sees is known.
                None => sight.2.is_none(),
            })
        })
    }

    /// What a node sees, and who made it.
    fn sees(&mut self, node: Node) -> Vec<(Sight, u64, Option<Node>)> {
        let graph = self.graph;
        let pass = &graph.spec.passes[node.0];
        let sight = |cell| (pass.name.clone(), node.1, cell);
        let inputs: Vec<u64> = pass.inputs.iter().map(|input| self.revisions[*input as usize]).collect();
        let own = node.1.map(|iteration| self.revisions[(iteration % INPUTS) as usize]);
        let outside = hash((pass.salt, pass.partial, ground(graph.spec, graph.alive, node), inputs, own));
        let mut found = vec![(sight(None), outside, None)];
        for (slot, part) in pass.reads.iter().map(|part| noticed(graph.spec, part)).enumerate() {
            for layer in layers(graph.spec, &part, None) {
                let place = graph.seen(&part, layer);
                let maker = place.map(|place| graph.chain(part.resource, layer)[place][0]);
                let value = place.map_or(DECLARED, |place| self.version(part.resource, layer, place));
                found.push((sight(Some((slot, layer))), value, maker));
            }
        }
        for (slot, part) in pass.modifies.iter().enumerate() {
            for layer in layers(graph.spec, part, node.1) {
                let chain = graph.chain(part.resource, layer);
                let before = chain.iter().position(|makers| makers.contains(&node)).and_then(|place| place.checked_sub(1));
                if let Some(before) = before {
                    let value = self.version(part.resource, layer, before);
                    found.push((sight(Some((pass.reads.len() + slot, layer))), value, Some(chain[before][0])));
                }
            }
        }
        found
    }
}

impl Meaning {
    /// The value that a pass modifies.
    pub fn before(&self, resource: usize, layer: u32, pass: usize) -> Option<u64> {
        self.befores.get(&(resource, layer, pass)).copied()
    }

    /// All values, with passes by name.
    pub fn named(&self, spec: &Spec) -> HashMap<(usize, u32, Option<String>), u64> {
        let name = |pass: usize| spec.passes[pass].name.clone();
        self.values.iter().map(|((resource, layer, version), value)| ((*resource, *layer, version.map(name)), *value)).collect()
    }
}
