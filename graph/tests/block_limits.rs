//! Blocks in great number and depth cost bounded time and stack, and never the process.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

use std::fmt::Write;
use std::time::Instant;

use luminaire_graph::compile::{Compilation, CompileInput, compile};
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::published::{PublishedSchema, SceneCounts};
use luminaire_graph::source::{FileKind, MemoryFiles};

/// Its output is its input.
const THROUGH: &str = r#"(
    doc: "Hands on what it gets.",
    inputs: {"light": Texture()},
    resources: {"own": Texture(format: "rgba8unorm")},
    passes: {"fill": Clear(write: "own")},
    outputs: {"light": "light", "own": "own"},
)"#;

fn pipeline(blocks: &str, shown: &str) -> String {
    format!(
        r#"(
    doc: "A chain of blocks.",
    blocks: {{{blocks}}},
    resources: {{"light": Texture(format: "rgba8unorm"), "shown": Texture(format: "rgba8unorm")}},
    passes: {{"fill": Clear(write: "light"), "show": Copy(read: "{shown}", write: "shown")}},
    outputs: {{"color": "shown"}},
)"#
    )
}

/// Compiles within the stack that a thread has by default.
fn compiled(files: &MemoryFiles) -> Compilation {
    let start = Instant::now();
    let compilation = compile(&CompileInput {
        pipeline: "it.ron",
        files,
        published: &PublishedSchema::default(),
        counts: &SceneCounts::default(),
        device: &DeviceFacts::webgpu_defaults(),
        output: [16, 16],
        sets: &[],
        outputs: None,
    });
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
    compilation
}

fn chain(length: usize, usage: &str) -> Compilation {
    let mut blocks = String::new();
    for index in 0..length {
        let before = if index == 0 { "light".to_owned() } else { format!("b{}.light", index - 1) };
        let usage = usage.replace("BEFORE", &before);
        write!(blocks, "\"b{index}\": (file: \"through.ron\", inputs: {{\"light\": \"{before}\"}}{usage}), ").unwrap();
    }
    let text = pipeline(&blocks, &format!("b{}.light", length - 1));
    compiled(&MemoryFiles::default().with(FileKind::Pipeline, "it.ron", &text).with(FileKind::Pipeline, "through.ron", THROUGH))
}

fn codes(compilation: &Compilation) -> Vec<&'static str> {
    let mut codes: Vec<_> = compilation.diagnostics.iter().filter(|problem| problem.is_error()).map(|problem| problem.code).collect();
    codes.dedup();
    codes
}

#[test]
fn chains_of_blocks() {
    assert!(chain(60, "").plan.is_some());
    assert_eq!(codes(&chain(999, "")), ["validate::bad-reference"], "too long");
    assert_eq!(codes(&chain(1001, "")), ["load::too-many-blocks"]);
}

#[test]
fn what_blocks_stand_for_when_they_do_not() {
    let usage = ", when: \"1 < 0\", otherwise: {\"light\": \"BEFORE\"}";
    assert!(chain(5, usage).plan.is_some());
    assert_eq!(codes(&chain(999, usage)), ["validate::bad-reference"], "each doubles what the last one may be");
}

#[test]
fn blocks_of_blocks() {
    // Each file has ten of the next: all would be ten to the power of their number.
    let mut files = MemoryFiles::default().with(FileKind::Pipeline, "f8.ron", THROUGH);
    for depth in (0..8).rev() {
        let mut blocks = String::new();
        for index in 0..10 {
            write!(blocks, "\"b{index}\": (file: \"f{}.ron\", inputs: {{\"light\": \"light\"}}), ", depth + 1).unwrap();
        }
        let inputs = if depth == 0 { "" } else { "inputs: {\"light\": Texture()}," };
        let text = pipeline(&blocks, "light").replace("blocks:", &format!("{inputs} blocks:"));
        let text = if depth == 0 {
            text
        } else {
            text.replace("\"light\": Texture(format: \"rgba8unorm\"), ", "").replace("\"fill\": Clear(write: \"light\"), ", "")
        };
        files = files.with(
            FileKind::Pipeline,
            if depth == 0 { "it.ron" } else { ["", "f1.ron", "f2.ron", "f3.ron", "f4.ron", "f5.ron", "f6.ron", "f7.ron"][depth] },
            &text,
        );
    }
    assert_eq!(codes(&compiled(&files)), ["load::too-many-blocks"]);

    let mut files = MemoryFiles::default();
    for depth in 0..20 {
        let blocks = format!("\"next\": (file: \"g{}.ron\")", depth + 1);
        let name = if depth == 0 { "it.ron".to_owned() } else { format!("g{depth}.ron") };
        files = files.with(FileKind::Pipeline, &name, &pipeline(&blocks, "light"));
    }
    assert_eq!(codes(&compiled(&files)), ["load::too-deep"]);
}

/// A pipeline of loops and a block, besides which a pass of the block modifies the same part.
fn loops(passes: &str) -> Compilation {
    let text = format!(
        r#"(
    doc: "Loops.",
    blocks: {{"other": (file: "through.ron", inputs: {{"light": "light"}})}},
    resources: {{"light": Texture(format: "rgba8unorm", clear: Zero), "many": Texture(format: "rgba8unorm", size: Square(4), clear: Zero)}},
    passes: {{{passes}}},
    outputs: {{"color": "many"}},
)"#
    );
    let shader = "struct Targets { color: vec4<f32> }\n@fragment fn add() -> Targets { return Targets(vec4<f32>(0.2)); }\n";
    let files = MemoryFiles::default().with(FileKind::Pipeline, "it.ron", &text).with(FileKind::Pipeline, "through.ron", THROUGH);
    compiled(&files.with(FileKind::Shader, "add.wgsl", shader))
}

const ADD: &str = "Fullscreen(shader: \"add.wgsl\", blend: {\"color\": Add}, modify: {\"color\": \"many\"})";

#[test]
fn many_modifiers() {
    let passes = format!("\"adds\": Repeat(each: Count(20000), as: \"i\", passes: {{\"add\": {ADD}}})");
    assert!(loops(&passes).plan.is_some());
}

#[test]
fn loops_after_loops() {
    let repeat = |name: &str, after: &str| {
        format!("\"{name}\": Repeat(each: Count(20000), as: \"i\", after: [{after}], passes: {{\"add\": {ADD}}}), ")
    };
    assert_eq!(codes(&loops(&(repeat("first", "") + &repeat("second", "\"first\"")))), ["expand::too-many-after"]);
}

#[test]
fn many_problems() {
    let wrong: String = (0..50_000).map(|index| format!("\"w{index}\": Clear(write: \"nothing{index}\"), ")).collect();
    let problems = loops(&wrong).diagnostics;
    assert!(problems.len() >= 50_000, "{} of {:?}", problems.len(), problems.first());
}
