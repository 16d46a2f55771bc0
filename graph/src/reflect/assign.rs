//! Groups and bindings for variables, locations for vertex inputs and fragment outputs: what authors do not write.
//!
//! Group 1 holds the material textures and samplers of the scene, each at its place in the schema, so that every shader can
//! use one bind group per material. Group 0 holds everything else, in the order of the text. Locations follow the order of
//! parameters and members. After an error the numbers are still assigned, so that naga can look for more.

use indexmap::IndexSet;
use naga::{AddressSpace, Binding, Handle, Module, ResourceBinding, ShaderStage, Type, TypeInner};

use super::error::ReflectError;
use super::interface::ScalarKind;
use super::io::{Io, inputs, outputs};
use super::places::Places;
use super::types::{numeric, type_text};
use crate::published::PublishedSchema;

/// Assigns everything, and reports what authors wrote and must not, or must write and did not.
pub(super) fn assign(module: &mut Module, places: &Places<'_>, published: &PublishedSchema) -> Vec<ReflectError> {
    let mut errors = Vec::new();
    assign_bindings(module, places, published, &mut errors);
    assign_locations(module, places, &mut errors);
    // Overrides get their values by name; a numeric id would hide the name from the device.
    for (_, constant) in module.overrides.iter_mut() {
        constant.id = constant.id.filter(|_| constant.name.is_none());
    }
    errors
}

fn assign_bindings(module: &mut Module, places: &Places<'_>, published: &PublishedSchema, errors: &mut Vec<ReflectError>) {
    let mut variables: Vec<(usize, Handle<naga::GlobalVariable>)> = module
        .global_variables
        .iter()
        .map(|(handle, variable)| (places.value_order(variable.name.as_deref().unwrap_or_default()), handle))
        .collect();
    variables.sort();
    let mut next = 0;
    for (_, handle) in variables {
        let variable = module.global_variables.get_mut(handle);
        let name = variable.name.clone().unwrap_or_default();
        if let Some((attributes, span)) = places.value_attributes(&name, &["group", "binding"]) {
            let attributes = attributes.iter().map(|attribute| format!("@{attribute}")).collect::<Vec<_>>().join(" and ");
            errors.push(ReflectError::WrittenBinding { name: name.clone(), attributes, span });
        }
        if !matches!(variable.space, AddressSpace::Uniform | AddressSpace::Storage { .. } | AddressSpace::Handle) {
            variable.binding = None;
            continue;
        }
        let inner = module.types.get_handle(variable.ty).map(|ty| &ty.inner);
        let place_in = |list: &[String]| list.iter().position(|known| *known == name);
        let material = match inner {
            Ok(TypeInner::Image { .. }) => place_in(&published.material_textures),
            Ok(TypeInner::Sampler { .. }) => place_in(&published.material_samplers).map(|index| published.material_textures.len() + index),
            _ => None,
        };
        variable.binding = Some(match material {
            Some(index) => ResourceBinding { group: 1, binding: index as u32 },
            None => {
                next += 1;
                ResourceBinding { group: 0, binding: next - 1 }
            }
        });
    }
}

/// A parameter of an entry point and the location that it gets.
struct Direct {
    entry: usize,
    parameter: usize,
    location: u32,
}

