//! What a pass does, apart from its variables: vertex inputs, workgroups, copies, clears.

use super::error::BindError;
use super::slots::Taken;
use super::views::{extent, whole};
use crate::device::DeviceFacts;
use crate::diagnostic::{did_you_mean, list_names};
use crate::expand::types::{ClearValue, Expanded, Pass, Shape, Work};
use crate::format::Format;
use crate::plan::Workgroups;
use crate::published::PublishedSchema;
use crate::reflect::interface::{EntryPoint, Shader};
use crate::validate::clear_fits;

/// The vertex attributes by location.
pub(super) fn attributes(pass: &Pass, vertex: &EntryPoint, published: &PublishedSchema, problems: &mut Vec<BindError>) -> Vec<String> {
    let mut inputs: Vec<_> = vertex.vertex_inputs.iter().collect();
    inputs.sort_by_key(|input| input.location);
    for input in &inputs {
        let known = || published.vertex.attributes.keys().map(String::as_str);
        let (reason, hint) = match published.vertex.attributes.get(&input.name) {
            None => {
                let hint = did_you_mean(&input.name, known()).unwrap_or_else(|| format!("vertices have {}", list_names(known())));
                (format!("vertices have no attribute `{}`", input.name), hint)
            }
            Some(attribute) if attribute.format.components() != input.components => {
                let components = attribute.format.components();
                (
                    format!("the vertex attribute `{}` has {components} components, not {}", input.name, input.components),
                    format!("declare it as vec{components}<f32>"),
                )
            }
            Some(_) => continue,
        };
        problems.push(BindError::Target { pass: pass.name.clone(), reason, hint: Some(hint), span: input.span });
    }
    inputs.into_iter().map(|input| input.name.clone()).collect()
}

/// A Procedural has no vertices to read, and whole triangles.
pub(super) fn check_procedural(pass: &Pass, vertex: &EntryPoint, vertices: u32, problems: &mut Vec<BindError>) {
    for input in &vertex.vertex_inputs {
        let reason = format!("its vertex shader takes the attribute `{}`, and a Procedural has no vertices to read", input.name);
        let hint = Some("make it from `@builtin(vertex_index)`, or draw the scene's surfaces with a Draw".to_owned());
        problems.push(BindError::Target { pass: pass.name.clone(), reason, hint, span: input.span });
    }
    if !vertices.is_multiple_of(3) {
        let reason = format!("it has {vertices} vertices, and triangles have three each");
        let hint = Some("make `vertices` a multiple of 3".to_owned());
        problems.push(BindError::Work { pass: pass.name.clone(), reason, hint, span: pass.span });
    }
}

/// The number of workgroups of a Compute.
pub(super) fn groups(
    pass: &Pass,
    work: &Work,
    shader: &Shader,
    main: &EntryPoint,
    expanded: &Expanded,
    device: &DeviceFacts,
    problems: &mut Vec<BindError>,
) -> Option<Workgroups> {
    let given = |name: &str| pass.constants.iter().find(|(constant, _)| constant.value == name).map(|(_, value)| *value);
    let size = shader.workgroup_size(&main.name, &given).unwrap_or(main.workgroup_size).map(|axis| axis.max(1));
    let mut bad = |reason: String, hint: &str, span| {
        let hint = (!hint.is_empty()).then(|| hint.to_owned());
        problems.push(BindError::Work { pass: pass.name.clone(), reason, hint, span });
    };
    let invocations: u64 = size.iter().map(|axis| u64::from(*axis)).product();
    let too_wide = (0..3).any(|axis| size[axis] > device.max_workgroup_size[axis]);
    if too_wide || invocations > u64::from(device.max_workgroup_invocations) {
        let reason = format!(
            "its workgroup of {}x{}x{} is larger than the limit of {} ({} invocations, {}x{}x{})",
            size[0],
            size[1],
            size[2],
            device.name,
            device.max_workgroup_invocations,
            device.max_workgroup_size[0],
            device.max_workgroup_size[1],
            device.max_workgroup_size[2]
        );
        bad(reason, "choose a smaller @workgroup_size", main.span);
        return None;
    }
    let (groups, span) = match work {
        Work::Indirect { buffer, offset } => {
            let resource = &expanded.resources[buffer.resource.index()];
            return match &resource.shape {
                Shape::Buffer { bytes } if offset.saturating_add(12) <= *bytes => {
                    Some(Workgroups::Indirect { buffer: buffer.resource, offset: *offset })
                }
                Shape::Buffer { bytes } => {
                    let reason = format!("three u32 at byte {offset} of `{}` end behind its {bytes} bytes", resource.name);
                    bad(reason, "make the buffer larger", buffer.span);
                    None
                }
                Shape::Texture(_) => {
                    bad(format!("`{}` is a texture, and a buffer says how much work there is", resource.name), "", buffer.span);
                    None
                }
            };
        }
        Work::Groups(groups) => (*groups, pass.span),
        Work::Count(count) => ([count.div_ceil(size[0]), 1, 1], pass.span),
        Work::Cover(part) => {
            let resource = &expanded.resources[part.resource.index()];
            let Shape::Texture(shape) = &resource.shape else {
                bad(format!("`cover` needs a texture, and `{}` is a buffer", resource.name), "use `count` for buffers", part.span);
                return None;
            };
            let view = whole(resource, part);
            if view.mips.len() > 1 {
                bad(format!("`cover` needs one mip, and `{}` has {}", resource.name, shape.mips), "name one: .mip(0)", part.span);
                return None;
            }
            let [width, height, depth] = extent(shape, view.mips.start);
            let depth = depth.max(view.layers.len() as u32);
            ([width.div_ceil(size[0]), height.div_ceil(size[1]), depth.div_ceil(size[2])], part.span)
        }
    };
    if groups.contains(&0) {
        bad("it has no work: a number of workgroups is 0".to_owned(), "guard the pass with `when`", span);
        return None;
    }
    if let Some(axis) = groups.iter().find(|axis| **axis > device.max_workgroups) {
        bad(
            format!("it has {axis} workgroups along one axis, and the limit is {} ({})", device.max_workgroups, device.name),
            "use a larger workgroup or more axes",
            span,
        );
        return None;
    }
    if pass.batch.is_some() && groups[2] != 1 {
        let reason = format!("each iteration of a batch is one workgroup deep, and this one has {}", groups[2]);
        bad(reason, "z counts the iterations that are due: let x and y hold the work of one", span);
        return None;
    }
    Some(Workgroups::Fixed(groups))
}

