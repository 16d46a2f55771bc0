//! The reference of the pipeline language is true: its examples compile, and it mentions everything that can be named.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

use std::path::Path;

use luminaire::files::DiskFiles;
use luminaire::graph::compile::{CompileInput, compile};
use luminaire::graph::device::DeviceFacts;
use luminaire::graph::diagnostic::{Diagnostic, render};
use luminaire::graph::expand::BLOCK_ALONE;
use luminaire::graph::format::FORMATS;
use luminaire::graph::source::{FileError, FileKind, Files, LoadedFile, LoadedImage, MemoryFiles, SourceMap};
use luminaire::graph::syntax::document::{Entries, ParamDoc, PassDoc, ResourceDoc};
use luminaire::graph::syntax::read_document;

fn reference() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines/README.md")).unwrap()
}

/// The code blocks of a language.
fn blocks(text: &str, language: &str) -> Vec<String> {
    text.split(&format!("```{language}\n")).skip(1).map(|rest| rest.split("```").next().unwrap().to_owned()).collect()
}

/// Shaders and pipelines of the page, with the shipped files behind them.
struct PageFiles(MemoryFiles);

impl Files for PageFiles {
    fn read(&self, kind: FileKind, path: &str) -> Result<LoadedFile, FileError> {
        self.0.read(kind, path).or_else(|_| DiskFiles::default().read(kind, path))
    }

    fn image(&self, path: &str) -> Result<LoadedImage, FileError> {
        DiskFiles::default().image(path)
    }

    fn known(&self, kind: FileKind) -> Vec<String> {
        self.0.known(kind)
    }
}

/// A block without the document's brackets: entries of params, resources or passes.
fn fragment(block: &str) -> Result<(), String> {
    let text = format!("{{{block}}}");
    let shown = |problems: Vec<Diagnostic>, sources: &SourceMap| render(&problems, sources, false);
    let mut sources = SourceMap::default();
    let file = sources.add("fragment", text.as_str());
    let passes = read_document::<Entries<PassDoc>>(&text, file).map(|_| ());
    let params = read_document::<Entries<ParamDoc>>(&text, file).map(|_| ());
    let resources = read_document::<Entries<ResourceDoc>>(&text, file).map(|_| ());
    if params.is_ok() || resources.is_ok() {
        return Ok(());
    }
    passes.map_err(|problems| shown(problems, &sources))
}

#[test]
fn examples_compile() {
    let page = reference();
    let mut files = MemoryFiles::default();
    for shader in blocks(&page, "wgsl") {
        let path = shader.lines().next().unwrap().trim_start_matches("// ").to_owned();
        files = files.with(FileKind::Shader, &path, &shader);
    }
    for block in blocks(&page, "ron").iter().filter(|block| block.starts_with("// example/")) {
        let path = block.lines().next().unwrap().trim_start_matches("// ");
        files = files.with(FileKind::Pipeline, path, block);
    }
    let published = luminaire::scenes::publish::schema();
    let counts = published.counts.iter().map(|name| (name.clone(), 1)).collect();
    let (mut whole, mut parts) = (0, 0);
    for (index, block) in blocks(&page, "ron").into_iter().enumerate() {
        if !block.contains("outputs:") {
            fragment(&block).unwrap_or_else(|problems| panic!("block {index}:\n{problems}"));
            parts += 1;
            continue;
        }
        whole += 1;
        let name = format!("block {index}");
        let files = PageFiles(files.clone().with(FileKind::Pipeline, &name, &block));
        let compilation = compile(&CompileInput {
            pipeline: &name,
            files: &files,
            published: &published,
            counts: &counts,
            device: &DeviceFacts::webgpu_defaults(),
            output: [1280, 720],
            sets: &[],
            outputs: None,
        });
        if block.contains("inputs: {\"picture\": Texture(") {
            // Somebody has to give a block its inputs; another example does.
            assert_eq!(compilation.diagnostics.iter().map(|problem| problem.code).collect::<Vec<_>>(), [BLOCK_ALONE]);
            continue;
        }
        let problems = render(&compilation.diagnostics, &compilation.sources, false);
        assert!(problems.is_empty(), "{problems}");
        assert!(compilation.plan.is_some());
    }
    assert!(whole >= 2 && parts >= 7, "{whole} documents and {parts} fragments were found");
}

#[test]
fn everything_that_can_be_named_is_mentioned() {
    let page = reference();
    let schema = luminaire::scenes::publish::schema();
    let mut missing = Vec::new();
    let mut need = |what: &str| {
        if !page.contains(&format!("`{what}`")) {
            missing.push(what.to_owned());
        }
    };
    for (name, table) in &schema.tables {
        need(name);
        // The page may name a member of that name elsewhere; the section of its table is what counts.
        let start = page.find(&format!("**`{name}`**")).unwrap_or_else(|| panic!("the page has no table `{name}`"));
        let section = page[start + 4..].split("**`").next().unwrap();
        for member in &table.members {
            let row = format!("| `{}` | `{}` |", member.name, member.wgsl);
            assert!(section.contains(&row), "the table `{name}` lacks {row}");
        }
    }
    schema.counts.iter().chain(&schema.material_textures).chain(&schema.material_samplers).for_each(|name| need(name));
    schema.vertex.attributes.keys().for_each(|name| need(name));
    FORMATS.iter().for_each(|format| need(format.name));
    luminaire::graph::plan::BuiltinSampler::ALL.into_iter().for_each(|sampler| need(sampler.name()));
    assert!(missing.is_empty(), "the page does not mention {missing:?}");
}
