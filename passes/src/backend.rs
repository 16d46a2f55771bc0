//! The verbs of the plan's walker, on wgpu.
//!
//! Preparing a step creates its objects and encodes it once for nothing, so that whatever wgpu has against it is said then,
//! with the pass's name, and not in the first frame.

use std::collections::HashMap;

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::dirty::{Adoption, Remembered, StepRun};
use luminaire_graph::execute::Backend;
use luminaire_graph::expand::types::{ClearValue, ResourceId};
use luminaire_graph::plan::{MemoryId, PartView, Plan, Step, StepKind};

use crate::clear::ClearStep;
use crate::compute::ComputeStep;
use crate::copy::CopyStep;
use crate::draw::DrawStep;
use crate::errors::{Subject, catch};
use crate::fullscreen::FullscreenStep;
use crate::image::ImageStep;
use crate::poison;
use crate::procedural::ProceduralStep;
use crate::remember::{Carried, RememberStep};
use crate::scene_data::SceneData;
use crate::store::Store;
use crate::timing::{FrameCounts, Stamps, Timing};

/// A step that is ready to run.
#[derive(Debug)]
enum Prepared {
    Draw(Box<DrawStep>),
    Procedural(ProceduralStep),
    Fullscreen(FullscreenStep),
    Compute(ComputeStep),
    Copy(CopyStep),
    Clear(ClearStep),
    Image(ImageStep),
    Remember(RememberStep),
}

/// A value in a part, by its bits.
type FillKey = (PartView, u8, [u64; 4]);

/// Runs a plan's verbs on a device.
#[derive(Debug)]
pub(crate) struct WgpuBackend {
    pub(crate) store: Store,
    pub(crate) timing: Option<Timing>,
    /// What this frame did so far.
    pub(crate) counts: FrameCounts,
    steps: Vec<Option<Prepared>>,
    /// Fills that were needed so far.
    fills: HashMap<FillKey, ClearStep>,
    /// Content of the plan before, by the name of its resource.
    carried: HashMap<String, Carried>,
    encoder: Option<wgpu::CommandEncoder>,
}

impl WgpuBackend {
    pub(crate) fn new(store: Store, timing: Option<Timing>) -> WgpuBackend {
        WgpuBackend {
            store,
            timing,
            counts: FrameCounts::default(),
            steps: Vec::new(),
            fills: HashMap::new(),
            carried: HashMap::new(),
            encoder: None,
        }
    }

    /// For a new plan: what it takes over stands.
    pub(crate) fn successor(
        &self,
        plan: &Plan,
        adoption: &Adoption,
        scene: SceneData,
        same_scene: bool,
        timing: Option<Timing>,
    ) -> WgpuBackend {
        let mut next = WgpuBackend::new(self.store.successor(&adoption.memories, scene, same_scene), timing);
        for carry in &adoption.carried {
            let content = match carry.from {
                Some(resource) => Carried::of(&self.store.memories, plan, resource),
                None => self.carried.get(&carry.name).cloned(),
            };
            next.carried.extend(content.map(|content| (carry.name.clone(), content)));
        }
        next
    }

    /// Forgets the last frame.
    pub(crate) fn begin_frame(&mut self) {
        self.counts = FrameCounts::default();
        if let Some(timing) = &mut self.timing {
            timing.begin();
        }
    }

    /// Takes the scene's draw lists over, where the step draws. The step is prepared.
    pub(crate) fn refresh_draw(&mut self, plan: &Plan, index: usize) -> Result<(), Diagnostic> {
        let step = &plan.steps[index];
        let device = self.store.gpu.device.clone();
        let WgpuBackend { store, steps, .. } = self;
        let Some(Prepared::Draw(draw)) = steps.get_mut(index).and_then(Option::as_mut) else {
            return Ok(());
        };
        let (refreshed, errors) = catch(&device, || draw.refresh(store, plan, step));
        Subject::step(plan, step).check(&errors)?;
        refreshed
    }

    fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        let device = &self.store.gpu.device;
        self.encoder.get_or_insert_with(|| new_encoder(device, "frame"))
    }
}

fn new_encoder(device: &wgpu::Device, label: &str) -> wgpu::CommandEncoder {
    device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(label) })
}

