//! The past of resources: a resource of the same shape for each, and the pass that fills it.

use std::collections::BTreeSet;

use super::types::{ClearValue, History, Keep, Located, PartRef, Pass, PassKind, Resource, ResourceId, Run, Slot};
use crate::validate::types::ResourceDecl;

/// Adds a history behind all declared resources for each whose past is read.
pub(super) fn resources(histories: &[Located<ResourceId>], declared: &[ResourceDecl], resources: &mut Vec<Resource>) {
    for history in histories {
        let (source, decl) = (&resources[history.value.index()], &declared[history.value.index()]);
        let first = decl.first.or(decl.clear).unwrap_or(ClearValue::Zero);
        resources.push(Resource {
            name: format!("previous({})", source.name),
            span: history.span,
            shape: source.shape.clone(),
            clear: None,
            history: Some(History { of: history.value, first, on_resize: decl.on_resize }),
            keep: Keep::Auto,
        });
    }
}

/// Adds the pass that fills each history that some pass reads: one in a block that does not stand has nothing to remember. It has the
/// history's name.
pub(super) fn passes(histories: &[Located<ResourceId>], resources: &[Resource], passes: &mut Vec<Pass>) {
    let first = resources.len() - histories.len();
    let read: BTreeSet<ResourceId> = passes.iter().flat_map(|pass| &pass.reads).map(|slot| slot.part.resource).collect();
    for (index, (history, resource)) in histories.iter().zip(&resources[first..]).enumerate() {
        let span = history.span;
        if !read.contains(&ResourceId((first + index) as u32)) {
            continue;
        }
        let part = PartRef { resource: ResourceId((first + index) as u32), mips: None, layers: None, version: None, span };
        passes.push(Pass {
            name: resource.name.as_str().into(),
            block: Default::default(),
            list: 0,
            span,
            indices: Vec::new(),
            kind: PassKind::Remember,
            shader: None,
            constants: Vec::new(),
            reads: Vec::new(),
            writes: vec![Slot { name: Located { value: "write".to_owned(), span }, part }],
            modifies: Vec::new(),
            after: Vec::new(),
            run: Run::OnChange,
            batch: None,
            elements: Vec::new(),
        });
    }
}
