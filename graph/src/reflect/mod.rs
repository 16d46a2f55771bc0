//! WGSL to an interface: what a shader file declares, what each of its entry points uses, and where all of it stands.
//!
//! The steps are: imports are joined into one text ([`import`]), naga parses it ([`wgsl`]), groups, bindings and locations are
//! assigned ([`assign`]), naga validates, and the interface is read off ([`entries`], [`globals`]). Authors write no `@group`,
//! no `@binding`, and `@location` only between the vertex and the fragment stage; everything else binds by name.
//!
//! Guarantees: the same files give the same interface, places are exact to the character in the file that the author wrote, and
//! an accepted module is valid for a device with [`interface::Shader::features`]. All problems are reported that can be told;
//! accepted downside: naga itself reports one syntax error or one invalid item of a shader at a time.

mod assign;
mod entries;
mod error;
mod globals;
mod import;
pub mod interface;
mod io;
mod limits;
mod overrides;
mod places;
mod reads;
mod text;
mod tokens;
mod types;
mod varyings;
mod wgsl;

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::published::PublishedSchema;
use crate::source::{Files, SourceMap, Span};
use error::ReflectError;
use interface::Shader;
use places::Places;
pub use varyings::{check_fullscreen_inputs, check_varyings};

/// Reads the shader file at `path` (relative to the shaders folder) with its imports, checks it, and describes it.
///
/// `requested_at` is the place that names the file, for the message where there is no such file. `published` tells which textures
/// and samplers belong to materials (group 1). Every text that is read is added to `sources`, once. Nothing is cached: a caller that
/// meets a path often keeps the result.
///
/// # Errors
/// Every problem that was found, each with a code `reflect::...`.
pub fn reflect(
    path: &str,
    requested_at: Span,
    files: &dyn Files,
    published: &PublishedSchema,
    sources: &mut SourceMap,
) -> Result<Shader, Vec<Diagnostic>> {
    reflect_steps(path, requested_at, files, published, sources)
        .map_err(|errors| without_repeats(errors.into_iter().map(Diagnostic::from).collect()))
}

/// Keeps the first of the problems of one kind at one place: a struct that two entry points share is wrong once.
fn without_repeats(problems: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut seen = BTreeSet::new();
    let place = |problem: &Diagnostic| problem.primary.as_ref().map(|label| label.span).filter(|span| span.is_somewhere());
    problems.into_iter().filter(|problem| place(problem).is_none_or(|span| seen.insert((problem.code, span)))).collect()
}

/// The steps, in order.
fn reflect_steps(
    path: &str,
    requested_at: Span,
    files: &dyn Files,
    published: &PublishedSchema,
    sources: &mut SourceMap,
) -> Result<Shader, Vec<ReflectError>> {
    let joined = import::load(path, requested_at, files, sources)?;
    let mut module = wgsl::parse(&joined).map_err(|error| vec![error])?;
    let places = Places::of(&joined);
    let mut errors = assign::assign(&mut module, &places, published);
    let (declared, problems) = globals::declared(&module, &places);
    errors.extend(problems);
    errors.extend(entries::check(&module, &places));
    if errors.iter().any(ReflectError::blocks_validation) {
        return Err(errors);
    }
    let (info, features) = match wgsl::validate(&module, &places) {
        Ok(valid) => valid,
        Err(error) => {
            errors.push(error);
            return Err(errors);
        }
    };
    let overrides = overrides::declared(&module, &places);
    let (entries, problems) = entries::describe(&module, &info, &declared, &overrides, &places);
    errors.extend(problems);
    if !errors.is_empty() {
        return Err(errors);
    }
    Ok(Shader { path: path.to_owned(), module: Arc::new(module), text: joined.as_str().into(), entries, overrides, features })
}
