//! naga's front end and validator, with places translated back to the author's files.
//!
//! Both stop at their first problem; that is a limit of naga. Only what core WebGPU or one of our [`Feature`]s offers is valid.

use std::error::Error;

use naga::valid::{Capabilities, ModuleInfo, ValidationError, ValidationFlags, Validator};

use super::error::{Place, ReflectError};
use super::places::Places;
use super::text::JoinedText;
use crate::device::Feature;
use crate::source::Span;

/// What shaders may use on every adapter.
const CORE: Capabilities =
    Capabilities::MULTISAMPLED_SHADING.union(Capabilities::CUBE_ARRAY_TEXTURES).union(Capabilities::SHADER_FLOAT16_IN_FLOAT32);

/// What each feature adds.
const OPTIONAL: [(Feature, Capabilities); 3] = [
    (Feature::ShaderF16, Capabilities::SHADER_FLOAT16),
    (Feature::PrimitiveIndex, Capabilities::PRIMITIVE_INDEX),
    (Feature::Subgroups, Capabilities::SUBGROUP),
];

/// Parses the joined text.
pub(super) fn parse(joined: &JoinedText) -> Result<naga::Module, ReflectError> {
    naga::front::wgsl::parse_str(joined.as_str()).map_err(|error| ReflectError::Syntax {
        message: error.message().to_owned(),
        places: error.labels().filter_map(|(span, text)| Some((joined.locate_naga(span)?, text.to_owned()))).collect(),
        notes: error.notes().map(str::to_owned).collect(),
    })
}

/// Validates a module; also tells which features it needs.
pub(super) fn validate(module: &naga::Module, places: &Places<'_>) -> Result<(ModuleInfo, Vec<Feature>), ReflectError> {
    let run = |capabilities| Validator::new(ValidationFlags::all(), capabilities).validate(module).map_err(Box::new);
    // Most shaders need no feature.
    if let Ok(info) = run(CORE) {
        return Ok((info, Vec::new()));
    }
    let all = OPTIONAL.iter().fold(CORE, |all, (_, capabilities)| all | *capabilities);
    let info = run(all).map_err(|error| invalid(&error, places))?;
    // A feature is needed if the module is invalid without it.
    let needed = OPTIONAL.iter().filter(|(_, capabilities)| run(all.difference(*capabilities)).is_err()).map(|(feature, _)| *feature);
    Ok((info, needed.collect()))
}

/// Turns a validation error and its chain of causes into one problem.
fn invalid(error: &naga::WithSpan<ValidationError>, names: &Places<'_>) -> ReflectError {
    let mut causes: Vec<String> = Vec::new();
    let mut cause = error.as_inner().source();
    while let Some(next) = cause {
        causes.push(next.to_string());
        cause = next.source();
    }
    let what = match error.as_inner() {
        ValidationError::Type { name, .. } => format!("the type `{name}` is invalid"),
        ValidationError::Constant { name, .. } => format!("the constant `{name}` is invalid"),
        ValidationError::Override { name, .. } => format!("the override `{name}` is invalid"),
        ValidationError::GlobalVariable { name, .. } => format!("the variable `{name}` is invalid"),
        ValidationError::Function { name, .. } => format!("the function `{name}` is invalid"),
        ValidationError::EntryPoint { name, .. } => format!("the entry point `{name}` is invalid"),
        ValidationError::ArraySizeError { .. } => "the size of an array is not positive".to_owned(),
        other => other.to_string(),
    };
    let message = match causes.last() {
        Some(root) => format!("{what}: {root}"),
        None => what,
    };
    let mut places: Vec<Place> = error
        .spans()
        .map(|(span, text)| (names.naga_span(*span), describe(text).to_owned()))
        .filter(|place| place.0.is_somewhere())
        .collect();
    if places.is_empty() {
        let item = match error.as_inner() {
            ValidationError::Function { name, .. } | ValidationError::EntryPoint { name, .. } => names.function_span(name),
            ValidationError::GlobalVariable { name, .. } => names.value_span(name),
            _ => Span::NOWHERE,
        };
        places.extend(item.is_somewhere().then(|| (item, "here".to_owned())));
    }
    // The narrowest place says most.
    places.sort_by_key(|(span, _)| span.end.saturating_sub(span.start));
    causes.pop();
    ReflectError::Invalid { message, places, notes: causes }
}

/// naga's labels name its own types; say what they are.
fn describe(label: &str) -> &str {
    let Some(rest) = label.strip_prefix("naga::") else { return label };
    let kind = rest.split([' ', '<', '[']).next().unwrap_or(rest);
    match kind.rsplit("::").next().unwrap_or(kind) {
        "Expression" => "this expression",
        "GlobalVariable" | "LocalVariable" => "this variable",
        "Type" => "this type",
        "Constant" => "this constant",
        "Override" => "this override",
        "Function" => "this function",
        _ => "here",
    }
}
