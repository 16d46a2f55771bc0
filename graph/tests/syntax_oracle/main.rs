//! The `ron` crate as the oracle of the reader: what both accept has the same value, and neither accepts more, but for the
//! listed differences.

#![allow(clippy::unwrap_used, clippy::panic)]

mod any;
mod random;

use std::fmt;

use indexmap::IndexMap;
use luminaire_graph::diagnostic::{Diagnostic, render};
use luminaire_graph::source::SourceMap;
use luminaire_graph::syntax::read_document;
use luminaire_graph::syntax::spanned::Spanned;
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use any::Any;

fn options() -> ron::Options {
    ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES).without_recursion_limit()
}

fn ours<T: DeserializeOwned>(text: &str) -> Result<T, (Vec<Diagnostic>, String)> {
    let mut sources = SourceMap::default();
    let file = sources.add("test.ron", text);
    read_document(text, file).map_err(|problems| {
        let shown = render(&problems, &sources, false);
        (problems, shown)
    })
}

/// Where we are stricter on purpose.
fn is_stricter_on_purpose(problems: &[Diagnostic], text: &str) -> bool {
    problems.iter().any(|problem| {
        matches!(
            problem.code,
            "syntax::duplicate-key"
                | "syntax::duplicate-field"
                | "syntax::number-out-of-range"
                | "syntax::unknown-extension"
                | "syntax::too-deep"
        )
    }) || text.contains("Some")
}

/// Both readers agree about a text as a type.
fn compare<T: DeserializeOwned + PartialEq + fmt::Debug>(text: &str) {
    match (ours::<T>(text), options().from_str::<T>(text)) {
        (Ok(ours), Ok(theirs)) => assert_eq!(ours, theirs, "{text}"),
        (Err(_), Err(_)) => {}
        (Ok(ours), Err(theirs)) => panic!("only we accept {text:?}\nas {ours:?}\nron: {theirs}"),
        (Err((problems, shown)), Ok(theirs)) => {
            assert!(is_stricter_on_purpose(&problems, text), "only ron accepts {text:?}\nas {theirs:?}\n{shown}");
        }
    }
}

fn accepted_by_both<T: DeserializeOwned + PartialEq + fmt::Debug>(text: &str) {
    if let Err((_, shown)) = ours::<T>(text) {
        panic!("{shown}");
    }
    compare::<T>(text);
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    doc: String,
    #[serde(default)]
    count: Option<u32>,
    #[serde(default)]
    ratio: Option<f32>,
    #[serde(default)]
    entries: IndexMap<Spanned<String>, Spanned<Entry>>,
    #[serde(default)]
    list: Vec<Spanned<Entry>>,
    #[serde(default)]
    pair: (i16, Spanned<f64>),
    #[serde(default)]
    wrapped: Meters,
    #[serde(default)]
    nested: Option<Option<bool>>,
    #[serde(default)]
    sign: char,
    #[serde(default)]
    unit: (),
}

