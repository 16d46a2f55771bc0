//! Shader modules and pipelines, each created once and shared by the steps that need the same.
//!
//! A loop over faces or lights unrolls to many steps with one pipeline between them. Keys hold every input of a pipeline, so
//! that equal keys mean equal pipelines.

use std::sync::Arc;

use luminaire_graph::diagnostic::{Diagnostic, did_you_mean};
use luminaire_graph::format::Format;
use luminaire_graph::plan::{Plan, Step, Targets};
use luminaire_graph::published::VertexSchema;
use luminaire_graph::syntax::document::{BlendDoc, CompareDoc};

use crate::convert;
use crate::errors::Subject;
use crate::fullscreen;
use crate::kept::Kept;
use crate::layouts::{GroupLayouts, Layouts};

/// The stages before the fragment stage.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum VertexStage {
    /// One triangle over all texels.
    Fullscreen,
    /// An entry point of the step's shader, with the attributes by location; none where it makes its vertices itself.
    Own { entry: String, attributes: Vec<String> },
}

/// Everything that a render pipeline is made from.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct RenderKey {
    shader: Option<ShaderText>,
    constants: Vec<(String, u64)>,
    layouts: GroupLayouts,
    vertex: VertexStage,
    fragment: Option<String>,
    colors: Vec<Option<(Format, Option<BlendDoc>)>>,
    depth: Option<(Format, bool, CompareDoc, i32, u32)>,
    samples: u32,
    front_face: wgpu::FrontFace,
    cull: Option<wgpu::Face>,
}

/// Everything that a compute pipeline is made from.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct ComputeKey {
    shader: Option<ShaderText>,
    constants: Vec<(String, u64)>,
    layouts: GroupLayouts,
    entry: String,
}

impl RenderKey {
    pub(crate) fn new(
        plan: &Plan,
        step: &Step,
        layouts: GroupLayouts,
        vertex: VertexStage,
        fragment: Option<&str>,
        targets: &Targets,
    ) -> RenderKey {
        RenderKey {
            shader: ShaderText::of(plan, step),
            constants: constants(plan, step),
            layouts,
            vertex,
            fragment: fragment.map(str::to_owned),
            colors: targets.colors.iter().map(|color| color.as_ref().map(|color| (color.format, color.blend))).collect(),
            depth: targets.depth.as_ref().map(|depth| {
                // A slope is compared by its bits.
                (depth.format, depth.write, depth.compare, depth.bias, depth.slope_bias.to_bits())
            }),
            samples: targets.samples,
            front_face: wgpu::FrontFace::Ccw,
            cull: None,
        }
    }

    /// The same with another winding of front faces, and these faces left out.
    pub(crate) fn with_faces(&self, front_face: wgpu::FrontFace, cull: Option<wgpu::Face>) -> RenderKey {
        RenderKey { front_face, cull, ..self.clone() }
    }
}

impl ComputeKey {
    pub(crate) fn new(plan: &Plan, step: &Step, layouts: GroupLayouts, entry: &str) -> ComputeKey {
        ComputeKey { shader: ShaderText::of(plan, step), constants: constants(plan, step), layouts, entry: entry.to_owned() }
    }
}

/// The text of a shader: an edit makes another pipeline, and nothing else does. Equal places in memory are compared first.
#[derive(Debug, Clone, Eq)]
struct ShaderText(Arc<str>);

impl ShaderText {
    fn of(plan: &Plan, step: &Step) -> Option<ShaderText> {
        step.shader.and_then(|index| plan.shaders.get(index)).map(|shader| ShaderText(Arc::clone(&shader.text)))
    }
}

impl PartialEq for ShaderText {
    fn eq(&self, other: &ShaderText) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl std::hash::Hash for ShaderText {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.0.hash(state);
    }
}

/// The modules and pipelines of a plan and the one before.
#[derive(Debug, Default)]
pub(crate) struct Pipelines {
    modules: Kept<ShaderText, wgpu::ShaderModule>,
    fullscreen: Option<wgpu::ShaderModule>,
    render: Kept<RenderKey, wgpu::RenderPipeline>,
    compute: Kept<ComputeKey, wgpu::ComputePipeline>,
    created: u64,
}

impl Pipelines {
    /// How many pipelines were created.
    pub(crate) fn created(&self) -> u64 {
        self.created
    }

    /// For the next plan.
    pub(crate) fn successor(&self) -> Pipelines {
        Pipelines {
            modules: self.modules.successor(),
            fullscreen: self.fullscreen.clone(),
            render: self.render.successor(),
            compute: self.compute.successor(),
            created: self.created,
        }
    }

