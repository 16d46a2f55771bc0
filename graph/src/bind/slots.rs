//! Which variable or output of the shader takes each slot of a pass.

use super::error::{BindError, Mismatch};
use super::program::Program;
use crate::expand::types::{PartRef, Pass, PassKind, Slot, Work};
use crate::plan::Role;
use crate::reflect::interface::{ColorOutput, Global, GlobalKind, Shader, StorageAccess};

/// A slot that found its place in the shader.
#[derive(Debug, Clone)]
pub(super) struct Taken {
    /// The slot's name.
    pub name: String,
    /// What it gets.
    pub part: PartRef,
    /// Read, produce or modify.
    pub role: Role,
    /// Who takes it.
    pub taker: Taker,
}

/// Who takes a slot.
#[derive(Debug, Clone)]
pub(super) enum Taker {
    /// A shader variable.
    Variable(Box<Global>),
    /// A color output of the fragment shader.
    Color {
        /// Which.
        output: ColorOutput,
        /// Whether it is blended.
        blend: bool,
    },
    /// The depth attachment.
    Depth,
    /// A Copy, Clear or Remember.
    Transfer,
    /// The buffer that says how many workgroups run.
    Indirect,
}

/// Finds a taker for every slot of a pass.
pub(super) fn take(pass: &Pass, program: Option<&Program>, shaders: &[Shader], problems: &mut Vec<BindError>) -> Vec<Taken> {
    let groups = [(Role::Read, &pass.reads), (Role::Produce, &pass.writes), (Role::Modify, &pass.modifies)];
    let mut taken = Vec::new();
    for (role, slots) in groups {
        for slot in slots {
            let taker = match program {
                None => Some(Taker::Transfer),
                Some(program) => taker(pass, program, shaders, role, slot, problems),
            };
            if let Some(taker) = taker {
                taken.push(Taken { name: slot.name.value.clone(), part: slot.part, role, taker });
            }
        }
    }
    taken
}

fn taker(pass: &Pass, program: &Program, shaders: &[Shader], role: Role, slot: &Slot, problems: &mut Vec<BindError>) -> Option<Taker> {
    let name = slot.name.value.as_str();
    let blends = match &pass.kind {
        PassKind::Draw { blend, .. } | PassKind::Procedural { blend, .. } | PassKind::Fullscreen { blend, .. } => blend.as_slice(),
        _ => &[],
    };
    if name == "depth" && matches!(pass.kind, PassKind::Draw { .. } | PassKind::Procedural { .. }) {
        return Some(Taker::Depth);
    }
    if name == "indirect" && matches!(pass.kind, PassKind::Compute { work: Work::Indirect { .. }, .. }) {
        return Some(Taker::Indirect);
    }
    let rasterises = matches!(pass.kind, PassKind::Draw { .. } | PassKind::Procedural { .. } | PassKind::Fullscreen { .. });
    let outputs = if rasterises { program.main(shaders).map_or(&[][..], |main| main.color_outputs.as_slice()) } else { &[] };
    if role != Role::Read
        && let Some(output) = outputs.iter().find(|output| output.name == name)
    {
        let blend = blends.iter().any(|(slot, _)| slot.value == name);
        return Some(Taker::Color { output: output.clone(), blend });
    }
    if let Some(global) = program.global(name) {
        check_access(pass, role, slot, global, problems);
        return Some(Taker::Variable(Box::new(global.clone())));
    }
    let shader = &shaders[program.shader];
    let declared = shader.module.global_variables.iter().any(|(_, variable)| variable.name.as_deref() == Some(name));
    let known =
        program.globals.iter().map(|(global, _)| global.name.clone()).chain(outputs.iter().map(|output| output.name.clone())).collect();
    problems.push(BindError::NoTaker { pass: pass.name.clone(), slot: name.to_owned(), declared, known, span: slot.name.span });
    None
}

/// A variable's access must be what its slot says, so that the RON alone shows the data flow.
fn check_access(pass: &Pass, role: Role, slot: &Slot, global: &Global, problems: &mut Vec<BindError>) {
    let reason = match (&global.kind, role) {
        (GlobalKind::Sampler { .. }, _) => {
            Some(("is a sampler, and no resource can feed it", "samplers have fixed names, such as `linear_clamp`"))
        }
        (GlobalKind::Uniform { .. } | GlobalKind::Texture { .. } | GlobalKind::DepthTexture { .. }, Role::Produce | Role::Modify) => {
            Some((
                "can only be read, and the pass writes it",
                "move the slot to `read`, or declare a storage texture or a `var<storage, read_write>`",
            ))
        }
        (GlobalKind::Storage { writable: false, .. }, Role::Produce | Role::Modify) => Some((
            "is declared `var<storage, read>`, and the pass writes it",
            "declare it `var<storage, read_write>`, or move the slot to `read`",
        )),
        (GlobalKind::Storage { writes: true, .. }, Role::Read) => {
            Some(("is written by the shader, and the pass only reads it", "move the slot to `write` or `modify`"))
        }
        (GlobalKind::Storage { writable: true, .. }, Role::Read) => {
            Some(("is declared `read_write`, and the pass only reads it", "declare it `var<storage, read>`"))
        }
        (GlobalKind::Storage { writes: false, .. }, Role::Produce | Role::Modify) => {
            Some(("is not written by the shader, and the pass says that it is", "move the slot to `read`"))
        }
        (GlobalKind::StorageTexture { access: StorageAccess::Read, .. }, Role::Produce | Role::Modify) => {
            Some(("is a storage texture to read, and the pass writes it", "declare its access as `write`"))
        }
        (GlobalKind::StorageTexture { access: StorageAccess::Write | StorageAccess::ReadWrite, .. }, Role::Read) => {
            Some(("is a storage texture to write, and the pass only reads it", "move the slot to `write` or `modify`"))
        }
        _ => None,
    };
    if let Some((reason, hint)) = reason {
        problems.push(BindError::Mismatch {
            kind: Mismatch::Access,
            pass: pass.name.clone(),
            variable: global.name.clone(),
            reason: reason.to_owned(),
            hint: Some(hint.to_owned()),
            slot_span: slot.name.span,
            variable_span: global.span,
        });
    }
}
