//! Parts as views: which mips and layers, in which dimension, and whether the shader's variable can see them so.

use super::error::{BindError, Mismatch};
use super::slots::Taken;
use crate::expand::types::{Dimension, Expanded, Indices, PartRef, Pass, Resource, Shape, TextureShape};
use crate::format::{Format, SampleKind};
use crate::plan::{BindingTarget, PartView, SampleType};
use crate::reflect::interface::{Global, GlobalKind, ScalarKind, ViewDimension};

/// All mips and layers that a reference names.
pub(super) fn whole(resource: &Resource, part: &PartRef) -> PartView {
    let (mips, layers) = match &resource.shape {
        Shape::Texture(shape) => (shape.mips, shape.layers),
        Shape::Buffer { .. } => (1, 1),
    };
    PartView {
        resource: part.resource,
        mips: part.mips.map_or(0..mips, Indices::range),
        layers: part.layers.map_or(0..layers, Indices::range),
        dimension: ViewDimension::D2,
    }
}

/// Width, height and depth of a mip level.
pub(super) fn extent(shape: &TextureShape, mip: u32) -> [u32; 3] {
    let at = |size: u32| (size >> mip.min(31)).max(1);
    let height = if shape.dimension == Dimension::D1 { 1 } else { at(shape.height) };
    let depth = if shape.dimension == Dimension::D3 { at(shape.depth) } else { 1 };
    [at(shape.width), height, depth]
}

/// Checks that a variable can see a part, and describes the binding.
pub(super) fn bind(
    pass: &Pass,
    slot: &Taken,
    global: &Global,
    expanded: &Expanded,
    formats: &[Option<Format>],
) -> Result<BindingTarget, BindError> {
    let resource = &expanded.resources[slot.part.resource.index()];
    let mismatch = |kind: Mismatch, reason: String, hint: Option<String>| BindError::Mismatch {
        kind,
        pass: pass.name.clone(),
        variable: global.name.clone(),
        reason,
        hint,
        slot_span: slot.part.span,
        variable_span: global.span,
    };
    let name = &resource.name;
    let shape = match (&resource.shape, &global.kind) {
        (Shape::Buffer { bytes }, GlobalKind::Uniform { layout } | GlobalKind::Storage { layout, .. }) => {
            if u64::from(layout.size) > *bytes {
                let reason = format!("is {} bytes large, and the buffer `{name}` holds {bytes}", layout.size);
                return Err(mismatch(Mismatch::Layout, reason, Some("make the buffer larger".to_owned())));
            }
            let uniform = matches!(global.kind, GlobalKind::Uniform { .. });
            let writable = matches!(global.kind, GlobalKind::Storage { writable: true, .. });
            return Ok(BindingTarget::Buffer { resource: slot.part.resource, uniform, writable });
        }
        (Shape::Buffer { .. }, _) => {
            let hint = Some("declare `var<storage, read>` or `var<uniform>`".to_owned());
            return Err(mismatch(Mismatch::Kind, format!("is {}, and `{name}` is a buffer", kind_name(&global.kind)), hint));
        }
        (Shape::Texture(_), GlobalKind::Uniform { .. } | GlobalKind::Storage { .. } | GlobalKind::Sampler { .. }) => {
            let reason = format!("is {}, and `{name}` is a texture", kind_name(&global.kind));
            return Err(mismatch(Mismatch::Kind, reason, Some("declare a texture variable".to_owned())));
        }
        (Shape::Texture(shape), _) => shape,
    };
    let Some(format) = formats[slot.part.resource.index()] else {
        return Err(mismatch(Mismatch::Format, format!("has no format for `{name}`"), None));
    };
    let mut view = whole(resource, &slot.part);
    let (dimension, multisampled) = match &global.kind {
        GlobalKind::Texture { dimension, multisampled, .. } | GlobalKind::DepthTexture { dimension, multisampled } => {
            (*dimension, *multisampled)
        }
        GlobalKind::StorageTexture { dimension, .. } => (*dimension, false),
        _ => (ViewDimension::D2, false),
    };
    if multisampled != (shape.samples > 1) {
        let reason =
            format!("sees {} per texel, and `{name}` has {}", if multisampled { "several samples" } else { "one sample" }, shape.samples);
        return Err(mismatch(Mismatch::Samples, reason, Some("use texture_multisampled_2d for 4 samples, texture_2d for one".to_owned())));
    }
    check_dimension(&view, dimension, shape, name).map_err(|(reason, hint)| mismatch(Mismatch::Dimension, reason, hint))?;
    view.dimension = dimension;
    match &global.kind {
        GlobalKind::StorageTexture { format: declared, access, .. } => {
            if view.mips.len() > 1 {
                let reason = format!("is a storage texture and sees one mip, and `{name}` has {}", shape.mips);
                return Err(mismatch(Mismatch::Part, reason, Some(format!("name one: \"{name}.mip(0)\""))));
            }
            Ok(BindingTarget::StorageTexture { view, format: *declared, access: *access })
        }
        GlobalKind::DepthTexture { .. } => {
            if !format.is_depth() {
                let reason = format!("is a depth texture, and `{name}` is {format}");
                return Err(mismatch(Mismatch::Format, reason, Some("declare texture_2d<f32> or its kin".to_owned())));
            }
            Ok(BindingTarget::Texture { view, sample: SampleType::Depth, multisampled })
        }
        GlobalKind::Texture { kind, filtered, .. } => {
            let expected = match format.info().sample {
                SampleKind::Float | SampleKind::UnfilterableFloat => ScalarKind::Float,
                SampleKind::Uint => ScalarKind::Uint,
                SampleKind::Sint => ScalarKind::Sint,
                SampleKind::Depth => {
                    let hint = Some("declare texture_depth_2d or its kin".to_owned());
                    return Err(mismatch(Mismatch::Format, format!("is no depth texture, and `{name}` is {format}"), hint));
                }
            };
            if *kind != expected {
                let reason = format!("samples {}, and `{name}` ({format}) holds {}", scalar_name(*kind), scalar_name(expected));
                return Err(mismatch(Mismatch::Format, reason, Some(format!("declare it with <{}>", scalar_name(expected)))));
            }
            let sample = match format.info().sample {
                SampleKind::Uint => SampleType::Uint,
                SampleKind::Sint => SampleType::Sint,
                SampleKind::UnfilterableFloat if !*filtered => SampleType::UnfilterableFloat,
                _ if multisampled => SampleType::UnfilterableFloat,
                _ => SampleType::FilterableFloat,
            };
            if *filtered && matches!(sample, SampleType::Uint | SampleType::Sint) {
                let reason = format!("is filtered, and `{name}` ({format}) holds whole numbers");
                return Err(mismatch(Mismatch::Filtering, reason, Some("use textureLoad, or a nearest sampler".to_owned())));
            }
            Ok(BindingTarget::Texture { view, sample, multisampled })
        }
        _ => Err(mismatch(Mismatch::Kind, "can't take a texture".to_owned(), None)),
    }
}

