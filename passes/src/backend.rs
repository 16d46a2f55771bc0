//! The verbs of the plan's walker, on wgpu.
//!
//! Preparing a step creates its objects and encodes it once for nothing, so that whatever wgpu has against it is said then,
//! with the pass's name, and not in the first frame.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::execute::Backend;
use luminaire_graph::plan::{MemoryId, Plan, Step, StepKind, Workgroups};

use crate::clear::ClearStep;
use crate::compute::ComputeStep;
use crate::copy::CopyStep;
use crate::draw::DrawStep;
use crate::errors::{Subject, catch};
use crate::fullscreen::FullscreenStep;
use crate::store::Store;
use crate::timing::{FrameCounts, Stamps, Timing};

/// A step that is ready to run.
#[derive(Debug)]
enum Prepared {
    Draw(Box<DrawStep>),
    Fullscreen(FullscreenStep),
    Compute(ComputeStep),
    Copy(CopyStep),
    Clear(ClearStep),
}

/// A step with its clears.
#[derive(Debug)]
struct PreparedStep {
    clears: Vec<ClearStep>,
    kind: Prepared,
}

/// Runs a plan's verbs on a device.
#[derive(Debug)]
pub(crate) struct WgpuBackend {
    pub(crate) store: Store,
    pub(crate) timing: Option<Timing>,
    /// What this frame did so far.
    pub(crate) counts: FrameCounts,
    steps: Vec<Option<PreparedStep>>,
    encoder: Option<wgpu::CommandEncoder>,
}

impl WgpuBackend {
    pub(crate) fn new(store: Store, timing: Option<Timing>) -> WgpuBackend {
        WgpuBackend { store, timing, counts: FrameCounts::default(), steps: Vec::new(), encoder: None }
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
        let Some(PreparedStep { kind: Prepared::Draw(draw), .. }) = steps.get_mut(index).and_then(Option::as_mut) else {
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

impl Backend for WgpuBackend {
    type Error = Diagnostic;

    fn create_memory(&mut self, plan: &Plan, memory: MemoryId) -> Result<(), Diagnostic> {
        let Store { gpu, memories, .. } = &mut self.store;
        memories.create(gpu, plan, memory)
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
            for clear in &prepared.clears {
                clear.encode(&mut encoder);
            }
            encode(&prepared.kind, &mut encoder, store, None, &mut counts);
            drop(encoder.finish());
            Ok::<PreparedStep, Diagnostic>(prepared)
        });
        subject.check(&errors)?;
        let prepared = prepared?;
        if self.steps.len() <= index {
            self.steps.resize_with(index + 1, || None);
        }
        self.steps[index] = Some(prepared);
        Ok(())
    }

    fn clear_part(&mut self, _plan: &Plan, step: usize, clear: usize) -> Result<(), Diagnostic> {
        self.encoder();
        let prepared = self.steps.get(step).and_then(Option::as_ref).and_then(|step| step.clears.get(clear));
        if let (Some(clear), Some(encoder)) = (prepared, &mut self.encoder) {
            clear.encode(encoder);
        }
        Ok(())
    }

    fn run_step(&mut self, _plan: &Plan, step: usize) -> Result<(), Diagnostic> {
        self.encoder();
        let WgpuBackend { store, timing, counts, steps, encoder } = self;
        if let (Some(prepared), Some(encoder)) = (steps.get(step).and_then(Option::as_ref), encoder) {
            let measures = matches!(prepared.kind, Prepared::Draw(_) | Prepared::Fullscreen(_) | Prepared::Compute(_));
            let stamps = timing.as_mut().filter(|_| measures).and_then(|timing| timing.stamps(step));
            encode(&prepared.kind, encoder, store, stamps, counts);
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
        let ((), errors) = catch(&gpu.device, || {
            gpu.queue.submit([encoder.finish()]);
        });
        // A lost device may raise errors everywhere; the loss explains them.
        gpu.check_alive()?;
        let subject = Subject::nowhere(format!("a frame of `{}`", plan.name));
        subject.check(&errors)?;
        subject.check(&gpu.errors.take())
    }

    fn abandon(&mut self) {
        self.encoder = None;
    }
}

fn prepare_step(store: &mut Store, plan: &Plan, step: &Step, subject: &Subject) -> Result<PreparedStep, Diagnostic> {
    let mut clears = Vec::with_capacity(step.clears.len());
    for (part, value) in &step.clears {
        clears.push(ClearStep::prepare(store, plan, subject, part, *value)?);
    }
    let kind = match &step.kind {
        StepKind::Draw { .. } => Prepared::Draw(Box::new(DrawStep::prepare(store, plan, step)?)),
        StepKind::Fullscreen { fragment, targets } => Prepared::Fullscreen(FullscreenStep::prepare(store, plan, step, fragment, targets)?),
        StepKind::Compute { entry, groups: Workgroups::Fixed(groups) } => {
            Prepared::Compute(ComputeStep::prepare(store, plan, step, entry, *groups)?)
        }
        StepKind::Copy { source, target } => Prepared::Copy(CopyStep::prepare(store, plan, step, source, target)?),
        StepKind::Compute { .. } | StepKind::Remember { .. } => {
            return Err(subject.error("execute::kind", "this kind of work is not known"));
        }
        StepKind::Clear { target, value } => Prepared::Clear(ClearStep::prepare(store, plan, subject, target, *value)?),
    };
    Ok(PreparedStep { clears, kind })
}

fn encode(prepared: &Prepared, encoder: &mut wgpu::CommandEncoder, store: &Store, stamps: Option<Stamps<'_>>, counts: &mut FrameCounts) {
    match prepared {
        Prepared::Draw(step) => step.encode(encoder, &store.scene, stamps, counts),
        Prepared::Fullscreen(step) => step.encode(encoder, stamps, counts),
        Prepared::Compute(step) => step.encode(encoder, stamps, counts),
        Prepared::Copy(step) => step.encode(encoder),
        Prepared::Clear(step) => step.encode(encoder),
    }
}
