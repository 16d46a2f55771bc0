//! Resource variables: what each is, and a refusal of those that no pipeline can feed.

use naga::common::wgsl::ToWgsl;
use naga::valid::{FunctionInfo, GlobalUse};
use naga::{AddressSpace, Handle, ImageClass, ImageDimension, Module, ShaderStage, Type, TypeInner};

use super::error::ReflectError;
use super::interface::{Global, GlobalKind, Layout, StorageAccess, ViewDimension};
use super::places::Places;
use super::reads::{self, Reads};
use super::types::{layout, scalar_kind, type_text};
use crate::format::{Format, StorageSupport};
use crate::published::RowReads;
use crate::source::Span;

/// Samplers that never filter, by name.
const NEAREST_SAMPLERS: [&str; 2] = ["nearest_clamp", "nearest_repeat"];

/// A variable as declared, whoever uses it.
pub(super) struct Declared {
    handle: Handle<naga::GlobalVariable>,
    global: Global,
}

/// Describes every resource variable in the order of the text. Variables of any kind that nothing can feed are errors even where
/// nobody uses them: the device would refuse the module.
pub(super) fn declared(module: &Module, places: &Places<'_>) -> (Vec<Declared>, Vec<ReflectError>) {
    let mut found = Vec::new();
    let mut errors = Vec::new();
    let float_atomics = types_with_float_atomics(module);
    let mut variables: Vec<_> = module.global_variables.iter().collect();
    variables.sort_by_key(|(handle, variable)| (places.value_order(variable.name.as_deref().unwrap_or_default()), *handle));
    for (handle, variable) in variables {
        let name = variable.name.clone().unwrap_or_default();
        let mut span = places.value_span(&name);
        if !span.is_somewhere() {
            span = places.naga_span(module.global_variables.get_span(handle));
        }
        if float_atomics.get(variable.ty.index()).copied().unwrap_or(false) {
            errors.push(ReflectError::FloatAtomic { name: name.clone(), wgsl: type_text(module, variable.ty), span });
            continue;
        }
        match kind(module, variable, &name, span, places) {
            Ok(Some(kind)) => {
                let (group, binding) = variable.binding.map_or((0, 0), |binding| (binding.group, binding.binding));
                found.push(Declared { handle, global: Global { name, span, group, binding, kind, reads: RowReads::Whole } });
            }
            Ok(None) => {}
            Err(error) => errors.push(error),
        }
    }
    (found, errors)
}

/// Which types are or contain atomic floats, by index. Types only refer to earlier ones.
fn types_with_float_atomics(module: &Module) -> Vec<bool> {
    let mut found: Vec<bool> = Vec::with_capacity(module.types.len());
    for (_, ty) in module.types.iter() {
        let has = |handle: &Handle<Type>| found.get(handle.index()).copied().unwrap_or(false);
        let has_float = match &ty.inner {
            TypeInner::Atomic(scalar) => scalar.kind == naga::ScalarKind::Float,
            TypeInner::Array { base, .. } | TypeInner::BindingArray { base, .. } => has(base),
            TypeInner::Struct { members, .. } => members.iter().any(|member| has(&member.ty)),
            _ => false,
        };
        found.push(has_float);
    }
    found
}

/// What a variable is; `None` where it is no resource.
fn kind(
    module: &Module,
    variable: &naga::GlobalVariable,
    name: &str,
    span: Span,
    places: &Places<'_>,
) -> Result<Option<GlobalKind>, ReflectError> {
    let unsupported = |what: &str| Err(ReflectError::Unsupported { name: name.to_owned(), what: what.to_owned(), span });
    let too_large = || ReflectError::LayoutTooLarge { name: name.to_owned(), span };
    let inner = module.types.get_handle(variable.ty).map(|ty| &ty.inner);
    if let Ok(TypeInner::BindingArray { .. }) = inner {
        return unsupported("a binding array");
    }
    let kind = match variable.space {
        AddressSpace::Function | AddressSpace::Private | AddressSpace::WorkGroup => return Ok(None),
        AddressSpace::Immediate => return unsupported("immediate data (a push constant)"),
        AddressSpace::TaskPayload => return unsupported("a task payload"),
        AddressSpace::RayPayload | AddressSpace::IncomingRayPayload => return unsupported("a ray payload"),
        AddressSpace::Uniform => GlobalKind::Uniform { layout: layout(module, variable.ty, places).ok_or_else(too_large)? },
        AddressSpace::Storage { access } => GlobalKind::Storage {
            writes: false,
            writable: access.contains(naga::StorageAccess::STORE),
            reads: false,
            layout: layout(module, variable.ty, places).ok_or_else(too_large)?,
        },
        AddressSpace::Handle => match inner {
            Ok(TypeInner::Sampler { comparison }) => GlobalKind::Sampler { comparison: *comparison },
            Ok(TypeInner::Image { dim, arrayed, class }) => {
                let Some(dimension) = dimension(*dim, *arrayed) else { return unsupported("an array of 1D or 3D textures") };
                match *class {
                    ImageClass::Sampled { multi: true, .. } | ImageClass::Depth { multi: true } if *arrayed => {
                        return unsupported("an array of multisampled textures");
                    }
                    ImageClass::Sampled { kind, multi } => match scalar_kind(kind) {
                        Some(kind) => GlobalKind::Texture { dimension, kind, multisampled: multi, filtered: false },
                        None => return unsupported("a texture of that type"),
                    },
                    ImageClass::Depth { multi } => GlobalKind::DepthTexture { dimension, multisampled: multi },
                    ImageClass::External => return unsupported("an external texture"),
                    ImageClass::Storage { access, .. } if access.contains(naga::StorageAccess::ATOMIC) => {
                        return unsupported("a storage texture with atomics");
                    }
                    ImageClass::Storage { format, access } => {
                        let access = storage_access(access);
                        let wrong =
                            |why| ReflectError::StorageFormat { name: name.to_owned(), format: format.to_wgsl().to_owned(), why, span };
                        let known = Format::from_name(format.to_wgsl()).ok_or_else(|| wrong("is not known to pipelines"))?;
                        match (known.info().storage, access) {
                            (StorageSupport::None, _) => return Err(wrong("can't be stored to")),
                            (StorageSupport::ReadOrWrite, StorageAccess::ReadWrite) => {
                                return Err(wrong("can be read or written, not both by one variable"));
                            }
                            _ => GlobalKind::StorageTexture { dimension, format: known, access },
                        }
                    }
                }
            }
            Ok(TypeInner::AccelerationStructure { .. }) => return unsupported("an acceleration structure"),
            _ => return unsupported("of a type"),
        },
    };
    Ok(Some(kind))
}

