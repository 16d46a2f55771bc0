//! The `ron` crate as the oracle of the reader: what both accept has the same value, and neither accepts more, but for the
//! listed differences.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::fmt;

use indexmap::IndexMap;
use luminaire_graph::diagnostic::{Diagnostic, render};
use luminaire_graph::source::SourceMap;
use luminaire_graph::syntax::read_document;
use luminaire_graph::syntax::spanned::Spanned;
use proptest::prelude::*;
use ron::extensions::Extensions;
use serde::de::{self, DeserializeOwned, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// Any value; numbers of all widths are alike.
#[derive(Debug, Clone, PartialEq)]
enum Any {
    Unit,
    Bool(bool),
    Integer(i128),
    Float(u64),
    Char(char),
    Text(String),
    Bytes(Vec<u8>),
    Nothing,
    Something(Box<Any>),
    List(Vec<Any>),
    Map(Vec<(Any, Any)>),
}

impl Any {
    fn float(value: f64) -> Any {
        Any::Float(if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() })
    }
}

impl<'de> Deserialize<'de> for Any {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Any, D::Error> {
        struct AnyVisitor;
        macro_rules! visit {
            ($($method:ident($type:ty) $make:expr;)*) => {
                $(fn $method<E: de::Error>(self, value: $type) -> Result<Any, E> {
                    Ok($make(value))
                })*
            };
        }
        impl<'de> Visitor<'de> for AnyVisitor {
            type Value = Any;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("anything")
            }
            visit! {
                visit_bool(bool) Any::Bool;
                visit_i8(i8) |value| Any::Integer(i128::from(value));
                visit_i16(i16) |value| Any::Integer(i128::from(value));
                visit_i32(i32) |value| Any::Integer(i128::from(value));
                visit_i64(i64) |value| Any::Integer(i128::from(value));
                visit_u8(u8) |value| Any::Integer(i128::from(value));
                visit_u16(u16) |value| Any::Integer(i128::from(value));
                visit_u32(u32) |value| Any::Integer(i128::from(value));
                visit_u64(u64) |value| Any::Integer(i128::from(value));
                visit_f32(f32) |value| Any::float(f64::from(value));
                visit_f64(f64) Any::float;
                visit_char(char) Any::Char;
                visit_str(&str) |value: &str| Any::Text(value.to_owned());
                visit_bytes(&[u8]) |value: &[u8]| Any::Bytes(value.to_vec());
            }
            fn visit_unit<E: de::Error>(self) -> Result<Any, E> {
                Ok(Any::Unit)
            }
            fn visit_none<E: de::Error>(self) -> Result<Any, E> {
                Ok(Any::Nothing)
            }
            fn visit_some<D: Deserializer<'de>>(self, inner: D) -> Result<Any, D::Error> {
                Any::deserialize(inner).map(|value| Any::Something(Box::new(value)))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut access: A) -> Result<Any, A::Error> {
                let mut items = Vec::new();
                while let Some(item) = access.next_element()? {
                    items.push(item);
                }
                Ok(Any::List(items))
            }
            fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Any, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = access.next_entry()? {
                    entries.push(entry);
                }
                Ok(Any::Map(entries))
            }
        }
        deserializer.deserialize_any(AnyVisitor)
    }
}

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

// Random texts.

fn space() -> impl Strategy<Value = String> {
    prop_oneof![
        6 => Just(String::new()),
        3 => Just(" ".to_owned()),
        1 => Just("\n\t".to_owned()),
        1 => Just("// , ( \" comment\n".to_owned()),
        1 => Just("/* , } /* \" */ */".to_owned()),
    ]
}

