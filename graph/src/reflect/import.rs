//! `#import "shared/brdf.wgsl"`: a shader file with everything that it imports, as one text.
//!
//! Each file stands in the text once, imported text before what imports it, names unchanged. An import is a line of its own;
//! inside a comment it is a comment. `enable`, `requires` and `diagnostic` directives of all files move to the front, where
//! WGSL wants them. A file is refused by itself where a bracket or comment is left open, since in the joined text the error
//! would be found in another file. Accepted downside: all names of all files share one scope.

use std::collections::BTreeMap;
use std::ops::Range;

use super::error::ReflectError;
use super::limits;
use super::text::JoinedText;
use super::tokens::{Scanned, Token, TokenKind, scan, unbalanced};
use crate::diagnostic::nearest;
use crate::source::{FileId, FileKind, Files, SourceMap, Span};

/// Bytes that a shader with its imports may have.
const MAX_BYTES: usize = 16 << 20;

/// An import line.
struct Import {
    path: String,
    /// The path between its quotes.
    span: Span,
}

/// A file, read and scanned.
struct ShaderFile {
    id: FileId,
    text: String,
    imports: Vec<Import>,
    /// Global directives at its start.
    directives: Vec<Range<usize>>,
    /// What naga must not see where it stands: directives and import lines, in order.
    hidden: Vec<Range<usize>>,
}

/// Whether a file is being followed or done.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Open,
    Done,
}

/// Reads a shader and its imports. All problems of all files that can be reached are reported.
pub(super) fn load(path: &str, requested_at: Span, files: &dyn Files, sources: &mut SourceMap) -> Result<JoinedText, Vec<ReflectError>> {
    let mut loader = Loader { files, sources, errors: Vec::new(), bytes: 0, declarations: 0, states: BTreeMap::new(), ordered: Vec::new() };
    loader.follow(path, requested_at);
    if loader.errors.is_empty() { Ok(join(&loader.ordered)) } else { Err(loader.errors) }
}

struct Loader<'a> {
    files: &'a dyn Files,
    sources: &'a mut SourceMap,
    errors: Vec<ReflectError>,
    bytes: usize,
    declarations: usize,
    states: BTreeMap<String, State>,
    /// Done files in dependency order.
    ordered: Vec<ShaderFile>,
}

/// A file on the way from the root, and how many of its imports were followed.
struct Step {
    path: String,
    file: ShaderFile,
    followed: usize,
}

