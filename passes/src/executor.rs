//! A plan and a scene on a device: prepared once, rendered frame after frame.
//!
//! Guarantees: everything is checked and created by [`Executor::new`]; a frame runs what the changes reach, and creates nothing but
//! its command buffer (a declared value that is set for the first time apart); the same plan and scene give the same images. After an error the executor may be dropped or used
//! on; where the device was lost, after [`Executor::recover`].

use std::sync::Arc;

use luminaire_graph::diagnostic::{Diagnostic, did_you_mean};
use luminaire_graph::dirty::{Frame, Tracker};
use luminaire_graph::dump;
use luminaire_graph::execute::{self, Backend};
use luminaire_graph::expand::types::Run;
use luminaire_graph::plan::{PartView, Plan, PlannedShape, StepKind};
use luminaire_graph::published::{PublishedScene, PublishedSchema};

use crate::backend::WgpuBackend;
use crate::check;
use crate::device::Gpu;
use crate::readback::{self, ReadImage};
use crate::revisions::Revisions;
use crate::scene_data::{Changed, SceneData};
use crate::store::Store;
use crate::timing::{FrameCounts, StepTime, Timing};

/// A prepared plan.
#[derive(Debug)]
pub struct Executor {
    plan: Arc<Plan>,
    backend: WgpuBackend,
    /// As last taken over.
    scene: Arc<PublishedScene>,
    tracker: Tracker,
    revisions: Revisions,
    /// By input of the plan.
    now: Vec<u64>,
    last: Arc<Frame>,
}

/// What a frame did and cost.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FrameStats {
    /// Counts of this frame.
    pub counts: FrameCounts,
    /// GPU time of the passes that have one, in the order of the plan; `None` if the device was not opened with timing or
    /// can't measure.
    pub times: Option<Vec<StepTime>>,
    /// Pipelines created since the executor was.
    pub pipelines_created: u64,
    /// Bind groups created since the executor was.
    pub bind_groups_created: u64,
    /// Everything created since the executor was: memories, views, pipelines, bind groups, and what the scene takes.
    pub created: u64,
    /// Nothing ran: the outputs are what they will be until something changes.
    pub settled: bool,
}

impl Executor {
    /// Checks the plan against the device and the scene against the plan, and creates everything.
    ///
    /// Errors, all at once where they don't follow from each other: `execute::too-large`, `execute::over-budget`, what is wrong
    /// with the scene (`execute::missing-table` and others), and per pass `execute::validation` (wgpu refuses it),
    /// `execute::out-of-memory`, `execute::internal`, `execute::device-lost`.
    pub fn new(gpu: &Gpu, plan: Arc<Plan>, schema: &PublishedSchema, scene: Arc<PublishedScene>) -> Result<Executor, Vec<Diagnostic>> {
        let backend = start(gpu, &plan, schema, &scene)?;
        let tracker = Tracker::new(Arc::clone(&plan));
        let mut revisions = Revisions::default();
        let now = revisions.update(&plan, &scene);
        Ok(Executor { plan, backend, scene, tracker, revisions, now, last: Arc::default() })
    }

    /// Whether the device is lost. Nothing but [`Executor::recover`] helps then. Waits for the device, since wgpu tells nobody before
    /// all work has ended.
    pub fn is_lost(&self) -> bool {
        self.gpu().wait().is_err()
    }

    /// Goes on with another device after the one that it had was lost. All content is gone: the next frame runs everything, what
    /// accumulates starts again, the past is its first value, and counts of what was created begin anew. Errors as of [`Executor::new`]; it may be tried again then.
    pub fn recover(&mut self, gpu: &Gpu) -> Result<(), Vec<Diagnostic>> {
        self.backend = start(gpu, &self.plan, &self.backend.store.schema, &self.scene)?;
        self.tracker.lose();
        self.last = Arc::default();
        Ok(())
    }

