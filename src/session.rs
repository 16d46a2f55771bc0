//! One rendering: a scene, a pipeline compiled for it and for an adapter, and the executor that runs it.

use std::path::Path;
use std::sync::Arc;

use luminaire_graph::compile::{Compilation, CompileInput, compile};
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::{Diagnostic, did_you_mean, has_errors};
use luminaire_graph::plan::Plan;
use luminaire_graph::published::{PublishedScene, SceneCounts};
use luminaire_graph::source::SourceMap;
use luminaire_passes::{Adapter, Executor, FrameStats, Gpu};
use luminaire_scenes::publish::{PublishRequest, Published, Publisher, counts, schema};
use luminaire_scenes::scene_file;
use luminaire_scenes::world::{World, assign_slots};

use crate::files::{DiskFiles, embedded_pipelines, embedded_scene, embedded_scenes};
use crate::image_file::LinearImage;
use crate::ron_kind::RonKind;

/// Problems and the texts that they point into.
pub type Problems = (Vec<Diagnostic>, SourceMap);

/// A scene with its warnings.
#[derive(Debug)]
pub struct LoadedScene {
    /// Entities, meshes, materials, images.
    pub world: World,
    /// Warnings.
    pub diagnostics: Vec<Diagnostic>,
    /// Texts that the warnings point into.
    pub sources: SourceMap,
}

/// Loads a scene by path, or an embedded one by name. `asset_root` is the folder that its files may come from; the scene's own
/// if not given.
pub fn load_scene(path: &str, asset_root: Option<&Path>) -> Result<LoadedScene, Problems> {
    let mut sources = SourceMap::default();
    let on_disk = Path::new(path);
    let loaded = match (on_disk.exists(), embedded_scene(path)) {
        (false, Some(embedded)) => scene_file::load_scene_text(&embedded.name, &embedded.text, &mut sources),
        _ => scene_file::load_scene(on_disk, asset_root, &mut sources),
    };
    match loaded {
        Ok(loaded) => Ok(LoadedScene { world: loaded.world, diagnostics: loaded.warnings, sources }),
        Err(diagnostics) => Err((explain_scene_errors(path, diagnostics, &sources), sources)),
    }
}

/// A path that leads nowhere gets the scenes that there are; a pipeline in a scene's place gets that said, and nothing else.
fn explain_scene_errors(path: &str, mut diagnostics: Vec<Diagnostic>, sources: &SourceMap) -> Vec<Diagnostic> {
    let known = embedded_scenes().join(", ");
    if first_text(sources).and_then(RonKind::of) == Some(RonKind::Pipeline) {
        let hint = format!("scenes are .gltf, .glb and scene .ron files; those that come with the program: {known}");
        return vec![Diagnostic::error("scene::is-pipeline", format!("`{path}` is a pipeline, and a scene belongs here")).hint(hint)];
    }
    if !Path::new(path).exists()
        && let Some(first) = diagnostics.first_mut()
    {
        if first.code == "scene::unknown-kind" {
            first.message = format!("there is no scene `{path}`");
        }
        let nearest = did_you_mean(path, embedded_scenes().iter().map(String::as_str));
        first.hint = Some(
            nearest.unwrap_or_else(|| format!("scenes are .gltf, .glb and scene .ron files; those that come with the program: {known}")),
        );
    }
    diagnostics
}

/// Compiles; a scene in a pipeline's place gets that said, and nothing else.
pub fn compile_pipeline(input: &CompileInput<'_>) -> Compilation {
    let mut compilation = compile(input);
    if compilation.plan.is_none() && first_text(&compilation.sources).and_then(RonKind::of) == Some(RonKind::Scene) {
        let known = embedded_pipelines().join(", ");
        let message = format!("`{}` is a scene, and a pipeline belongs here", input.pipeline);
        let hint = format!("name the scene after --scene; pipelines that come with the program: {known}");
        compilation.diagnostics = vec![Diagnostic::error("compile::is-scene", message).hint(hint)];
    }
    compilation
}

/// The text that was read first: the pipeline or scene itself.
fn first_text(sources: &SourceMap) -> Option<&str> {
    sources.iter().next().map(|(_, file)| &*file.text)
}

