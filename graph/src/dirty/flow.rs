//! Who makes what for whom, by node: a node is a step, or one iteration of a batched step.
//!
//! Three groupings carry all the rules. A *source* is a part that somebody reads (or shows), with the nodes that make it: a thousand
//! readers of a thousand layers meet in one source. A *unit* is what can only run together: the producer of a part and its modifiers,
//! and the passes of an iteration of a spread loop. A *piece* is what one unit leaves in one resource: the grain in which content is
//! held.
//!
//! Accepted: the flow is built anew for every plan, in time linear in uses.

use std::collections::{BTreeMap, HashMap};

use petgraph::algo::tarjan_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use super::cells::Cells;
use crate::expand::types::{PassId, ResourceId, Run};
use crate::lists::Lists;
use crate::plan::{InputId, Role, Step, Use};
use crate::schedule::part::{Rect, merged};

/// A step, or an iteration of one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    /// By place among the steps that the flow was built from.
    pub(super) step: u32,
    /// Place in [`Step::batch`], if it has any.
    pub(super) iteration: Option<u32>,
    /// When it runs; a batched iteration has its own.
    pub(super) run: Run,
}

/// A part that somebody reads or shows.
#[derive(Debug, Clone)]
pub(super) struct Source {
    pub(super) resource: ResourceId,
    /// The nodes that left the value.
    pub(super) makers: Vec<u32>,
    /// Whether nothing changes it later, so that it may be held.
    pub(super) last: bool,
    /// The pieces that hold it.
    pub(super) pieces: Vec<u32>,
    /// Whether it has cells that nothing makes.
    pub(super) unmade: bool,
}

/// What one unit leaves in one resource.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub(super) unit: u32,
    pub(super) resource: ResourceId,
    pub(super) rects: Vec<Rect>,
}

/// All of it.
#[derive(Debug, Clone, Default)]
pub(super) struct Flow {
    pub(super) nodes: Vec<Node>,
    /// First node of each step.
    starts: Vec<u32>,
    pub(super) sources: Vec<Source>,
    pub(super) pieces: Vec<Piece>,
    /// By node: sources that it reads.
    pub(super) reads: Lists,
    /// By source: nodes that read it.
    pub(super) readers: Lists,
    /// By node: sources that it makes.
    pub(super) feeds: Lists,
    /// By node: nodes that modify what it leaves.
    pub(super) modifiers: Lists,
    /// By node: nodes that leave what it modifies.
    modified: Lists,
    /// By node.
    pub(super) unit_of: Vec<u32>,
    /// By unit: its nodes.
    pub(super) units: Lists,
    /// By unit: its pieces.
    pub(super) unit_pieces: Lists,
    /// By unit: whether it runs when its turn comes, and is never run for a reader.
    amortised_units: Vec<bool>,
    /// By step: resources that it writes, in the order of its uses.
    pub(super) writes: Lists,
    /// By resource: its pieces.
    pub(super) resource_pieces: Lists,
    /// By resource: parts that nothing makes, where something is used or shown.
    pub(super) unmade: Vec<Vec<Rect>>,
    /// By input: nodes that take it.
    pub(super) input_readers: Lists,
    /// By resource: whether several units leave their share of one cell in it.
    pub(super) shared: Vec<bool>,
    /// By resource: nodes that remember it.
    pub(super) recallers: Lists,
    /// By node: its cycle through history, or itself alone.
    pub(super) cycle_of: Vec<u32>,
    /// By cycle: its amortised nodes.
    pub(super) amortised: Lists,
    /// By output: its source.
    pub(super) outputs: Vec<u32>,
    /// By resource that is remembered: the source that all of it is.
    pub(super) recalled: BTreeMap<u32, u32>,
}

/// What a flow is built from.
pub(super) struct FlowInput<'a> {
    /// In any order; modifiers of a part follow each other by pass.
    pub(super) steps: &'a [&'a Step],
    pub(super) resources: usize,
    pub(super) inputs: usize,
    pub(super) outputs: &'a [(ResourceId, Rect)],
}

