//! A device whose memories hold numbers for content. Memory is poisoned when it is created and whenever another resource moves in,
//! so that a stale read is never right by accident.

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use luminaire_graph::dirty::{Adoption, Remembered, StepRun};
use luminaire_graph::execute::Backend;
use luminaire_graph::expand::types::{ClearValue, ResourceId};
use luminaire_graph::plan::{MemoryId, MemoryKind, PartView, Plan, PlannedShape, Role, StepKind};

use super::spec::Spec;
use super::value::{DECLARED, FIRST, cropped, ground, layers, made};

/// Whose content is left of a plan before.
const NOBODY: ResourceId = ResourceId(u32::MAX);

#[derive(Debug, Clone, Default)]
pub struct SimulatedMemory {
    /// By layer of a texture, by offset in an arena: content, and whose it is.
    cells: HashMap<u64, (u64, ResourceId)>,
}

/// Everything on the device.
#[derive(Debug, Clone, Default)]
pub struct Simulation {
    pub memories: Vec<SimulatedMemory>,
    pub carried: HashMap<String, (u32, Vec<u64>)>,
    pub poison: u64,
    pub created: usize,
    pub submitted: usize,
    /// Steps after which a frame fails.
    pub fails_after: Option<usize>,
    pub ran: usize,
    /// Nodes left out of the frame, to see whether anybody misses them.
    pub without: BTreeSet<(usize, Option<u32>)>,
    /// Resources that this frame wrote.
    pub touched: BTreeSet<String>,
    /// What a frame is checked against, and what it got wrong.
    pub frame: u64,
    pub revisions: Vec<u64>,
    pub spec: Spec,
    pub expected: HashMap<(usize, u32, Option<String>), u64>,
    pub wrong: Vec<String>,
}

impl Simulation {
    fn poison(&mut self) -> u64 {
        self.poison += 1;
        u64::MAX - self.poison
    }

    /// Moves memories from one plan to the next.
    pub fn adopt(&mut self, before: &Plan, after: &Plan, adoption: &Adoption) {
        let mut carried = HashMap::new();
        for carry in &adoption.carried {
            let content = match carry.from {
                Some(resource) => {
                    let layers = layer_count(before, resource);
                    (edge_of(before, resource), (0..layers).map(|layer| self.load(before, resource, layer)).collect())
                }
                None => self.carried[&carry.name].clone(),
            };
            carried.insert(carry.name.clone(), content);
        }
        self.carried = carried;
        let old = std::mem::take(&mut self.memories);
        self.memories =
            adoption.memories.iter().map(|taken| taken.map_or_else(SimulatedMemory::default, |id| old[id.index()].clone())).collect();
        for (id, taken) in adoption.memories.iter().enumerate() {
            let fits = taken.is_none_or(|taken| same_kind(&before.memories[taken.index()].kind, &after.memories[id].kind));
            assert!(fits, "memory {id} is another than was taken over for it");
        }
        // Ids of resources belong to their plan. Content of resources that stand no more is nobody's.
        let moved = |owner: ResourceId| {
            let name = before.resources.get(owner.index()).map(|resource| &resource.name);
            let place = after.resources.iter().position(|resource| Some(&resource.name) == name);
            place.map_or(NOBODY, |place| ResourceId(place as u32))
        };
        for memory in &mut self.memories {
            for cell in memory.cells.values_mut() {
                cell.1 = moved(cell.1);
            }
        }
    }

    /// Nobody knows what a frame that failed left in these resources.
    pub fn scramble(&mut self, plan: &Plan, resources: &BTreeSet<String>) {
        for index in (0..plan.resources.len()).filter(|index| resources.contains(&plan.resources[*index].name)) {
            let resource = ResourceId(index as u32);
            for layer in 0..layer_count(plan, resource) {
                let poison = self.poison();
                self.store(plan, resource, layer, poison);
            }
        }
    }