/// What to render.
#[derive(Debug, Clone)]
pub struct RenderRequest<'a> {
    /// The pipeline's path.
    pub pipeline: &'a str,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The camera's name.
    pub camera: Option<&'a str>,
    /// Parameters that are set.
    pub sets: &'a [(String, String)],
    /// The outputs asked for; `None` asks for all.
    pub outputs: Option<&'a [String]>,
    /// Measure the GPU time of each pass.
    pub timing: bool,
    /// Bytes that the plan may allocate; `None` leaves it to the adapter.
    pub memory_budget: Option<u64>,
}

/// A plan that is ready to render.
#[derive(Debug)]
pub struct Session {
    /// What runs.
    pub plan: Arc<Plan>,
    /// What it runs on.
    pub adapter: Adapter,
    /// Warnings of the compilation and the publishing.
    pub warnings: Problems,
    executor: Executor,
    publisher: Publisher,
    camera: Option<String>,
    /// What the scene had when the plan was compiled.
    counts: SceneCounts,
    facts: DeviceFacts,
    timing: bool,
    recoveries: u64,
}

/// A plan, with the warnings of its compilation and the texts that they point into.
struct Compiled {
    plan: Arc<Plan>,
    counts: SceneCounts,
    warnings: Vec<Diagnostic>,
    sources: SourceMap,
}

fn compile_for(facts: &DeviceFacts, world: &mut World, request: &RenderRequest<'_>) -> Result<Compiled, Problems> {
    let counts = counts_now(world);
    let compilation = compile_pipeline(&CompileInput {
        pipeline: request.pipeline,
        files: &DiskFiles::for_pipeline(Path::new(request.pipeline)),
        published: &schema(),
        counts: &counts,
        device: facts,
        output: request.size,
        sets: request.sets,
        outputs: request.outputs,
    });
    let (warnings, sources) = (compilation.diagnostics, compilation.sources);
    match compilation.plan {
        Some(plan) => Ok(Compiled { plan: Arc::new(plan), counts, warnings, sources }),
        None => Err((warnings, sources)),
    }
}

/// Whether frames of a pipeline depend on those before them ([`Plan::carries_over`]), for what the world has now.
pub fn carries_over(adapter: &Adapter, world: &mut World, request: &RenderRequest<'_>) -> Result<bool, Problems> {
    compile_for(&adapter.facts(), world, request).map(|compiled| compiled.plan.carries_over())
}

/// What the world has, with what has just come into it.
fn counts_now(world: &mut World) -> SceneCounts {
    assign_slots(world);
    counts(world)
}

/// What the world publishes for a plan.
fn publish_for(
    publisher: &mut Publisher,
    world: &mut World,
    plan: &Plan,
    camera: Option<&str>,
    facts: &DeviceFacts,
) -> Result<Published, Vec<Diagnostic>> {
    let (views, draw_lists) = (&plan.views, &plan.draw_lists);
    publisher.publish(world, &PublishRequest { camera, extent: plan.extent, views, draw_lists, max_texture_2d: facts.max_texture_2d })
}

impl Session {
    /// Compiles a pipeline for a world and an adapter, publishes the world, and creates everything on the GPU.
    pub fn new(world: &mut World, request: &RenderRequest<'_>) -> Result<Session, Problems> {
        let adapter = Adapter::choose(request.memory_budget).map_err(|problems| (problems, SourceMap::default()))?;
        Session::on(&adapter, world, request)
    }

    /// The same on an adapter that the caller has chosen.
    pub fn on(adapter: &Adapter, world: &mut World, request: &RenderRequest<'_>) -> Result<Session, Problems> {
        let facts = adapter.facts();
        let Compiled { plan, counts, mut warnings, sources } = compile_for(&facts, world, request)?;
        let mut publisher = Publisher::default();
        let made = publish_for(&mut publisher, world, &plan, request.camera, &facts).and_then(|published| {
            warnings.extend(published.warnings);
            let gpu = adapter.open(&plan.requirements, request.timing)?;
            Executor::new(&gpu, Arc::clone(&plan), &schema(), Arc::new(published.scene))
        });
        match made {
            Ok(executor) => Ok(Session {
                plan,
                adapter: adapter.clone(),
                timing: request.timing,
                recoveries: 0,
                warnings: (warnings, sources),
                executor,
                publisher,
                camera: request.camera.map(str::to_owned),
                counts,
                facts,
            }),
            Err(problems) => {
                warnings.extend(problems);
                debug_assert!(has_errors(&warnings));
                Err((warnings, sources))
            }
        }
    }

    /// The device, for those who draw beside the executor (a viewer).
    pub fn gpu(&self) -> &Gpu {
        self.executor.gpu()
    }

