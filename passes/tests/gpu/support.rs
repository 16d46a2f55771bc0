//! Plans without a planner: resources, shaders and steps put together by hand.

use std::sync::Arc;

use luminaire_graph::expand::types::{ClearValue, Dimension, PassId, ResourceId, Run, TextureShape};
use luminaire_graph::format::Format;
use luminaire_graph::plan::{
    Binding, BindingTarget, ColorTarget, DrawReads, Input, InputId, Load, Memory, MemoryFigures, MemoryId, MemoryKind, PartView, Placement,
    Plan, PlannedOutput, PlannedResource, PlannedShape, SampleType, Stages, Step, StepKind, Targets, Usage, Workgroups,
};
use luminaire_graph::published::{PublishedScene, PublishedSchema, RowReads};
use luminaire_graph::reflect::interface::{Shader, ViewDimension};
use luminaire_graph::source::Span;
use luminaire_passes::{Executor, Gpu, GpuOptions, ReadImage};

/// The device that all tests share.
pub(crate) fn open() -> Option<Gpu> {
    Gpu::open(&GpuOptions { timing: true, ..GpuOptions::default() }).ok()
}

pub(crate) fn format(name: &str) -> Format {
    Format::from_name(name).expect("a format")
}

/// A plan that grows.
pub(crate) struct Builder {
    pub(crate) plan: Plan,
    pub(crate) schema: PublishedSchema,
    pub(crate) scene: PublishedScene,
}

/// A 2D texture of 8x8 texels, to be changed by the test.
pub(crate) fn shape(format_name: &str) -> TextureShape {
    TextureShape {
        dimension: Dimension::D2,
        formats: [format(format_name)].into_iter().collect(),
        format_span: Span::NOWHERE,
        width: 8,
        height: 8,
        depth: 1,
        layers: 1,
        mips: 1,
        samples: 1,
    }
}

impl Builder {
    pub(crate) fn new() -> Builder {
        Builder {
            plan: Plan {
                name: "test.ron".to_owned(),
                doc: String::new(),
                extent: [8, 8],
                params: Vec::new(),
                resources: Vec::new(),
                memories: Vec::new(),
                shaders: Vec::new(),
                steps: Vec::new(),
                culled: Vec::new(),
                inputs: Vec::new(),
                spreads: Vec::new(),
                views: Vec::new(),
                draw_lists: Vec::new(),
                outputs: Vec::new(),
                figures: MemoryFigures::default(),
                flow: Default::default(),
                requirements: Vec::new(),
            },
            schema: PublishedSchema::default(),
            scene: PublishedScene::default(),
        }
    }

    /// A texture in a memory of its own, which is an output, too.
    pub(crate) fn texture(&mut self, name: &str, shape: TextureShape, usage: Usage) -> ResourceId {
        let format = shape.formats[0];
        let bytes = u64::from(shape.width) * u64::from(shape.height) * u64::from(shape.depth * shape.layers) * 16;
        let layers = shape.layers;
        let planned = PlannedShape::Texture(shape.clone(), format);
        self.resource(name, planned, MemoryKind::Texture(shape, format), bytes, 0, usage, layers)
    }

    /// A buffer in a memory of its own at some offset, which is an output, too.
    pub(crate) fn buffer(&mut self, name: &str, bytes: u64, offset: u64) -> ResourceId {
        let usage = Usage { storage: true, copy_source: true, ..Usage::default() };
        self.resource(name, PlannedShape::Buffer(bytes), MemoryKind::Arena, bytes, offset, usage, 1)
    }

    #[allow(clippy::too_many_arguments)]
    fn resource(
        &mut self,
        name: &str,
        shape: PlannedShape,
        kind: MemoryKind,
        bytes: u64,
        offset: u64,
        usage: Usage,
        layers: u32,
    ) -> ResourceId {
        let id = ResourceId(self.plan.resources.len() as u32);
        let memory = MemoryId(self.plan.memories.len() as u32);
        self.plan.memories.push(Memory { kind, usage, bytes: bytes + offset, holders: vec![id] });
        self.plan.resources.push(PlannedResource {
            name: name.to_owned(),
            span: Span::NOWHERE,
            shape,
            usage,
            bytes,
            lifetime: 0..1,
            placement: Some(Placement { memory, offset }),
            retained: None,
            alone: None,
            clear: None,
            retained_for: Vec::new(),
            history: None,
        });
        let view = PartView { resource: id, mips: 0..1, layers: 0..layers, dimension: ViewDimension::D2 };
        self.plan.outputs.push(PlannedOutput { name: name.to_owned(), view });
        id
    }

    /// A shader whose variables get bindings in the order of the file; those named `material_*` get group 1.
    pub(crate) fn shader(&mut self, path: &str, wgsl: &str) -> usize {
        let mut module = naga::front::wgsl::parse_str(wgsl).expect("a shader");
        let mut next = [0, 0];
        for (_, global) in module.global_variables.iter_mut() {
            if matches!(global.space, naga::AddressSpace::Private | naga::AddressSpace::WorkGroup) {
                continue;
            }
            let group = usize::from(global.name.as_ref().is_some_and(|name| name.starts_with("material_")));
            global.binding = Some(naga::ResourceBinding { group: group as u32, binding: next[group] });
            next[group] += 1;
        }
        self.plan.shaders.push(Shader {
            path: path.to_owned(),
            module: Arc::new(module),
            text: wgsl.into(),
            entries: Vec::new(),
            overrides: Vec::new(),
            features: Vec::new(),
        });
        self.plan.shaders.len() - 1
    }