fn scalar() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<i64>().prop_map(|value| value.to_string()),
        any::<u64>().prop_map(|value| value.to_string()),
        any::<u32>().prop_map(|value| format!("0x{value:X}")),
        any::<u16>().prop_map(|value| format!("0b{value:b}")),
        any::<u8>().prop_map(|value| format!("{value}u8")),
        any::<i16>().prop_map(|value| format!("{value}i16")),
        any::<f64>().prop_map(|value| ron::to_string(&value).unwrap()),
        any::<f32>().prop_map(|value| ron::to_string(&value).unwrap()),
        any::<f32>().prop_filter("finite", |value| value.is_finite()).prop_map(|value| format!("{value:e}f32")),
        "[0-9][0-9_]{0,6}(\\.[0-9]{0,4})?(e-?[0-9]{1,2})?",
        any::<String>().prop_map(|value| ron::to_string(&value).unwrap()),
        "[a-zA-Z \\\\]{0,8}".prop_map(|value| format!("r#\"{value}\"#")),
        any::<char>().prop_map(|value| ron::to_string(&value).unwrap()),
        proptest::collection::vec(any::<u8>(), 0..6).prop_map(|bytes| {
            let escaped: String = bytes.iter().map(|byte| format!("\\x{byte:02x}")).collect();
            format!("b\"{escaped}\"")
        }),
        prop_oneof!["true", "false", "\\(\\)", "None", "inf", "NaN", "\\.\\.", "1\\.\\.2", "Foo", "r#a-b"],
        "[A-Z][a-z0-9_]{0,5}".prop_filter("not a keyword", |word| word != "Some"),
    ]
}

/// A separated list with random white space and sometimes a comma at the end.
fn joined(items: Vec<(String, String)>, comma_at_end: bool) -> String {
    let mut text = String::new();
    let count = items.len();
    for (index, (space, item)) in items.into_iter().enumerate() {
        text.push_str(&space);
        text.push_str(&item);
        if index + 1 < count || comma_at_end {
            text.push_str(&space);
            text.push(',');
        }
    }
    text
}

fn any_text() -> impl Strategy<Value = String> {
    scalar().prop_recursive(4, 48, 6, |inner| {
        let items = (proptest::collection::vec((space(), inner.clone()), 1..6), any::<bool>()).boxed();
        let values = items.clone().prop_map(|(items, comma)| joined(items, comma)).boxed();
        let fields = items.clone().prop_map(|(items, comma)| {
            let named = |(index, (space, item)): (usize, (String, String))| (space.clone(), format!("field_{index}{space}:{space}{item}"));
            joined(items.into_iter().enumerate().map(named).collect(), comma)
        });
        let entries = items.prop_map(|(items, comma)| {
            let keyed =
                |(index, (space, item)): (usize, (String, String))| (space.clone(), format!("\"key {index}\"{space}:{space}{item}"));
            joined(items.into_iter().enumerate().map(keyed).collect(), comma)
        });
        prop_oneof![
            values.clone().prop_map(|values| format!("[{values}]")),
            entries.prop_map(|entries| format!("{{{entries}}}")),
            ("([A-Z][a-z]{0,3}/\\*\\*/)?", values).prop_map(|(name, values)| format!("{name}({values})")),
            ("([A-Z][a-z]{0,3} ?)?", fields).prop_map(|(name, fields)| format!("{name}({fields})")),
            inner.prop_map(|inner| format!("Some({inner})")),
        ]
    })
}

/// A slip at a random place: characters left out, doubled, or others put in.
#[derive(Debug, Clone)]
enum Slip {
    Drop(usize, usize),
    Double(usize, usize),
    Insert(usize, String),
}

fn slip() -> impl Strategy<Value = Slip> {
    let place = any::<prop::sample::Index>().prop_map(|index| index.index(1 << 20));
    prop_oneof![
        (place.clone(), 1..4usize).prop_map(|(place, length)| Slip::Drop(place, length)),
        (place.clone(), 1..12usize).prop_map(|(place, length)| Slip::Double(place, length)),
        (place, "[\\[\\]{}(),:.\"'/*#!=\\\\+_rbxeEuif0-9 \n-]{1,2}|Some|None|true|inf|0x|r#\"|/\\*|é")
            .prop_map(|(place, text)| Slip::Insert(place, text)),
    ]
}

fn apply(text: &str, slips: &[Slip]) -> String {
    let mut chars: Vec<char> = text.chars().collect();
    for slip in slips {
        let at = |place: usize, chars: &[char]| place % (chars.len() + 1);
        match slip {
            Slip::Drop(place, length) => {
                let start = at(*place, &chars);
                let end = (start + length).min(chars.len());
                chars.drain(start..end);
            }
            Slip::Double(place, length) => {
                let start = at(*place, &chars);
                let end = (start + length).min(chars.len());
                let copy = chars[start..end].to_vec();
                chars.splice(end..end, copy);
            }
            Slip::Insert(place, text) => {
                let start = at(*place, &chars);
                chars.splice(start..start, text.chars());
            }
        }
    }
    chars.into_iter().collect()
}

