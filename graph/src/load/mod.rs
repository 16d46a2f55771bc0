//! A pipeline's path to its document, with every file that it names: blocks, images, and what it extends.
//!
//! Guarantees: no file contains itself, what a pipeline extends is worked in, and each block stands beside the document that names
//! it. The authors' documents are left as they are: what comes out is a new one, whose entries keep their places. Accepted downside:
//! a block that is used twice is held twice.

mod error;
mod extend;

pub use error::LoadError;

use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

use indexmap::IndexMap;

use crate::diagnostic::{Diagnostic, has_errors};
use crate::source::{FileError, FileId, FileKind, Files, LoadedImage, SourceMap, Span};
use crate::syntax::document::{BlockDoc, Document, Entries, ResourceDoc, Text};
use crate::syntax::read_document;

/// Files that name each other deeper than this are refused.
const MAX_DEPTH: usize = 16;
/// Pipelines with more blocks than this, those of blocks counted, are refused.
const MAX_BLOCKS: usize = 1000;

/// A document and those of its blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// Without `extend`: what it extended is part of it.
    pub document: Document,
    /// Where it is written; of a pipeline that extends another, its own file.
    pub file: FileId,
    /// One for each of the document's blocks, by name.
    pub blocks: IndexMap<String, Loaded>,
    /// The files in whose lists passes stand that another file put there, by the places of their names.
    pub placed: BTreeMap<Span, FileId>,
}

impl Loaded {
    fn new(document: Document, file: FileId, blocks: IndexMap<String, Loaded>) -> Loaded {
        Loaded { document, file, blocks, placed: BTreeMap::new() }
    }
}

/// Reads a pipeline and all files that it names.
///
/// # Errors
/// Files that can't be read or are no documents, files that contain themselves, and changes to a pipeline that don't fit it.
pub fn load(files: &dyn Files, pipeline: &str, sources: &mut SourceMap) -> Result<Loaded, Vec<Diagnostic>> {
    let (read, images, chain, problems) = Default::default();
    let mut loader = Loader { files, sources, read, images, chain, blocks: 0, problems };
    let loaded = loader.file(FileKind::Pipeline, pipeline, Span::NOWHERE);
    match loaded {
        Some(loaded) if !has_errors(&loader.problems) => Ok(loaded),
        _ => Err(loader.problems),
    }
}

struct Loader<'a> {
    files: &'a dyn Files,
    sources: &'a mut SourceMap,
    /// Documents by the names of their files; `None` where one is wrong, which is reported once.
    read: BTreeMap<String, Option<(FileId, Rc<Document>)>>,
    /// Images by their paths, or why they can't be read.
    images: BTreeMap<String, Result<Arc<LoadedImage>, FileError>>,
    /// The files around, outermost first.
    chain: Vec<String>,
    blocks: usize,
    problems: Vec<Diagnostic>,
}

impl Loader<'_> {
    fn report(&mut self, error: LoadError) {
        self.problems.push(error.into());
    }

    /// Reads a file and those that it names. `span` is where it is named.
    fn file(&mut self, kind: FileKind, path: &str, span: Span) -> Option<Loaded> {
        let read = match self.files.read(kind, path) {
            Ok(read) => read,
            Err(error) => {
                let known = self.files.known(kind);
                self.report(LoadError::Unreadable { path: path.to_owned(), error, known, span });
                return None;
            }
        };
        let name = read.name;
        if self.chain.contains(&name) {
            let chain = [self.chain.as_slice(), std::slice::from_ref(&name)].concat();
            self.report(LoadError::Recursion { chain, span });
            return None;
        }
        if self.chain.len() >= MAX_DEPTH {
            self.report(LoadError::TooDeep { path: path.to_owned(), limit: MAX_DEPTH, span });
            return None;
        }
        if !self.read.contains_key(&name) {
            let file = self.sources.add(name.as_str(), read.text.as_str());
            let document = read_document::<Document>(&read.text, file).map_err(|problems| self.problems.extend(problems)).ok();
            self.read.insert(name.clone(), document.map(|document| (file, Rc::new(document))));
        }
        let (file, document) = self.read.get(&name).cloned().flatten()?;
        self.chain.push(name);
        let loaded = self.document(file, &document);
        self.chain.pop();
        loaded
    }

    fn document(&mut self, file: FileId, document: &Document) -> Option<Loaded> {
        let mut document = document.clone();
        self.images(&mut document.resources);
        let mut blocks = self.blocks(&document.blocks);
        let Some(mut changes) = document.extend.take() else { return Some(Loaded::new(document, file, blocks)) };
        self.images(&mut changes.replace.resources);
        blocks.extend(self.blocks(&changes.replace.blocks));
        let base = self.file(FileKind::Block, &changes.file.value, changes.file.span)?;
        Some(extend::extend(base, Loaded::new(document, file, blocks), &changes, &mut self.problems))
    }

    /// Reads the images that resources name.
    fn images(&mut self, resources: &mut Entries<ResourceDoc>) {
        for resource in resources.values_mut() {
            if let ResourceDoc::Image { file, loaded, .. } = resource {
                *loaded = self.image(file);
            }
        }
    }

    fn image(&mut self, path: &Text) -> Option<Arc<LoadedImage>> {
        if !self.images.contains_key(&path.value) {
            let read = self.files.image(&path.value).map(Arc::new);
            if let Ok(image) = &read {
                self.sources.add(image.name.as_str(), "");
            }
            self.images.insert(path.value.clone(), read);
        }
        match self.images.get(&path.value)? {
            Ok(image) => Some(Arc::clone(image)),
            Err(error) => {
                let (error, known) = (error.clone(), self.files.known(FileKind::Image));
                self.report(LoadError::BadImage { path: path.value.clone(), error, known, span: path.span });
                None
            }
        }
    }

    fn blocks(&mut self, blocks: &Entries<BlockDoc>) -> IndexMap<String, Loaded> {
        let mut loaded = IndexMap::new();
        for (name, block) in blocks {
            self.blocks += 1;
            if self.blocks > MAX_BLOCKS {
                if self.blocks == MAX_BLOCKS + 1 {
                    self.report(LoadError::TooManyBlocks { limit: MAX_BLOCKS, span: name.span });
                }
                break;
            }
            loaded.extend(self.file(FileKind::Block, &block.file.value, block.file.span).map(|block| (name.value.clone(), block)));
        }
        loaded
    }
}
