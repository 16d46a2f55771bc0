//! Random texts and documents, and slips in them.

use luminaire_graph::syntax::spanned::Spanned;
use proptest::prelude::*;

use super::any::Any;
use super::{Document, Entry, Kind, Loose, Meters, Two, accepted_by_both, compare, options, ours};

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
            ("([A-Z][a-z]{0,2}/\\*\\*/)?", values).prop_map(|(name, values)| format!("{name}({values})")),
            ("([A-Z][a-z]{0,2} ?)?", fields).prop_map(|(name, fields)| format!("{name}({fields})")),
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
    #![proptest_config(ProptestConfig { cases: cases(1000), failure_persistence: None, ..ProptestConfig::default() })]

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
