//! Where pipelines, shaders and scenes come from: the disk first, then what is embedded in the program.
//!
//! A shader or image that a pipeline names is looked up in the `shaders` folder beside the pipeline's folder, then beside the pipeline
//! itself, then in `shaders` of the working directory, then among the embedded ones. A block, or what a pipeline extends, is looked up
//! beside the pipeline, then in the folder around, then among the embedded pipelines. Paths in pipelines can't leave these folders.

use std::borrow::Cow;
use std::path::{Component, Path, PathBuf};

use include_dir::{Dir, DirEntry, include_dir};
use luminaire_graph::source::{FileError, FileKind, Files, LoadedFile, LoadedImage};
use luminaire_scenes::linear_image::decode_linear;

static PIPELINES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/pipelines");
static SHADERS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/shaders");
/// Scene files; a test checks that none is missing here.
static SCENES: &[(&str, &str)] = &[
    ("cornell.ron", include_str!("../scenes/cornell.ron")),
    ("day.ron", include_str!("../scenes/day.ron")),
    ("day_night.ron", include_str!("../scenes/day_night.ron")),
    ("hall.ron", include_str!("../scenes/hall.ron")),
    ("light_kinds.ron", include_str!("../scenes/light_kinds.ron")),
    ("materials.ron", include_str!("../scenes/materials.ron")),
    ("mirrors.ron", include_str!("../scenes/mirrors.ron")),
    ("probe_grid.ron", include_str!("../scenes/probe_grid.ron")),
    ("room.ron", include_str!("../scenes/room.ron")),
    ("scene1.ron", include_str!("../scenes/scene1.ron")),
    ("scene2.ron", include_str!("../scenes/scene2.ron")),
    ("shadows.ron", include_str!("../scenes/shadows.ron")),
    ("spawned.ron", include_str!("../scenes/spawned.ron")),
    ("sun_path.ron", include_str!("../scenes/sun_path.ron")),
    ("wall_removed.ron", include_str!("../scenes/wall_removed.ron")),
];

/// Files larger than this are refused.
const MAX_FILE_BYTES: u64 = 64 << 20;

/// Files on disk with the embedded ones behind them.
#[derive(Debug, Clone, Default)]
pub struct DiskFiles {
    block_folders: Vec<PathBuf>,
    shader_folders: Vec<PathBuf>,
}

impl DiskFiles {
    /// Files for a pipeline: its path decides where its shaders are looked up.
    pub fn for_pipeline(pipeline: &Path) -> DiskFiles {
        let (mut shader_folders, mut block_folders) = (Vec::new(), Vec::new());
        if pipeline.is_file()
            && let Some(folder) = pipeline.parent()
        {
            shader_folders.push(folder.join("..").join("shaders"));
            shader_folders.push(folder.to_owned());
            block_folders = vec![folder.to_owned(), folder.join("..")];
        }
        shader_folders.push(PathBuf::from("shaders"));
        DiskFiles { block_folders, shader_folders }
    }

    /// Files for a shader by itself: `name` is the end of `path`, and imports are looked up where `path` begins.
    pub fn for_shader(path: &Path, name: &str) -> DiskFiles {
        let depth = Path::new(name).components().count();
        let folder = path.ancestors().nth(depth).map(Path::to_owned).unwrap_or_default();
        let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder };
        DiskFiles { block_folders: Vec::new(), shader_folders: vec![folder] }
    }
}

impl Files for DiskFiles {
    fn read(&self, kind: FileKind, path: &str) -> Result<LoadedFile, FileError> {
        match kind {
            FileKind::Pipeline => read_disk(Path::new(path)).unwrap_or_else(|| read_embedded(&PIPELINES, "pipelines", path, &["."])),
            FileKind::Block => read_below(&self.block_folders, path, &PIPELINES, "pipelines"),
            FileKind::Shader | FileKind::Image => read_below(&self.shader_folders, path, &SHADERS, "shaders"),
        }
        .and_then(Bytes::into_text)
    }

    fn image(&self, path: &str) -> Result<LoadedImage, FileError> {
        let Bytes { name, bytes } = read_below(&self.shader_folders, path, &SHADERS, "shaders")?;
        let image = decode_linear(&bytes).map_err(FileError::Unreadable)?;
        Ok(LoadedImage { name, width: image.width, height: image.height, texels: image.texels })
    }

    fn known(&self, kind: FileKind) -> Vec<String> {
        match kind {
            FileKind::Pipeline => embedded_pipelines(),
            FileKind::Block => names(&PIPELINES, &["ron"]),
            FileKind::Shader | FileKind::Image => {
                let extensions: &[&str] = if kind == FileKind::Shader { &["wgsl"] } else { &["exr", "hdr"] };
                let mut known = names(&SHADERS, extensions);
                for folder in &self.shader_folders {
                    collect(folder, folder, extensions, 0, &mut known);
                }
                known.sort();
                known.dedup();
                known
            }
        }
    }
}

