//! Bound pipelines by hand, from a line-based notation, for tests of the steps after binding:
//!
//! ```text
//! texture NAME FORMAT WIDTHxHEIGHT [mips N] [layers N] [depth N] [cube] [samples N] [clear]
//! buffer NAME BYTES [clear]
//! pass NAME [read PART] [uniform PART] [tested PART] [write PART] [modify PART] [copy PART to PART] [after PASS]
//! output NAME PART
//! ```
//!
//! A part is `name`, `name.mip(1)`, `name.layer(2)`, each with `@pass` for a version. Places point into the notation.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use luminaire_graph::allocate::{Allocation, allocate};
use luminaire_graph::assemble::assemble;
use luminaire_graph::bind::types::Bound;
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::{Diagnostic, render};
use luminaire_graph::dirty::retention;
use luminaire_graph::expand::types::*;
use luminaire_graph::format::Format;
use luminaire_graph::lifetime::{Lifetimes, lifetimes};
use luminaire_graph::plan::{Access, Plan, Role, Step, StepKind, Use, Workgroups};
use luminaire_graph::schedule::{Schedule, schedule};
use luminaire_graph::source::{FileId, SourceMap, Span};

/// A pipeline of the notation.
pub struct Fixture {
    pub bound: Bound,
    pub sources: SourceMap,
}

/// A word with its place.
#[derive(Clone, Copy)]
struct Word<'a> {
    text: &'a str,
    start: usize,
    file: FileId,
}

impl Word<'_> {
    fn span(&self) -> Span {
        Span::new(self.file, self.start, self.start + self.text.len())
    }

    fn number<T: std::str::FromStr>(&self) -> T {
        self.text.parse().unwrap_or_else(|_| panic!("`{}` is no number", self.text))
    }
}

/// Reads the notation; panics where it is wrong.
pub fn fixture(text: &str) -> Fixture {
    let mut sources = SourceMap::default();
    let file = sources.add("test.graph", text);
    let mut lines = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let words: Vec<Word<'_>> = line
            .split_whitespace()
            .map(|word| Word { text: word, start: start + (word.as_ptr() as usize - line.as_ptr() as usize), file })
            .collect();
        if !words.is_empty() {
            lines.push(words);
        }
        start += line.len();
    }
    let mut resources = Vec::new();
    for words in lines.iter().filter(|words| matches!(words[0].text, "texture" | "buffer")) {
        resources.push(resource(words));
    }
    let pass_names: Vec<&str> = lines.iter().filter(|words| words[0].text == "pass").map(|words| words[1].text).collect();
    let names = Names { resources: &resources, passes: &pass_names };
    let (mut passes, mut steps, mut outputs) = (Vec::new(), Vec::new(), Vec::new());
    for words in &lines {
        match words[0].text {
            "pass" => {
                let (pass, step) = names.pass(words, steps.len());
                passes.push(pass);
                steps.push(step);
            }
            "output" => outputs.push(Output { name: words[1].text.to_owned(), part: names.part(words[2]) }),
            "texture" | "buffer" => {}
            other => panic!("`{other}` is no kind of line"),
        }
    }
    let formats = resources
        .iter()
        .map(|resource| match &resource.shape {
            Shape::Texture(shape) => shape.formats.first().copied(),
            Shape::Buffer { .. } => None,
        })
        .collect();
    let expanded = Expanded {
        doc: "A test.".to_owned(),
        params: Vec::new(),
        resources,
        passes,
        spreads: Vec::new(),
        retained_budget: None,
        outputs,
        offered: Vec::new(),
    };
    let bound = Bound {
        expanded,
        shaders: Vec::new(),
        steps,
        formats,
        views: Vec::new(),
        draw_lists: Vec::new(),
        inputs: Vec::new(),
        requirements: Vec::new(),
    };
    Fixture { bound, sources }
}

