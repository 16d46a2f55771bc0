//! What is going on, on a terminal; nothing elsewhere.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::source::SourceMap;

use super::report;

/// A line at the bottom of a terminal.
pub(super) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    pub(super) fn new() -> Progress {
        let bar = ProgressBar::new_spinner();
        bar.enable_steady_tick(Duration::from_millis(120));
        Progress { bar }
    }

    /// What is done now.
    pub(super) fn say(&self, what: &'static str) {
        self.bar.set_message(what);
    }

    /// From now on so many things of a kind are done: a bar, if they are several.
    pub(super) fn count(&self, things: u64) {
        if things > 1
            && let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {pos}/{len} {eta}")
        {
            self.bar.set_style(style);
            self.bar.set_length(things);
            self.bar.reset_eta();
        }
    }

    /// How many of them are done.
    pub(super) fn at(&self, thing: u64) {
        self.bar.set_position(thing);
    }

    /// Warnings go above the bar.
    pub(super) fn report(&self, diagnostics: &[Diagnostic], sources: &SourceMap) {
        self.bar.suspend(|| report(diagnostics, sources));
    }

    pub(super) fn done(&self) {
        self.bar.finish_and_clear();
    }
}
