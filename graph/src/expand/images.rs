//! Images: the pass that puts what a file holds into its resource. No other pass may write it.

use super::environment::Environment;
use super::error::ExpandError;
use super::types::{Located, PartRef, Pass, PassKind, Resource, Run, Slot};
use crate::validate::types::ImageDecl;

/// Reports passes that write an image.
pub(super) fn check(environment: &mut Environment<'_>, images: &[ImageDecl], resources: &[Resource], passes: &[Pass]) {
    for pass in passes {
        for slot in pass.writes.iter().chain(&pass.modifies) {
            if let Some(image) = images.iter().find(|image| image.resource == slot.part.resource) {
                environment.report(ExpandError::WritesImage {
                    image: resources[image.resource.index()].name.clone(),
                    pass: pass.name.clone(),
                    span: slot.part.span,
                    declared: image.span,
                });
            }
        }
    }
}

/// Adds the pass that fills each image.
pub(super) fn passes(images: &[ImageDecl], resources: &[Resource], passes: &mut Vec<Pass>) {
    for ImageDecl { resource, image, span } in images {
        let (resource, span) = (*resource, *span);
        let part = PartRef { resource, mips: None, layers: None, version: None, span };
        passes.push(Pass {
            name: format!("image({})", resources[resource.index()].name).into(),
            block: Default::default(),
            list: 0,
            span,
            indices: Vec::new(),
            kind: PassKind::Image(image.clone()),
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