    /// Whether the content of the frame before of this resource is carried.
    pub fn carries(&self, name: &str) -> bool {
        self.carried.contains_key(name)
    }

    fn place(plan: &Plan, resource: ResourceId, layer: u32) -> Option<(usize, u64)> {
        let placement = plan.resources[resource.index()].placement?;
        let arena = plan.memories[placement.memory.index()].kind == MemoryKind::Arena;
        Some((placement.memory.index(), if arena { placement.offset } else { u64::from(layer) }))
    }

    pub fn load(&mut self, plan: &Plan, resource: ResourceId, layer: u32) -> u64 {
        let Some((memory, at)) = Self::place(plan, resource, layer) else { return 0 };
        match self.memories[memory].cells.get(&at) {
            Some((content, _)) => *content,
            None => self.poison(),
        }
    }

    fn store(&mut self, plan: &Plan, resource: ResourceId, layer: u32, content: u64) {
        let Some((memory, at)) = Self::place(plan, resource, layer) else { return };
        self.touched.insert(plan.resources[resource.index()].name.clone());
        // Somebody else lived here: nothing of that is left.
        let arena = plan.memories[memory].kind == MemoryKind::Arena;
        let strangers = |(place, owner): (&u64, &ResourceId)| *owner != resource && (!arena || *place == at);
        let moved_in = self.memories[memory].cells.iter().any(|(place, (_, owner))| strangers((place, owner)));
        if moved_in {
            let places: Vec<u64> = self.memories[memory].cells.keys().copied().filter(|place| !arena || *place == at).collect();
            for place in places {
                let poison = self.poison();
                self.memories[memory].cells.insert(place, (poison, resource));
            }
        }
        self.memories[memory].cells.insert(at, (content, resource));
    }

    fn expect(&mut self, plan: &Plan, step: usize, resource: ResourceId, layer: u32, version: Option<&String>, found: u64) {
        let name = &plan.resources[resource.index()].name;
        let wanted = self.expected.get(&(resource.index(), layer, version.cloned())).copied();
        if wanted != Some(found) {
            self.wrong.push(format!("`{}` reads {name}[{layer}] of {version:?}: {found:x}, wanted {wanted:x?}", plan.steps[step].name));
        }
    }

    fn run_node(&mut self, plan: &Plan, run: &StepRun, iteration: Option<u32>) {
        if self.without.contains(&(run.step, iteration)) {
            return;
        }
        let step = &plan.steps[run.step];
        if let StepKind::Remember { source, target, .. } = &step.kind {
            let targets = cells(&target.mips, &target.layers);
            for layer in targets.clone() {
                let name = plan.resources[source.resource.index()].name.clone();
                let content = match run.remembered {
                    Some(Remembered::Here) => self.load(plan, source.resource, layer),
                    Some(Remembered::Carried) => {
                        let (edge, cells) = self.carried.get(&name).cloned().unwrap_or_default();
                        let cell = cells.get(layer as usize).copied();
                        let same = edge == edge_of(plan, target.resource) && cells.len() == targets.len();
                        cell.map_or(FIRST, |cell| if same { cell } else { cropped(cell) })
                    }
                    Some(Remembered::Gone) | None => FIRST,
                };
                self.store(plan, target.resource, layer, content);
            }
            return;
        }
        let spec = self.spec.clone();
        let Some(index) = spec.passes.iter().position(|pass| *pass.name == *step.name) else { return };
        let pass = &spec.passes[index];
        let alive = plan.steps.iter().map(|step| step.name.to_string()).collect();
        let ground = ground(&spec, &alive, (index, iteration));
        let mut reads = Vec::new();
        for used in step.uses.iter().filter(|used| used.role == Role::Read) {
            for layer in cells(&used.mips, &used.layers) {
                let content = self.load(plan, used.resource, layer);
                let version = used.version.and_then(|id| plan.steps.iter().find(|step| step.pass == id)).map(|step| step.name.to_string());
                self.expect(plan, run.step, used.resource, layer, version.as_ref(), content);
                reads.push(content);
            }
        }
        let partial = |resource: ResourceId| pass.partial && pass.writes.iter().any(|part| part.resource == resource.index());
        let mut results = Vec::new();
        for part in pass.writes.iter().chain(&pass.modifies) {
            for layer in layers(&spec, part, iteration) {
                let id = ResourceId(part.resource as u32);
                let modifies = pass.modifies.contains(part);
                let old = if modifies || partial(id) { self.load(plan, id, layer) } else { 0 };
                results.push((id, layer, made(pass, iteration, run.accumulated, self.frame, &self.revisions, &reads, layer, old, ground)));
            }
        }
        for (id, layer, content) in results {
            self.store(plan, id, layer, content);
        }
    }
}

