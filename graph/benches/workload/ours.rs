//! The planner of this crate on declared graphs.
//!
//! A graph becomes what binding would make of it. A resource that is replaced by a second `writes` can't be said in pipelines,
//! where a part has one producer, and is refused; the files have none.

use std::collections::HashMap;
use std::sync::Arc;

use luminaire_graph::allocate::{Allocation, allocate};
use luminaire_graph::bind::types::Bound;
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::expand::types::*;
use luminaire_graph::format::Format;
use luminaire_graph::lifetime::lifetimes;
use luminaire_graph::place::{Alignment, HeapPlan};
use luminaire_graph::plan::{Access, MemoryKind, Retained, Role, Step, StepKind, Use, Workgroups};
use luminaire_graph::schedule::{Schedule, schedule};
use luminaire_graph::source::Span;

use super::declared::{Declared, DeclaredResource, UNIT};

/// What the steps up to the allocation made.
pub struct Ours {
    schedule: Schedule,
    allocation: Allocation,
}

/// From declarations to an order and memory. What binding makes comes along: it becomes a part of the plan, and is not freed.
pub fn plan(declared: &Declared) -> (Bound, Ours) {
    let bound = bound(declared);
    let ours = plan_of(&bound);
    (bound, ours)
}

/// From what binding makes to an order and memory.
pub fn plan_of(bound: &Bound) -> Ours {
    let device = DeviceFacts { memory_budget: u64::MAX, ..DeviceFacts::webgpu_defaults() };
    let retained = outputs_alone(bound);
    let schedule = schedule(bound, &retained).unwrap_or_else(|problems| panic!("{:?}", problems.first()));
    let lifetimes = lifetimes(bound, &schedule, retained);
    let allocation = allocate(bound, &schedule, &lifetimes, &device).unwrap_or_else(|problems| panic!("{:?}", problems.first()));
    Ours { schedule, allocation }
}

/// These graphs have no inputs from outside: all but outputs is transient.
fn outputs_alone(bound: &Bound) -> Vec<Option<Retained>> {
    let mut retained = vec![None; bound.expanded.resources.len()];
    for output in &bound.expanded.outputs {
        retained[output.part.resource.index()] = Some(Retained::Output);
    }
    retained
}

impl Ours {
    /// The order and offsets for one heap.
    pub fn placed(&self) -> HeapPlan {
        self.schedule.placed(Alignment { texture: UNIT, buffer: UNIT })
    }

    /// Bytes of all memories that hold no output, textures and arenas in whole units.
    pub fn allocated(&self, declared: &Declared) -> u64 {
        let transient = self
            .allocation
            .memories
            .iter()
            .filter(|memory| !memory.holders.iter().any(|holder| declared.outputs.contains(&declared.resources[holder.index()].name)));
        transient
            .map(|memory| match memory.kind {
                MemoryKind::Texture(..) => memory.holders.first().map_or(0, |holder| declared.resources[holder.index()].bytes),
                MemoryKind::Arena => memory.bytes.next_multiple_of(UNIT),
            })
            .sum()
    }
}

