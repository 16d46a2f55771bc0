//! Random pipelines and random changes of them. A choice is a number out of a list, so that a failure shrinks.

use std::ops::Range;

use luminaire_graph::bind::types::Bound;
use luminaire_graph::expand::types::*;
use luminaire_graph::format::Format;
use luminaire_graph::plan::{Access, Input, InputId, PartView, Role, Step, StepIteration, StepKind, Use, Workgroups};
use luminaire_graph::published::RowReads;
use luminaire_graph::reflect::interface::ViewDimension;
use luminaire_graph::source::Span;

/// A part: a resource and one of its layers, or all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    pub resource: usize,
    pub layer: Option<u32>,
    /// The value as this pass left it.
    pub version: Option<usize>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct ResourceSpec {
    pub name: String,
    pub layers: u32,
    /// Whether what is called layers are mip levels.
    pub mips: bool,
    pub edge: u32,
    pub clear: bool,
    pub buffer: bool,
    pub keep: Keep,
    /// Whose past it is.
    pub history: Option<(usize, OnResize)>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct PassSpec {
    pub name: String,
    /// Stands for the text of its shader.
    pub salt: u32,
    pub run: Run,
    pub inputs: Vec<u32>,
    pub reads: Vec<Part>,
    pub writes: Vec<Part>,
    pub modifies: Vec<Part>,
    /// It may leave texels out of what it writes.
    pub partial: bool,
    /// Iterations; iteration i writes layer i of its one resource.
    pub batch: u32,
    pub remembers: Option<usize>,
    /// Left out of the plan.
    pub off: bool,
}

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spec {
    pub resources: Vec<ResourceSpec>,
    pub passes: Vec<PassSpec>,
    pub spreads: Vec<(u32, u32)>,
    /// Bytes that the compiler may retain where it has the choice.
    pub budget: Option<u64>,
    pub outputs: Vec<usize>,
}

pub const INPUTS: u32 = 4;

/// Choices out of a list of numbers.
pub struct Choices<'a>(pub std::slice::Iter<'a, u16>);

impl Choices<'_> {
    pub fn below(&mut self, limit: usize) -> usize {
        usize::from(self.0.next().copied().unwrap_or(0)) % limit.max(1)
    }

    pub fn chance(&mut self, per_cent: usize) -> bool {
        // Exhausted choices answer no, so that shrunk graphs are small.
        99 - self.below(100) < per_cent
    }
}

fn pass(name: String) -> PassSpec {
    PassSpec {
        name,
        salt: 0,
        run: Run::OnChange,
        inputs: Vec::new(),
        reads: Vec::new(),
        writes: Vec::new(),
        modifies: Vec::new(),
        partial: false,
        batch: 0,
        remembers: None,
        off: false,
    }
}

/// What may stand in a pipeline.
#[derive(Debug, Clone, Copy)]
pub struct Kinds {
    pub history: bool,
    pub amortised: bool,
}

/// Built along a time line: what a pass reads stands before it, but for the past.
pub fn random(choose: &mut Choices<'_>, kinds: Kinds) -> Spec {
    let mut spec = Spec::default();
    let count = 3 + choose.below(8);
    // The past of some, which anybody may read.
    let remembered: Vec<bool> = (0..count).map(|_| choose.chance(15) && kinds.history).collect();
    for index in 0..count {
        let buffer = choose.chance(20);
        spec.resources.push(ResourceSpec {
            name: format!("x{index}"),
            layers: if buffer { 1 } else { 1 + choose.below(3) as u32 },
            mips: choose.chance(30),
            edge: 8 << choose.below(2),
            clear: choose.chance(40),
            buffer,
            keep: [Keep::Auto, Keep::Auto, Keep::Always, Keep::Never][choose.below(4)],
            history: None,
        });
    }
    let mut histories = Vec::new();
    for index in (0..count).filter(|index| remembered[*index]) {
        histories.push(spec.resources.len());
        let on_resize = if choose.chance(50) { OnResize::Crop } else { OnResize::First };
        let of = spec.resources[index].clone();
        spec.resources[index].keep = Keep::Auto;
        spec.resources.push(ResourceSpec {
            name: format!("previous(x{index})"),
            history: Some((index, on_resize)),
            keep: Keep::Auto,
            clear: false,
            ..of
        });
    }
    for index in 0..count {
        match choose.below(10) {
            0 if kinds.amortised => accumulating(&mut spec, choose, index, &histories),
            1 if kinds.amortised => spreading(&mut spec, choose, index, &histories),
            _ => on_change(&mut spec, choose, index, &histories),
        }
    }
    for history in histories {
        let Some((of, _)) = spec.resources[history].history else { continue };
        let mut remember = pass(format!("previous(x{of})"));
        remember.remembers = Some(of);
        remember.writes.push(Part { resource: history, layer: None, version: None });
        spec.passes.push(remember);
    }
    spec.budget = choose.chance(20).then(|| [0, 300, 2_000][choose.below(3)]);
    spec.outputs = (0..1 + choose.below(3)).map(|_| count - 1 - choose.below(count.min(4))).collect();
    spec.outputs.sort_unstable();
    spec.outputs.dedup();
    spec
}

