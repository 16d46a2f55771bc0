//! Attachments of Draw and Fullscreen passes.
//!
//! Load operations are the plan's; everything is stored, since the planner names no attachment that nobody reads. A depth
//! attachment that is not written is read-only, so that the same pass may sample it.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::plan::{Load, PartView, Plan, Targets};

use crate::convert;
use crate::errors::Subject;
use crate::textures::Memories;
use crate::timing::Stamps;

/// A view and what it starts from; `None` where an output goes nowhere.
type Color = Option<(wgpu::TextureView, wgpu::LoadOp<wgpu::Color>)>;

/// Attachments with their views.
#[derive(Debug, Clone)]
pub(crate) struct Attachments {
    name: String,
    colors: Vec<Color>,
    depth: Option<(wgpu::TextureView, Option<wgpu::LoadOp<f32>>)>,
}

impl Attachments {
    /// Makes the views. Runs in the caller's error scope.
    pub(crate) fn prepare(
        plan: &Plan,
        name: &str,
        subject: &Subject,
        targets: &Targets,
        memories: &mut Memories,
    ) -> Result<Attachments, Diagnostic> {
        let mut view = |part: &PartView| {
            memories.view(plan, part).ok_or_else(|| {
                let resource = &plan.resources[part.resource.index()].name;
                subject.error("execute::no-texture", format!("`{resource}` is no texture to draw into"))
            })
        };
        let mut colors = Vec::with_capacity(targets.colors.len());
        for color in &targets.colors {
            colors.push(match color {
                Some(color) => {
                    let load = match color.load {
                        Load::Clear(value) => wgpu::LoadOp::Clear(convert::clear_color(value, color.format)),
                        Load::Keep => wgpu::LoadOp::Load,
                    };
                    Some((view(&color.view)?, load))
                }
                None => None,
            });
        }
        let depth = match &targets.depth {
            Some(depth) => {
                let load = match depth.load {
                    Load::Clear(value) => Some(wgpu::LoadOp::Clear(convert::clear_depth(value, depth.format))),
                    Load::Keep => depth.write.then_some(wgpu::LoadOp::Load),
                };
                Some((view(&depth.view)?, load))
            }
            None => None,
        };
        Ok(Attachments { name: name.to_owned(), colors, depth })
    }

    /// Begins a pass.
    pub(crate) fn begin<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        stamps: Option<Stamps<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        let (one, several);
        let colors: &[Option<wgpu::RenderPassColorAttachment<'_>>] = match self.colors.as_slice() {
            // The usual case allocates nothing.
            [color] => {
                one = [attachment(color)];
                &one
            }
            colors => {
                several = colors.iter().map(attachment).collect::<Vec<_>>();
                &several
            }
        };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&self.name),
            color_attachments: colors,
            depth_stencil_attachment: self.depth.as_ref().map(|(view, load)| wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: load.map(|load| wgpu::Operations { load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            timestamp_writes: stamps.map(|stamps| wgpu::RenderPassTimestampWrites {
                query_set: stamps.set,
                beginning_of_pass_write_index: Some(stamps.first),
                end_of_pass_write_index: Some(stamps.first + 1),
            }),
            ..wgpu::RenderPassDescriptor::default()
        })
    }
}

fn attachment(color: &Color) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    color.as_ref().map(|(view, load)| wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: *load, store: wgpu::StoreOp::Store },
    })
}

/// One attachment and nothing drawn: how parts are cleared.
pub(crate) fn clear_view(encoder: &mut wgpu::CommandEncoder, view: &wgpu::TextureView, value: ClearTo) {
    let color = match value {
        ClearTo::Color(color) => Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(color), store: wgpu::StoreOp::Store },
        }),
        ClearTo::Depth(_) => None,
    };
    let depth = match value {
        ClearTo::Depth(depth) => Some(wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(depth), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ClearTo::Color(_) => None,
    };
    let colors = [color];
    let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("clear"),
        color_attachments: if colors[0].is_some() { &colors } else { &[] },
        depth_stencil_attachment: depth,
        ..wgpu::RenderPassDescriptor::default()
    });
    drop(pass);
}

/// The value of [`clear_view`].
#[derive(Debug, Clone, Copy)]
pub(crate) enum ClearTo {
    Color(wgpu::Color),
    Depth(f32),
}
