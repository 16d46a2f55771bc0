//! WGSL text and memory layout of naga's types.

use naga::{ArraySize, Handle, Module, ScalarKind as Kind, Type, TypeInner};

use super::interface::{Layout, Member, ScalarKind, Shader};
use super::places::Places;

/// The type as an author would write it: `f32`, `mat4x4<f32>`, `array<vec4<f32>, 14>`; structs by name.
pub(super) fn type_text(module: &Module, handle: Handle<Type>) -> String {
    nested_type_text(module, handle, 0)
}

/// Arrays of arrays of arrays: deeper than anyone reads.
const MAX_NESTING: u32 = 16;

fn nested_type_text(module: &Module, handle: Handle<Type>, depth: u32) -> String {
    if depth > MAX_NESTING {
        return "...".to_owned();
    }
    let Ok(ty) = module.types.get_handle(handle) else { return "?".to_owned() };
    match &ty.inner {
        TypeInner::Scalar(scalar) => scalar_text(*scalar),
        TypeInner::Vector { size, scalar } => format!("vec{}<{}>", *size as u8, scalar_text(*scalar)),
        TypeInner::Matrix { columns, rows, scalar } => {
            format!("mat{}x{}<{}>", *columns as u8, *rows as u8, scalar_text(*scalar))
        }
        TypeInner::Atomic(scalar) => format!("atomic<{}>", scalar_text(*scalar)),
        TypeInner::Array { base, size, .. } => {
            let base = nested_type_text(module, *base, depth + 1);
            match size {
                ArraySize::Constant(count) => format!("array<{base}, {count}>"),
                ArraySize::Dynamic => format!("array<{base}>"),
                ArraySize::Pending(handle) => {
                    let count = module.overrides.try_get(*handle).ok().and_then(|size| size.name.clone());
                    format!("array<{base}, {}>", count.unwrap_or_else(|| "?".to_owned()))
                }
            }
        }
        _ => ty.name.clone().unwrap_or_else(|| "?".to_owned()),
    }
}

/// `f32`, `u32`, `bool` and so on.
fn scalar_text(scalar: naga::Scalar) -> String {
    let bits = u32::from(scalar.width) * 8;
    match scalar.kind {
        Kind::Float | Kind::AbstractFloat => format!("f{bits}"),
        Kind::Sint | Kind::AbstractInt => format!("i{bits}"),
        Kind::Uint => format!("u{bits}"),
        Kind::Bool => "bool".to_owned(),
    }
}

/// Kind and components of a 32-bit scalar or vector; `None` for all else.
pub(super) fn numeric(module: &Module, handle: Handle<Type>) -> Option<(ScalarKind, u32)> {
    let (scalar, components) = match module.types.get_handle(handle).ok()?.inner {
        TypeInner::Scalar(scalar) => (scalar, 1),
        TypeInner::Vector { size, scalar } => (scalar, size as u32),
        _ => return None,
    };
    if scalar.width != 4 {
        return None;
    }
    Some((scalar_kind(scalar.kind)?, components))
}

/// The kind of a scalar, where shaders can exchange it with the outside.
pub(super) fn scalar_kind(kind: Kind) -> Option<ScalarKind> {
    match kind {
        Kind::Float => Some(ScalarKind::Float),
        Kind::Sint => Some(ScalarKind::Sint),
        Kind::Uint => Some(ScalarKind::Uint),
        Kind::Bool | Kind::AbstractInt | Kind::AbstractFloat => None,
    }
}

/// Bytes of a type that can stand in a buffer; `None` where they overflow or are not known.
fn size_of(module: &Module, handle: Handle<Type>) -> Option<u32> {
    match module.types.get_handle(handle).ok()?.inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Some(u32::from(scalar.width)),
        TypeInner::Vector { size, scalar } => Some(u32::from(scalar.width) * size as u32),
        TypeInner::Matrix { columns, rows, scalar } => {
            // WGSL, "Alignment and Size": a column of three takes the room of four.
            let column = if rows as u32 == 3 { 4 } else { rows as u32 };
            Some(u32::from(scalar.width) * column * columns as u32)
        }
        TypeInner::Array { size: ArraySize::Constant(count), stride, .. } => stride.checked_mul(count.get()),
        TypeInner::Array { size: ArraySize::Dynamic, stride, .. } => Some(stride),
        TypeInner::Struct { span, .. } => Some(span),
        _ => None,
    }
}

/// The layout of a uniform or storage variable. A struct that ends with a runtime-sized array counts one element of it.
pub(super) fn layout(module: &Module, handle: Handle<Type>, places: &Places<'_>) -> Option<Layout> {
    let size = size_of(module, handle)?;
    let mut inner = &module.types.get_handle(handle).ok()?.inner;
    let mut runtime_array = false;
    let mut owner = handle;
    while let TypeInner::Array { base, size, .. } = inner {
        runtime_array |= *size == ArraySize::Dynamic;
        owner = *base;
        inner = &module.types.get_handle(*base).ok()?.inner;
    }
    let mut members = Vec::new();
    if let TypeInner::Struct { members: declared, .. } = inner {
        let structure = module.types.get_handle(owner).ok()?.name.as_deref().unwrap_or_default();
        for (index, member) in declared.iter().enumerate() {
            members.push(Member {
                name: member.name.clone().unwrap_or_default(),
                span: places.member_span(structure, index),
                wgsl: type_text(module, member.ty),
                offset: member.offset,
            });
            let last = module.types.get_handle(member.ty).ok().map(|ty| &ty.inner);
            runtime_array |= matches!(last, Some(TypeInner::Array { size: ArraySize::Dynamic, .. }));
        }
    }
    Some(Layout { size, members, runtime_array })
}

impl Shader {
    /// The WGSL type of a module-scope variable, as in `array<u32>`: what a [`Layout`] without members does not tell.
    pub fn variable_type(&self, name: &str) -> Option<String> {
        let (_, variable) = self.module.global_variables.iter().find(|(_, variable)| variable.name.as_deref() == Some(name))?;
        Some(type_text(&self.module, variable.ty))
    }
}