impl Loader<'_> {
    /// Follows imports depth first, with a stack of its own: a long chain of files must not exhaust the thread's.
    fn follow(&mut self, path: &str, requested_at: Span) {
        let mut stack: Vec<Step> = Vec::new();
        if let Some(file) = self.read(path, requested_at, stack.is_empty()) {
            stack.push(Step { path: path.to_owned(), file, followed: 0 });
        }
        while let Some(step) = stack.last_mut() {
            if let Some(import) = step.file.imports.get(step.followed) {
                step.followed += 1;
                let (path, span) = (import.path.clone(), import.span);
                match self.states.get(&path) {
                    Some(State::Done) => {}
                    Some(State::Open) => {
                        let first = stack.iter().position(|step| step.path == path).unwrap_or(0);
                        let mut cycle: Vec<String> = stack.iter().skip(first).map(|step| step.path.clone()).collect();
                        cycle.push(path);
                        self.errors.push(ReflectError::ImportCycle { cycle, span });
                    }
                    None => {
                        if let Some(file) = self.read(&path, span, false) {
                            stack.push(Step { path, file, followed: 0 });
                        }
                    }
                }
            } else if let Some(step) = stack.pop() {
                self.states.insert(step.path, State::Done);
                self.ordered.push(step.file);
            }
        }
    }

    /// Reads and scans one file; problems with it are recorded.
    fn read(&mut self, path: &str, asked_at: Span, is_root: bool) -> Option<ShaderFile> {
        if !is_plain(path) {
            self.errors.push(ReflectError::ImportPath { path: path.to_owned(), span: asked_at });
            return None;
        }
        let loaded = match self.files.read(FileKind::Shader, path) {
            Ok(loaded) => loaded,
            Err(cause) => {
                let known = self.files.known(FileKind::Shader);
                let nearest = nearest(path, known.iter().map(String::as_str)).map(str::to_owned);
                self.errors.push(ReflectError::FileUnreadable { path: path.to_owned(), span: asked_at, cause, nearest, is_root });
                return None;
            }
        };
        self.bytes = self.bytes.saturating_add(loaded.text.len());
        if self.bytes > MAX_BYTES {
            self.errors.push(ReflectError::TooLarge { path: path.to_owned(), span: asked_at, limit: MAX_BYTES });
            return None;
        }
        let id = source_id(self.sources, &loaded.name, &loaded.text);
        self.states.insert(path.to_owned(), State::Open);
        let scanned = scan(&loaded.text);
        self.check_closed(id, &scanned, &loaded.text);
        self.check_limits(id, &scanned.tokens, &loaded.text, asked_at);
        let directives = directives(&scanned.tokens, &loaded.text);
        let mut imports = Vec::new();
        let mut hidden = directives.clone();
        for token in scanned.tokens.iter().filter(|token| token.kind == TokenKind::HashLine) {
            hidden.push(token.range.clone());
            match import_path(token.text(&loaded.text)) {
                Some(range) => {
                    let range = token.range.start + range.start..token.range.start + range.end;
                    let path = loaded.text.get(range.clone()).unwrap_or("").to_owned();
                    imports.push(Import { path, span: Span::new(id, range.start, range.end) });
                }
                None => self.errors.push(ReflectError::ImportSyntax {
                    line: token.text(&loaded.text).to_owned(),
                    span: Span::new(id, token.range.start, token.range.end),
                }),
            }
        }
        hidden.sort_by_key(|range| range.start);
        Some(ShaderFile { id, text: loaded.text, imports, directives, hidden })
    }

    fn check_limits(&mut self, id: FileId, tokens: &[Token], text: &str, asked_at: Span) {
        if let Some((range, what)) = limits::excess(text, tokens) {
            self.errors.push(ReflectError::TooComplex { what, span: Span::new(id, range.start, range.end) });
        }
        let before = self.declarations;
        self.declarations += limits::declarations(text, tokens);
        if before <= limits::MAX_DECLARATIONS && self.declarations > limits::MAX_DECLARATIONS {
            let what = format!("a shader and its imports have more than {} declarations", limits::MAX_DECLARATIONS);
            self.errors.push(ReflectError::TooComplex { what, span: asked_at });
        }
    }

    fn check_closed(&mut self, id: FileId, scanned: &Scanned, text: &str) {
        if let Some(open) = &scanned.open_comment {
            self.errors.push(ReflectError::OpenComment { span: Span::new(id, open.start, open.end) });
        } else if let Some(token) = unbalanced(&scanned.tokens) {
            let bracket = token.text(text).to_owned();
            self.errors.push(ReflectError::Unbalanced { bracket, span: Span::new(id, token.range.start, token.range.end) });
        }
    }
}

/// Joins files: the directives of all, then the rest of all.
fn join(files: &[ShaderFile]) -> JoinedText {
    let mut joined = JoinedText::default();
    for file in files {
        for range in &file.directives {
            joined.push(file.id, &file.text, range.clone(), &[]);
        }
    }
    for file in files {
        joined.push(file.id, &file.text, 0..file.text.len(), &file.hidden);
    }
    joined
}

/// The id of a text: that of an equal one under the same name, so that many shaders with one import add it once.
fn source_id(sources: &mut SourceMap, name: &str, text: &str) -> FileId {
    let known = sources.iter().find(|(_, file)| *file.name == *name && *file.text == *text).map(|(id, _)| id);
    known.unwrap_or_else(|| sources.add(name, text))
}

/// Whether a path has one spelling only: no `.`, `..`, empty part, backslash or root, so that equal files have equal paths.
fn is_plain(path: &str) -> bool {
    !path.contains(['\\', ':']) && path.split('/').all(|part| !matches!(part, "" | "." | ".."))
}

/// The directives at the start of a file, each with its semicolon.
fn directives(tokens: &[Token], text: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut tokens = tokens.iter().filter(|token| token.kind != TokenKind::HashLine);
    while let Some(first) = tokens.next() {
        if !matches!(first.text(text), "enable" | "requires" | "diagnostic") {
            break;
        }
        let Some(last) = tokens.by_ref().find(|token| token.is(';')) else { break };
        found.push(first.range.start..last.range.end);
    }
    found
}

