//! Document to validated document: names resolved, expressions parsed, everything wrong reported at once.
//!
//! Guarantees: every reference is a typed id that may be used as an index; every expression names only what is visible where it
//! stands; formats exist; sizes fit dimensions; clear values fit formats. What depends on the value of an expression is checked
//! by the next step.

mod error;
mod loops;
mod params;
mod passes;
mod resources;
mod scope;
pub mod types;

pub use error::ValidateError;
pub(crate) use resources::clear_fits;
pub(crate) use scope::without_indices;

use crate::diagnostic::{Diagnostic, has_errors};
use crate::expand::types::{Located, ResourceId};
use crate::published::PublishedSchema;
use crate::source::{FileId, Span};
use crate::syntax::document::Document;
use scope::Scope;
use types::Validated;

/// Resolves every name of a document.
pub fn validate(document: &Document, file: FileId, published: &PublishedSchema) -> Result<Validated, Vec<Diagnostic>> {
    let mut scope = Scope {
        resources: document.resources.keys().enumerate().map(|(index, name)| (name.value.as_str(), ResourceId(index as u32))).collect(),
        params: document.params.keys().map(|name| name.value.as_str()).collect(),
        words: document
            .params
            .values()
            .flat_map(|param| param.options.iter().flat_map(|options| options.value.iter().map(String::as_str)))
            .collect(),
        counts: &published.counts,
        passes: Vec::new(),
        variables: Vec::new(),
        declared: document.resources.values().collect(),
        histories: Vec::new(),
        collections: &published.collections,
        batched: None,
        spread: false,
        problems: Vec::new(),
    };
    passes::paths(&document.passes, "", 0, &mut scope.passes);
    let start = Span::new(file, 0, 1);
    for (what, empty) in [("passes", document.passes.is_empty()), ("outputs", document.outputs.is_empty())] {
        if empty {
            scope.report(ValidateError::Empty { what, span: start });
        }
    }
    let params = document.params.iter().filter_map(|(name, doc)| params::param(&mut scope, name, doc)).collect();
    let resources = document.resources.iter().filter_map(|(name, doc)| resources::resource(&mut scope, name, doc)).collect();
    let items = passes::items(&mut scope, &document.passes);
    let mut outputs = Vec::new();
    for (name, reference) in &document.outputs {
        scope.check_name(name);
        if let Some(part) = scope.part(reference) {
            outputs.push((Located { value: name.value.clone(), span: name.span }, part));
        }
    }
    let retained_budget = document.retained_budget.as_ref().and_then(|budget| scope.expression(budget));
    let Scope { problems, histories, .. } = scope;
    if has_errors(&problems) {
        return Err(problems);
    }
    Ok(Validated { doc: document.doc.clone(), params, resources, items, outputs, histories, retained_budget })
}