fn fill_key(part: &PartView, value: ClearValue) -> FillKey {
    let (kind, bits) = match value {
        ClearValue::Zero => (0, [0; 4]),
        ClearValue::Color(color) => (1, color.map(f64::to_bits)),
        ClearValue::Depth(depth) => (2, [u64::from(depth.to_bits()), 0, 0, 0]),
        ClearValue::Uint(values) => (3, values.map(u64::from)),
    };
    (part.clone(), kind, bits)
}

impl Backend for WgpuBackend {
    type Error = Diagnostic;

    fn create_memory(&mut self, plan: &Plan, memory: MemoryId) -> Result<(), Diagnostic> {
        let Store { gpu, memories, .. } = &mut self.store;
        memories.create(gpu, plan, memory)?;
        if gpu.poison {
            let holders = &plan.memories[memory.index()].holders;
            holders.iter().try_for_each(|holder| self.poison(plan, *holder))?;
        }
        Ok(())
    }

    fn prepare_step(&mut self, plan: &Plan, index: usize) -> Result<(), Diagnostic> {
        let step = &plan.steps[index];
        let subject = Subject::step(plan, step);
        let device = self.store.gpu.device.clone();
        let store = &mut self.store;
        let (prepared, errors) = catch(&device, || {
            let prepared = prepare_step(store, plan, step, &subject)?;
            // Dropped without being submitted: wgpu checks an encoder when it is finished.
            let mut encoder = new_encoder(&device, &step.name);
            let mut counts = FrameCounts::default();
            let mut clears = Vec::with_capacity(step.clears.len());
            for (part, value) in &step.clears {
                let clear = ClearStep::prepare(store, plan, &subject, part, *value)?;
                clear.encode(&mut encoder);
                clears.push((fill_key(part, *value), clear));
            }
            encode(&prepared, &mut encoder, store, 1, None, &mut counts);
            drop(encoder.finish());
            Ok::<_, Diagnostic>((prepared, clears))
        });
        subject.check(&errors)?;
        let (prepared, clears) = prepared?;
        self.fills.extend(clears);
        if self.steps.len() <= index {
            self.steps.resize_with(index + 1, || None);
        }
        self.steps[index] = Some(prepared);
        Ok(())
    }

    fn fill(&mut self, plan: &Plan, part: &PartView, value: ClearValue) -> Result<(), Diagnostic> {
        let key = fill_key(part, value);
        if !self.fills.contains_key(&key) {
            let name = &plan.resources[part.resource.index()].name;
            let subject = Subject::nowhere(format!("the declared value of `{name}`"));
            let device = self.store.gpu.device.clone();
            let (prepared, errors) = catch(&device, || ClearStep::prepare(&mut self.store, plan, &subject, part, value));
            subject.check(&errors)?;
            self.fills.insert(key.clone(), prepared?);
        }
        self.encoder();
        if let (Some(fill), Some(encoder)) = (self.fills.get(&key), &mut self.encoder) {
            fill.encode(encoder);
        }
        Ok(())
    }

    fn run_step(&mut self, plan: &Plan, run: &StepRun) -> Result<(), Diagnostic> {
        if let Some(remembered) = run.remembered.filter(|remembered| *remembered != Remembered::Here) {
            return self.remember_otherwise(plan, run, remembered);
        }
        self.encoder();
        let WgpuBackend { store, timing, counts, steps, encoder, .. } = self;
        if let (Some(prepared), Some(encoder)) = (steps.get(run.step).and_then(Option::as_ref), encoder) {
            let groups = match prepared {
                Prepared::Draw(step) => Some(step.groups()),
                Prepared::Procedural(step) => Some(step.groups()),
                Prepared::Fullscreen(step) => Some(step.groups()),
                Prepared::Compute(step) => Some(step.groups()),
                Prepared::Copy(_) | Prepared::Clear(_) | Prepared::Image(_) | Prepared::Remember(_) => None,
            };
            if let Some(groups) = groups {
                groups.update(&store.gpu.queue, run);
            }
            let stamps = timing.as_mut().filter(|_| groups.is_some()).and_then(|timing| timing.stamps(run.step));
            encode(prepared, encoder, store, (run.iterations.len() as u32).max(1), stamps, counts);
            counts.steps += 1;
        }
        Ok(())
    }