    /// The pipeline of a key. Runs in the caller's error scope.
    pub(crate) fn render(
        &mut self,
        device: &wgpu::Device,
        plan: &Plan,
        subject: &Subject,
        schema: &VertexSchema,
        layouts: &mut Layouts,
        key: &RenderKey,
    ) -> Result<wgpu::RenderPipeline, Diagnostic> {
        if let Some(pipeline) = self.render.get(key) {
            return Ok(pipeline);
        }
        let module = self.module(device, plan, subject, key.shader.as_ref())?;
        let constants: Vec<(&str, f64)> = constant_refs(&key.constants);
        let options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        let attributes = match &key.vertex {
            VertexStage::Fullscreen => Vec::new(),
            VertexStage::Own { attributes, .. } => vertex_attributes(subject, schema, attributes)?,
        };
        let buffers = [Some(wgpu::VertexBufferLayout {
            array_stride: u64::from(schema.stride),
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        })];
        let vertex = match &key.vertex {
            VertexStage::Fullscreen => wgpu::VertexState {
                module: self.fullscreen.get_or_insert_with(|| fullscreen::vertex_module(device)),
                entry_point: Some(fullscreen::VERTEX_ENTRY),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            VertexStage::Own { entry, attributes } => wgpu::VertexState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: options.clone(),
                buffers: if attributes.is_empty() { &[] } else { &buffers },
            },
        };
        let targets: Vec<Option<wgpu::ColorTargetState>> = key
            .colors
            .iter()
            .map(|color| {
                color.map(|(format, blend)| wgpu::ColorTargetState {
                    format: convert::texture_format(format),
                    blend: blend.map(convert::blend),
                    write_mask: wgpu::ColorWrites::ALL,
                })
            })
            .collect();
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&subject.what),
            layout: Some(&layouts.pipeline(device, key.layouts)),
            vertex,
            primitive: wgpu::PrimitiveState { front_face: key.front_face, cull_mode: key.cull, ..wgpu::PrimitiveState::default() },
            depth_stencil: key.depth.map(depth_state),
            multisample: wgpu::MultisampleState { count: key.samples, ..wgpu::MultisampleState::default() },
            fragment: key.fragment.as_ref().map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: options,
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        });
        self.created += 1;
        self.render.insert(key.clone(), pipeline.clone());
        Ok(pipeline)
    }

    /// The pipeline of a key. Runs in the caller's error scope.
    pub(crate) fn compute(
        &mut self,
        device: &wgpu::Device,
        plan: &Plan,
        subject: &Subject,
        layouts: &mut Layouts,
        key: &ComputeKey,
    ) -> Result<wgpu::ComputePipeline, Diagnostic> {
        if let Some(pipeline) = self.compute.get(key) {
            return Ok(pipeline);
        }
        let module = self.module(device, plan, subject, key.shader.as_ref())?;
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&subject.what),
            layout: Some(&layouts.pipeline(device, key.layouts)),
            module: &module,
            entry_point: Some(&key.entry),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constant_refs(&key.constants), ..Default::default() },
            cache: None,
        });
        self.created += 1;
        self.compute.insert(key.clone(), pipeline.clone());
        Ok(pipeline)
    }

    fn module(
        &mut self,
        device: &wgpu::Device,
        plan: &Plan,
        subject: &Subject,
        text: Option<&ShaderText>,
    ) -> Result<wgpu::ShaderModule, Diagnostic> {
        let found = text.and_then(|text| Some((text, plan.shaders.iter().find(|shader| shader.text == text.0)?)));
        let Some((text, shader)) = found else {
            return Err(subject.error("execute::no-shader", "it has no shader"));
        };
        if let Some(module) = self.modules.get(text) {
            return Ok(module);
        }
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(&shader.path),
            source: wgpu::ShaderSource::Naga(std::borrow::Cow::Owned((*shader.module).clone())),
        });
        self.modules.insert(text.clone(), module.clone());
        Ok(module)
    }
}

fn depth_state((format, write, compare, bias, slope): (Format, bool, CompareDoc, i32, u32)) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: convert::texture_format(format),
        depth_write_enabled: Some(write),
        depth_compare: Some(convert::compare(compare)),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState { constant: bias, slope_scale: f32::from_bits(slope), clamp: 0.0 },
    }
}

/// Overrides under the keys by which pipelines take them: the `@id` where there is one, else the name. Values by their bits.
fn constants(plan: &Plan, step: &Step) -> Vec<(String, u64)> {
    let module = step.shader.and_then(|index| plan.shaders.get(index)).map(|shader| &shader.module);
    let key = |name: &String| {
        let id = module.and_then(|module| {
            module.overrides.iter().find(|(_, declared)| declared.name.as_ref() == Some(name)).and_then(|(_, declared)| declared.id)
        });
        id.map_or_else(|| name.clone(), |id| id.to_string())
    };
    step.constants.iter().map(|(name, value)| (key(name), value.to_bits())).collect()
}

fn constant_refs(constants: &[(String, u64)]) -> Vec<(&str, f64)> {
    constants.iter().map(|(key, bits)| (key.as_str(), f64::from_bits(*bits))).collect()
}

fn vertex_attributes(subject: &Subject, schema: &VertexSchema, names: &[String]) -> Result<Vec<wgpu::VertexAttribute>, Diagnostic> {
    let attribute = |(location, name): (usize, &String)| match schema.attributes.get(name) {
        Some(attribute) => Ok(wgpu::VertexAttribute {
            format: convert::vertex_format(attribute.format),
            offset: u64::from(attribute.offset),
            shader_location: location as u32,
        }),
        None => Err(subject
            .error("execute::missing-attribute", format!("the scene's vertices have no `{name}`"))
            .maybe_hint(did_you_mean(name, schema.attributes.keys().map(String::as_str)))),
    };
    names.iter().enumerate().map(attribute).collect()
}
