//! Which of some files changed on disk, for those who reload them.
//!
//! Folders are watched, not files, since editors often put a new file in the old one's place. A change is told when nothing more
//! has happened for a moment: a file that is saved in several steps is told once.
//!
//! Accepted: a change is told even where the content is the same as before; and of a file system that tells nothing (some network
//! ones) nothing is known.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::source::SourceMap;
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};

/// How long nothing must happen before changes are told.
pub const QUIET: Duration = Duration::from_millis(100);

/// Watches some files.
#[derive(Debug)]
pub struct Watch {
    watcher: RecommendedWatcher,
    events: Receiver<notify::Result<Event>>,
    folders: BTreeSet<PathBuf>,
    /// As the system names them, beside what they were called.
    files: BTreeSet<(PathBuf, PathBuf)>,
    /// What changed and has not been told.
    changed: BTreeSet<PathBuf>,
    last: Option<Instant>,
}

impl Watch {
    /// Watches the files of a compilation that lie on disk: the pipeline, its shaders, and what they import. Error `watch::failed`.
    pub fn sources(sources: &SourceMap) -> Result<Watch, Diagnostic> {
        Watch::files(sources.iter().map(|(_, file)| PathBuf::from(&*file.name)))
    }

    /// Watches files; those that are not there are left out. Error `watch::failed`.
    pub fn files(files: impl IntoIterator<Item = PathBuf>) -> Result<Watch, Diagnostic> {
        let (sender, events) = channel();
        let watcher = notify::recommended_watcher(move |event| {
            // Nobody listens once the watch is dropped.
            let _ = sender.send(event);
        });
        let watcher = watcher.map_err(|error| failed(&error))?;
        let mut watch = Watch { watcher, events, folders: BTreeSet::new(), files: BTreeSet::new(), changed: BTreeSet::new(), last: None };
        watch.turn_to(files)?;
        Ok(watch)
    }

    /// Watches other files, after a reload. What has changed and was not told is kept, if it is still watched.
    pub fn turn_to(&mut self, files: impl IntoIterator<Item = PathBuf>) -> Result<(), Diagnostic> {
        let place = |file: PathBuf| real(&file).map(|real| (real, file));
        self.files = files.into_iter().filter_map(place).collect();
        let folders: BTreeSet<PathBuf> = self.files.iter().filter_map(|(real, _)| real.parent().map(Path::to_owned)).collect();
        for folder in self.folders.difference(&folders) {
            // One that is gone is not watched any more as it is.
            let _ = self.watcher.unwatch(folder);
        }
        for folder in folders.difference(&self.folders) {
            self.watcher.watch(folder, RecursiveMode::NonRecursive).map_err(|error| failed(&error))?;
        }
        self.folders = folders;
        self.changed.retain(|changed| self.files.iter().any(|(_, name)| name == changed));
        Ok(())
    }

    /// The files that changed since they were told last, by the names under which they are watched; empty while changes still come
    /// in. Never waits.
    pub fn changed(&mut self) -> Vec<PathBuf> {
        while let Ok(event) = self.events.try_recv() {
            let Ok(event) = event else { continue };
            if matches!(event.kind, EventKind::Access(_)) {
                continue;
            }
            for path in event.paths {
                let names = self.files.iter().filter(|(real, _)| *real == path).map(|(_, name)| name.clone());
                let before = self.changed.len();
                self.changed.extend(names);
                if self.changed.len() > before || self.files.iter().any(|(real, _)| *real == path) {
                    self.last = Some(Instant::now());
                }
            }
        }
        if self.last.is_some_and(|last| last.elapsed() < QUIET) {
            return Vec::new();
        }
        self.last = None;
        std::mem::take(&mut self.changed).into_iter().collect()
    }
}

/// The path as events have it; `None` if the file is not there. Its last part is not followed, so that a link that is set anew is seen.
fn real(file: &Path) -> Option<PathBuf> {
    let name = file.is_file().then(|| file.file_name()).flatten()?;
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    Some(folder.canonicalize().ok()?.join(name))
}

fn failed(error: &notify::Error) -> Diagnostic {
    Diagnostic::error("watch::failed", format!("files can't be watched: {error}"))
        .hint("where too many are watched already, the system's limit may be raised")
}