    /// Turns to another plan on the same device: after a resize, a parameter, an edited file, another output. What is the same
    /// stays held, and pipelines that did not change are not built again. After an error the old plan goes on.
    pub fn adopt(&mut self, plan: Arc<Plan>, scene: Arc<PublishedScene>) -> Result<(), Vec<Diagnostic>> {
        let Store { gpu, schema, scene: data, .. } = &self.backend.store;
        let (gpu, schema) = (gpu.clone(), schema.clone());
        let problems = check::check(&plan, &scene, gpu.facts());
        if !problems.is_empty() {
            return Err(problems);
        }
        let (data, changed) = data.successor(&gpu, &plan, &schema, Arc::clone(&scene))?;
        let timing =
            Timing::new(&gpu, if self.backend.timing.is_some() { plan.steps.len() } else { 0 }).map_err(|problem| vec![problem])?;
        let mut tracker = self.tracker.clone();
        let adoption = tracker.adopt(Arc::clone(&plan));
        let mut backend = self.backend.successor(&self.plan, &adoption, data, !changed.bound, timing);
        let prepared = execute::prepare(&plan, &adoption.memories, &mut backend);
        if let Err(problems) = gpu.check_alive().map_err(|problem| vec![problem]).and(prepared) {
            // The new scene was written over the old one.
            self.backend.store.scene.forget();
            return Err(problems);
        }
        self.now = self.revisions.update(&plan, &backend.store.scene.scene);
        (self.plan, self.backend, self.scene, self.tracker, self.last) = (plan, backend, scene, tracker, Arc::default());
        Ok(())
    }

    /// The device that it runs on.
    pub fn gpu(&self) -> &Gpu {
        &self.backend.store.gpu
    }

    /// The plan that it runs.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The scene that it shows.
    pub fn scene(&self) -> Arc<PublishedScene> {
        Arc::clone(&self.scene)
    }

    /// Takes another state of the scene over. Equal bytes cost a comparison, other bytes of equal length are written in place;
    /// bind groups are made anew only if a table changed its length or a texture changed, and other draw lists create only what
    /// they show for the first time. The scene must fit the same plan: it publishes the draw lists and views that the plan asks
    /// for.
    pub fn update_scene(&mut self, scene: Arc<PublishedScene>) -> Result<(), Vec<Diagnostic>> {
        let Store { gpu, schema, scene: data, bind_groups, .. } = &mut self.backend.store;
        let before = Arc::clone(&data.scene);
        let changed = data.update(gpu, &self.plan, schema, Arc::clone(&scene))?;
        self.scene = scene;
        if !Arc::ptr_eq(&before, &data.scene) {
            self.now = self.revisions.update(&self.plan, &data.scene);
        }
        if changed.bound {
            bind_groups.forget_materials();
        }
        let mut problems = Vec::new();
        for (index, step) in self.plan.steps.iter().enumerate() {
            let binds = !matches!(step.kind, StepKind::Copy { .. } | StepKind::Clear { .. } | StepKind::Image { .. });
            let done = match changed {
                Changed { bound: true, .. } if binds => self.backend.prepare_step(&self.plan, index),
                Changed { draws: true, .. } => self.backend.refresh_draw(&self.plan, index),
                _ => Ok(()),
            };
            problems.extend(done.err());
        }
        if problems.is_empty() { Ok(()) } else { Err(problems) }
    }

    /// Runs what the changes since the last frame reach. Where nothing changed nothing is submitted. A frame that fails is decided
    /// again by the next call. A lost device is noticed even where nothing runs,
    /// when its last work has ended.
    pub fn render_frame(&mut self) -> Result<FrameStats, Vec<Diagnostic>> {
        self.backend.begin_frame();
        let frame = self.tracker.frame(&self.now);
        if frame.is_empty() {
            self.gpu().check_alive().map_err(|problem| vec![problem])?;
        }
        let ran = if self.backend.store.gpu.poison {
            execute::execute_poisoned(&self.tracker, &frame, &mut self.backend)
        } else {
            execute::execute(&self.plan, &frame, &mut self.backend)
        };
        match ran {
            Ok(()) => self.tracker.commit(&frame, &self.now),
            Err(problem) => {
                if self.backend.store.gpu.check_alive().is_err() {
                    self.tracker.lose();
                } else {
                    self.tracker.fail(&frame);
                }
                return Err(vec![problem]);
            }
        }
        let empty = frame.is_empty();
        self.last = frame;
        let times = match &self.backend.timing {
            Some(timing) => Some(timing.read(&self.backend.store.gpu).map_err(|problem| vec![problem])?),
            None => None,
        };
        let named = |(step, milliseconds): (usize, f64)| StepTime { name: self.plan.steps[step].name.clone(), milliseconds };
        Ok(FrameStats {
            counts: self.backend.counts,
            settled: empty,
            created: self.backend.store.created(),
            times: times.map(|times| times.into_iter().map(named).collect()),
            pipelines_created: self.backend.store.pipelines.created(),
            bind_groups_created: self.backend.store.bind_groups.created(),
        })
    }

