//! Problems with a place, and the one renderer that prints them.
//!
//! Each step has its own error enum, which turns itself into a [`Diagnostic`]: a code, a message, a primary place, further
//! labelled places, notes and a hint. Steps collect all their problems; nothing prints before the end.

use codespan_reporting::diagnostic as report;
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term;

use crate::source::{SourceMap, Span};

/// How bad it is. An error leaves no result; a warning does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Nothing can be compiled or loaded.
    Error,
    /// The result stands, and is probably not what was meant.
    Warning,
}

/// A place with a short text beside it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is there.
    pub text: String,
}

/// One problem, ready to be rendered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// `step::what`, for example `validate::unknown-resource`. Stable: tests and tools match on it.
    pub code: &'static str,
    /// Error or warning.
    pub severity: Severity,
    /// One sentence that names what is wrong, and in which pass or resource.
    pub message: String,
    /// The place to look at first.
    pub primary: Option<Label>,
    /// Other places that take part, such as the first of two definitions.
    pub secondary: Vec<Label>,
    /// Causes and facts, one sentence each.
    pub notes: Vec<String>,
    /// What to do about it.
    pub hint: Option<String>,
}

impl Diagnostic {
    /// An error with nothing but its message.
    pub fn error(code: &'static str, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            code,
            severity: Severity::Error,
            message: message.into(),
            primary: None,
            secondary: Vec::new(),
            notes: Vec::new(),
            hint: None,
        }
    }

    /// A warning with nothing but its message.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, message) }
    }

    /// Sets the primary place.
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.primary = Some(Label { span, text: text.into() });
        self
    }

    /// Adds a further place.
    pub fn and(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.secondary.push(Label { span, text: text.into() });
        self
    }

    /// Adds a note.
    pub fn note(mut self, text: impl Into<String>) -> Diagnostic {
        self.notes.push(text.into());
        self
    }

    /// Sets the hint.
    pub fn hint(mut self, text: impl Into<String>) -> Diagnostic {
        self.hint = Some(text.into());
        self
    }

    /// Sets the hint, where there is one.
    pub fn maybe_hint(mut self, text: Option<String>) -> Diagnostic {
        self.hint = text;
        self
    }

    /// Whether it is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// Whether any of the problems is an error.
pub fn has_errors(diagnostics: &[Diagnostic]) -> bool {
    diagnostics.iter().any(Diagnostic::is_error)
}

/// The known name that a misspelt one probably meant, as a hint.
pub fn did_you_mean<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    nearest(wrong, known).map(|name| format!("did you mean `{name}`?"))
}

/// Longer names are no slips of a person, and comparing them takes the product of their lengths.
const LONGEST_SLIP: usize = 200;

/// The nearest known name, if it is near enough to be a slip.
pub fn nearest<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = wrong.chars().take(LONGEST_SLIP + 1).count();
    let limit = (length / 3).max(2);
    let may_be_near = |name: &&str| length <= LONGEST_SLIP && name.chars().take(length + limit + 1).count().abs_diff(length) <= limit;
    known
        .into_iter()
        .filter(may_be_near)
        .map(|name| {
            let distance = if name.eq_ignore_ascii_case(wrong) { 0 } else { strsim::osa_distance(wrong, name) };
            (distance, name)
        })
        .filter(|(distance, _)| *distance <= limit)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

/// A comma-separated list of names in backquotes, cut after twelve; long ones are cut, too.
pub fn list_names<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let clip = |name: &str| match name.char_indices().nth(LONGEST_SLIP) {
        Some((end, _)) => format!("`{}...`", name.get(..end).unwrap_or_default()),
        None => format!("`{name}`"),
    };
    let shown: Vec<String> = names.by_ref().take(12).map(clip).collect();
    match (shown.len(), names.count()) {
        (0, _) => "none".to_owned(),
        (_, 0) => shown.join(", "),
        (_, more) => format!("{}, and {more} more", shown.join(", ")),
    }
}

/// Problems beyond this are counted and not shown: the first ones are what people mend.
const MAX_SHOWN: usize = 100;
/// Lines longer than this many bytes are not quoted.
const MAX_QUOTED_LINE: usize = 2000;
/// Messages are cut to this many characters: they may quote what the author wrote.
const MAX_MESSAGE: usize = 1000;