/// A copy's source and target have one shape.
pub(super) fn check_copy(
    pass: &Pass,
    source: &Taken,
    target: &Taken,
    expanded: &Expanded,
    formats: &[Option<Format>],
    problems: &mut Vec<BindError>,
) {
    let (from, to) = (&expanded.resources[source.part.resource.index()], &expanded.resources[target.part.resource.index()]);
    let reason = match (&from.shape, &to.shape) {
        (Shape::Buffer { bytes }, Shape::Buffer { bytes: other }) if bytes != other => {
            Some(format!("`{}` has {bytes} bytes, and `{}` has {other}", from.name, to.name))
        }
        (Shape::Buffer { .. }, Shape::Buffer { .. }) => None,
        (Shape::Texture(a), Shape::Texture(b)) => {
            let (view_a, view_b) = (whole(from, &source.part), whole(to, &target.part));
            let format = (formats[source.part.resource.index()], formats[target.part.resource.index()]);
            let (extent_a, extent_b) = (extent(a, view_a.mips.start), extent(b, view_b.mips.start));
            if format.0 != format.1 {
                Some(format!("`{}` and `{}` have different formats", from.name, to.name))
            } else if extent_a != extent_b {
                let shown = |extent: [u32; 3]| format!("{}x{}x{}", extent[0], extent[1], extent[2]);
                Some(format!("`{}` is {} and `{}` is {}", from.name, shown(extent_a), to.name, shown(extent_b)))
            } else if view_a.mips.len() != view_b.mips.len() || view_a.layers.len() != view_b.layers.len() || a.samples != b.samples {
                Some(format!("`{}` and `{}` differ in mips, layers or samples", from.name, to.name))
            } else {
                None
            }
        }
        _ => Some(format!("one of `{}` and `{}` is a texture and the other a buffer", from.name, to.name)),
    };
    if let Some(reason) = reason {
        let hint = Some("a Copy needs parts of one extent and format; use a Fullscreen or Compute to convert".to_owned());
        problems.push(BindError::Target { pass: pass.name.clone(), reason, hint, span: target.part.span });
    }
}

/// A clear's value fits its target.
pub(super) fn check_clear(pass: &Pass, target: &Taken, value: ClearValue, formats: &[Option<Format>], problems: &mut Vec<BindError>) {
    let reason = match (formats[target.part.resource.index()], value) {
        (Some(format), value) => clear_fits(value, format).err(),
        (None, ClearValue::Zero) => None,
        (None, _) => Some("a buffer can only be cleared to `Zero`".to_owned()),
    };
    if let Some(reason) = reason {
        problems.push(BindError::Target { pass: pass.name.clone(), reason, hint: None, span: target.part.span });
    }
}
