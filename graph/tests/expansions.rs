//! What documents come to once loops are unrolled and values are known, as text beside each fixture.
#![allow(dead_code, clippy::expect_used, clippy::panic, reason = "helpers of tests")]

#[path = "support/fixture_files.rs"]
mod support;

use std::fmt::Write;

use luminaire_graph::device::DeviceFacts;
use luminaire_graph::diagnostic::render;
use luminaire_graph::expand::types::{Expanded, Indices, PartRef, PassKind, Shape, Work};
use luminaire_graph::expand::{ExpandInput, expand};
use luminaire_graph::load::load;
use luminaire_graph::source::SourceMap;
use luminaire_graph::validate::validate;

fn expanded(name: &str) -> Expanded {
    let mut sources = SourceMap::default();
    let counts = [("point_lights".to_owned(), 2), ("directional_lights".to_owned(), 0)].into_iter().collect();
    let input = ExpandInput { output: [256, 128], counts: &counts, sets: &[], outputs: None, device: &DeviceFacts::webgpu_defaults() };
    load(&support::FixtureFiles, &format!("expansions/{name}.ron"), &mut sources)
        .and_then(|loaded| validate(&loaded, &support::schema()))
        .and_then(|validated| expand(&validated, &input))
        .unwrap_or_else(|problems| panic!("{}", render(&problems, &sources, false)))
}

fn part(expanded: &Expanded, part: &PartRef) -> String {
    let mut text = expanded.resources[part.resource.index()].name.clone();
    for (word, indices) in [("mip", part.mips), ("layer", part.layers)] {
        match indices {
            None => {}
            Some(Indices { first, count: 1 }) => text += &format!(".{word}({first})"),
            Some(indices) => text += &format!(".{word}s({:?})", indices.range()),
        }
    }
    if let Some(version) = part.version {
        text += &format!("@{}", expanded.passes[version.index()].name);
    }
    text
}

fn describe(expanded: &Expanded) -> String {
    let mut text = String::new();
    let mut line = |line: String| writeln!(text, "{line}").expect("writing to a string");
    line(format!("retained budget {:?}", expanded.retained_budget));
    for param in &expanded.params {
        line(format!("param {} = {}{}", param.name, param.value, if param.live { " live" } else { "" }));
    }
    for resource in &expanded.resources {
        let formats = match &resource.shape {
            Shape::Texture(shape) => shape.formats.iter().map(|format| format.name()).collect::<Vec<_>>().join(" or "),
            Shape::Buffer { .. } => "bytes".to_owned(),
        };
        line(format!("resource {} of {formats} {:?} {:?}", resource.name, resource.keep, resource.history));
    }
    for spread in &expanded.spreads {
        line(format!("spread {}: {} a frame, {} rounds", spread.name, spread.per_frame, spread.rounds));
    }
    for pass in &expanded.passes {
        line(format!("{} {} {:?} {:?}", pass.kind.name(), pass.name, pass.run, pass.indices));
        if let PassKind::Compute { work, .. } = &pass.kind {
            match work {
                Work::Cover(covered) => line(format!("    covers {}", part(expanded, covered))),
                Work::Indirect { buffer, offset } => line(format!("    as many as {} says at {offset}", part(expanded, buffer))),
                other => line(format!("    {other:?}")),
            }
        }
        for element in &pass.elements {
            line(format!("    {} is {}[{}]", element.variable, element.table, element.row));
        }
        for (role, slots) in [("read", &pass.reads), ("write", &pass.writes), ("modify", &pass.modifies)] {
            for slot in slots {
                line(format!("    {role} {} {}", slot.name.value, part(expanded, &slot.part)));
            }
        }
        for (index, iteration) in pass.batch.iter().flat_map(|batch| &batch.iterations).enumerate() {
            let parts: Vec<String> = iteration.parts.iter().map(|named| part(expanded, named)).collect();
            let element = iteration.element.as_ref().map(|element| format!(", {} is {}[{}]", element.variable, element.table, element.row));
            line(format!("    [{index}] {}{}", parts.join(", "), element.unwrap_or_default()));
        }
    }
    text
}

#[test]
fn every_document_comes_to_what_stands_beside_it() {
    let names = support::fixtures_in("expansions");
    assert!(names.len() >= 2, "only {} documents", names.len());
    let failures: Vec<String> = names
        .iter()
        .filter_map(|name| {
            support::check_text(&support::fixtures().join(format!("expansions/{name}.txt")), &describe(&expanded(name))).err()
        })
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}