fn resource(words: &[Word<'_>]) -> Resource {
    let mut clear = None;
    let shape = if words[0].text == "buffer" {
        clear = words.get(3).map(|_| ClearValue::Zero);
        Shape::Buffer { bytes: words[2].number() }
    } else {
        let format = Format::from_name(words[2].text).unwrap_or_else(|| panic!("`{}` is no format", words[2].text));
        let (width, height) = words[3].text.split_once('x').expect("an extent is WIDTHxHEIGHT");
        let mut shape = TextureShape {
            dimension: Dimension::D2,
            formats: [format].into_iter().collect(),
            format_span: words[2].span(),
            width: width.parse().expect("a width is a number"),
            height: height.parse().expect("a height is a number"),
            depth: 1,
            layers: 1,
            mips: 1,
            samples: 1,
        };
        let mut rest = words[4..].iter();
        while let Some(word) = rest.next() {
            let mut number = || rest.next().expect("a number follows").number();
            match word.text {
                "mips" => shape.mips = number(),
                "layers" => shape.layers = number(),
                "samples" => shape.samples = number(),
                "depth" => (shape.depth, shape.dimension) = (number(), Dimension::D3),
                "cube" => (shape.layers, shape.dimension) = (6, Dimension::Cube),
                "clear" => clear = Some(ClearValue::Zero),
                other => panic!("`{other}` says nothing of a texture"),
            }
        }
        Shape::Texture(shape)
    };
    Resource { name: words[1].text.to_owned(), span: words[1].span(), shape, clear, history: None, keep: Keep::Auto }
}

struct Names<'a> {
    resources: &'a [Resource],
    passes: &'a [&'a str],
}

impl Names<'_> {
    fn pass_id(&self, name: &str) -> PassId {
        PassId(self.passes.iter().position(|known| *known == name).unwrap_or_else(|| panic!("no pass `{name}`")) as u32)
    }

    fn part(&self, word: Word<'_>) -> PartRef {
        let (part, version) = word.text.split_once('@').map_or((word.text, None), |(part, pass)| (part, Some(self.pass_id(pass))));
        let mut pieces = part.split('.');
        let name = pieces.next().expect("a part has a name");
        let resource = self.resources.iter().position(|known| known.name == name).unwrap_or_else(|| panic!("no resource `{name}`"));
        let mut found = PartRef { resource: ResourceId(resource as u32), mips: None, layers: None, version, span: word.span() };
        for piece in pieces {
            let (what, index) = piece.trim_end_matches(')').split_once('(').expect("a piece is what(index)");
            let index = Some(Indices::one(index.parse().expect("an index is a number")));
            match what {
                "mip" => found.mips = index,
                _ => found.layers = index,
            }
        }
        found
    }

    fn used(&self, word: Word<'_>, role: Role, access: Access) -> Use {
        let part = self.part(word);
        let (mips, layers) = match &self.resources[part.resource.index()].shape {
            Shape::Texture(shape) if shape.dimension == Dimension::D3 => (shape.mips, 1),
            Shape::Texture(shape) => (shape.mips, shape.layers),
            Shape::Buffer { .. } => (1, 1),
        };
        let range = |some: Option<Indices>, all| some.map_or(0..all, Indices::range);
        Use {
            resource: part.resource,
            mips: range(part.mips, mips),
            layers: range(part.layers, layers),
            role,
            access,
            version: part.version,
            slot: word.text.split(['.', '@']).next().unwrap_or_default().to_owned(),
            span: word.span(),
        }
    }

    fn pass(&self, words: &[Word<'_>], index: usize) -> (Pass, Step) {
        let (mut uses, mut after) = (Vec::new(), Vec::new());
        let mut rest = words[2..].iter();
        while let Some(word) = rest.next() {
            let part = *rest.next().expect("a part follows");
            let shape = (word.text != "after").then(|| &self.resources[self.part(part).resource.index()].shape);
            let is_buffer = matches!(shape, Some(Shape::Buffer { .. }));
            let is_depth = matches!(shape, Some(Shape::Texture(shape)) if shape.formats[0].is_depth());
            let (role, access) = match word.text {
                "read" => (Role::Read, if is_buffer { Access::StorageRead } else { Access::Sampled }),
                "uniform" => (Role::Read, Access::Uniform),
                "tested" => (Role::Modify, Access::DepthReadOnly),
                "write" if is_depth => (Role::Produce, Access::DepthAttachment),
                "write" => (Role::Produce, Access::StorageWrite),
                "modify" if is_depth => (Role::Modify, Access::DepthAttachment),
                "modify" => (Role::Modify, Access::StorageReadWrite),
                "copy" => (Role::Read, Access::CopySource),
                "to" => (Role::Produce, Access::CopyTarget),
                "after" => {
                    after.push(self.pass_id(part.text));
                    continue;
                }
                other => panic!("`{other}` is nothing that a pass does"),
            };
            uses.push(self.used(part, role, access));
        }
        uses.sort_by_key(|used| used.role);
        let kind = PassKind::Compute { entry: None, work: Work::Groups([1, 1, 1]) };
        let name = words[1].text.to_owned();
        let span = words[1].span();
        let pass = Pass {
            name: name.as_str().into(),
            span,
            block: Default::default(),
            list: 0,
            indices: Vec::new(),
            kind,
            shader: None,
            constants: Vec::new(),
            reads: Vec::new(),
            writes: Vec::new(),
            modifies: Vec::new(),
            after,
            run: Run::OnChange,
            batch: None,
            elements: Vec::new(),
        };
        let step = Step {
            pass: PassId(index as u32),
            name: name.into(),
            span,
            shader: None,
            kind: StepKind::Compute { entry: "main".to_owned(), groups: Workgroups::Fixed([1, 1, 1]) },
            bindings: Vec::new(),
            constants: Vec::new(),
            clears: Vec::new(),
            uses,
            run: Run::OnChange,
            batch: Vec::new(),
            inputs: Vec::new(),
        };
        (pass, step)
    }
}