    fn submit(&mut self, plan: &Plan) -> Result<(), Diagnostic> {
        let Some(mut encoder) = self.encoder.take() else { return Ok(()) };
        if let Some(timing) = &self.timing {
            timing.resolve(&mut encoder);
        }
        let gpu = &self.store.gpu;
        // Errors reach the sink: scopes would cost as much as a pass.
        gpu.queue.submit([encoder.finish()]);
        // A lost device may raise errors everywhere; the loss explains them.
        gpu.check_alive()?;
        let errors = gpu.errors.take();
        if !errors.is_empty() {
            Subject::nowhere(format!("a frame of `{}`", plan.name)).check(&errors)?;
        }
        self.counts.submissions += 1;
        self.carried.clear();
        Ok(())
    }

    fn poison(&mut self, plan: &Plan, resource: ResourceId) -> Result<(), Diagnostic> {
        self.encoder();
        let device = self.store.gpu.device.clone();
        let WgpuBackend { store, encoder: Some(encoder), .. } = self else { return Ok(()) };
        let (poisoned, errors) = catch(&device, || poison::encode(store, encoder, plan, resource));
        Subject::nowhere(format!("the poison of `{}`", plan.resources[resource.index()].name)).check(&errors)?;
        poisoned
    }

    fn abandon(&mut self) {
        self.encoder = None;
    }
}

impl WgpuBackend {
    /// A history whose resource's memory does not hold the frame before.
    fn remember_otherwise(&mut self, plan: &Plan, run: &StepRun, remembered: Remembered) -> Result<(), Diagnostic> {
        let StepKind::Remember { source, target, first, .. } = &plan.steps[run.step].kind else { return Ok(()) };
        self.fill(plan, target, *first)?;
        let name = &plan.resources[source.resource.index()].name;
        if let (Remembered::Carried, Some(content), Some(encoder)) = (remembered, self.carried.get(name), &mut self.encoder) {
            content.encode(encoder, &self.store.memories, plan, target.resource);
        }
        self.counts.steps += 1;
        Ok(())
    }
}

fn prepare_step(store: &mut Store, plan: &Plan, step: &Step, subject: &Subject) -> Result<Prepared, Diagnostic> {
    Ok(match &step.kind {
        StepKind::Draw { .. } => Prepared::Draw(Box::new(DrawStep::prepare(store, plan, step)?)),
        StepKind::Procedural { .. } => Prepared::Procedural(ProceduralStep::prepare(store, plan, step)?),
        StepKind::Fullscreen { fragment, targets } => Prepared::Fullscreen(FullscreenStep::prepare(store, plan, step, fragment, targets)?),
        StepKind::Compute { entry, groups } => Prepared::Compute(ComputeStep::prepare(store, plan, step, entry, *groups)?),
        StepKind::Copy { source, target } => Prepared::Copy(CopyStep::prepare(store, plan, step, source, target)?),
        StepKind::Clear { target, value } => Prepared::Clear(ClearStep::prepare(store, plan, subject, target, *value)?),
        StepKind::Image { target, image } => Prepared::Image(ImageStep::prepare(store, plan, subject, target, image)?),
        StepKind::Remember { source, target, .. } => Prepared::Remember(RememberStep::prepare(store, plan, step, source, target)?),
    })
}

fn encode(
    prepared: &Prepared,
    encoder: &mut wgpu::CommandEncoder,
    store: &Store,
    iterations: u32,
    stamps: Option<Stamps<'_>>,
    counts: &mut FrameCounts,
) {
    match prepared {
        Prepared::Draw(step) => step.encode(encoder, &store.scene, stamps, counts),
        Prepared::Procedural(step) => step.encode(encoder, stamps, counts),
        Prepared::Fullscreen(step) => step.encode(encoder, stamps, counts),
        Prepared::Compute(step) => step.encode(encoder, iterations, stamps, counts),
        Prepared::Copy(step) => step.encode(encoder),
        Prepared::Clear(step) => step.encode(encoder),
        Prepared::Image(step) => step.encode(encoder),
        Prepared::Remember(step) => step.encode(encoder),
    }
}
