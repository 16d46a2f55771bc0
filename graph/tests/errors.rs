//! Documents that are wrong, each with the message that its author sees beside it.

#[path = "support/fixture_files.rs"]
mod support;

use luminaire_graph::diagnostic::render;

#[test]
fn every_wrong_document_has_its_message() {
    let names = support::fixtures_in("errors");
    assert!(names.len() >= 40, "only {} documents", names.len());
    let mut failures = Vec::new();
    for name in names {
        let compilation = support::compile_fixture(&format!("errors/{name}.ron"));
        let text = render(&compilation.diagnostics, &compilation.sources, false);
        if text.is_empty() {
            failures.push(format!("{name} has nothing wrong with it"));
        }
        let is_warning = name == "schedule_unread_resource";
        if compilation.plan.is_some() != is_warning {
            failures.push(format!("{name}: a plan {}", if is_warning { "is missing" } else { "came out" }));
        }
        failures.extend(support::check_text(&support::fixtures().join(format!("errors/{name}.txt")), &text).err());
    }
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}

#[test]
fn deep_nesting_is_an_error() {
    for open in ["(a:", "[", "{1:", "Some("] {
        let text = open.repeat(100_000);
        let files = luminaire_graph::source::MemoryFiles::default().with(luminaire_graph::source::FileKind::Pipeline, "deep.ron", &text);
        let counts = Default::default();
        let compilation = luminaire_graph::compile::compile(&luminaire_graph::compile::CompileInput {
            pipeline: "deep.ron",
            files: &files,
            published: &support::schema(),
            counts: &counts,
            device: &luminaire_graph::device::DeviceFacts::webgpu_defaults(),
            output: [64, 64],
            sets: &[],
            outputs: None,
        });
        assert!(compilation.plan.is_none());
        assert!(!compilation.diagnostics.is_empty());
    }
}