/// Renders problems as text, in the order given, with the lines that they point at. `color` adds ANSI escapes. What would fill
/// the screen with one line, or with thousands of problems, is cut.
pub fn render(diagnostics: &[Diagnostic], sources: &SourceMap, color: bool) -> String {
    let mut files = SimpleFiles::new();
    for (_, file) in sources.iter() {
        files.add(file.name.to_string(), file.text.to_string());
    }
    let index_of = |span: Span| {
        let found = sources.iter().position(|(id, _)| id == span.file)?;
        let length = sources.get(span.file)?.text.len();
        Some((found, (span.start as usize).min(length)..(span.end as usize).min(length)))
    };
    let config = term::Config { tab_width: 4, ..term::Config::default() };
    let mut out = String::new();
    for diagnostic in diagnostics.iter().take(MAX_SHOWN) {
        let message = clipped(&diagnostic.message);
        let mut notes = Vec::new();
        let mut labels = Vec::new();
        let spans = diagnostic.primary.iter().chain(&diagnostic.secondary);
        let quoted = spans.clone().all(|label| line_length(sources, label.span) <= MAX_QUOTED_LINE);
        if !quoted {
            notes.extend(spans.filter_map(|label| {
                let (line, column) = sources.line_column(label.span)?;
                Some(format!("{}:{line}:{column}: {}", sources.get(label.span.file)?.name, label.text))
            }));
        }
        if let Some(label) = diagnostic.primary.as_ref().filter(|_| quoted)
            && let Some((file, range)) = index_of(label.span)
        {
            labels.push(report::Label::primary(file, range).with_message(&label.text));
        }
        for label in diagnostic.secondary.iter().filter(|_| quoted) {
            if let Some((file, range)) = index_of(label.span) {
                labels.push(report::Label::secondary(file, range).with_message(&label.text));
            }
        }
        notes.extend(diagnostic.notes.iter().cloned());
        notes.extend(diagnostic.hint.iter().map(|hint| format!("hint: {hint}")));
        let severity = match diagnostic.severity {
            Severity::Error => report::Severity::Error,
            Severity::Warning => report::Severity::Warning,
        };
        let shown =
            report::Diagnostic::new(severity).with_code(diagnostic.code).with_message(&message).with_labels(labels).with_notes(notes);
        let rendered = if color {
            let mut buffer = term::termcolor::Ansi::new(Vec::new());
            term::emit_to_write_style(&mut buffer, &config, &files, &shown)
                .map(|()| String::from_utf8_lossy(&buffer.into_inner()).into_owned())
        } else {
            term::emit_into_string(&config, &files, &shown)
        };
        match rendered {
            Ok(text) => out.push_str(&text),
            // Only a label outside of its file gets here; the message alone still says what is wrong.
            Err(_) => {
                let severity = if diagnostic.is_error() { "error" } else { "warning" };
                out.push_str(&format!("{severity}[{}]: {message}\n", diagnostic.code));
            }
        }
    }
    if diagnostics.len() > MAX_SHOWN {
        out.push_str(&format!("... and {} more\n", diagnostics.len() - MAX_SHOWN));
    }
    out
}

fn clipped(text: &str) -> String {
    match text.char_indices().nth(MAX_MESSAGE) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}...", &text[..end]),
    }
}

/// Bytes of the line in which a span starts.
fn line_length(sources: &SourceMap, span: Span) -> usize {
    let Some((before, after)) = sources.get(span.file).and_then(|file| file.text.split_at_checked(span.start as usize)) else { return 0 };
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    before.len() - start + after.find('\n').unwrap_or(after.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_and_many_problems_are_cut() {
        let mut sources = SourceMap::default();
        let file = sources.add("long.ron", format!("a\n{}", "x".repeat(1_000_000)));
        let problem = Diagnostic::error("a::b", "y".repeat(100_000)).at(Span::new(file, 12, 13), "here").hint("shorten it");
        let text = render(&vec![problem; 5000], &sources, false);
        assert!(text.len() < 200_000, "{} bytes", text.len());
        assert!(text.contains("long.ron:2:11: here") && text.contains("hint: shorten it") && text.ends_with("... and 4900 more\n"));
    }
}
