//! Shaders in memory, and texts of what comes out.

use luminaire_graph::diagnostic::Diagnostic;
use luminaire_graph::published::PublishedSchema;
use luminaire_graph::reflect::interface::{EntryPoint, Global, GlobalKind, Layout, Shader};
use luminaire_graph::reflect::reflect;
use luminaire_graph::source::{FileKind, MemoryFiles, SourceMap, Span};

/// A schema with two material textures and samplers.
pub(crate) fn published() -> PublishedSchema {
    PublishedSchema {
        material_textures: vec!["base_color_texture".to_owned(), "normal_texture".to_owned()],
        material_samplers: vec!["base_color_sampler".to_owned(), "normal_sampler".to_owned()],
        ..PublishedSchema::default()
    }
}

/// Reflects the first of these files.
pub(crate) fn run(files: &[(&str, &str)]) -> (Result<Shader, Vec<Diagnostic>>, SourceMap) {
    let mut memory = MemoryFiles::default();
    for (path, text) in files {
        memory = memory.with(FileKind::Shader, path, text);
    }
    let mut sources = SourceMap::default();
    let path = files.first().map_or("main.wgsl", |file| file.0);
    let result = reflect(path, Span::NOWHERE, &memory, &published(), &mut sources);
    (result, sources)
}

/// Reflects one file that must be right.
pub(crate) fn shader(text: &str) -> Shader {
    let (result, sources) = run(&[("main.wgsl", text)]);
    result.unwrap_or_else(|problems| panic!("{}", luminaire_graph::diagnostic::render(&problems, &sources, false)))
}

/// Compares texts line by line, without what surrounds each line.
#[track_caller]
pub(crate) fn check(actual: &str, expected: &str) {
    let lines = |text: &str| text.lines().map(str::trim).filter(|line| !line.is_empty()).map(str::to_owned).collect::<Vec<_>>();
    let (actual, expected) = (lines(actual), lines(expected));
    assert!(actual == expected, "expected:\n{}\n\nfound:\n{}\n", expected.join("\n"), actual.join("\n"));
}

/// Checks the interface of one file, see [`describe`].
#[track_caller]
pub(crate) fn check_interface(text: &str, expected: &str) {
    check(&describe(&shader(text)), expected);
}

/// Checks the problems with the first of these files, see [`describe_problems`].
#[track_caller]
pub(crate) fn check_problems(files: &[(&str, &str)], expected: &str) {
    let (result, sources) = run(files);
    match result {
        Ok(shader) => panic!("nothing is wrong: {}", describe(&shader)),
        Err(problems) => {
            check(&describe_problems(&problems, &sources), expected);
            // It must be possible to show them.
            assert!(!luminaire_graph::diagnostic::render(&problems, &sources, false).is_empty());
        }
    }
}

/// One line for a problem, one for each place (`file:line:column text-there: label`), note and hint.
pub(crate) fn describe_problems(problems: &[Diagnostic], sources: &SourceMap) -> String {
    let mut out = String::new();
    for problem in problems {
        out += &format!("{}: {}\n", problem.code, problem.message);
        for label in problem.primary.iter().chain(&problem.secondary) {
            let file = sources.get(label.span.file).map_or("nowhere", |file| &file.name);
            let (line, column) = sources.line_column(label.span).unwrap_or_default();
            out += &format!("at {file}:{line}:{column} `{}`: {}\n", sources.text(label.span), label.text);
        }
        for note in &problem.notes {
            out += &format!("note {note}\n");
        }
        if let Some(hint) = &problem.hint {
            out += &format!("hint {hint}\n");
        }
    }
    out
}

/// The whole interface, a line for each thing.
pub(crate) fn describe(shader: &Shader) -> String {
    let mut out = String::new();
    for constant in &shader.overrides {
        out += &format!("override {}: {}{}\n", constant.name, constant.wgsl, if constant.has_default { " with default" } else { "" });
    }
    for feature in &shader.features {
        out += &format!("needs {}\n", feature.name());
    }
    for entry in &shader.entries {
        out += &describe_entry(entry);
    }
    out
}

fn describe_entry(entry: &EntryPoint) -> String {
    let mut out = format!("{:?} {}", entry.stage, entry.name);
    if entry.workgroup_size != [0; 3] {
        out += &format!(" {:?}", entry.workgroup_size);
    }
    out += if entry.writes_depth { " writes-depth" } else { "" };
    out += if entry.discards { " discards" } else { "" };
    if !entry.overrides.is_empty() {
        out += &format!(" overrides {}", entry.overrides.join(" "));
    }
    out += "\n";
    for global in &entry.globals {
        out += &describe_global(global);
    }
    for input in &entry.vertex_inputs {
        out += &format!("vertex {} {} x{}\n", input.location, input.name, input.components);
    }
    for varying in &entry.varyings {
        out += &format!("varying {} {}: {} {}\n", varying.location, varying.name, varying.wgsl, varying.interpolation);
    }
    for output in &entry.color_outputs {
        out += &format!("color {} {} {:?} x{}\n", output.location, output.name, output.kind, output.components);
    }
    out
}

fn describe_global(global: &Global) -> String {
    let flag = |on: bool, name: &'static str| if on { name } else { "" };
    let kind = match &global.kind {
        GlobalKind::Uniform { layout } => format!("uniform {}", describe_layout(layout)),
        GlobalKind::Storage { writes, writable, reads, layout } => {
            let flags = [flag(*writable, "writable "), flag(*reads, "reads "), flag(*writes, "writes ")].concat();
            format!("storage {flags}{}", describe_layout(layout))
        }
        GlobalKind::Texture { dimension, kind, multisampled, filtered } => {
            format!("texture {dimension:?} {kind:?}{}{}", flag(*multisampled, " multisampled"), flag(*filtered, " filtered"))
        }
        GlobalKind::DepthTexture { dimension, multisampled } => {
            format!("depth {dimension:?}{}", flag(*multisampled, " multisampled"))
        }
        GlobalKind::StorageTexture { dimension, format, access } => format!("storage-texture {dimension:?} {format} {access:?}"),
        GlobalKind::Sampler { comparison } => format!("sampler{}", flag(*comparison, " comparison")),
    };
    format!("{}.{} {}: {kind}\n", global.group, global.binding, global.name)
}

fn describe_layout(layout: &Layout) -> String {
    let members: Vec<_> = layout.members.iter().map(|member| format!("{}: {} @{}", member.name, member.wgsl, member.offset)).collect();
    format!("{} bytes{} [{}]", layout.size, if layout.runtime_array { " each" } else { "" }, members.join(", "))
}
