//! Source files and places in them.
//!
//! Every text that a compilation reads (pipelines, shaders, scene files) is added to one [`SourceMap`] and from then on
//! named by a [`FileId`]; a [`Span`] is a byte range in it. Images are added
//! without text, so that a list of all files is complete. Files are never removed, so a span stays valid as long as the map.

use std::sync::Arc;

/// A file in a [`SourceMap`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId(u32);

/// A byte range of a file. Places that belong to no text (a command line, a built-in) use [`Span::NOWHERE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The file that holds the text.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// A place that is in no file. Diagnostics leave labels there out.
    pub const NOWHERE: Span = Span { file: FileId(u32::MAX), start: 0, end: 0 };

    /// A byte range of `file`.
    pub fn new(file: FileId, start: usize, end: usize) -> Span {
        Span { file, start: start as u32, end: end as u32 }
    }

    /// Whether the place is in a file.
    pub fn is_somewhere(self) -> bool {
        self.file.0 != u32::MAX
    }
}

/// One text with the name that messages show for it.
#[derive(Debug, Clone)]
pub struct SourceFile {
    /// The path as the user wrote it, or the name of an embedded file.
    pub name: Arc<str>,
    /// The whole text.
    pub text: Arc<str>,
}

/// All texts of a compilation, in the order in which they were read.
#[derive(Debug, Clone, Default)]
pub struct SourceMap {
    files: Vec<SourceFile>,
}

impl SourceMap {
    /// Adds a text. The same name may be added again (a reload): each gets its own id.
    pub fn add(&mut self, name: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> FileId {
        let id = FileId(self.files.len() as u32);
        self.files.push(SourceFile { name: name.into(), text: text.into() });
        id
    }

    /// The file behind an id; `None` for [`Span::NOWHERE`] and ids of other maps.
    pub fn get(&self, id: FileId) -> Option<&SourceFile> {
        self.files.get(id.0 as usize)
    }

    /// Every file, in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = (FileId, &SourceFile)> {
        self.files.iter().enumerate().map(|(index, file)| (FileId(index as u32), file))
    }

    /// The text of a span; empty where it lies outside of its file.
    pub fn text(&self, span: Span) -> &str {
        self.get(span.file).and_then(|file| file.text.get(span.start as usize..span.end as usize)).unwrap_or("")
    }

    /// One-based line and column (in characters) of a span's start.
    pub fn line_column(&self, span: Span) -> Option<(usize, usize)> {
        let before = self.get(span.file)?.text.get(..span.start as usize)?;
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Some((before.matches('\n').count() + 1, before[line_start..].chars().count() + 1))
    }
}

/// Where a compilation finds the files that a pipeline names. Paths use `/` and are relative to the folder of their kind.
pub trait Files {
    /// Reads a text file.
    fn read(&self, kind: FileKind, path: &str) -> Result<LoadedFile, FileError>;

    /// Reads an image. Whoever has no images finds none.
    fn image(&self, path: &str) -> Result<LoadedImage, FileError> {
        let _ = path;
        Err(FileError::NotFound { searched: Vec::new() })
    }

    /// The paths of a kind that could have been meant, for hints. May be empty.
    fn known(&self, kind: FileKind) -> Vec<String> {
        let _ = kind;
        Vec::new()
    }
}

/// Which folder a path is relative to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FileKind {
    /// A `.ron` pipeline that a user names.
    Pipeline,
    /// A `.ron` file that a pipeline names: a block, or what it extends. Relative to the pipeline's folder.
    Block,
    /// A `.wgsl` shader.
    Shader,
    /// An image, by [`Files::image`]. Relative to the folder of shaders.
    Image,
}

/// A text and the name under which messages show it.
#[derive(Debug, Clone)]
pub struct LoadedFile {
    /// For example the path on disk.
    pub name: String,
    /// Its content.
    pub text: String,
}

/// The texels of an image, and the name under which messages show it.
#[derive(Clone, PartialEq)]
pub struct LoadedImage {
    /// For example the path on disk.
    pub name: String,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height`, row by row from the top: red, green, blue, alpha as they stand in the file.
    pub texels: Vec<[f32; 4]>,
}

impl std::fmt::Debug for LoadedImage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} ({} x {})", self.name, self.width, self.height)
    }
}

/// Why a file could not be read. The message is shown after the path.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FileError {
    /// No such file in any of the places that were searched.
    #[error("no such file (searched: {})", searched.join(", "))]
    NotFound {
        /// The places, as the user knows them.
        searched: Vec<String>,
    },
    /// It exists and can't be read, or is not UTF-8.
    #[error("{0}")]
    Unreadable(String),
}

/// Files in memory, for tests and tools. Blocks are found among the pipelines.
#[derive(Debug, Clone, Default)]
pub struct MemoryFiles {
    files: std::collections::BTreeMap<(FileKind, String), String>,
    images: std::collections::BTreeMap<String, LoadedImage>,
}

impl MemoryFiles {
    /// Adds or replaces a file.
    pub fn with(mut self, kind: FileKind, path: &str, text: &str) -> MemoryFiles {
        self.files.insert((kind, path.to_owned()), text.to_owned());
        self
    }

    /// Adds or replaces an image, under its name.
    pub fn with_image(mut self, image: LoadedImage) -> MemoryFiles {
        self.images.insert(image.name.clone(), image);
        self
    }
}

impl Files for MemoryFiles {
    fn read(&self, kind: FileKind, path: &str) -> Result<LoadedFile, FileError> {
        let kind = if kind == FileKind::Block { FileKind::Pipeline } else { kind };
        match self.files.get(&(kind, path.to_owned())) {
            Some(text) => Ok(LoadedFile { name: path.to_owned(), text: text.clone() }),
            None => Err(FileError::NotFound { searched: vec!["memory".to_owned()] }),
        }
    }

    fn image(&self, path: &str) -> Result<LoadedImage, FileError> {
        self.images.get(path).cloned().ok_or_else(|| FileError::NotFound { searched: vec!["memory".to_owned()] })
    }

    fn known(&self, kind: FileKind) -> Vec<String> {
        if kind == FileKind::Image {
            return self.images.keys().cloned().collect();
        }
        self.files.keys().filter(|key| key.0 == kind).map(|key| key.1.clone()).collect()
    }
}

impl Default for Span {
    fn default() -> Span {
        Span::NOWHERE
    }
}
