//! Documents to a validated document: names resolved, expressions parsed, everything wrong reported at once.
//!
//! Guarantees: every reference is a typed id that may be used as an index; every expression names only what is visible where it
//! stands; formats exist; sizes fit dimensions; clear values fit formats. What depends on the value of an expression is checked
//! by the next step.

mod blocks;
mod error;
mod instances;
mod loops;
mod params;
mod passes;
mod references;
mod resources;
mod scope;
pub mod types;

pub use error::ValidateError;
pub(crate) use references::without_indices;
pub(crate) use resources::clear_fits;

use std::sync::Arc;

use crate::diagnostic::{Diagnostic, has_errors};
use crate::expand::types::{Located, ResourceId};
use crate::load::Loaded;
use crate::published::PublishedSchema;
use crate::source::Span;
use crate::syntax::document::ResourceDoc;
use instances::Instance;
use scope::Scope;
use types::{ImageDecl, Validated};

/// Resolves every name of a pipeline and its blocks.
///
/// # Errors
/// Everything that is wrong with it.
pub fn validate(loaded: &Loaded, published: &PublishedSchema) -> Result<Validated, Vec<Diagnostic>> {
    let (instances, declared) = instances::instances(loaded);
    let params = instances.iter().flat_map(|instance| instance.document().params.values());
    let words = params.flat_map(|param| param.options.iter().flat_map(|options| options.value.iter().map(String::as_str)));
    let mut scope = Scope {
        instances: &instances,
        current: 0,
        declared: &declared,
        words: words.collect(),
        counts: &published.counts,
        collections: &published.collections,
        histories: Vec::new(),
        measured: Vec::new(),
        loops: Default::default(),
        following: Vec::new(),
        problems: Vec::new(),
        reported: Default::default(),
    };
    let (mut blocks, mut params, mut resources) = (Vec::new(), Vec::new(), Vec::new());
    for index in 0..instances.len() {
        blocks.push(blocks::usage(&mut scope, index));
        scope.within(index, |scope| {
            check_document(scope);
            params.extend(blocks::params(scope));
            let declared = scope.document().resources.iter();
            resources.extend(declared.filter_map(|(name, doc)| resources::resource(scope, name, doc)));
        });
    }
    let items = blocks::items(&mut scope, 0);
    let document = &loaded.document;
    // Those of blocks are checked, too, whether somebody reads them or not.
    let outputs: Vec<_> = (0..instances.len()).map(|index| scope.within(index, outputs_of)).collect();
    let outputs = outputs.into_iter().next().unwrap_or_default();
    let retained_budget = document.retained_budget.as_ref().and_then(|budget| scope.expression(budget));
    let Scope { problems, histories, measured, .. } = scope;
    if has_errors(&problems) {
        return Err(problems);
    }
    let inputs = document.inputs.keys().map(passes::located).collect();
    let blocks = blocks.into_iter().flatten().collect();
    let (doc, images) = (document.doc.clone(), images(&instances));
    Ok(Validated { doc, params, resources, blocks, inputs, items, outputs, histories, images, measured, retained_budget })
}

/// The resources of all files that are images.
fn images(instances: &[Instance<'_>]) -> Vec<ImageDecl> {
    let mut found = Vec::new();
    for instance in instances {
        for (id, resource) in (instance.first_resource..).zip(instance.document().resources.values()) {
            if let ResourceDoc::Image { file, loaded: Some(image), .. } = resource {
                found.push(ImageDecl { resource: ResourceId(id), image: Arc::clone(image), span: file.span });
            }
        }
    }
    found
}

/// What holds for a file as a whole.
fn check_document(scope: &mut Scope<'_>) {
    let document = scope.document();
    let start = Span::new(scope.instance().loaded.file, 0, 1);
    // What fills an image is a pass, too.
    let images = document.resources.values().any(|resource| matches!(resource, ResourceDoc::Image { .. }));
    let nothing_runs = document.passes.is_empty() && document.blocks.is_empty() && !images;
    for (what, empty) in [("passes", nothing_runs), ("outputs", document.outputs.is_empty())] {
        if empty {
            scope.report(ValidateError::Empty { what, span: start });
        }
    }
    let resources = document.resources.keys().map(|name| (name, "a resource"));
    let mut names: Vec<_> = resources.chain(document.inputs.keys().map(|name| (name, "an input"))).collect();
    for name in document.blocks.keys() {
        if let Some((pass, _)) = document.passes.get_key_value(name) {
            let ambiguous = ValidateError::Ambiguous { name: name.value.clone(), first: "a block", second: "a pass", span: pass.span };
            scope.report(ambiguous);
        }
        if ["output", "scene"].contains(&name.value.as_str()) {
            let rule = "expressions have `output.width` and `scene.NAME` for the image and the scene";
            scope.report(ValidateError::BadName { name: name.value.clone(), rule, span: name.span });
        }
        names.push((name, "a block"));
    }
    for (index, (name, second)) in names.iter().enumerate().skip(document.resources.len()) {
        scope.check_name(name);
        if let Some((_, first)) = names[..index].iter().find(|(other, _)| other == name) {
            scope.report(ValidateError::Ambiguous { name: name.value.clone(), first, second, span: name.span });
        }
    }
}

fn outputs_of(scope: &mut Scope<'_>) -> Vec<(Located<String>, types::PartExpr)> {
    let mut outputs = Vec::new();
    for (name, reference) in &scope.document().outputs {
        scope.check_name(name);
        if let Some(part) = scope.part(reference) {
            outputs.push((passes::located(name), part));
        }
    }
    outputs
}
