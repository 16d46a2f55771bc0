//! What reaches a shader from parameters: the bytes of its `params` struct, and its `override` constants.

use super::error::BindError;
use crate::diagnostic::{did_you_mean, list_names};
use crate::expand::types::{Param, Pass, Run, Value};
use crate::expression::kind_of;
use crate::plan::BindingTarget;
use crate::reflect::interface::{EntryPoint, Layout, Member, Shader};

/// The member of `params` that gets the number of the run, in an accumulating pass.
const ACCUMULATED: &str = "accumulated";

/// Packs parameters and loop indices into the layout of a `params` struct. Bytes between members are zero.
pub(super) fn pack(pass: &Pass, params: &[Param], layout: &Layout, problems: &mut Vec<BindError>) -> BindingTarget {
    let mut bytes = vec![0; layout.size as usize];
    let counted = |member: &&Member| matches!(pass.run, Run::Accumulate(_)) && member.name == ACCUMULATED;
    let accumulated = layout.members.iter().find(counted);
    if let Some(member) = accumulated.filter(|member| member.wgsl != "u32") {
        let reason = format!("the member `{ACCUMULATED}` of `params` is {}, and it counts runs", member.wgsl);
        let hint = Some("declare it as u32".to_owned());
        problems.push(BindError::Param { pass: pass.name.clone(), reason, hint, span: member.span, pass_span: pass.span });
    }
    for member in layout.members.iter().filter(|member| !counted(member)) {
        match encode(pass, params, member) {
            Ok(encoded) => {
                if let Some(target) = bytes.get_mut(member.offset as usize..member.offset as usize + encoded.len()) {
                    target.copy_from_slice(&encoded);
                }
            }
            Err((reason, hint)) => {
                problems.push(BindError::Param { pass: pass.name.clone(), reason, hint, span: member.span, pass_span: pass.span });
            }
        }
    }
    BindingTarget::Params { bytes, accumulated: accumulated.map(|member| member.offset as usize) }
}

/// The parameters marked `live` that a `params` struct names.
pub(super) fn live<'a>(pass: &'a Pass, params: &'a [Param], layout: &'a Layout) -> impl Iterator<Item = &'a str> {
    let named = |param: &&Param| own_name(pass, param).is_some_and(|name| layout.members.iter().any(|member| member.name == name));
    params.iter().filter(|param| param.live).filter(named).map(|param| param.name.as_str())
}

/// The name by which the shader of a pass knows a parameter: those of its own file, and no others.
fn own_name<'a>(pass: &Pass, param: &'a Param) -> Option<&'a str> {
    param.name.strip_prefix(&*pass.block).filter(|name| !name.contains('.'))
}

fn encode(pass: &Pass, params: &[Param], member: &Member) -> Result<Vec<u8>, (String, Option<String>)> {
    let name = member.name.as_str();
    let value = if let Some((_, index)) = pass.indices.iter().rev().find(|(variable, _)| variable == name) {
        Value::Int(i64::from(*index))
    } else if let Some(param) = params.iter().find(|param| own_name(pass, param) == Some(name)) {
        param.value.clone()
    } else {
        let known: Vec<&str> =
            params.iter().filter_map(|param| own_name(pass, param)).chain(pass.indices.iter().map(|(name, _)| name.as_str())).collect();
        let hint = did_you_mean(name, known.iter().copied()).unwrap_or_else(|| format!("there are {}", list_names(known)));
        return Err((format!("the member `{name}` of `params` is no parameter of the pipeline"), Some(hint)));
    };
    let wrong = |expected: &str| {
        let reason = format!("the member `{name}` of `params` is {}, and the parameter is {}", member.wgsl, kind_of(&value));
        Err((reason, Some(format!("declare it as {expected}"))))
    };
    match (&value, member.wgsl.as_str()) {
        (Value::Bool(value), "u32") => Ok(u32::from(*value).to_le_bytes().to_vec()),
        (Value::Word(index, _), "u32") => Ok(index.to_le_bytes().to_vec()),
        (Value::Int(value), "i32") => match i32::try_from(*value) {
            Ok(value) => Ok(value.to_le_bytes().to_vec()),
            Err(_) => Err((format!("the parameter `{name}` is {value}, which does not fit into i32"), None)),
        },
        (Value::Int(value), "u32") => match u32::try_from(*value) {
            Ok(value) => Ok(value.to_le_bytes().to_vec()),
            Err(_) => Err((format!("the parameter `{name}` is {value}, which does not fit into u32"), None)),
        },
        (Value::Float(value), "f32") => Ok((*value as f32).to_le_bytes().to_vec()),
        (Value::Vector(values), wgsl) if wgsl == format!("vec{}<f32>", values.len()) => {
            Ok(values.iter().flat_map(|value| (*value as f32).to_le_bytes()).collect())
        }
        (Value::Bool(_) | Value::Word(..), _) => wrong("u32"),
        (Value::Int(_), _) => wrong("i32 or u32"),
        (Value::Float(_), _) => wrong("f32"),
        (Value::Vector(values), _) => wrong(&format!("vec{}<f32>", values.len())),
    }
}

/// The values of the overrides that the entry points use.
pub(super) fn constants(pass: &Pass, shader: &Shader, entries: &[&EntryPoint], problems: &mut Vec<BindError>) -> Vec<(String, f64)> {
    let mut values = Vec::new();
    for (name, value) in &pass.constants {
        let Some(declared) = shader.overrides.iter().find(|declared| declared.name == name.value) else {
            let known: Vec<&str> = shader.overrides.iter().map(|declared| declared.name.as_str()).collect();
            let hint = did_you_mean(&name.value, known.iter().copied()).unwrap_or_else(|| format!("it has {}", list_names(known)));
            let reason = format!("`{}` has no override `{}`", shader.path, name.value);
            problems.push(BindError::Constant { pass: pass.name.clone(), reason, hint: Some(hint), span: name.span });
            continue;
        };
        let fits = match declared.wgsl.as_str() {
            "bool" => *value == 0.0 || *value == 1.0,
            "u32" => value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(value),
            "i32" => value.fract() == 0.0 && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(value),
            _ => true,
        };
        if !fits {
            let reason = format!("the override `{}` is {}, and {value} is none", name.value, declared.wgsl);
            problems.push(BindError::Constant { pass: pass.name.clone(), reason, hint: None, span: name.span });
        } else if entries.iter().any(|entry| entry.overrides.contains(&name.value)) {
            values.push((name.value.clone(), *value));
        }
    }
    for declared in shader.overrides.iter().filter(|declared| !declared.has_default) {
        let used = entries.iter().any(|entry| entry.overrides.contains(&declared.name));
        if used && !pass.constants.iter().any(|(name, _)| name.value == declared.name) {
            let reason = format!("the override `{}` of `{}` has no value", declared.name, shader.path);
            let hint = Some(format!("add constants: {{\"{}\": ..}}", declared.name));
            problems.push(BindError::Constant { pass: pass.name.clone(), reason, hint, span: pass.span });
        }
    }
    values
}