    /// A step; its variables are bound by name, visible to the given stages.
    pub(crate) fn step(&mut self, name: &str, shader: Option<usize>, kind: StepKind, stages: Stages, bound: Vec<(&str, BindingTarget)>) {
        let bindings = bound
            .into_iter()
            .map(|(variable, target)| {
                let module = &self.plan.shaders[shader.expect("a shader")].module;
                let global = module.global_variables.iter().find(|(_, global)| global.name.as_deref() == Some(variable));
                let place = global.and_then(|(_, global)| global.binding).expect("a variable");
                Binding { group: place.group, binding: place.binding, variable: variable.to_owned(), stages, target }
            })
            .collect::<Vec<Binding>>();
        let mut inputs = Vec::new();
        let mut takes = |input: Input| {
            let known = self.plan.inputs.iter().position(|known| *known == input);
            let index = known.unwrap_or_else(|| {
                self.plan.inputs.push(input);
                self.plan.inputs.len() - 1
            });
            inputs.push(InputId(index as u32));
        };
        for binding in &bindings {
            match &binding.target {
                BindingTarget::UniformTable(name) | BindingTarget::StorageTable(name) => takes(Input::Table(name.clone(), RowReads::Whole)),
                BindingTarget::View(view) => takes(Input::View(self.plan.views[*view])),
                _ => {}
            }
        }
        if let StepKind::Draw { list, .. } = &kind {
            let (filter, view) = self.plan.draw_lists[*list];
            let whole = |binding: &Binding| match &binding.target {
                BindingTarget::StorageTable(name) => Some((name.clone(), RowReads::Whole)),
                _ => None,
            };
            takes(Input::Draws(filter, view, DrawReads { rows: bindings.iter().filter_map(whole).collect(), textures: true }));
        }
        self.plan.steps.push(Step {
            pass: PassId(self.plan.steps.len() as u32),
            name: name.into(),
            span: Span::NOWHERE,
            shader,
            kind,
            bindings,
            constants: Vec::new(),
            clears: Vec::new(),
            uses: Vec::new(),
            run: Run::OnChange,
            batch: Vec::new(),
            inputs,
        });
    }

    /// A Fullscreen with the entry point `shade`.
    pub(crate) fn fullscreen(&mut self, name: &str, shader: usize, colors: Vec<Option<ColorTarget>>, bound: Vec<(&str, BindingTarget)>) {
        let targets = Targets { colors, depth: None, extent: [8, 8], samples: 1 };
        let kind = StepKind::Fullscreen { fragment: "shade".to_owned(), targets };
        self.step(name, Some(shader), kind, Stages { fragment: true, ..Stages::default() }, bound);
    }

    /// A Compute with the entry point `main`.
    pub(crate) fn compute(&mut self, name: &str, shader: usize, groups: [u32; 3], bound: Vec<(&str, BindingTarget)>) {
        let kind = StepKind::Compute { entry: "main".to_owned(), groups: Workgroups::Fixed(groups) };
        self.step(name, Some(shader), kind, Stages { compute: true, ..Stages::default() }, bound);
    }

    pub(crate) fn clear(&mut self, target: PartView, value: ClearValue) {
        self.step("clear", None, StepKind::Clear { target, value }, Stages::default(), Vec::new());
    }

    /// Prepares the plan. Panics with the diagnostics' messages.
    pub(crate) fn prepare(self, gpu: &Gpu) -> Executor {
        match Executor::new(gpu, Arc::new(self.plan), &self.schema, Arc::new(self.scene)) {
            Ok(executor) => executor,
            Err(problems) => panic!("{problems:#?}"),
        }
    }

    /// Renders one frame.
    pub(crate) fn render(self, gpu: &Gpu) -> Executor {
        let mut executor = self.prepare(gpu);
        executor.render_frame().expect("a frame");
        executor
    }
}

pub(crate) fn read(executor: &Executor, output: &str) -> ReadImage {
    executor.read_output(output).expect("an image")
}

/// One mip level and layer.
pub(crate) fn part(resource: ResourceId, mip: u32, layer: u32) -> PartView {
    PartView { resource, mips: mip..mip + 1, layers: layer..layer + 1, dimension: ViewDimension::D2 }
}

/// A color attachment that is cleared to zero.
pub(crate) fn target(view: PartView, format_name: &str) -> Option<ColorTarget> {
    Some(ColorTarget { view, format: format(format_name), load: Load::Clear(ClearValue::Zero), blend: None })
}

pub(crate) fn sampled(view: PartView) -> BindingTarget {
    BindingTarget::Texture { view, sample: SampleType::UnfilterableFloat, multisampled: false }
}

pub(crate) const ATTACHED: Usage =
    Usage { sampled: false, storage: false, uniform: false, attachment: true, copy_source: false, copy_target: false, indirect: false };
pub(crate) const SAMPLED: Usage = Usage { sampled: true, ..ATTACHED };
pub(crate) const COPIED: Usage =
    Usage { sampled: false, storage: false, uniform: false, attachment: false, copy_source: true, copy_target: true, indirect: false };

/// Whether all components are within a step of 8 bits.
#[track_caller]
pub(crate) fn assert_near(found: Option<[f32; 4]>, wanted: [f32; 4]) {
    let found = found.expect("a texel");
    assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 0.005), "{found:?}, wanted {wanted:?}");
}
