//! What goes in and out of entry points, with structs taken apart.

use naga::{Binding, EntryPoint, Handle, Module, Type, TypeInner};

use super::places::Places;
use crate::source::Span;

/// One input or output.
#[derive(Debug, Clone)]
pub(super) struct Io {
    /// Of the parameter or member; `result` for a result that is no struct.
    pub(super) name: String,
    /// Where the name stands.
    pub(super) span: Span,
    /// Its type.
    pub(super) ty: Handle<Type>,
    /// Builtin or location.
    pub(super) binding: Option<Binding>,
    /// The struct that it is a member of.
    pub(super) structure: Option<Handle<Type>>,
    /// The parameter that it is or stands in; 0 for results.
    pub(super) parameter: usize,
}

impl Io {
    /// Whether it is `@builtin(...)`.
    pub(super) fn is_builtin(&self) -> bool {
        matches!(self.binding, Some(Binding::BuiltIn(_)))
    }

    /// Its `@location(...)`.
    pub(super) fn location(&self) -> Option<u32> {
        match self.binding {
            Some(Binding::Location { location, .. }) => Some(location),
            _ => None,
        }
    }
}

/// The inputs of an entry point, in order.
pub(super) fn inputs(module: &Module, entry: &EntryPoint, places: &Places<'_>) -> Vec<Io> {
    let mut found = Vec::new();
    for (index, argument) in entry.function.arguments.iter().enumerate() {
        let io = Io {
            name: argument.name.clone().unwrap_or_default(),
            span: places.parameter_span(&entry.name, index),
            ty: argument.ty,
            binding: argument.binding.clone(),
            structure: None,
            parameter: index,
        };
        take_apart(module, io, places, &mut found);
    }
    found
}

/// The outputs of an entry point, in order.
pub(super) fn outputs(module: &Module, entry: &EntryPoint, places: &Places<'_>) -> Vec<Io> {
    let mut found = Vec::new();
    if let Some(result) = &entry.function.result {
        let io = Io {
            name: "result".to_owned(),
            span: places.result_span(&entry.name),
            ty: result.ty,
            binding: result.binding.clone(),
            structure: None,
            parameter: 0,
        };
        take_apart(module, io, places, &mut found);
    }
    found
}

/// Adds a value, or its members where it is a struct.
fn take_apart(module: &Module, io: Io, places: &Places<'_>, found: &mut Vec<Io>) {
    let Ok(Type { name, inner: TypeInner::Struct { members, .. } }) = module.types.get_handle(io.ty) else {
        found.push(io);
        return;
    };
    for (index, member) in members.iter().enumerate() {
        found.push(Io {
            name: member.name.clone().unwrap_or_default(),
            span: places.member_span(name.as_deref().unwrap_or_default(), index),
            ty: member.ty,
            binding: member.binding.clone(),
            structure: Some(io.ty),
            parameter: io.parameter,
        });
    }
}
