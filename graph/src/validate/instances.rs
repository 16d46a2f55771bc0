//! Every document that takes part: the pipeline, and each block as often as it stands.

use indexmap::IndexMap;

use super::passes::paths;
use crate::load::Loaded;
use crate::syntax::document::{BlockDoc, DimensionDoc, Document, InputDoc, ResourceDoc, Text};

/// A document at one of the places where it stands.
pub(super) struct Instance<'a> {
    /// Begins every name of its own: nothing for the pipeline, `shadows.` for a block.
    pub path: String,
    /// Who uses it.
    pub parent: usize,
    /// How it is used; `None` for the pipeline.
    pub block: Option<(&'a Text, &'a BlockDoc)>,
    /// What is written.
    pub loaded: &'a Loaded,
    /// Its own blocks.
    pub children: IndexMap<&'a str, usize>,
    /// The number of its first resource.
    pub first_resource: u32,
    /// Paths of its own passes and loops: `faces`, `faces.draw`.
    pub passes: Vec<String>,
    /// Paths of its blocks, and of their passes and loops.
    pub block_passes: Vec<String>,
}

impl<'a> Instance<'a> {
    /// What is written.
    pub fn document(&self) -> &'a Document {
        &self.loaded.document
    }
}

/// What is known of a resource before sizes are.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Declared {
    Buffer,
    /// With every format that it may get; none where any will do.
    Texture(DimensionDoc, Vec<String>),
}

/// All instances, each behind the one that uses it, and what resources there are, by id.
pub(super) fn instances(loaded: &Loaded) -> (Vec<Instance<'_>>, Vec<Declared>) {
    let (mut instances, mut declared) = (Vec::new(), Vec::new());
    add(loaded, "", 0, None, &mut instances, &mut declared);
    (instances, declared)
}

fn add<'a>(
    loaded: &'a Loaded,
    path: &str,
    parent: usize,
    block: Option<(&'a Text, &'a BlockDoc)>,
    instances: &mut Vec<Instance<'a>>,
    declared: &mut Vec<Declared>,
) -> usize {
    let index = instances.len();
    let document = &loaded.document;
    let first_resource = declared.len() as u32;
    declared.extend(document.resources.values().map(|resource| match resource {
        ResourceDoc::Buffer { .. } => Declared::Buffer,
        ResourceDoc::Texture { dimension, format, .. } => Declared::Texture(*dimension, formats(document, format.value.names())),
        ResourceDoc::Image { format, .. } => Declared::Texture(DimensionDoc::D2, formats(document, std::slice::from_ref(&format.value))),
    }));
    if block.is_none() {
        // Of a block that stands alone, as while it is checked, the inputs are resources that nobody gives.
        declared.extend(document.inputs.values().map(|input| match input {
            InputDoc::Buffer { .. } => Declared::Buffer,
            InputDoc::Texture { dimension, format, .. } => {
                Declared::Texture(*dimension, format.as_ref().map(|format| format.value.names().to_vec()).unwrap_or_default())
            }
        }));
    }
    let mut passes = Vec::new();
    paths(&document.passes, "", 0, &mut passes);
    let (children, block_passes) = Default::default();
    instances.push(Instance { path: path.to_owned(), parent, block, loaded, children, first_resource, passes, block_passes });
    for (name, doc) in &document.blocks {
        let Some(inner) = loaded.blocks.get(&name.value) else { continue };
        let child = add(inner, &format!("{path}{}.", name.value), index, Some((name, doc)), instances, declared);
        let below = [&instances[child].passes, &instances[child].block_passes].into_iter().flatten();
        let below: Vec<String> = below.map(|pass| format!("{}.{pass}", name.value)).collect();
        let instance = &mut instances[index];
        instance.children.insert(&name.value, child);
        instance.block_passes.push(name.value.clone());
        instance.block_passes.extend(below);
    }
    index
}

/// Every format that names stand for, which are formats or parameters of the document whose options are.
fn formats(document: &Document, names: &[String]) -> Vec<String> {
    let options = |name: &String| document.params.get(name.as_str())?.options.as_ref().map(|options| options.value.clone());
    names.iter().flat_map(|name| options(name).unwrap_or_else(|| vec![name.clone()])).collect()
}