fn assign_locations(module: &mut Module, places: &Places<'_>, errors: &mut Vec<ReflectError>) {
    let mut structs: IndexSet<Handle<Type>> = IndexSet::new();
    let mut direct: Vec<Direct> = Vec::new();
    for (index, entry) in module.entry_points.iter().enumerate() {
        let (inputs, outputs) = (inputs(module, entry, places), outputs(module, entry, places));
        let checker = Checker { module, entry: &entry.name };
        match entry.stage {
            ShaderStage::Vertex => {
                errors.extend(inputs.iter().filter_map(|io| checker.by_name("vertex input", io)));
                errors.extend(inputs.iter().filter_map(|io| checker.vertex_input(io)));
                errors.extend(outputs.iter().filter_map(|io| checker.by_location("output", io)));
                let mut location = 0;
                let own: IndexSet<_> = inputs.iter().filter(|io| !io.is_builtin()).filter_map(|io| io.structure).collect();
                let parameters: IndexSet<_> =
                    inputs.iter().filter(|io| !io.is_builtin() && io.structure.is_some()).map(|io| io.parameter).collect();
                if parameters.len() > 1 {
                    let (entry, span) = (entry.name.clone(), places.function_span(&entry.name));
                    errors.push(ReflectError::TwoInputStructs { entry, span });
                }
                // Members come first: a struct has the same locations wherever it is used.
                location += inputs.iter().filter(|io| !io.is_builtin() && io.structure.is_some()).count() as u32;
                for io in inputs.iter().filter(|io| !io.is_builtin() && io.structure.is_none()) {
                    direct.push(Direct { entry: index, parameter: io.parameter, location });
                    location += 1;
                }
                structs.extend(own);
            }
            ShaderStage::Fragment => {
                errors.extend(inputs.iter().filter_map(|io| checker.by_location("input", io)));
                for io in outputs.iter().filter(|io| !io.is_builtin()) {
                    match io.structure {
                        Some(structure) => {
                            structs.insert(structure);
                            errors.extend(checker.by_name("fragment output", io));
                            errors.extend(checker.color_output(io));
                        }
                        None => errors.push(ReflectError::UnnamedOutput { entry: entry.name.clone(), span: io.span }),
                    }
                }
            }
            _ => {}
        }
    }
    for handle in structs {
        number_members(module, handle);
    }
    for Direct { entry, parameter, location } in direct {
        let argument = module.entry_points.get_mut(entry).and_then(|entry| entry.function.arguments.get_mut(parameter));
        if let Some(argument) = argument {
            argument.binding = Some(at_location(location, argument.binding.as_ref()));
        }
    }
}

/// Checks single inputs and outputs.
struct Checker<'a> {
    module: &'a Module,
    entry: &'a str,
}

impl Checker<'_> {
    /// What binds by name has no location.
    fn by_name(&self, what: &'static str, io: &Io) -> Option<ReflectError> {
        let (name, entry, span) = (io.name.clone(), self.entry.to_owned(), io.span);
        io.location().map(|_| ReflectError::WrittenLocation { what, name, entry, span })
    }

    /// What binds by location has one.
    fn by_location(&self, what: &'static str, io: &Io) -> Option<ReflectError> {
        let (name, entry, span) = (io.name.clone(), self.entry.to_owned(), io.span);
        io.binding.is_none().then_some(ReflectError::MissingLocation { what, name, entry, span })
    }

    fn vertex_input(&self, io: &Io) -> Option<ReflectError> {
        if io.is_builtin() || matches!(numeric(self.module, io.ty), Some((ScalarKind::Float, _))) {
            return None;
        }
        let (name, entry, wgsl) = (io.name.clone(), self.entry.to_owned(), type_text(self.module, io.ty));
        Some(ReflectError::VertexInputType { name, entry, wgsl, span: io.span })
    }

    fn color_output(&self, io: &Io) -> Option<ReflectError> {
        if numeric(self.module, io.ty).is_some() {
            return None;
        }
        let (name, entry, wgsl) = (io.name.clone(), self.entry.to_owned(), type_text(self.module, io.ty));
        Some(ReflectError::OutputType { name, entry, wgsl, span: io.span })
    }
}

/// A location; what else was written stays.
fn at_location(location: u32, written: Option<&Binding>) -> Binding {
    match written {
        Some(Binding::Location { interpolation, sampling, blend_src, per_primitive, .. }) => Binding::Location {
            location,
            interpolation: *interpolation,
            sampling: *sampling,
            blend_src: *blend_src,
            per_primitive: *per_primitive,
        },
        _ => Binding::Location { location, interpolation: None, sampling: None, blend_src: None, per_primitive: false },
    }
}

/// Gives the members of a struct locations in their order.
fn number_members(module: &mut Module, handle: Handle<Type>) {
    let Ok(ty) = module.types.get_handle(handle) else { return };
    let mut numbered = ty.clone();
    let TypeInner::Struct { members, .. } = &mut numbered.inner else { return };
    let plain = members.iter_mut().filter(|member| !matches!(member.binding, Some(Binding::BuiltIn(_))));
    for (location, member) in (0..).zip(plain) {
        member.binding = Some(at_location(location, member.binding.as_ref()));
    }
    // `replace` keeps the handle; it must not meet an equal type, which only an unchanged one could be.
    if module.types.get(&numbered).is_none() {
        module.types.replace(handle, numbered);
    }
}