#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct Meters(f64);

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Two(u8, String);

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
enum Entry {
    Empty,
    Scalar(Spanned<i64>),
    Pair(u8, Option<String>),
    Fields {
        a: Spanned<u64>,
        #[serde(default)]
        b: Vec<Entry>,
    },
    Struct(Two),
    Value(Loose),
    Text(Option<String>),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
enum Loose {
    Flag(bool),
    Integer(i64),
    Float(f64),
    // Before the text: serde finds a bare word in both.
    Kind(Kind),
    Text(String),
    List(Vec<Loose>),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum Kind {
    Plain,
    Of(u8),
    Both(u8, u8),
    Named { x: u8 },
}

#[test]
fn values_of_any_type() {
    for text in [
        "()",
        "( )",
        "(/**/)",
        "true",
        "false",
        "0",
        "-0",
        "+7",
        "0xFF",
        "0o17",
        "0b1_0",
        "1_000",
        "255u8",
        "-128i8",
        "0x7fi8",
        "b'a'",
        r"b'\n'",
        r"b'\xff'",
        r"b'\''",
        "18446744073709551615",
        "-9223372036854775808",
        "18446744073709551616",
        "-9223372036854775809",
        "1.5",
        ".5",
        "5.",
        "1e3",
        "1E-3",
        "1e+3",
        "1e_-3",
        "1_e_+_3",
        "1_0.5_0",
        "-1.5e-3_0",
        "1f32",
        "0.1f32",
        "0.1f64",
        "1e5f32",
        "1_f32",
        "007",
        "1e2",
        "inf",
        "-inf",
        "+inf",
        "NaN",
        "-NaN",
        "inff32",
        "NaNf64",
        "-inff64",
        "'a'",
        "'''",
        r"'\''",
        r"'\u{1F600}'",
        r"'\x41'",
        "'é'",
        r#""""#,
        r#""a\n\t\\\"\'\0\u{e9}\x41""#,
        r#""\xe2\x82\xac""#,
        "\"a\\\n   b\"",
        "\"a\\\r\n b\"",
        "\"two\nlines\"",
        r##"r"raw\n""##,
        r###"r#"a "quoted" b"#"###,
        r###"r##"a"# b"##"###,
        r#"b"bytes\xff\u{e9}""#,
        r##"br"raw""##,
        r###"br#"a"b"#"###,
        "[]",
        "[1,2,]",
        "[1 , 2]",
        "{}",
        "{1:2,}",
        r#"{"a": 1, 'b': 2, Foo: 3, (1, 2): 4, [1]: 5}"#,
        "(1,)",
        "(1, 2)",
        "((1))",
        "(a: 1)",
        "(a: 1,)",
        "Foo",
        "Foo()",
        "Foo( )",
        "Foo(1)",
        "Foo (1, 2)",
        "Foo(a: 1, b: Bar(c: [2]))",
        "None",
        "Some(1)",
        "Some(Some(None))",
        "Some((a: 1))",
        "r#foo-bar.baz",
        "r#None",
        "r#true",
        "(r#a-b: 1)",
        "(true: 1, inf: 2, None: 3)",
        "..",
        "1..",
        "1..2",
        "1..=2",
        "..2",
        "..=2",
        "1.5..2.5",
        "-5..-2",
        "inf..",
        "..inf",
        "b'a'..=b'z'",
        "...5",
        "1...5",
        "[1..2, ..]",
        "\u{2028}1\u{85}",
        "// a\n1 // b",
        "/* a /* b */ c */ 1",
        "#![enable(implicit_some)]\n#![enable(unwrap_newtypes, implicit_some,)] 1",
        "# ! [ enable ( implicit_some ) ] 1",
        "#![type = \"a::B\"]\n#![schema = \"x\"]\n(a: 1)",
        "_a",
        "été",
        "b",
        "r",
        "br",
        "bar",
    ] {
        accepted_by_both::<Any>(text);
    }
}

#[test]
fn texts_that_both_refuse() {
    for text in [
        "",
        " ",
        ",",
        "[,]",
        "[1,,2]",
        "[1 2]",
        "(a: 1, 2)",
        "(1, a: 2)",
        "{1}",
        "{1:}",
        "{1:2 3:4}",
        "1 2",
        "[1",
        "1]",
        "(",
        "\"",
        "'",
        "''",
        "'ab'",
        "+",
        "-",
        ".",
        "_1.",
        "0x",
        "0b2",
        "0o8",
        "0x_1",
        "1__.5_.",
        "1._5",
        "256u8",
        "-1u8",
        "128i8",
        "5i128",
        "1.5i32",
        "0x1f64x",
        "1.5.2",
        "1e",
        "é-",
        r#""\q""#,
        r#""\xe9""#,
        r#""\x4""#,
        r#""\u{}""#,
        r#""\u{d800}""#,
        r#""\u{1234567}""#,
        r"'\xe9'",
        r"b'\u{41}'",
        "b'é'",
        "r#",
        "r##",
        "/* a",
        "/",
        "# 1",
        "#![enable()] 1",
        "#![enable(nothing)] 1",
        "#![type = 1] 1",
        "..=",
        "1 ..2 ..",
        "1..=",
        "foo-bar",
        "(a-b: 1)",
        "@",
        ";",
        "Foo{a: 1}",
        "\u{feff}1",
        "(a = 1)",
        "(\"a\": 1)",
        "[1}",
        "0x10000000000000000",
        "1.5.",
        "....5",
    ] {
        assert!(ours::<Any>(text).is_err(), "{text}");
        compare::<Any>(text);
    }
}

#[test]
fn differences_are_as_listed() {
    let codes = |text: &str| ours::<Any>(text).map_err(|(problems, _)| problems.iter().map(|problem| problem.code).collect::<Vec<_>>());
    for (text, code) in [
        ("{1: 2, 1: 3}", "syntax::duplicate-key"),
        ("{\"a\": 2, r\"a\": 3}", "syntax::duplicate-key"),
        ("1e400", "syntax::number-out-of-range"),
        ("#![enable(unwrap_variant_newtypes)] 1", "syntax::unknown-extension"),
        ("#![enable(explicit_struct_names)] 1", "syntax::unknown-extension"),
    ] {
        assert!(options().from_str::<Any>(text).is_ok(), "{text}");
        assert_eq!(codes(text), Err(vec![code]), "{text}");
    }
    // Both refuse this one, here with both places.
    assert_eq!(codes("(a: 1, a: 2)"), Err(vec!["syntax::duplicate-field"]));
}

#[test]
fn documents() {
    for text in [
        r#"(doc: "a")"#,
        r#"Document(doc: "a", count: 5, ratio: 1, nested: Some(true), sign: '-', unit: ())"#,
        r#"(doc: "a", count: Some(5), ratio: Some(16777217), nested: None)"#,
        r#"(doc: "a", ratio: 0.1, wrapped: 3, pair: (-1, 2))"#,
        r#"(doc: "a", entries: {"x": Empty, "y": Scalar(-5), "z": Pair(1, "b"), "w": Pair(1, None,), "v": Fields(a: 7, b: [Empty, Scalar(1)])})"#,
        r#"(doc: "a", list: [Struct((1, "b")), Struct(Two(1, "b")), Text("a"), Text(Some("a")), Text(None), Fields(a: 1)])"#,
        r#"(doc: "a", list: [Value(true), Value(5), Value(-5), Value(0.5), Value("t"), Value([1, "a", [2.5]])])"#,
        r#"(doc: "a", list: [Value(Plain), Value(Of(1)), Value(Both(1, 2)), Value(Named(x: 1))])"#,
    ] {
        accepted_by_both::<Document>(text);
    }
}

#[test]
fn wrong_documents() {
    for text in [
        "()",
        r#"(doc: 1)"#,
        r#"(doc: "a", more: 1)"#,
        r#"(doc: "a", count: -1)"#,
        r#"(doc: "a", count: 4294967296)"#,
        r#"(doc: "a", count: 1.0)"#,
        r#"(doc: "a", count: 1u8)"#,
        r#"(doc: "a", ratio: 0x10)"#,
        r#"(doc: "a", ratio: 1u8)"#,
        r#"(doc: "a", ratio: 1f64)"#,
        r#"(doc: "a", entries: [])"#,
        r#"(doc: "a", entries: (a: 1))"#,
        r#"(doc: "a", entries: {a: Empty})"#,
        r#"(doc: "a", list: ())"#,
        r#"(doc: "a", list: [Empty()])"#,
        r#"(doc: "a", list: [Scalar])"#,
        r#"(doc: "a", list: [Scalar()])"#,
        r#"(doc: "a", list: [Scalar(1, 2)])"#,
        r#"(doc: "a", list: [Pair(1)])"#,
        r#"(doc: "a", list: [Pair(1, None, 2)])"#,
        r#"(doc: "a", list: [Fields()])"#,
        r#"(doc: "a", list: [Fields(1)])"#,
        r#"(doc: "a", list: [Fields(a: 1, c: 2)])"#,
        r#"(doc: "a", list: [Nothing])"#,
        r#"(doc: "a", list: ["Empty"])"#,
        r#"(doc: "a", pair: [1, 2])"#,
        r#"(doc: "a", pair: Foo(1, 2))"#,
        r#"(doc: "a", pair: (1))"#,
        r#"(doc: "a", wrapped: (3.0))"#,
        r#"(doc: "a", wrapped: Meters(3.0))"#,
        r#"(doc: "a", sign: "a")"#,
        r#"(doc: "a", unit: ( ))"#,
        r#"(doc: "a", list: [Struct(Three(1, "b"))])"#,
        r#"Other(doc: "a")"#,
        r#"{"doc": "a"}"#,
        r#"(doc: "a", nested: True)"#,
    ] {
        assert!(ours::<Document>(text).is_err(), "{text}");
        compare::<Document>(text);
    }
}

#[derive(Debug, PartialEq, Deserialize)]
struct Ranges {
    a: std::ops::Range<u32>,
    b: std::ops::RangeInclusive<i8>,
    c: std::ops::RangeFrom<u8>,
    d: std::ops::RangeTo<f64>,
}

#[test]
fn ranges() {
    accepted_by_both::<Ranges>("(a: 1..5, b: -1..=1, c: 3.., d: ..0.5)");
    accepted_by_both::<Ranges>("(a: (start: 1, end: 5), b: (start: -1, end: 1), c: (start: 3), d: (end: 0.5))");
    compare::<Ranges>("(a: 1..=5, b: -1..=1, c: 3.., d: ..0.5)");
    compare::<Ranges>("(a: 1..5, b: -1..1, c: 3.., d: ..0.5)");
    compare::<Ranges>("(a: 1..5, b: -1..=1, c: 3..4, d: ..0.5)");
    compare::<Ranges>("(a: 1..5, b: -1..=1000, c: 3.., d: ..0.5)");
}