/// The pipelines in the program, without the blocks that they are made of.
pub fn embedded_pipelines() -> Vec<String> {
    names(&PIPELINES, &["ron"]).into_iter().filter(|name| !name.starts_with("blocks/")).map(|name| format!("pipelines/{name}")).collect()
}

/// The scenes in the program.
pub fn embedded_scenes() -> Vec<String> {
    SCENES.iter().map(|(name, _)| format!("scenes/{name}")).collect()
}

/// The text of an embedded scene: `scenes/cornell.ron`, `cornell.ron` or `cornell`.
pub fn embedded_scene(path: &str) -> Option<LoadedFile> {
    let inner = path.strip_prefix("./").unwrap_or(path);
    let inner = inner.strip_prefix("scenes/").unwrap_or(inner);
    let found = SCENES.iter().find(|(name, _)| *name == inner || name.strip_suffix(".ron") == Some(inner));
    found.map(|(name, text)| LoadedFile { name: format!("scenes/{name}"), text: (*text).to_owned() })
}

/// What a file holds, under the name that messages show.
struct Bytes {
    name: String,
    bytes: Cow<'static, [u8]>,
}

impl Bytes {
    fn into_text(self) -> Result<LoadedFile, FileError> {
        match String::from_utf8(self.bytes.into_owned()) {
            Ok(text) => Ok(LoadedFile { name: self.name, text }),
            Err(error) => Err(FileError::Unreadable(format!("it is not UTF-8 at byte {}", error.utf8_error().valid_up_to()))),
        }
    }
}

/// A file that a pipeline names: in the first of the folders that has it, or in the program.
fn read_below(folders: &[PathBuf], path: &str, embedded: &'static Dir<'static>, name: &str) -> Result<Bytes, FileError> {
    if Path::new(path).components().any(|component| !matches!(component, Component::Normal(_) | Component::CurDir)) {
        return Err(FileError::Unreadable(format!("a path in a pipeline stays inside the {name} folder")));
    }
    let on_disk = folders.iter().find_map(|folder| read_disk(&folder.join(path)));
    let searched: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
    let searched: Vec<&str> = searched.iter().map(String::as_str).collect();
    on_disk.unwrap_or_else(|| read_embedded(embedded, name, path, &searched))
}

/// `None` if there is no such file, so that the next place is tried.
fn read_disk(path: &Path) -> Option<Result<Bytes, FileError>> {
    let metadata = std::fs::metadata(path).ok()?;
    let unreadable = |reason: String| Some(Err(FileError::Unreadable(reason)));
    if metadata.is_dir() {
        return unreadable("it is a folder".to_owned());
    }
    if metadata.len() > MAX_FILE_BYTES {
        return unreadable(format!("it is larger than {} MiB", MAX_FILE_BYTES >> 20));
    }
    match std::fs::read(path) {
        Err(error) => unreadable(error.to_string()),
        Ok(bytes) => Some(Ok(Bytes { name: path.display().to_string(), bytes: bytes.into() })),
    }
}

fn read_embedded(dir: &'static Dir<'static>, folder: &str, path: &str, searched: &[&str]) -> Result<Bytes, FileError> {
    let prefix = format!("{folder}/");
    let inner = path.strip_prefix("./").unwrap_or(path);
    let inner = inner.strip_prefix(&prefix).unwrap_or(inner);
    let file = dir.get_file(inner).or_else(|| dir.get_file(format!("{inner}.ron")));
    match file {
        Some(file) => Ok(Bytes { name: format!("{prefix}{}", file.path().display()), bytes: file.contents().into() }),
        None => {
            let searched = searched.iter().map(|place| (*place).to_owned()).chain(["the files in the program".to_owned()]).collect();
            Err(FileError::NotFound { searched })
        }
    }
}

fn names(dir: &Dir<'_>, extensions: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    for entry in dir.entries() {
        match entry {
            DirEntry::Dir(dir) => found.extend(names(dir, extensions)),
            DirEntry::File(file) if has_extension(file.path(), extensions) => {
                found.push(file.path().display().to_string());
            }
            DirEntry::File(_) => {}
        }
    }
    found.sort();
    found
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    path.extension().is_some_and(|found| extensions.iter().any(|extension| found == *extension))
}

/// Files of some kinds below a folder, for hints.
fn collect(root: &Path, folder: &Path, extensions: &[&str], depth: usize, found: &mut Vec<String>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten().take(1000) {
        let path = entry.path();
        if path.is_dir() && depth < 4 {
            collect(root, &path, extensions, depth + 1, found);
        } else if has_extension(&path, extensions)
            && let Ok(inner) = path.strip_prefix(root)
        {
            found.push(inner.display().to_string());
        }
    }
}