/// The range of the path in `#import "path"`; a `//` comment may follow.
fn import_path(line: &str) -> Option<Range<usize>> {
    let rest = line.strip_prefix("#import")?;
    let quoted = rest.trim_start();
    let start = line.len() - quoted.len() + 1;
    let length = quoted.strip_prefix('"')?.find('"')?;
    let after = line.get(start + length + 1..)?.trim();
    (quoted.len() < rest.len() && (after.is_empty() || after.starts_with("//"))).then_some(start..start + length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::MemoryFiles;

    fn files(files: &[(&str, &str)]) -> MemoryFiles {
        files.iter().fold(MemoryFiles::default(), |all, (path, text)| all.with(FileKind::Shader, path, text))
    }

    fn joined(list: &[(&str, &str)]) -> String {
        let mut sources = SourceMap::default();
        load("main", Span::NOWHERE, &files(list), &mut sources).unwrap().as_str().split_whitespace().collect::<Vec<_>>().join(" ")
    }

    fn problems(list: &[(&str, &str)]) -> Vec<String> {
        let mut sources = SourceMap::default();
        let errors = load("main", Span::NOWHERE, &files(list), &mut sources).unwrap_err();
        errors
            .into_iter()
            .map(|error| {
                let diagnostic = crate::diagnostic::Diagnostic::from(error);
                let place = diagnostic.primary.as_ref().and_then(|label| sources.line_column(label.span));
                let (line, column) = place.unwrap_or((0, 0));
                format!("{line}:{column} {} {}", diagnostic.code, diagnostic.message)
            })
            .collect()
    }

    #[test]
    fn imports_once_and_in_dependency_order() {
        // A diamond, and a file that imports one thing twice.
        let diamond = [
            ("main", "#import \"a\"\n#import \"b\"\n#import \"a\"\nM"),
            ("a", "#import \"base\"\nA"),
            ("b", "#import \"base\" // twice\nB"),
            ("base", "X // no newline at the end"),
        ];
        assert_eq!(joined(&diamond), "X // no newline at the end A // twice B M".replace("// twice ", ""));
    }

    #[test]
    fn comments_hold_no_imports_and_directives_move_to_the_front() {
        assert_eq!(joined(&[("main", "// #import \"nowhere\"\n/*\n#import \"nowhere\"\n*/\nM")]).split(' ').next_back(), Some("M"));
        let text = joined(&[("main", "enable f16;\n#import \"a\"\ndiagnostic(off, x);\nM"), ("a", "/*x*/ enable g;\nA enable;")]);
        assert_eq!(text, "enable g; enable f16; diagnostic(off, x); /*x*/ A enable; M");
    }

    #[test]
    fn cycles_are_named_in_full() {
        let list = [("main", "#import \"a\""), ("a", "\n#import \"b\""), ("b", "#import \"c\"\n#import \"b\""), ("c", " #import \"a\"")];
        assert_eq!(
            problems(&list),
            [
                "1:11 reflect::import-cycle imports go in a circle: `a` -> `b` -> `c` -> `a`",
                "2:10 reflect::import-cycle imports go in a circle: `b` -> `b`",
            ]
        );
    }

    #[test]
    fn all_problems_are_reported() {
        let list = [
            ("main", "#import \"shared/brfd.wgsl\"\n#import <x>\n#define A\n#import \"../x\"\n#import \"open\"\n#import \"brace\""),
            ("shared/brdf.wgsl", ""),
            ("open", "fn a() {} /* x"),
            ("brace", "fn a() { b(); "),
        ];
        assert_eq!(
            problems(&list),
            [
                "2:1 reflect::import-syntax `#import <x>` is not an import",
                "3:1 reflect::import-syntax `#define A` is not an import",
                "1:10 reflect::missing-import can't read the imported shader file `shared/brfd.wgsl`: no such file (searched: memory)",
                "4:10 reflect::import-path the path `../x` is not plain",
                "1:11 reflect::open-comment a comment is never closed",
                "1:8 reflect::unbalanced-bracket `{` has no partner in its file",
            ]
        );
        assert_eq!(problems(&[]).len(), 1);
    }

    #[test]
    fn equal_texts_are_added_to_the_sources_once() {
        let mut sources = SourceMap::default();
        let files = files(&[("main", "#import \"a\""), ("a", "A"), ("other", "#import \"a\"")]);
        load("main", Span::NOWHERE, &files, &mut sources).unwrap();
        load("other", Span::NOWHERE, &files, &mut sources).unwrap();
        assert_eq!(sources.iter().count(), 3);
    }
}