/// The cells of a part: a texture has layers or mip levels, never several of both.
fn cells(mips: &Range<u32>, layers: &Range<u32>) -> Vec<u32> {
    mips.clone().flat_map(|mip| layers.clone().map(move |layer| mip + layer)).collect()
}

fn same_kind(a: &MemoryKind, b: &MemoryKind) -> bool {
    match (a, b) {
        (MemoryKind::Texture(a, format), MemoryKind::Texture(b, other)) => {
            (a.width, a.height, a.layers, a.mips, format) == (b.width, b.height, b.layers, b.mips, other)
        }
        (MemoryKind::Arena, MemoryKind::Arena) => true,
        _ => false,
    }
}

fn layer_count(plan: &Plan, resource: ResourceId) -> u32 {
    match &plan.resources[resource.index()].shape {
        PlannedShape::Texture(shape, _) => shape.layers * shape.mips,
        PlannedShape::Buffer(_) => 1,
    }
}

fn edge_of(plan: &Plan, resource: ResourceId) -> u32 {
    match &plan.resources[resource.index()].shape {
        PlannedShape::Texture(shape, _) => shape.width,
        PlannedShape::Buffer(bytes) => (*bytes / 16) as u32,
    }
}

impl Backend for Simulation {
    type Error = &'static str;

    fn create_memory(&mut self, plan: &Plan, memory: MemoryId) -> Result<(), &'static str> {
        self.created += 1;
        self.memories.resize(plan.memories.len(), SimulatedMemory::default());
        self.memories[memory.index()] = SimulatedMemory::default();
        Ok(())
    }

    fn prepare_step(&mut self, _: &Plan, _: usize) -> Result<(), &'static str> {
        Ok(())
    }

    fn fill(&mut self, plan: &Plan, part: &PartView, _: ClearValue) -> Result<(), &'static str> {
        for layer in cells(&part.mips, &part.layers) {
            self.store(plan, part.resource, layer, DECLARED);
        }
        Ok(())
    }

    fn run_step(&mut self, plan: &Plan, run: &StepRun) -> Result<(), &'static str> {
        self.ran += 1;
        if self.fails_after.is_some_and(|steps| self.ran > steps) {
            return Err("the device refuses");
        }
        match run.iterations.as_slice() {
            [] => self.run_node(plan, run, None),
            some => some.iter().for_each(|iteration| self.run_node(plan, run, Some(*iteration))),
        }
        Ok(())
    }

    fn submit(&mut self, _: &Plan) -> Result<(), &'static str> {
        if self.fails_after.is_some() {
            return Err("the device refuses");
        }
        self.submitted += 1;
        self.carried.clear();
        Ok(())
    }

    // Its bytes know whose they are.
    fn poison(&mut self, _: &Plan, _: ResourceId) -> Result<(), &'static str> {
        Ok(())
    }

    fn abandon(&mut self) {}
}

impl Simulation {
    /// Before a frame.
    pub fn begin(&mut self) {
        (self.ran, self.wrong, self.touched) = (0, Vec::new(), BTreeSet::new());
    }
}