    /// Renders a frame. Where the device turns out to be lost another one is opened, and the frame renders everything there; an
    /// error means that this failed, too, and the next frame tries again.
    pub fn render_frame(&mut self) -> Result<FrameStats, Problems> {
        self.on_living_device(Executor::render_frame).map_err(|problems| (problems, self.warnings.1.clone()))
    }

    /// How many lost devices were replaced.
    pub fn recoveries(&self) -> u64 {
        self.recoveries
    }

    /// Does something; where it fails because the device is lost, once more on another one.
    fn on_living_device<T>(&mut self, mut work: impl FnMut(&mut Executor) -> Result<T, Vec<Diagnostic>>) -> Result<T, Vec<Diagnostic>> {
        let done = work(&mut self.executor);
        if done.is_ok() || !self.executor.is_lost() {
            return done;
        }
        let gpu = self.adapter.open(&self.plan.requirements, self.timing)?;
        self.executor.recover(&gpu)?;
        self.recoveries += 1;
        work(&mut self.executor)
    }

    /// Takes the world's present state over. What did not change will not run again.
    pub fn update(&mut self, world: &mut World) -> Result<(), Problems> {
        let updated = publish_for(&mut self.publisher, world, &self.plan, self.camera.as_deref(), &self.facts).and_then(|published| {
            let scene = Arc::new(published.scene);
            self.on_living_device(|executor| executor.update_scene(Arc::clone(&scene)))
        });
        updated.map_err(|problems| (problems, self.warnings.1.clone()))
    }

    /// The same for a scene in which things come and go: where it has another number of something than the plan was compiled for, it is
    /// compiled anew. Returns whether it was, and [`Session::warnings`] are new.
    pub fn follow(&mut self, world: &mut World, request: &RenderRequest<'_>) -> Result<bool, Problems> {
        if counts_now(world) == self.counts {
            return self.update(world).map(|()| false);
        }
        self.reload(world, request).map(|()| true)
    }

    /// Whether some pass runs in every frame, so that the image never settles.
    pub fn never_settles(&self) -> bool {
        self.executor.never_settles()
    }

    /// What it runs.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What the world has published for it.
    pub fn scene(&self) -> Arc<PublishedScene> {
        self.executor.scene()
    }

    /// The passes that ran in the last frame, in order.
    pub fn ran(&self) -> Vec<&str> {
        self.executor.ran()
    }

    /// Why each pass ran in the last frame or did not.
    pub fn explain(&self, pass: Option<&str>) -> String {
        self.executor.explain(pass)
    }

    /// Compiles again, for a changed file, parameter, size or output, and turns to the new plan. What is the same stays held, and
    /// pipelines that did not change are not built again; a plan that needs a feature which the device was opened without gets another
    /// device, and runs everything. After an error the last good plan goes on.
    pub fn reload(&mut self, world: &mut World, request: &RenderRequest<'_>) -> Result<(), Problems> {
        let Compiled { plan, counts, mut warnings, sources } = compile_for(&self.facts, world, request)?;
        let adopted = publish_for(&mut self.publisher, world, &plan, request.camera, &self.facts).and_then(|published| {
            warnings.extend(published.warnings);
            let scene = Arc::new(published.scene);
            let open = &self.executor.gpu().facts().features;
            if plan.requirements.iter().all(|requirement| open.contains(&requirement.feature)) {
                return self.on_living_device(|executor| executor.adopt(Arc::clone(&plan), Arc::clone(&scene)));
            }
            let gpu = self.adapter.open(&plan.requirements, self.timing)?;
            self.executor = Executor::new(&gpu, Arc::clone(&plan), &schema(), scene)?;
            Ok(())
        });
        match adopted {
            Ok(()) => {
                self.camera = request.camera.map(str::to_owned);
                (self.plan, self.counts, self.warnings) = (plan, counts, (warnings, sources));
                Ok(())
            }
            Err(problems) => Err((problems, sources)),
        }
    }

    /// Reads an output as a linear image.
    pub fn read_output(&self, name: &str) -> Result<LinearImage, Problems> {
        let image = self.executor.read_output(name).map_err(|problems| (problems, self.warnings.1.clone()))?;
        let texels = image.pixels.chunks_exact(4).map(|texel| [texel[0], texel[1], texel[2], texel[3]]).collect();
        Ok(LinearImage { width: image.width, height: image.height, texels, components: image.format.info().components })
    }
}