fn dimension(dim: ImageDimension, arrayed: bool) -> Option<ViewDimension> {
    match (dim, arrayed) {
        (ImageDimension::D1, false) => Some(ViewDimension::D1),
        (ImageDimension::D2, false) => Some(ViewDimension::D2),
        (ImageDimension::D2, true) => Some(ViewDimension::D2Array),
        (ImageDimension::D3, false) => Some(ViewDimension::D3),
        (ImageDimension::Cube, false) => Some(ViewDimension::Cube),
        (ImageDimension::Cube, true) => Some(ViewDimension::CubeArray),
        (ImageDimension::D1 | ImageDimension::D3, true) => None,
    }
}

fn storage_access(access: naga::StorageAccess) -> StorageAccess {
    match (access.contains(naga::StorageAccess::LOAD), access.contains(naga::StorageAccess::STORE)) {
        (true, true) => StorageAccess::ReadWrite,
        (false, true) => StorageAccess::Write,
        _ => StorageAccess::Read,
    }
}

/// The variables that an entry point uses, directly or through what it calls, and how.
pub(super) fn used(module: &Module, info: &FunctionInfo, declared: &[Declared], reads: &Reads) -> Vec<Global> {
    let use_of = |handle: Handle<naga::GlobalVariable>| info.global_uses.get(handle.index()).copied().unwrap_or(GlobalUse::empty());
    declared
        .iter()
        .filter(|variable| !use_of(variable.handle).is_empty())
        .map(|variable| {
            let mut global = variable.global.clone();
            if let GlobalKind::Uniform { layout } | GlobalKind::Storage { layout, .. } = &global.kind {
                global.reads = row_reads(module, variable.handle, layout, reads);
            }
            match &mut global.kind {
                GlobalKind::Storage { writes, reads, .. } => {
                    let uses = use_of(variable.handle);
                    *writes = uses.contains(GlobalUse::WRITE);
                    *reads = uses.intersects(GlobalUse::READ | GlobalUse::ATOMIC);
                }
                GlobalKind::Texture { filtered, .. } => *filtered = is_filtered(module, info, variable.handle),
                _ => {}
            }
            global
        })
        .collect()
}

/// What is read of a struct, or of each element of an array of structs; all of anything else.
fn row_reads(module: &Module, variable: Handle<naga::GlobalVariable>, layout: &Layout, reads: &Reads) -> RowReads {
    if !reads::has_rows(module, variable) {
        return RowReads::Whole;
    }
    match reads.members(variable) {
        Some(members) => layout.reads(members),
        None => layout.reads(0..layout.members.len()),
    }
}

/// Whether a texture meets a sampler that filters.
fn is_filtered(module: &Module, info: &FunctionInfo, image: Handle<naga::GlobalVariable>) -> bool {
    info.sampling_set.iter().filter(|pair| pair.image == image).any(|pair| {
        let Ok(sampler) = module.global_variables.try_get(pair.sampler) else { return true };
        let compares = matches!(module.types.get_handle(sampler.ty).map(|ty| &ty.inner), Ok(TypeInner::Sampler { comparison: true }));
        !compares && !NEAREST_SAMPLERS.contains(&sampler.name.as_deref().unwrap_or_default())
    })
}

/// WebGPU lets no vertex stage bind what it could write.
pub(super) fn check_stage(entry: &naga::EntryPoint, globals: &[Global], places: &Places<'_>) -> Vec<ReflectError> {
    let writable = |kind: &GlobalKind| match kind {
        GlobalKind::Storage { writable, .. } => *writable,
        GlobalKind::StorageTexture { access, .. } => *access != StorageAccess::Read,
        _ => false,
    };
    let bad = globals.iter().filter(|global| entry.stage == ShaderStage::Vertex && writable(&global.kind));
    let span = places.function_span(&entry.name);
    bad.map(|global| ReflectError::VertexWrites { entry: entry.name.clone(), name: global.name.clone(), span }).collect()
}
