//! Whether two stages fit: what the vertex stage sends and what the fragment stage expects.

use super::interface::{EntryPoint, Varying};
use crate::diagnostic::Diagnostic;
use crate::source::Span;

/// What the vertex stage of a fullscreen pass sends.
const FULLSCREEN_UV: (u32, &str, &str) = (0, "vec2<f32>", "perspective, center");

/// The text of an interpolation, with its default sampling written out.
pub(super) fn interpolation_text(interpolation: Option<naga::Interpolation>, sampling: Option<naga::Sampling>) -> String {
    use naga::{Interpolation, Sampling};
    let kind = match interpolation {
        None | Some(Interpolation::Perspective) => "perspective",
        Some(Interpolation::Linear) => "linear",
        Some(Interpolation::Flat) => "flat",
        Some(Interpolation::PerVertex) => "per_vertex",
    };
    let sampling = match sampling {
        Some(Sampling::Center) => "center",
        Some(Sampling::Centroid) => "centroid",
        Some(Sampling::Sample) => "sample",
        Some(Sampling::First) => "first",
        Some(Sampling::Either) => "either",
        None if interpolation == Some(Interpolation::Flat) => "first",
        None => "center",
    };
    format!("{kind}, {sampling}")
}

/// Checks the fragment entry point of a fullscreen pass: it may take builtins and `@location(0) vec2<f32>`, the place on the
/// screen, and nothing else. One problem for each input that does not fit.
pub fn check_fullscreen_inputs(entry: &EntryPoint) -> Vec<Diagnostic> {
    let (location, wgsl, interpolation) = FULLSCREEN_UV;
    let fits = |input: &&Varying| input.location == location && input.wgsl == wgsl && input.interpolation == interpolation;
    let wrong = entry.varyings.iter().filter(|input| !fits(input));
    wrong
        .map(|input| {
            let message = format!("a fullscreen pass can't feed the input `{}` of `{}`", input.name, entry.name);
            Diagnostic::error("reflect::fullscreen-input", message)
                .at(input.span, format!("@location({}), `{}`, interpolated {}", input.location, input.wgsl, input.interpolation))
                .hint("fullscreen passes have builtins and `@location(0) uv: vec2<f32>`, (0, 0) at the top left")
        })
        .collect()
}

/// Checks that a vertex entry point sends everything that a fragment entry point expects, with equal types and interpolation.
pub fn check_varyings(vertex: &EntryPoint, fragment: &EntryPoint) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for input in &fragment.varyings {
        let Some(output) = vertex.varyings.iter().find(|output| output.location == input.location) else {
            let message = format!(
                "`{}` expects `{}` at @location({}), which `{}` does not send",
                fragment.name, input.name, input.location, vertex.name
            );
            found.push(error(message, input.span, "expected here").and(vertex.span, "the vertex entry point"));
            continue;
        };
        let differs = |ours: &str, theirs: &str, what: &str| {
            (ours != theirs).then(|| {
                let message = format!(
                    "`{}` of `{}` and `{}` of `{}` share @location({}) and have different {what}",
                    output.name, vertex.name, input.name, fragment.name, input.location
                );
                error(message, input.span, format!("expects `{theirs}`")).and(output.span, format!("sends `{ours}`"))
            })
        };
        found.extend(differs(&output.wgsl, &input.wgsl, "types"));
        found.extend(differs(&output.interpolation, &input.interpolation, "interpolation"));
    }
    found
}

fn error(message: String, span: Span, label: impl Into<String>) -> Diagnostic {
    Diagnostic::error("reflect::varying-mismatch", message).at(span, label)
}
