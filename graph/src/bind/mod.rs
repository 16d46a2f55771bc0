//! Expanded passes and their shaders to steps: each variable gets its resource, each resource its format, each part its access.
//!
//! The order of the work: load and reflect each shader once; choose entry points; find who takes each slot; choose formats, which
//! needs all uses; then build the steps. Problems of all passes are reported together.
//!
//! Guarantees: every variable of every step is fed, with a resource that it can see; every slot is taken; nothing is bound that
//! the device can't bind.

mod error;
mod formats;
mod limits;
mod params;
mod program;
mod slots;
mod steps;
mod tables;
mod targets;
pub mod types;
mod views;
mod work;

pub use error::{BindError, Mismatch};

use std::collections::{HashMap, HashSet};

use crate::device::DeviceFacts;
use crate::diagnostic::{Diagnostic, has_errors};
use crate::expand::types::{Expanded, Pass};
use crate::published::PublishedSchema;
use crate::reflect::interface::{Shader, Stage};
use crate::reflect::{check_fullscreen_inputs, check_varyings, reflect};
use crate::source::{Files, SourceMap, Span};
use program::Program;
use types::Bound;

/// What shaders are bound to.
pub struct BindInput<'a> {
    /// Where shader files come from.
    pub files: &'a dyn Files,
    /// What the scene publishes.
    pub published: &'a PublishedSchema,
    /// Limits and features.
    pub device: &'a DeviceFacts,
    /// Width and height of the rendered image, for the camera's view.
    pub output: [u32; 2],
}

/// Binds every pass. Texts of shaders are added to `sources`.
pub fn bind(expanded: Expanded, input: &BindInput<'_>, sources: &mut SourceMap) -> Result<Bound, Vec<Diagnostic>> {
    let mut diagnostics = Vec::new();
    let mut loader =
        Loader { input, sources, shaders: Vec::new(), by_path: HashMap::new(), programs: HashMap::new(), diagnostics: &mut diagnostics };
    let programs: Vec<Option<usize>> = expanded.passes.iter().map(|pass| loader.program(pass)).collect();
    let Loader { shaders, programs: cache, .. } = loader;
    let mut all_programs: Vec<Option<Program>> = (0..cache.len()).map(|_| None).collect();
    for (program, index) in cache.into_values() {
        all_programs[index] = Some(program);
    }
    let program_of = |index: usize| programs[index].and_then(|program| all_programs[program].as_ref());

    let mut problems = Vec::new();
    let taken: Vec<_> = expanded
        .passes
        .iter()
        .enumerate()
        .map(|(index, pass)| match program_of(index) {
            // A shader that failed has been reported; its pass can't be checked further.
            None if pass.shader.is_some() => Vec::new(),
            program => slots::take(pass, program, &shaders, &mut problems),
        })
        .collect();
    let formats = formats::choose(&expanded, &taken, input.device, &mut problems);
    let mut builder = steps::Builder::new(&expanded, input, &shaders, &formats, &mut problems);
    let mut steps = Vec::new();
    for (index, pass) in expanded.passes.iter().enumerate() {
        let program = program_of(index);
        if pass.shader.is_none() || program.is_some() {
            steps.extend(builder.step(index, pass, program, &taken[index]));
        }
    }
    let steps::Builder { views, draw_lists, inputs, requirements, .. } = builder;
    // One slip in a loop or in a shared shader shows once, however many passes meet it.
    let mut seen = HashSet::new();
    diagnostics.extend(problems.into_iter().map(Diagnostic::from).filter(|problem| {
        let place = problem.primary.as_ref().map_or(Span::NOWHERE, |label| label.span);
        let other = problem.secondary.first().map_or(Span::NOWHERE, |label| label.span);
        seen.insert((problem.code, place, other))
    }));
    if has_errors(&diagnostics) {
        return Err(diagnostics);
    }
    Ok(Bound {
        expanded,
        shaders,
        steps,
        formats,
        views: views.into_vec(),
        draw_lists: draw_lists.into_vec(),
        inputs: inputs.into_vec(),
        requirements,
    })
}

type ProgramKey = (usize, Option<usize>, Option<usize>);

/// Loads each shader file once, and puts each combination of entry points together once.
struct Loader<'a, 'b> {
    input: &'a BindInput<'b>,
    sources: &'a mut SourceMap,
    shaders: Vec<Shader>,
    /// `None` for files that failed.
    by_path: HashMap<String, Option<usize>>,
    programs: HashMap<ProgramKey, (Program, usize)>,
    diagnostics: &'a mut Vec<Diagnostic>,
}

impl Loader<'_, '_> {
    fn program(&mut self, pass: &Pass) -> Option<usize> {
        let path = pass.shader.as_ref()?;
        let shader = match self.by_path.get(&path.value) {
            Some(known) => (*known)?,
            None => {
                let loaded = match reflect(&path.value, path.span, self.input.files, self.input.published, self.sources) {
                    Ok(shader) => {
                        self.shaders.push(shader);
                        Some(self.shaders.len() - 1)
                    }
                    Err(problems) => {
                        self.diagnostics.extend(problems);
                        None
                    }
                };
                self.by_path.insert(path.value.clone(), loaded);
                loaded?
            }
        };
        match program::entries(pass, &self.shaders[shader]) {
            Ok((vertex, main)) => {
                let key = (shader, vertex, main);
                if let Some((_, index)) = self.programs.get(&key) {
                    return Some(*index);
                }
                let index = self.programs.len();
                self.programs.insert(key, (program::program(shader, &self.shaders[shader], vertex, main), index));
                self.check_stages(key);
                Some(index)
            }
            Err(problems) => {
                self.diagnostics.extend(problems.into_iter().map(Diagnostic::from));
                None
            }
        }
    }

    /// What the fragment stage takes, the stage before it must give.
    fn check_stages(&mut self, (shader, vertex, main): ProgramKey) {
        let entry = |index: Option<usize>| index.and_then(|index| self.shaders[shader].entries.get(index));
        let problems = match (entry(vertex), entry(main)) {
            (Some(vertex), Some(fragment)) => check_varyings(vertex, fragment),
            (None, Some(main)) if main.stage == Stage::Fragment => check_fullscreen_inputs(main),
            _ => Vec::new(),
        };
        self.diagnostics.extend(problems);
    }
}
