//! Collects the problems of one file.
//!
//! Guarantees: every message names the file and the place in its JSON, and at most [`MOST`] problems of each severity are kept,
//! followed by one line that counts the rest. Downside: places are JSON paths, not lines, since the JSON reader keeps no lines.

use std::cell::RefCell;
use std::fmt::Display;

use luminaire_graph::diagnostic::{Diagnostic, Severity};

/// How many errors, and how many warnings, are kept.
const MOST: usize = 50;

/// The problems found so far. Shared by reference, so that a reader at any depth can add to it.
pub(super) struct Report {
    file: String,
    errors: RefCell<Kept>,
    warnings: RefCell<Kept>,
}

#[derive(Default)]
struct Kept {
    list: Vec<Diagnostic>,
    left_out: usize,
}

impl Kept {
    fn add(&mut self, diagnostic: Diagnostic) {
        if self.list.len() < MOST {
            self.list.push(diagnostic);
        } else {
            self.left_out += 1;
        }
    }

    fn finish(self, file: &str, severity: Severity) -> Vec<Diagnostic> {
        let mut list = self.list;
        if self.left_out > 0 {
            let text = format!("{file}: and {} more like these", self.left_out);
            list.push(match severity {
                Severity::Error => Diagnostic::error("gltf::more-problems", text),
                Severity::Warning => Diagnostic::warning("gltf::more-problems", text),
            });
        }
        list
    }
}

impl Report {
    /// An empty report for a file of this name.
    pub(super) fn new(file: impl Into<String>) -> Report {
        Report { file: file.into(), errors: RefCell::default(), warnings: RefCell::default() }
    }

    /// Adds an error. `place` is a JSON path, or empty where the file as a whole is wrong.
    pub(super) fn error(&self, code: &'static str, place: impl Display, problem: impl Display, hint: &str) {
        self.errors.borrow_mut().add(with_hint(Diagnostic::error(code, self.message(place, problem)), hint));
    }

    /// Adds a warning.
    pub(super) fn warning(&self, code: &'static str, place: impl Display, problem: impl Display, hint: &str) {
        self.warnings.borrow_mut().add(with_hint(Diagnostic::warning(code, self.message(place, problem)), hint));
    }

    /// Whether the file must be refused.
    pub(super) fn has_errors(&self) -> bool {
        !self.errors.borrow().list.is_empty()
    }

    /// The warnings if there is no error, else errors followed by warnings.
    pub(super) fn finish(self) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
        let failed = self.has_errors();
        let warnings = self.warnings.into_inner().finish(&self.file, Severity::Warning);
        if !failed {
            return Ok(warnings);
        }
        let mut all = self.errors.into_inner().finish(&self.file, Severity::Error);
        all.extend(warnings);
        Err(all)
    }

    fn message(&self, place: impl Display, problem: impl Display) -> String {
        let place = place.to_string();
        if place.is_empty() { format!("{}: {problem}", self.file) } else { format!("{}: {place}: {problem}", self.file) }
    }
}

fn with_hint(diagnostic: Diagnostic, hint: &str) -> Diagnostic {
    if hint.is_empty() { diagnostic } else { diagnostic.hint(hint) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn problems_are_capped_and_counted() {
        let report = Report::new("a.gltf");
        for index in 0..60 {
            report.error("gltf::test", format!("nodes[{index}]"), "wrong", "");
        }
        let Err(all) = report.finish() else { panic!("errors were added") };
        assert_eq!(all.len(), MOST + 1);
        assert_eq!(all[MOST].message, "a.gltf: and 10 more like these");
    }
}
