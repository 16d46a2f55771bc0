//! Texts that are too deep, too large or full of problems cost bounded time and memory, and never the process.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::fmt::Write;
use std::time::Instant;

use indexmap::IndexMap;
use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::source::{FileId, SourceMap};
use luminaire_graph::syntax::error::{MAX_BYTES, MAX_PROBLEMS};
use luminaire_graph::syntax::spanned::Spanned;
use luminaire_graph::syntax::tree::MAX_DEPTH;
use luminaire_graph::syntax::{deserialize_document, parse, read_document};
use serde::Deserialize;

fn file() -> FileId {
    SourceMap::default().add("test.ron", "")
}

fn codes(problems: &[Diagnostic]) -> Vec<&'static str> {
    problems.iter().map(|problem| problem.code).collect()
}

#[test]
fn deep_nesting_is_one_error() {
    for (open, close) in [("[", "]"), ("(", ")"), ("{1:", "}"), ("Foo(", ")"), ("Some(", ")"), ("(a:", ")"), ("[1,{2:(a:", ")}]")] {
        for depth in [MAX_DEPTH + 1, 100_000] {
            let text = format!("{}1{}", open.repeat(depth), close.repeat(depth));
            assert_eq!(codes(&parse(&text, file()).unwrap_err()), ["syntax::too-deep"], "{open}");
        }
        let unclosed = open.repeat(100_000);
        let problems = parse(&unclosed, file()).unwrap_err();
        assert_eq!(codes(&problems), ["syntax::too-deep", "syntax::unclosed-bracket"], "{open}");
        let stray = format!("1{}", close.repeat(100_000));
        assert_eq!(codes(&parse(&stray, file()).unwrap_err()), ["syntax::stray-bracket"]);
    }
    let deepest = format!("{}{}", "[".repeat(MAX_DEPTH), "]".repeat(MAX_DEPTH));
    drop(parse(&deepest, file()).unwrap());
    // What comes behind is still read.
    let text = format!("(a: {}{}, b: @, c: 1)", "[".repeat(1000), "]".repeat(1000));
    assert_eq!(codes(&parse(&text, file()).unwrap_err()), ["syntax::too-deep", "syntax::unexpected-character"]);
}

#[derive(Debug, Deserialize)]
#[allow(dead_code)]
enum Tree {
    Leaf,
    Boxed(Box<Tree>),
    Optional(Option<Box<Tree>>),
    Struct { inner: Option<Box<Spanned<Tree>>> },
}

#[derive(Debug, Deserialize)]
#[allow(dead_code)]
struct Endless(Option<Box<Endless>>);

#[test]
fn deep_values_are_read_on_a_small_stack() {
    let thread = std::thread::Builder::new().stack_size(1 << 20).spawn(|| {
        for (open, close) in [("Boxed(", ")"), ("Optional(", ")"), ("Struct(inner:", ")")] {
            let text = format!("{}Leaf{}", open.repeat(MAX_DEPTH), close.repeat(MAX_DEPTH));
            read_document::<Tree>(&text, file()).unwrap();
        }
        // A type that asks for the same value for ever.
        assert!(read_document::<Endless>("5", file()).is_err());
    });
    thread.unwrap().join().unwrap();
}

#[test]
fn large_files_are_refused() {
    let text = " ".repeat(MAX_BYTES + 1);
    assert_eq!(codes(&parse(&text, file()).unwrap_err()), ["syntax::file-too-large"]);
}

#[test]
fn problems_are_counted() {
    for text in
        [",".repeat(1 << 20), "@".repeat(1 << 20), "[,".repeat(100), "'ab ".repeat(1 << 18), format!("[{}]", "'ab' @,".repeat(100_000))]
    {
        let start = Instant::now();
        let count = parse(&text, file()).unwrap_err().len();
        assert!((1..=MAX_PROBLEMS + 1).contains(&count));
        assert!(start.elapsed().as_secs() < 5);
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
struct Document {
    doc: String,
    #[serde(default)]
    first: u8,
    #[serde(default)]
    second: u8,
    passes: IndexMap<Spanned<String>, Pass>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
enum Pass {
    Draw { shader: Spanned<String>, read: IndexMap<String, Spanned<String>>, write: IndexMap<String, Spanned<String>>, count: u32 },
}

fn document(passes: usize, count: &str) -> String {
    let mut text = String::from("(\n    doc: \"A text of many passes.\",\n    passes: {\n");
    for pass in 0..passes {
        writeln!(
            text,
            "        \"pass {pass}\": Draw(\n            shader: \"folder/shader_{pass}.wgsl\", // what it runs\n            \
             read: {{\"source\": \"image.mip({pass})\", \"other\": \"other.layer({pass})\"}},\n            \
             write: {{\"target\": \"result.mip({pass})\"}},\n            count: {count},\n        ),"
        )
        .unwrap();
    }
    text.push_str("    },\n)\n");
    text
}

#[test]
fn time_is_linear() {
    for passes in [100, 1000, 10_000] {
        let text = document(passes, "5");
        let start = Instant::now();
        let node = parse(&text, file()).unwrap();
        let parsed = start.elapsed();
        let read: Document = deserialize_document(&node).unwrap();
        let took = start.elapsed();
        assert_eq!(read.passes.len(), passes);
        println!("{passes} passes, {} bytes: {parsed:?} to the tree, {took:?} in all", text.len());
        // Far above what it takes, and far below what a quadratic step would.
        assert!(took.as_millis() < 2000);
    }
}

#[test]
fn time_with_faults_is_linear() {
    let mut text = document(10_000, "-5");
    text = text.replacen("doc:", "first: 1000, second: -1, doc:", 1);
    let start = Instant::now();
    let problems = read_document::<Document>(&text, file()).unwrap_err();
    println!("{} problems: {:?}", problems.len(), start.elapsed());
    assert_eq!(problems.len(), MAX_PROBLEMS);
    assert!(start.elapsed().as_millis() < 5000);
    // In the order of the text, those of the document itself included.
    assert!(problems[0].message.starts_with("1000 is out of range") && problems[1].message.starts_with("-1 is out of range"));
}