fn take(spec: &Spec, choose: &mut Choices<'_>, before: usize, histories: &[usize], into: &mut PassSpec) {
    for _ in 0..choose.below(4) {
        let resource = match choose.chance(20) && !histories.is_empty() {
            true => histories[choose.below(histories.len())],
            false if before > 0 => choose.below(before),
            false => continue,
        };
        let layers = spec.resources[resource].layers;
        // A history is remembered whole: a reader of a part is due with all of it, and would make the same again.
        let whole = spec.resources[resource].history.is_some();
        let layer = (layers > 1 && !whole && choose.chance(50)).then(|| choose.below(layers as usize) as u32);
        if !into.reads.iter().any(|read| read.resource == resource) {
            into.reads.push(Part { resource, layer, version: None });
        }
    }
    for input in 0..INPUTS {
        if choose.chance(20) {
            into.inputs.push(input);
        }
    }
}

fn on_change(spec: &mut Spec, choose: &mut Choices<'_>, index: usize, histories: &[usize]) {
    let layers = spec.resources[index].layers;
    if layers > 1 && choose.chance(20) {
        let mut batched = pass(format!("p{}", spec.passes.len()));
        batched.batch = layers;
        batched.partial = choose.chance(30);
        take(spec, choose, index, histories, &mut batched);
        batched.writes.push(Part { resource: index, layer: None, version: None });
        spec.passes.push(batched);
        return;
    }
    let parts: Vec<Option<u32>> = if layers > 1 && choose.chance(60) { (0..layers).map(Some).collect() } else { vec![None] };
    for layer in parts {
        let part = Part { resource: index, layer, version: None };
        let mut last = None;
        if !(spec.resources[index].clear && choose.chance(30)) {
            let mut producer = pass(format!("p{}", spec.passes.len()));
            producer.partial = choose.chance(30);
            if choose.chance(5) {
                producer.run = Run::EveryFrame;
            }
            take(spec, choose, index, histories, &mut producer);
            producer.writes.push(part);
            last = Some(spec.passes.len());
            spec.passes.push(producer);
        }
        for _ in 0..choose.below(3) {
            if last.is_none() && !spec.resources[index].clear {
                break;
            }
            if let Some(version) = last
                && choose.chance(30)
            {
                // Somebody sees the value in between, and leaves it for others.
                let seen = spec.resources.len();
                spec.resources.push(ResourceSpec {
                    name: format!("v{seen}"),
                    layers: 1,
                    mips: false,
                    edge: 8,
                    clear: false,
                    buffer: false,
                    keep: Keep::Auto,
                    history: None,
                });
                let mut reader = pass(format!("p{}", spec.passes.len()));
                reader.reads.push(Part { version: Some(version), ..part });
                take(spec, choose, index.min(1), histories, &mut reader);
                reader.writes.push(Part { resource: seen, layer: None, version: None });
                spec.passes.push(reader);
                spec.outputs.push(seen);
            }
            let mut modifier = pass(format!("p{}", spec.passes.len()));
            take(spec, choose, index, histories, &mut modifier);
            modifier.modifies.push(part);
            last = Some(spec.passes.len());
            spec.passes.push(modifier);
        }
        if last.is_none() {
            spec.resources[index].clear = true;
        }
    }
}

fn accumulating(spec: &mut Spec, choose: &mut Choices<'_>, index: usize, histories: &[usize]) {
    let mut gather = pass(format!("p{}", spec.passes.len()));
    gather.run = Run::Accumulate(1 + choose.below(3) as u32);
    take(spec, choose, index, histories, &mut gather);
    let part = Part { resource: index, layer: None, version: None };
    spec.resources[index].keep = Keep::Auto;
    if choose.chance(50) {
        spec.resources[index].clear = true;
        gather.modifies.push(part);
    } else {
        gather.writes.push(part);
    }
    spec.passes.push(gather);
}

