//! A shader file with the entry points that a pass runs, and all that they use together.

use std::collections::HashMap;

use super::error::BindError;
use crate::expand::types::{Located, Pass, PassKind};
use crate::plan::Stages;
use crate::reflect::interface::{EntryPoint, Global, GlobalKind, Shader, Stage};

/// What a pass runs.
#[derive(Debug, Clone)]
pub(super) struct Program {
    /// Index into the shaders.
    pub shader: usize,
    /// Index into the shader's entries, for Draw.
    pub vertex: Option<usize>,
    /// Fragment or compute entry; a Draw may have none.
    pub main: Option<usize>,
    /// The variables that the entries use, by group and binding.
    pub globals: Vec<(Global, Stages)>,
    /// Positions in `globals`.
    pub by_name: HashMap<String, usize>,
}

impl Program {
    /// The fragment or compute entry.
    pub fn main<'a>(&self, shaders: &'a [Shader]) -> Option<&'a EntryPoint> {
        self.main.and_then(|index| shaders.get(self.shader)?.entries.get(index))
    }

    /// The vertex entry.
    pub fn vertex<'a>(&self, shaders: &'a [Shader]) -> Option<&'a EntryPoint> {
        self.vertex.and_then(|index| shaders.get(self.shader)?.entries.get(index))
    }

    /// A variable by its name.
    pub fn global(&self, name: &str) -> Option<&Global> {
        self.by_name.get(name).and_then(|index| self.globals.get(*index)).map(|(global, _)| global)
    }
}

/// Chooses the entry points of a pass: `(vertex, fragment or compute)`.
pub(super) fn entries(pass: &Pass, shader: &Shader) -> Result<(Option<usize>, Option<usize>), Vec<BindError>> {
    let mut problems = Vec::new();
    let mut choose = |stage: Stage, field: &'static str, asked: Option<&Located<String>>, required: bool| -> Option<usize> {
        let known: Vec<(usize, &EntryPoint)> = shader.entries.iter().enumerate().filter(|(_, entry)| entry.stage == stage).collect();
        let names = || known.iter().map(|(_, entry)| entry.name.clone()).collect::<Vec<_>>();
        let (pass_name, file, stage_name) = (pass.name.clone(), shader.path.clone(), name_of(stage));
        let span = pass.shader.as_ref().map_or(pass.span, |shader| shader.span);
        match (asked, known.as_slice()) {
            (Some(asked), _) => {
                let found = known.iter().find(|(_, entry)| entry.name == asked.value).map(|(index, _)| *index);
                if found.is_none() {
                    let name = Some(asked.value.clone());
                    problems.push(BindError::NoEntry { pass: pass_name, file, stage: stage_name, name, known: names(), span: asked.span });
                }
                found
            }
            (None, [(index, _)]) => Some(*index),
            (None, []) => {
                if required {
                    problems.push(BindError::NoEntry { pass: pass_name, file, stage: stage_name, name: None, known: Vec::new(), span });
                }
                None
            }
            (None, _) => {
                problems.push(BindError::ManyEntries { pass: pass_name, file, stage: stage_name, field, known: names(), span });
                None
            }
        }
    };
    let chosen = match &pass.kind {
        PassKind::Draw { vertex, fragment, .. } | PassKind::Procedural { vertex, fragment, .. } => {
            (choose(Stage::Vertex, "vertex", vertex.as_ref(), true), choose(Stage::Fragment, "fragment", fragment.as_ref(), false))
        }
        PassKind::Fullscreen { entry, .. } => (None, choose(Stage::Fragment, "entry", entry.as_ref(), true)),
        PassKind::Compute { entry, .. } => (None, choose(Stage::Compute, "entry", entry.as_ref(), true)),
        PassKind::Copy | PassKind::Clear { .. } | PassKind::Image(_) | PassKind::Remember => (None, None),
    };
    if problems.is_empty() { Ok(chosen) } else { Err(problems) }
}

fn name_of(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vertex",
        Stage::Fragment => "fragment",
        Stage::Compute => "compute",
    }
}

/// Puts the variables of a program's entry points together.
pub(super) fn program(shader_index: usize, shader: &Shader, vertex: Option<usize>, main: Option<usize>) -> Program {
    let mut globals: Vec<(Global, Stages)> = Vec::new();
    for entry in [vertex, main].into_iter().flatten().filter_map(|index| shader.entries.get(index)) {
        for global in &entry.globals {
            let position = globals.iter().position(|(known, _)| known.name == global.name);
            let index = position.unwrap_or_else(|| {
                globals.push((global.clone(), Stages::default()));
                globals.len() - 1
            });
            let (known, stages) = &mut globals[index];
            merge(&mut known.kind, &global.kind);
            known.reads.add(&global.reads);
            match entry.stage {
                Stage::Vertex => stages.vertex = true,
                Stage::Fragment => stages.fragment = true,
                Stage::Compute => stages.compute = true,
            }
        }
    }
    globals.sort_by_key(|(global, _)| (global.group, global.binding));
    let by_name = globals.iter().enumerate().map(|(index, (global, _))| (global.name.clone(), index)).collect();
    Program { shader: shader_index, vertex, main, globals, by_name }
}

/// What two entry points do with one variable, together.
fn merge(known: &mut GlobalKind, other: &GlobalKind) {
    match (known, other) {
        (GlobalKind::Texture { filtered, .. }, GlobalKind::Texture { filtered: also, .. }) => *filtered |= also,
        (GlobalKind::Storage { reads, writes, .. }, GlobalKind::Storage { reads: also_reads, writes: also_writes, .. }) => {
            *reads |= also_reads;
            *writes |= also_writes;
        }
        _ => {}
    }
}