/// All results up to the allocation; panics on an error.
pub struct Planned {
    pub schedule: Schedule,
    pub lifetimes: Lifetimes,
    pub allocation: Allocation,
}

impl Fixture {
    /// The schedule; panics on an error.
    pub fn schedule(&self) -> Schedule {
        let scheduled = schedule(&self.bound, &retention(&self.bound).retained);
        scheduled.unwrap_or_else(|problems| panic!("{}", render(&problems, &self.sources, false)))
    }

    /// The problems of scheduling, as text.
    pub fn problems(&self) -> String {
        let scheduled = schedule(&self.bound, &retention(&self.bound).retained);
        render(&scheduled.map_or_else(|problems| problems, |schedule| schedule.warnings(&self.bound)), &self.sources, false)
    }

    /// Plans on a device.
    pub fn planned_on(&self, device: &DeviceFacts) -> Result<Planned, Vec<Diagnostic>> {
        let schedule = self.schedule();
        let lifetimes = lifetimes(&self.bound, &schedule, retention(&self.bound).retained);
        let allocation = allocate(&self.bound, &schedule, &lifetimes, device)?;
        Ok(Planned { schedule, lifetimes, allocation })
    }

    /// Plans on a device whose memory is no matter.
    pub fn planned(&self) -> Planned {
        let device = DeviceFacts { memory_budget: u64::MAX, ..DeviceFacts::webgpu_defaults() };
        self.planned_on(&device).unwrap_or_else(|problems| panic!("{}", render(&problems, &self.sources, false)))
    }

    /// The whole plan.
    pub fn plan(&self) -> Plan {
        let Planned { schedule, lifetimes, allocation } = self.planned();
        assemble(self.bound.clone(), schedule, lifetimes, allocation, retention(&self.bound).for_inputs, "test.graph", [64, 64])
    }

    /// The names of the passes that run, in order.
    pub fn order(&self) -> Vec<String> {
        self.schedule().order.iter().map(|pass| self.bound.steps[pass.index()].name.to_string()).collect()
    }
}
