//! Texts that nobody would write: no input may panic, hang or overflow the stack.

use proptest::prelude::*;

use crate::support::run;

/// A shader that touches most of reflection.
const SEED: &str = "
enable f16;
#import \"other.wgsl\"
/* ünï /* nested */ */
struct Input { position: vec3<f32>, @builtin(vertex_index) index: u32 }
struct Varyings { @builtin(position) clip: vec4<f32>, @location(0) uv: vec2<f32>, @location(1) @interpolate(flat) id: u32 }
struct Output { color: vec4<f32>, @builtin(frag_depth) depth: f32 }
struct Item { total: atomic<u32>, list: array<vec4<f32>, 3>, half: vec2<f16>, }
override tile: u32 = 4 * 2;
override debug: bool = false;
var<uniform> params: Item2; struct Item2 { a: mat4x4<f32>, b: f32 }
var<storage, read_write> items: array<Item>;
var image: texture_2d<f32>;
var linear_clamp: sampler;
var result: texture_storage_2d<rgba16float, write>;
var<workgroup> cache: array<f32, tile>;
fn helper(x: f32) -> f32 { if (debug) { discard; } else if (x > 1.0) { return x; } switch (i32(x)) { case 1: { return 2.0; } default: { } } return x - 1.0; }
@vertex fn vertex_main(in: Input) -> Varyings { return Varyings(vec4<f32>(in.position, 1.0), vec2<f32>(0.0), in.index); }
@fragment fn fragment_main(in: Varyings) -> Output { return Output(textureSample(image, linear_clamp, in.uv) * helper(params.b), 0.5); }
@compute @workgroup_size(tile, tile + 1) fn compute_main(@builtin(global_invocation_id) id: vec3<u32>) {
    cache[id.x] = 1.0; workgroupBarrier();
    for (var i = 0u; i < 4u; i++) { atomicAdd(&items[i].total, 1u); }
    textureStore(result, vec2<i32>(id.xy), vec4<f32>(cache[0], shared_value(), 0.0, 1.0));
}
";
const OTHER: &str = "const one = 1.0;\nfn shared_value() -> f32 { return one; }\n";

/// What mutations put in.
const PIECES: [&str; 44] = [
    "{",
    "}",
    "(",
    ")",
    "[",
    "]",
    "<",
    ">",
    ";",
    ",",
    ":",
    "@",
    "#",
    "\"",
    "/*",
    "*/",
    "//",
    "\n",
    "ä",
    "→",
    "\u{0}",
    "\u{feff}",
    "0",
    "1u",
    "4294967296",
    "0x",
    "1e99f",
    "-",
    "@group(0)",
    "@location(0) ",
    "@binding(1)",
    "var<uniform> ",
    "array<f32, 0>",
    "array<vec3<f32>>",
    "atomic<f32>",
    "struct ",
    "fn ",
    "return",
    "override ",
    "f16",
    "texture_external",
    "binding_array<sampler>",
    "\n#import \"other.wgsl\"\n",
    "\n#import \"main.wgsl\"\n",
];

/// Replaces characters at these places (in 0..1) by these pieces.
fn mutate(text: &str, changes: &[(f64, usize, usize)]) -> String {
    let mut chars: Vec<char> = text.chars().collect();
    for (place, removed, piece) in changes {
        let start = ((chars.len() as f64) * place) as usize;
        let end = (start + removed).min(chars.len());
        let start = start.min(end);
        chars.splice(start..end, PIECES.get(*piece).unwrap_or(&"").chars());
    }
    chars.into_iter().collect()
}

#[test]
fn the_seed_is_right() {
    let (result, sources) = run(&[("main.wgsl", SEED), ("other.wgsl", OTHER)]);
    if let Err(problems) = result {
        panic!("{}", luminaire_graph::diagnostic::render(&problems, &sources, false));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_shaders_do_not_panic(
        changes in proptest::collection::vec((0.0..1.0, 0..12usize, 0..PIECES.len() + 4), 1..5),
        other in proptest::collection::vec((0.0..1.0, 0..12usize, 0..PIECES.len() + 4), 0..2),
    ) {
        let (main, other) = (mutate(SEED, &changes), mutate(OTHER, &other));
        let (result, sources) = run(&[("main.wgsl", &main), ("other.wgsl", &other)]);
        if let Err(problems) = result {
            prop_assert!(!problems.is_empty());
            prop_assert!(!luminaire_graph::diagnostic::render(&problems, &sources, false).is_empty());
            // Every place is in its file, on characters.
            for label in problems.iter().flat_map(|problem| problem.primary.iter().chain(&problem.secondary)) {
                let file = sources.get(label.span.file).expect("a known file");
                prop_assert!(file.text.get(label.span.start as usize..label.span.end as usize).is_some(), "{label:?} in {main:?}");
            }
        }
    }

    #[test]
    fn random_text_does_not_panic(text in "\\PC{0,80}") {
        let (result, sources) = run(&[("main.wgsl", &text)]);
        if let Err(problems) = result {
            prop_assert!(!luminaire_graph::diagnostic::render(&problems, &sources, false).is_empty());
        }
    }
}

#[test]
fn deep_and_long_texts_do_not_overflow() {
    let deep = 5_000;
    let texts = [
        format!("fn a() -> f32 {{ return {}1.0{}; }}", "(".repeat(deep), ")".repeat(deep)),
        format!("fn a() {{ {}{} }}", "{".repeat(deep), "}".repeat(deep)),
        format!("fn a() {{ _ = {}1; }}", "-".repeat(deep)),
        format!("fn a(x: bool) {{ if (x) {{}} {} }}", "else if (x) {} ".repeat(deep)),
        format!("alias a = {}f32{};", "array<".repeat(deep), ", 1>".repeat(deep)),
        format!("const a = 1{};", " + 1".repeat(deep)),
        format!("/*{}", "/*".repeat(deep)),
        (1..deep).fold("override o0: u32 = 1;\n".to_owned(), |text, i| text + &format!("override o{i}: u32 = o{} + o{};\n", i - 1, i - 1))
            + &format!("@compute @workgroup_size(o{}) fn main() {{}}", deep - 1),
        (1..deep).rev().fold("fn f0() {}".to_owned(), |text, i| text + &format!("fn f{i}() {{ f{}(); }}\n", i - 1)),
        (1..deep).fold("alias t0 = f32;\n".to_owned(), |text, i| text + &format!("alias t{i} = array<t{}, 1>;\n", i - 1))
            + &format!("var<storage> x: t{}; @compute @workgroup_size(1) fn main() {{ _ = x[0][0]; }}", deep - 1),
    ];
    for text in texts {
        let (result, sources) = run(&[("main.wgsl", &text)]);
        if let Err(problems) = result {
            assert!(!luminaire_graph::diagnostic::render(&problems, &sources, false).is_empty());
        }
    }
}

#[test]
fn a_long_chain_of_imports_is_followed() {
    let count = 3_000;
    let names: Vec<String> = (0..count).map(|index| format!("{index}.wgsl")).collect();
    let texts: Vec<String> = (0..count)
        .map(|index| if index + 1 < count { format!("#import \"{}.wgsl\"\n", index + 1) } else { "const last = 1;".to_owned() })
        .collect();
    let files: Vec<(&str, &str)> = names.iter().map(String::as_str).zip(texts.iter().map(String::as_str)).collect();
    assert!(run(&files).0.is_ok());
}
