//! The dumps of one small pipeline, byte for byte. `LUMINAIRE_ACCEPT=1` writes what is expected anew.
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use luminaire_graph::dump;
use support::{Fixture, fixture};

const GRAPH: &str = "\
texture shadow depth32float 64x64
texture albedo rgba8unorm 64x64
texture light rgba16float 64x64
texture chain r32float 64x64 mips 3 clear
texture blurred rgba16float 64x64
texture color rgba8unorm 64x64
texture debug rgba8unorm 64x64
buffer histogram 1024
buffer exposure 16

pass tonemap read blurred uniform exposure write color
pass shade read albedo read shadow read chain write light
pass draw_shadow write shadow
pass fog modify light read shadow
pass gbuffer write albedo
pass count read light@shade write histogram
pass adapt read histogram write exposure
pass blur read light read chain.mip(1) write blurred
pass seed read albedo write chain.mip(0)
pass halve read chain.mip(0) write chain.mip(1)
pass show read light write debug

output color color
output shadow shadow
";

fn expect(name: &str, found: &str) {
    let path = format!("{}/tests/expected/{name}", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("LUMINAIRE_ACCEPT").is_some() {
        std::fs::write(&path, found).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(found, expected, "{path} differs");
}

fn graph() -> Fixture {
    fixture(GRAPH)
}

#[test]
fn text() {
    expect("plan.txt", &dump::text(&graph().plan(), &graph().sources));
}

#[test]
fn dot() {
    expect("plan.dot", &dump::dot(&graph().plan()));
}

#[test]
fn html() {
    expect("plan.html", &dump::html(&graph().plan(), &graph().sources));
}

#[test]
fn json() {
    expect("plan.json", &format!("{:#}\n", dump::json(&graph().plan(), &graph().sources)));
}