/// Collects while resources are walked.
#[derive(Default)]
struct Builder {
    sources: Vec<Source>,
    reads: Vec<(u32, u32)>,
    feeds: Vec<(u32, u32)>,
    modifiers: Vec<(u32, u32)>,
    joins: Vec<(u32, u32)>,
    /// By (node, resource): the cells whose last value it leaves.
    left: BTreeMap<(u32, u32), Vec<Rect>>,
    outputs: Vec<u32>,
    recalled: BTreeMap<u32, u32>,
    /// Two nodes that both leave a cell, and its resource.
    shared: Vec<((u32, u32), u32)>,
}

/// A use of a resource by a node.
struct NodeUse<'a> {
    node: u32,
    pass: PassId,
    rect: Rect,
    used: &'a Use,
}

impl Flow {
    /// Builds the flow.
    pub(super) fn of(input: &FlowInput<'_>) -> Flow {
        let mut flow = Flow::default();
        for (place, step) in input.steps.iter().enumerate() {
            flow.starts.push(flow.nodes.len() as u32);
            if step.batch.is_empty() {
                flow.nodes.push(Node { step: place as u32, iteration: None, run: step.run });
            }
            for iteration in 0..step.batch.len() as u32 {
                let run = match step.run {
                    Run::Spread { spread, .. } => Run::Spread { spread, iteration },
                    other => other,
                };
                flow.nodes.push(Node { step: place as u32, iteration: Some(iteration), run });
            }
        }
        let by_resource = flow.uses(input);
        let mut builder = Builder { outputs: vec![0; input.outputs.len()], ..Builder::default() };
        let mut recalls = Vec::new();
        flow.unmade = vec![Vec::new(); input.resources];
        for (resource, uses) in by_resource.iter().enumerate() {
            recalls.extend(uses.iter().filter(|used| used.used.role == Role::Recall).map(|used| (resource as u32, used.node)));
            flow.unmade[resource] = builder.resource(ResourceId(resource as u32), uses, input);
        }
        flow.finish(builder, input, &recalls);
        flow
    }

    /// The nodes of a step.
    pub(super) fn of_step(&self, step: usize) -> std::ops::Range<u32> {
        self.starts[step]..self.starts.get(step + 1).copied().unwrap_or(self.nodes.len() as u32)
    }