fn spreading(spec: &mut Spec, choose: &mut Choices<'_>, index: usize, histories: &[usize]) {
    let spread = spec.spreads.len() as u32;
    spec.spreads.push((1 + choose.below(2) as u32, 1 + choose.below(2) as u32));
    spec.resources[index].clear = true;
    spec.resources[index].keep = Keep::Auto;
    let layers = spec.resources[index].layers;
    if choose.chance(40) {
        let mut batched = pass(format!("p{}", spec.passes.len()));
        batched.batch = layers;
        batched.run = Run::Spread { spread, iteration: 0 };
        take(spec, choose, index, histories, &mut batched);
        batched.writes.push(Part { resource: index, layer: None, version: None });
        spec.passes.push(batched);
        return;
    }
    // Each iteration may have two passes, of which the second reads what the first makes.
    let between = choose.chance(40).then_some(spec.resources.len());
    if between.is_some() {
        let name = format!("w{}", spec.resources.len());
        spec.resources.push(ResourceSpec { name, buffer: false, ..spec.resources[index].clone() });
    }
    for iteration in 0..layers {
        let mut part = pass(format!("p{}", spec.passes.len()));
        part.run = Run::Spread { spread, iteration };
        if let Some(between) = between {
            let own = Part { resource: between, layer: Some(iteration), version: None };
            let mut first = PassSpec { writes: vec![own], ..part.clone() };
            take(spec, choose, index, histories, &mut first);
            spec.passes.push(first);
            part.name = format!("p{}", spec.passes.len());
            part.reads.push(own);
        }
        take(spec, choose, index, histories, &mut part);
        part.writes.push(Part { resource: index, layer: Some(iteration), version: None });
        spec.passes.push(part);
    }
}

impl Spec {
    /// What binding would make of it.
    pub fn bound(&self) -> Bound {
        let resources: Vec<Resource> = self.resources.iter().map(|resource| resource.bound()).collect();
        let stands: Vec<usize> = (0..self.passes.len()).filter(|index| !self.passes[*index].off).collect();
        let id = |index: usize| stands.iter().position(|stands| *stands == index).map(|place| PassId(place as u32));
        let mut passes = Vec::new();
        let mut steps = Vec::new();
        for (place, index) in stands.iter().enumerate() {
            let (pass, step) = self.passes[*index].bound(self, place, &id);
            passes.push(pass);
            steps.push(step);
        }
        let outputs = self.outputs.iter().map(|resource| Output {
            name: self.resources[*resource].name.clone(),
            part: PartRef { resource: ResourceId(*resource as u32), mips: None, layers: None, version: None, span: Span::NOWHERE },
        });
        let spreads = self.spreads.iter().enumerate().map(|(index, (per_frame, rounds))| Spread {
            name: format!("s{index}"),
            span: Span::NOWHERE,
            per_frame: *per_frame,
            rounds: *rounds,
        });
        let formats = self.resources.iter().map(|resource| if resource.buffer { None } else { Format::from_name("r32float") }).collect();
        let expanded = Expanded {
            doc: String::new(),
            params: Vec::new(),
            resources,
            passes,
            spreads: spreads.collect(),
            retained_budget: self.budget,
            outputs: outputs.collect(),
            offered: (0..self.resources.len()).map(|index| ResourceId(index as u32)).collect(),
        };
        Bound {
            expanded,
            shaders: Vec::new(),
            steps,
            formats,
            views: Vec::new(),
            draw_lists: Vec::new(),
            inputs: (0..INPUTS).map(|input| Input::Table(format!("i{input}"), RowReads::Whole)).collect(),
            requirements: Vec::new(),
        }
    }
}

impl ResourceSpec {
    /// Mip levels and layers of one of its cells, or of all.
    fn ranges(&self, cell: Option<u32>) -> (Range<u32>, Range<u32>) {
        let cells = cell.map_or(0..self.layers, |cell| cell..cell + 1);
        if self.mips { (cells, 0..1) } else { (0..1, cells) }
    }