fn check_dimension(view: &PartView, dimension: ViewDimension, shape: &TextureShape, name: &str) -> Result<(), (String, Option<String>)> {
    let layers = view.layers.len();
    let is = match shape.dimension {
        Dimension::D1 => "1D",
        Dimension::D2 => "2D",
        Dimension::D3 => "3D",
        Dimension::Cube => "a cube",
    };
    let fits = match (dimension, shape.dimension) {
        (ViewDimension::D1, Dimension::D1) | (ViewDimension::D3, Dimension::D3) => true,
        (ViewDimension::D2Array, Dimension::D2 | Dimension::Cube) => true,
        (ViewDimension::D2, Dimension::D2 | Dimension::Cube) => {
            if layers != 1 {
                return Err((
                    format!("sees one layer, and `{name}` has {layers}"),
                    Some(format!("name one: \"{name}.layer(0)\", or declare an array texture")),
                ));
            }
            true
        }
        (ViewDimension::Cube, Dimension::Cube) => {
            if layers != 6 {
                let hint = Some("declare texture_cube_array or texture_depth_cube_array".to_owned());
                return Err((format!("sees one cube of six faces, and this part of `{name}` has {layers}"), hint));
            }
            true
        }
        (ViewDimension::CubeArray, Dimension::Cube) => layers.is_multiple_of(6),
        _ => false,
    };
    if fits {
        return Ok(());
    }
    let sees = match dimension {
        ViewDimension::D1 => "a 1D texture",
        ViewDimension::D2 => "a 2D texture",
        ViewDimension::D2Array => "a 2D array",
        ViewDimension::D3 => "a 3D texture",
        ViewDimension::Cube => "a cube",
        ViewDimension::CubeArray => "an array of cubes",
    };
    let declare = match shape.dimension {
        Dimension::D1 => "texture_1d",
        Dimension::D2 if layers > 1 => "texture_2d_array",
        Dimension::D2 => "texture_2d",
        Dimension::D3 => "texture_3d",
        Dimension::Cube if layers > 6 => "texture_cube_array",
        Dimension::Cube => "texture_cube",
    };
    Err((format!("is {sees}, and `{name}` is {is}"), Some(format!("declare {declare} or its kin, or name another resource"))))
}

fn scalar_name(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Float => "f32",
        ScalarKind::Sint => "i32",
        ScalarKind::Uint => "u32",
    }
}

fn kind_name(kind: &GlobalKind) -> &'static str {
    match kind {
        GlobalKind::Uniform { .. } => "a uniform buffer",
        GlobalKind::Storage { .. } => "a storage buffer",
        GlobalKind::Texture { .. } => "a texture",
        GlobalKind::DepthTexture { .. } => "a depth texture",
        GlobalKind::StorageTexture { .. } => "a storage texture",
        GlobalKind::Sampler { .. } => "a sampler",
    }
}