    /// All uses by resource, in the order of the steps.
    fn uses<'a>(&self, input: &FlowInput<'a>) -> Vec<Vec<NodeUse<'a>>> {
        let mut found: Vec<Vec<NodeUse<'a>>> = Vec::new();
        found.resize_with(input.resources, Vec::new);
        for (node, entry) in self.nodes.iter().enumerate() {
            let step: &'a Step = input.steps[entry.step as usize];
            for (index, used) in step.uses.iter().enumerate() {
                let own = entry.iteration.and_then(|iteration| step.batch.get(iteration as usize)?.parts.get(index));
                let rect = own.map_or_else(|| Rect::new(&used.mips, &used.layers), |(mips, layers)| Rect::new(mips, layers));
                if let Some(list) = found.get_mut(used.resource.index()) {
                    list.push(NodeUse { node: node as u32, pass: step.pass, rect, used });
                }
            }
        }
        found
    }

    fn finish(&mut self, builder: Builder, input: &FlowInput<'_>, recalls: &[(u32, u32)]) {
        let count = self.nodes.len();
        let Builder { mut sources, reads, feeds, modifiers, joins, left, outputs, shared, recalled } = builder;
        self.join(&joins, input);
        let mut piece_of: HashMap<(u32, u32), u32> = HashMap::new();
        for ((node, resource), rects) in left {
            let unit = self.unit_of[node as usize];
            let piece = *piece_of.entry((unit, resource)).or_insert_with(|| {
                self.pieces.push(Piece { unit, resource: ResourceId(resource), rects: Vec::new() });
                self.pieces.len() as u32 - 1
            });
            self.pieces[piece as usize].rects.extend(rects);
        }
        for piece in &mut self.pieces {
            piece.rects.sort_unstable();
            piece.rects.dedup();
            piece.rects = merged(std::mem::take(&mut piece.rects));
        }
        self.shared = vec![false; input.resources];
        for ((maker, other), resource) in shared {
            self.shared[resource as usize] |= self.unit_of[maker as usize] != self.unit_of[other as usize];
        }
        for source in &mut sources {
            let held = source.makers.iter().map(|maker| (self.unit_of[*maker as usize], source.resource.0));
            source.pieces = held.filter_map(|key| piece_of.get(&key).copied()).collect();
            source.pieces.sort_unstable();
            source.pieces.dedup();
        }
        let numbered = |pairs: Vec<(u32, u32)>, lists: usize| Lists::sets(lists, pairs);
        let units = self.unit_of.iter().copied().max().map_or(0, |last| last as usize + 1);
        let pieces = || (0u32..).zip(&self.pieces);
        let unit_pieces = numbered(pieces().map(|(at, piece)| (piece.unit, at)).collect(), units);
        let resource_pieces = numbered(pieces().map(|(at, piece)| (piece.resource.0, at)).collect(), input.resources);
        (self.unit_pieces, self.resource_pieces) = (unit_pieces, resource_pieces);
        self.amortised_units = vec![false; units];
        for (node, unit) in self.nodes.iter().zip(&self.unit_of) {
            self.amortised_units[*unit as usize] |= is_amortised(node.run);
        }
        for step in input.steps {
            let written = step.uses.iter().filter(|used| crate::schedule::writes(used.role));
            written.for_each(|used| self.writes.push(used.resource.0));
            self.writes.finish_list();
        }
        self.units = numbered(self.unit_of.iter().enumerate().map(|(node, unit)| (*unit, node as u32)).collect(), units);
        self.input_readers = numbered(self.taken_inputs(input), input.inputs);
        self.recallers = numbered(recalls.to_vec(), input.resources);
        self.readers = numbered(reads.iter().map(|(node, source)| (*source, *node)).collect(), sources.len());
        self.reads = numbered(reads, count);
        self.feeds = numbered(feeds, count);
        self.modified = numbered(modifiers.iter().map(|(before, after)| (*after, *before)).collect(), count);
        self.modifiers = numbered(modifiers, count);
        self.outputs = outputs;
        self.recalled = recalled;
        self.sources = sources;
        self.find_cycles(recalls);
    }

    /// Gives every node its unit, numbered by first node.
    fn join(&mut self, joins: &[(u32, u32)], input: &FlowInput<'_>) {
        let mut parent: Vec<u32> = (0..self.nodes.len() as u32).collect();
        fn root(parent: &mut [u32], mut node: u32) -> u32 {
            while parent[node as usize] != node {
                parent[node as usize] = parent[parent[node as usize] as usize];
                node = parent[node as usize];
            }
            node
        }
        let mut iterations: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let spread = self.nodes.iter().enumerate().filter_map(|(node, entry)| match entry.run {
            Run::Spread { spread, iteration } => {
                let index = input.steps[entry.step as usize].batch.is_empty().then_some(iteration).or(entry.iteration)?;
                Some((*iterations.entry((spread, index)).or_insert(node as u32), node as u32))
            }
            _ => None,
        });
        let together: Vec<(u32, u32)> = joins.iter().copied().chain(spread).collect();
        for (a, b) in together {
            let (a, b) = (root(&mut parent, a), root(&mut parent, b));
            parent[a.max(b) as usize] = a.min(b);
        }
        let mut number: Vec<Option<u32>> = vec![None; self.nodes.len()];
        let mut next = 0;
        for node in 0..self.nodes.len() as u32 {
            let first = root(&mut parent, node) as usize;
            let unit = *number[first].get_or_insert_with(|| {
                next += 1;
                next - 1
            });
            self.unit_of.push(unit);
        }
    }

    fn taken_inputs(&self, input: &FlowInput<'_>) -> Vec<(u32, u32)> {
        let mut taken = Vec::new();
        for (node, entry) in self.nodes.iter().enumerate() {
            let step = input.steps[entry.step as usize];
            let own = entry.iteration.and_then(|iteration| step.batch.get(iteration as usize)).map_or(&[][..], |own| &own.inputs);
            taken.extend(step.inputs.iter().chain(own).map(|InputId(id)| (*id, node as u32)));
        }
        taken
    }

    /// Cycles: nodes that feed each other, through history too.
    fn find_cycles(&mut self, recalls: &[(u32, u32)]) {
        self.cycle_of = (0..self.nodes.len() as u32).collect();
        let spread = |node: &Node| matches!(node.run, Run::Spread { .. });
        if !recalls.is_empty() || self.nodes.iter().any(spread) {
            let sources = self.nodes.len();
            let mut graph: DiGraph<(), ()> = DiGraph::with_capacity(sources + self.sources.len(), 0);
            for _ in 0..sources + self.sources.len() {
                graph.add_node(());
            }
            let at = |node: u32| NodeIndex::new(node as usize);
            for (source, entry) in self.sources.iter().enumerate() {
                for maker in &entry.makers {
                    graph.add_edge(at(*maker), NodeIndex::new(sources + source), ());
                }
                for reader in self.readers.of(source) {
                    graph.add_edge(NodeIndex::new(sources + source), at(*reader), ());
                }
            }
            for node in 0..self.nodes.len() {
                for modifier in self.modifiers.of(node) {
                    graph.add_edge(NodeIndex::new(node), at(*modifier), ());
                }
            }
            // The passes of an iteration stand for each other.
            for (node, unit) in self.unit_of.iter().enumerate().filter(|(node, _)| spread(&self.nodes[*node])) {
                let first = self.units.of(*unit as usize)[0];
                graph.add_edge(NodeIndex::new(node), at(first), ());
                graph.add_edge(at(first), NodeIndex::new(node), ());
            }
            for (resource, recaller) in recalls {
                for piece in self.resource_pieces.of(*resource as usize) {
                    for maker in self.units.of(self.pieces[*piece as usize].unit as usize) {
                        graph.add_edge(at(*maker), at(*recaller), ());
                    }
                }
            }
            for cycle in tarjan_scc(&graph) {
                let members = || cycle.iter().map(|node| node.index()).filter(|node| *node < sources);
                let Some(first) = members().min() else { continue };
                for member in members() {
                    self.cycle_of[member] = first as u32;
                }
            }
        }
        let members = self.nodes.iter().enumerate().filter(|(_, node)| is_amortised(node.run));
        self.amortised = Lists::sets(self.nodes.len(), members.map(|(node, _)| (self.cycle_of[node], node as u32)).collect());
    }

    /// The nodes that leave what a node modifies.
    pub(super) fn modifies(&self, node: u32) -> &[u32] {
        self.modified.of(node as usize)
    }

    /// Whether a unit is amortised: it runs when its turn comes, and is never run for a reader.
    pub(super) fn is_amortised(&self, unit: u32) -> bool {
        self.amortised_units[unit as usize]
    }
}