/// Formats by the names that they have in the files; all else is a buffer.
fn formats() -> [(&'static str, Format); 7] {
    [
        ("r8", "r8unorm"),
        ("r16f", "r16float"),
        ("rgba8", "rgba8unorm"),
        ("rg16f", "rg16float"),
        ("d32", "depth32float"),
        ("rg11b10", "rg11b10ufloat"),
        ("rgba16f", "rgba16float"),
    ]
    .map(|(name, format)| (name, Format::from_name(format).unwrap()))
}

fn resource(declared: &DeclaredResource, formats: &[(&str, Format)]) -> Resource {
    let shape = match formats.iter().find(|(name, _)| *name == declared.format).map(|(_, format)| *format) {
        None => Shape::Buffer { bytes: u64::from(declared.extent[0]) },
        Some(format) => Shape::Texture(TextureShape {
            dimension: if declared.extent[2] > 1 { Dimension::D3 } else { Dimension::D2 },
            formats: [format].into_iter().collect(),
            format_span: Span::NOWHERE,
            width: declared.extent[0],
            height: declared.extent[1],
            depth: declared.extent[2],
            layers: declared.layers,
            mips: declared.mips,
            samples: 1,
        }),
    };
    Resource { name: declared.name.clone(), span: Span::NOWHERE, shape, clear: None, history: None, keep: Keep::Auto }
}

/// What binding would make of it.
fn bound(declared: &Declared) -> Bound {
    let formats = formats();
    let resources: Vec<Resource> = declared.resources.iter().map(|declared| resource(declared, &formats)).collect();
    let ids: HashMap<&str, u32> = resources.iter().enumerate().map(|(index, resource)| (resource.name.as_str(), index as u32)).collect();
    let extent = |resource: &Resource| match &resource.shape {
        Shape::Texture(shape) => (true, shape.mips, shape.layers),
        Shape::Buffer { .. } => (false, 1, 1),
    };
    let extents: Vec<(bool, u32, u32)> = resources.iter().map(extent).collect();
    let mut latest: Vec<Option<PassId>> = vec![None; resources.len()];
    let mut passes = Vec::with_capacity(declared.passes.len());
    let mut steps = Vec::with_capacity(declared.passes.len());
    for (index, entry) in declared.passes.iter().enumerate() {
        let pass = PassId(index as u32);
        let mut uses = Vec::with_capacity(entry.reads.len() + entry.writes.len() + entry.modifies.len());
        for (names, role) in [(&entry.reads, Role::Read), (&entry.writes, Role::Produce), (&entry.modifies, Role::Modify)] {
            for name in names {
                let id = ids[name.as_str()];
                let latest = &mut latest[id as usize];
                let version = if role == Role::Read { *latest } else { latest.replace(pass).and(None) };
                let (is_texture, mips, layers) = extents[id as usize];
                let access = match (is_texture, role) {
                    (true, Role::Read) => Access::Sampled,
                    (true, _) => Access::StorageWrite,
                    (false, Role::Read) => Access::StorageRead,
                    (false, _) => Access::StorageReadWrite,
                };
                let slot = String::new();
                uses.push(Use {
                    resource: ResourceId(id),
                    mips: 0..mips,
                    layers: 0..layers,
                    role,
                    access,
                    version,
                    slot,
                    span: Span::NOWHERE,
                });
            }
        }
        let name: Arc<str> = entry.name.as_str().into();
        passes.push(Pass {
            name: name.clone(),
            span: Span::NOWHERE,
            block: Default::default(),
            list: 0,
            indices: Vec::new(),
            kind: PassKind::Copy,
            shader: None,
            constants: Vec::new(),
            reads: Vec::new(),
            writes: Vec::new(),
            modifies: Vec::new(),
            after: Vec::new(),
            run: Run::OnChange,
            batch: None,
            elements: Vec::new(),
        });
        let kind = StepKind::Compute { entry: String::new(), groups: Workgroups::Fixed([1, 1, 1]) };
        steps.push(Step {
            pass,
            name,
            span: Span::NOWHERE,
            shader: None,
            kind,
            bindings: Vec::new(),
            constants: Vec::new(),
            clears: Vec::new(),
            uses,
            run: Run::OnChange,
            batch: Vec::new(),
            inputs: Vec::new(),
        });
    }
    let output = |name: &String| Output {
        name: name.clone(),
        part: PartRef { resource: ResourceId(ids[name.as_str()]), mips: None, layers: None, version: None, span: Span::NOWHERE },
    };
    let outputs = declared.outputs.iter().map(output).collect();
    let formats = resources
        .iter()
        .map(|resource| if let Shape::Texture(shape) = &resource.shape { shape.formats.first().copied() } else { None })
        .collect();
    let expanded = Expanded {
        doc: String::new(),
        params: Vec::new(),
        resources,
        passes,
        spreads: Vec::new(),
        retained_budget: None,
        outputs,
        offered: Vec::new(),
    };
    Bound {
        expanded,
        shaders: Vec::new(),
        steps,
        formats,
        views: Vec::new(),
        draw_lists: Vec::new(),
        inputs: Vec::new(),
        requirements: Vec::new(),
    }
}