    fn bound(&self) -> Resource {
        let shape = if self.buffer {
            Shape::Buffer { bytes: u64::from(self.edge) * 16 }
        } else {
            Shape::Texture(TextureShape {
                dimension: Dimension::D2,
                formats: Format::from_name("r32float").into_iter().collect(),
                format_span: Span::NOWHERE,
                width: self.edge,
                height: 8,
                depth: 1,
                layers: if self.mips { 1 } else { self.layers },
                mips: if self.mips { self.layers } else { 1 },
                samples: 1,
            })
        };
        let history = self.history.map(|(of, on_resize)| History { of: ResourceId(of as u32), first: ClearValue::Zero, on_resize });
        Resource {
            name: self.name.clone(),
            span: Span::NOWHERE,
            shape,
            clear: self.clear.then_some(ClearValue::Zero),
            history,
            keep: self.keep,
        }
    }
}

impl PassSpec {
    fn bound(&self, spec: &Spec, place: usize, id: &dyn Fn(usize) -> Option<PassId>) -> (Pass, Step) {
        let used = |part: &Part, role: Role| {
            let resource = &spec.resources[part.resource];
            let access = match (role, resource.buffer) {
                (Role::Read, false) => Access::Sampled,
                (Role::Read, true) => Access::StorageRead,
                (Role::Recall, _) => Access::CopySource,
                (Role::Produce, _) if self.remembers.is_some() => Access::CopyTarget,
                (Role::Produce, _) => Access::StorageWrite,
                (Role::Modify, _) => Access::StorageReadWrite,
            };
            let (mips, layers) = resource.ranges(part.layer);
            let version = part.version.and_then(id);
            Use {
                resource: ResourceId(part.resource as u32),
                mips,
                layers,
                role,
                access,
                version,
                slot: String::new(),
                span: Span::NOWHERE,
            }
        };
        let recall = self.remembers.map(|of| Part { resource: of, layer: None, version: None });
        let uses: Vec<Use> = recall
            .iter()
            .map(|part| used(part, Role::Recall))
            .chain(self.reads.iter().map(|part| used(part, Role::Read)))
            .chain(self.writes.iter().map(|part| used(part, Role::Produce)))
            .chain(self.modifies.iter().map(|part| used(part, Role::Modify)))
            .collect();
        let view = |resource: usize| {
            let (mips, layers) = spec.resources[resource].ranges(None);
            PartView { resource: ResourceId(resource as u32), mips, layers, dimension: ViewDimension::D2 }
        };
        let kind = match self.remembers {
            Some(of) => StepKind::Remember {
                source: view(of),
                target: view(self.writes[0].resource),
                first: ClearValue::Zero,
                on_resize: spec.resources[self.writes[0].resource].history.map(|(_, on_resize)| on_resize).unwrap_or_default(),
            },
            None => StepKind::Compute { entry: "main".to_owned(), groups: Workgroups::Fixed([1, 1, 1]) },
        };
        let clears = if self.partial {
            let writes = uses.iter().filter(|used| used.role == Role::Produce);
            writes
                .map(|used| {
                    (
                        PartView {
                            resource: used.resource,
                            mips: used.mips.clone(),
                            layers: used.layers.clone(),
                            dimension: ViewDimension::D2,
                        },
                        ClearValue::Zero,
                    )
                })
                .collect()
        } else {
            Vec::new()
        };
        let batch: Vec<StepIteration> = (0..self.batch)
            .map(|iteration| StepIteration {
                parts: uses
                    .iter()
                    .map(|used| match used.role {
                        Role::Produce => spec.resources[used.resource.index()].ranges(Some(iteration)),
                        _ => (used.mips.clone(), used.layers.clone()),
                    })
                    .collect(),
                // Each iteration has an input of its own.
                inputs: vec![InputId(iteration % INPUTS)],
            })
            .collect();
        let name = self.name.clone();
        let span = Span::NOWHERE;
        let step = Step {
            pass: PassId(place as u32),
            name: name.as_str().into(),
            span,
            shader: None,
            kind,
            bindings: Vec::new(),
            constants: vec![("salt".to_owned(), f64::from(self.salt))],
            clears,
            uses,
            run: self.run,
            batch,
            inputs: self.inputs.iter().map(|input| InputId(*input)).collect(),
        };
        let pass = Pass {
            name: name.into(),
            span,
            block: Default::default(),
            list: 0,
            indices: Vec::new(),
            kind: if self.remembers.is_some() {
                PassKind::Remember
            } else {
                PassKind::Compute { entry: None, work: Work::Groups([1, 1, 1]) }
            },
            shader: None,
            constants: Vec::new(),
            reads: Vec::new(),
            writes: Vec::new(),
            modifies: Vec::new(),
            after: Vec::new(),
            run: self.run,
            batch: None,
            elements: Vec::new(),
        };
        (pass, step)
    }
}