/// Whether a node runs when its turn comes.
pub(super) fn is_amortised(run: Run) -> bool {
    matches!(run, Run::Spread { .. } | Run::Accumulate(_))
}

/// A version of a cell: the step that made it, and those of its nodes that did.
struct Version {
    pass: PassId,
    makers: Vec<u32>,
}

impl Builder {
    /// Walks the uses of a resource; returns the parts that nothing makes.
    fn resource(&mut self, resource: ResourceId, uses: &[NodeUse<'_>], input: &FlowInput<'_>) -> Vec<Rect> {
        let shown: Vec<(u32, &Rect)> =
            (0u32..).zip(input.outputs).filter(|(_, (id, _))| *id == resource).map(|(at, (_, rect))| (at, rect)).collect();
        let cells = Cells::cut(uses.iter().map(|used| &used.rect).chain(shown.iter().map(|(_, rect)| *rect)));
        let mut chains: Vec<Vec<Version>> = Vec::new();
        chains.resize_with(cells.count(), Vec::new);
        let mut writes: Vec<&NodeUse<'_>> = uses.iter().filter(|used| matches!(used.used.role, Role::Produce | Role::Modify)).collect();
        // The producer first, then modifiers in the order of the file.
        writes.sort_by_key(|write| (write.used.role == Role::Modify, write.pass, write.node));
        for write in writes {
            let pass = write.pass;
            for cell in cells.within(&write.rect) {
                match chains[cell].last_mut().filter(|version| version.pass == pass) {
                    Some(version) => version.makers.push(write.node),
                    None => chains[cell].push(Version { pass, makers: vec![write.node] }),
                }
            }
        }
        for (cell, chain) in chains.iter().enumerate() {
            for pair in chain.windows(2) {
                for before in &pair[0].makers {
                    self.modifiers.extend(pair[1].makers.iter().map(|after| (*before, *after)));
                }
                let first = pair[0].makers[0];
                self.joins.extend(pair.iter().flat_map(|version| &version.makers).map(|maker| (first, *maker)));
            }
            for maker in chain.last().into_iter().flat_map(|version| &version.makers) {
                let first = chain.last().map_or(*maker, |version| version.makers[0]);
                if first != *maker {
                    self.shared.push(((first, *maker), resource.0));
                }
                self.left.entry((*maker, resource.0)).or_default().push(cells.rect(cell));
            }
        }
        let mut known: HashMap<(Rect, Option<PassId>), u32> = HashMap::new();
        for used in uses.iter().filter(|used| used.used.role == Role::Read) {
            let source = self.source(resource, &used.rect, used.used.version, &cells, &chains, &mut known);
            self.reads.push((used.node, source));
        }
        for used in uses.iter().filter(|used| used.used.role == Role::Recall) {
            let source = self.source(resource, &used.rect, None, &cells, &chains, &mut known);
            self.recalled.insert(resource.0, source);
        }
        for (output, rect) in shown {
            self.outputs[output as usize] = self.source(resource, rect, None, &cells, &chains, &mut known);
        }
        let unmade = chains.iter().enumerate().filter(|(_, chain)| chain.is_empty()).map(|(cell, _)| cells.rect(cell)).collect();
        merged(unmade)
    }

    fn source(
        &mut self,
        resource: ResourceId,
        rect: &Rect,
        version: Option<PassId>,
        cells: &Cells,
        chains: &[Vec<Version>],
        known: &mut HashMap<(Rect, Option<PassId>), u32>,
    ) -> u32 {
        if let Some(found) = known.get(&(rect.clone(), version)) {
            return *found;
        }
        let id = self.sources.len() as u32;
        let mut source = Source { resource, makers: Vec::new(), last: true, pieces: Vec::new(), unmade: false };
        for cell in cells.within(rect) {
            let chain = &chains[cell];
            let seen = match version {
                None => chain.len().checked_sub(1),
                Some(pass) => chain.iter().position(|version| version.pass == pass),
            };
            match seen {
                Some(place) => {
                    source.last &= place + 1 == chain.len();
                    source.makers.extend(&chain[place].makers);
                }
                None => source.unmade = true,
            }
        }
        source.makers.sort_unstable();
        source.makers.dedup();
        self.feeds.extend(source.makers.iter().map(|maker| (*maker, id)));
        self.sources.push(source);
        known.insert((rect.clone(), version), id);
        id
    }
}