    /// Why each pass ran in the last frame or did not; see `luminaire explain`.
    pub fn explain(&self, pass: Option<&str>) -> String {
        dump::explain_text(&self.tracker, &self.last, pass)
    }

    /// The passes that ran in the last frame, in order.
    pub fn ran(&self) -> Vec<&str> {
        self.last.runs.iter().map(|run| &*self.plan.steps[run.step].name).collect()
    }

    /// Whether some pass runs in every frame, so that it never settles.
    pub fn never_settles(&self) -> bool {
        self.plan.steps.iter().any(|step| step.run == Run::EveryFrame)
    }

    /// Waits until the GPU has done all frames.
    pub fn wait(&self) -> Result<(), Vec<Diagnostic>> {
        self.backend.store.gpu.wait().map_err(|problem| vec![problem])
    }

    /// An output that is a texture: one mip level, all layers. Waits for the GPU. Errors: `execute::unknown-output`,
    /// `execute::unreadable-output`.
    pub fn read_output(&self, name: &str) -> Result<ReadImage, Vec<Diagnostic>> {
        let store = &self.backend.store;
        self.output(name)
            .and_then(|part| readback::read_texture(&store.gpu, &self.plan, &store.memories, name, part))
            .map_err(|problem| vec![problem])
    }

    /// An output that is a buffer, as bytes. Waits for the GPU. Errors as [`Executor::read_output`].
    pub fn read_buffer(&self, name: &str) -> Result<Vec<u8>, Vec<Diagnostic>> {
        let store = &self.backend.store;
        self.output(name)
            .and_then(|part| readback::read_bytes(&store.gpu, &self.plan, &store.memories, name, part))
            .map_err(|problem| vec![problem])
    }

    /// A view of an output that is a texture, for those who draw beside the executor (a viewer).
    pub fn output_view(&mut self, name: &str) -> Result<wgpu::TextureView, Vec<Diagnostic>> {
        let part = self.output(name).map_err(|problem| vec![problem])?.clone();
        let no_texture = || Diagnostic::error("execute::unreadable-output", format!("output `{name}` is no texture"));
        if !matches!(self.plan.resources[part.resource.index()].shape, PlannedShape::Texture(..)) {
            return Err(vec![no_texture()]);
        }
        self.backend.store.memories.view(&self.plan, &part).ok_or_else(|| vec![no_texture()])
    }

    fn output(&self, name: &str) -> Result<&PartView, Diagnostic> {
        let outputs = &self.plan.outputs;
        outputs.iter().find(|output| output.name == name).map(|output| &output.view).ok_or_else(|| {
            Diagnostic::error("execute::unknown-output", format!("`{}` has no output `{name}`", self.plan.name))
                .maybe_hint(did_you_mean(name, outputs.iter().map(|output| output.name.as_str())))
        })
    }
}

/// Checks a plan and a scene against a device, and creates everything.
fn start(gpu: &Gpu, plan: &Plan, schema: &PublishedSchema, scene: &Arc<PublishedScene>) -> Result<WgpuBackend, Vec<Diagnostic>> {
    let problems = check::check(plan, scene, gpu.facts());
    if !problems.is_empty() {
        return Err(problems);
    }
    let data = SceneData::new(gpu, plan, schema, Arc::clone(scene))?;
    let timing = Timing::new(gpu, plan.steps.len()).map_err(|problem| vec![problem])?;
    let mut backend = WgpuBackend::new(Store::new(gpu.clone(), schema.clone(), data), timing);
    let prepared = execute::prepare(plan, &[], &mut backend);
    // A lost device may raise errors everywhere; the loss explains them.
    gpu.check_alive().map_err(|problem| vec![problem])?;
    prepared?;
    Ok(backend)
}