fn loose() -> impl Strategy<Value = Loose> {
    let leaf = prop_oneof![
        any::<bool>().prop_map(Loose::Flag),
        any::<i64>().prop_map(Loose::Integer),
        any::<f64>().prop_filter("a number", |value| value.is_finite()).prop_map(Loose::Float),
        any::<String>().prop_map(Loose::Text),
        prop_oneof![
            Just(Kind::Plain),
            any::<u8>().prop_map(Kind::Of),
            any::<(u8, u8)>().prop_map(|(a, b)| Kind::Both(a, b)),
            any::<u8>().prop_map(|x| Kind::Named { x })
        ]
        .prop_map(Loose::Kind),
    ];
    leaf.prop_recursive(2, 8, 3, |inner| proptest::collection::vec(inner, 0..3).prop_map(Loose::List))
}

fn entry() -> impl Strategy<Value = Entry> {
    let leaf = prop_oneof![
        Just(Entry::Empty),
        any::<i64>().prop_map(|value| Entry::Scalar(value.into())),
        (any::<u8>(), any::<Option<String>>()).prop_map(|(a, b)| Entry::Pair(a, b)),
        (any::<u8>(), any::<String>()).prop_map(|(a, b)| Entry::Struct(Two(a, b))),
        loose().prop_map(Entry::Value),
        any::<Option<String>>().prop_map(Entry::Text),
    ];
    leaf.prop_recursive(3, 12, 3, |inner| {
        (any::<u64>(), proptest::collection::vec(inner, 0..3)).prop_map(|(a, b)| Entry::Fields { a: a.into(), b })
    })
}

fn document() -> impl Strategy<Value = Document> {
    (
        any::<(String, Option<u32>, i16, char)>(),
        proptest::option::of(-1e30f32..1e30),
        proptest::collection::vec(("[a-z]{0,6}", entry()), 0..4),
        proptest::collection::vec(entry(), 0..4),
        (-1e300f64..1e300, -1e3f64..1e3),
        proptest::option::of(any::<bool>().prop_map(Some)),
    )
        .prop_map(|((doc, count, left, sign), ratio, entries, list, (right, wrapped), nested)| Document {
            doc,
            count,
            ratio,
            entries: entries.into_iter().map(|(key, value)| (key.into(), value.into())).collect(),
            list: list.into_iter().map(Spanned::from).collect(),
            pair: (left, right.into()),
            wrapped: Meters(wrapped),
            nested,
            sign,
            unit: (),
        })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(400), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_values(text in any_text()) {
        accepted_by_both::<Any>(&text);
    }

    #[test]
    fn random_documents(document in document(), pretty in any::<bool>()) {
        let text = if pretty {
            options().to_string_pretty(&document, ron::ser::PrettyConfig::default().struct_names(true)).unwrap()
        } else {
            options().to_string(&document).unwrap()
        };
        match ours::<Document>(&text) {
            Ok(read) => prop_assert_eq!(&read, &document, "{}", text),
            Err((_, shown)) => prop_assert!(false, "{}", shown),
        }
        compare::<Document>(&text);
    }

    #[test]
    fn slips_in_values(text in any_text(), slips in proptest::collection::vec(slip(), 1..4)) {
        compare::<Any>(&apply(&text, &slips));
    }

    #[test]
    fn slips_in_documents(document in document(), slips in proptest::collection::vec(slip(), 1..4)) {
        let text = options().to_string(&document).unwrap();
        compare::<Document>(&apply(&text, &slips));
    }

    #[test]
    fn random_strings(text in any::<String>()) {
        compare::<Any>(&text);
    }

    #[test]
    fn random_tokens(text in "([\\[\\](){},:]|\"a\"|'b'|Foo|Some|r#|#!|\\.\\.|1|-|\\\\|/\\*|\\*/|//|\n| ){0,24}") {
        compare::<Any>(&text);
        compare::<Document>(&text);
    }
}

/// `LUMINAIRE_CASES` asks for more.
fn cases(default: u32) -> u32 {
    std::env::var("LUMINAIRE_CASES").ok().and_then(|count| count.parse().ok()).unwrap_or(default)
}
