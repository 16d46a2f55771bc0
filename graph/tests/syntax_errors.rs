//! What the messages of the reader say, and that each slip costs one.
//!
//! The fixtures in `syntax/` hold texts and, behind each, what is reported. `LUMINAIRE_ACCEPT=1` writes what is reported into them.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeMap;

use indexmap::IndexMap;
use luminaire_graph::diagnostic::render;
use luminaire_graph::source::SourceMap;
use luminaire_graph::syntax::spanned::Spanned;
use luminaire_graph::syntax::{from_tree, parse, read_document};
use serde::Deserialize;
use serde::de::{DeserializeOwned, IgnoredAny};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
struct Document {
    doc: String,
    #[serde(default)]
    count: u8,
    #[serde(default)]
    scale: f32,
    #[serde(default)]
    size: Option<(u32, u32)>,
    #[serde(default)]
    passes: IndexMap<Spanned<String>, Pass>,
    #[serde(default)]
    outputs: BTreeMap<String, Spanned<String>>,
    #[serde(default)]
    names: Vec<String>,
    #[serde(default)]
    depth: Option<Depth>,
    #[serde(default)]
    rate: Rate,
    #[serde(default)]
    extent: Option<Extent>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
enum Pass {
    Draw {
        shader: Spanned<String>,
        #[serde(default)]
        read: IndexMap<String, String>,
        #[serde(default)]
        depth: Option<Depth>,
        #[serde(default)]
        blend: Blend,
    },
    Repeat {
        passes: IndexMap<String, Pass>,
    },
    Copy(String, String),
    Clear(String),
}

#[derive(Debug, Default, Deserialize)]
enum Blend {
    #[default]
    Off,
    Add,
    Multiply,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)]
struct Depth {
    test: bool,
    write: bool,
}

#[derive(Debug, Default, Deserialize)]
#[serde(try_from = "f64")]
struct Rate;

impl TryFrom<f64> for Rate {
    type Error = String;

    fn try_from(value: f64) -> Result<Rate, String> {
        if value > 0.0 { Ok(Rate) } else { Err(format!("a rate is positive, and {value} is not")) }
    }
}

#[derive(Debug, Deserialize)]
#[serde(untagged)]
#[allow(dead_code)]
enum Extent {
    Texels(u32),
    Expression(String),
}

/// What is reported about a text that is read as a type; `IgnoredAny` takes every value.
fn reported<T: DeserializeOwned>(text: &str) -> String {
    let mut sources = SourceMap::default();
    let file = sources.add("test.ron", text);
    match read_document::<T>(text, file) {
        Ok(_) => "accepted\n".to_owned(),
        Err(problems) => render(&problems, &sources, false),
    }
}

/// Checks a fixture: texts and reports, with `----` between a text and its report and `====` between two cases.
fn check<T: DeserializeOwned>(name: &str) {
    let path = format!("{}/tests/syntax/{name}.txt", env!("CARGO_MANIFEST_DIR"));
    let fixture = std::fs::read_to_string(&path).unwrap();
    let mut found = String::new();
    for case in fixture.split("====\n") {
        let text = case.split_once("----\n").map_or(case, |(text, _)| text);
        // Lines without trailing white space, so that editors leave the fixture alone.
        let report: String = reported::<T>(text).trim_end().lines().map(|line| line.trim_end().to_owned() + "\n").collect();
        if !found.is_empty() {
            found.push_str("====\n");
        }
        found.push_str(&format!("{text}----\n{report}"));
    }
    if std::env::var_os("LUMINAIRE_ACCEPT").is_some() {
        std::fs::write(path, found).unwrap();
    } else {
        assert_eq!(found, fixture, "{name}: with LUMINAIRE_ACCEPT=1 the fixture takes over what is reported");
    }
}

#[test]
fn brackets_and_commas() {
    check::<IgnoredAny>("brackets");
}

#[test]
fn literals() {
    check::<IgnoredAny>("literals");
}

#[test]
fn duplicates_and_attributes() {
    check::<IgnoredAny>("duplicates");
}

#[test]
fn documents() {
    check::<Document>("documents");
}

#[test]
fn a_value_alone_stops_at_its_first_fault() {
    let mut sources = SourceMap::default();
    let text = r#"(doc: 5, count: 300)"#;
    let node = parse(text, sources.add("test.ron", text)).unwrap();
    let problem = from_tree::<Document>(&node).unwrap_err();
    assert_eq!(problem.message, "expected a string, found the integer 5");
}

#[test]
fn places_reach_the_document() {
    let mut sources = SourceMap::default();
    let text = r#"(doc: "d", passes: {"a": Draw(shader: "x.wgsl")}, outputs: {"color": "a.color"})"#;
    let document: Document = read_document(text, sources.add("test.ron", text)).unwrap();
    let (name, pass) = document.passes.get_index(0).unwrap();
    assert_eq!(sources.text(name.span), "\"a\"");
    let Pass::Draw { shader, .. } = pass else { panic!() };
    assert_eq!(sources.text(shader.span), "\"x.wgsl\"");
    assert_eq!(sources.text(document.outputs["color"].span), "\"a.color\"");
    assert!(document.passes.contains_key("a"));

    type Twice = Spanned<Spanned<(u8, u8)>>;
    #[derive(Deserialize)]
    struct All {
        a: Spanned<Option<Spanned<u8>>>,
        b: Spanned<Vec<Twice>>,
        c: Spanned<Blend>,
        d: Spanned<IndexMap<Spanned<u8>, ()>>,
    }
    let text = "(a: Some(5), b: [(1, 2)], c: Add, d: { 7: () })";
    let all: All = read_document(text, sources.add("all.ron", text)).unwrap();
    assert_eq!(sources.text(all.a.span), "Some(5)");
    assert_eq!(sources.text(all.a.value.unwrap().span), "5");
    assert_eq!(sources.text(all.b.span), "[(1, 2)]");
    assert_eq!(sources.text(all.b[0].span), "(1, 2)");
    assert_eq!(sources.text(all.b[0].value.span), "(1, 2)");
    assert_eq!(sources.text(all.c.span), "Add");
    assert_eq!(sources.text(all.d.span), "{ 7: () }");
    assert_eq!(sources.text(all.d.get_index(0).unwrap().0.span), "7");
}
