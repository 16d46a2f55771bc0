//! Animations: checked, and not kept.
//!
//! A file whose animations are broken is refused like any other broken file, so that a later version that plays them refuses no
//! file that this one takes. Key times that do not increase are a warning.

use std::collections::BTreeSet;

use super::accessor::Accessor;
use super::element::{Component, Kind};
use super::json::{Json, clip};
use super::mesh::MeshSource;
use super::node::NodeSource;

/// A checked sampler.
struct Track<'a> {
    place: String,
    output: &'a Accessor<'a>,
    /// Elements of the output for each value: keys, or three times as many with tangents.
    steps: usize,
}

/// Checks every animation.
pub(super) fn check(root: &Json<'_>, accessors: &[Option<Accessor<'_>>], nodes: &[NodeSource], meshes: &[MeshSource<'_>]) {
    // Samplers share their key times; each accessor is read once.
    let mut checked = BTreeSet::new();
    for animation in root.objects("animations") {
        animation.required("channels");
        animation.required("samplers");
        let samplers = animation.objects("samplers");
        let tracks: Vec<Option<Track<'_>>> = samplers.iter().map(|sampler| read_sampler(sampler, accessors, &mut checked)).collect();
        for channel in animation.objects("channels") {
            check_channel(&channel, &tracks, nodes, meshes);
        }
    }
}

fn read_sampler<'a>(json: &Json<'_>, accessors: &'a [Option<Accessor<'a>>], checked: &mut BTreeSet<&'a str>) -> Option<Track<'a>> {
    let accessor = |key: &str| accessors.get(json.required_index(key, "accessors", accessors.len())?)?.as_ref();
    let (input, output) = (accessor("input"), accessor("output"));
    let per_key = match json.text("interpolation") {
        None | Some("LINEAR" | "STEP") => 1,
        Some("CUBICSPLINE") => 3,
        Some(other) => {
            let expected = "expected LINEAR, STEP or CUBICSPLINE";
            json.error_at("interpolation", "gltf::animation", format_args!("{expected}, found `{}`", clip(other)));
            return None;
        }
    };
    let (input, output) = (input?, output?);
    if input.kind != Kind::Scalar || input.component != Component::F32 {
        json.error_at("input", "gltf::animation", format_args!("expected SCALAR of FLOAT, found {}", input.shown()));
        return None;
    }
    if checked.insert(input.place.as_str()) {
        check_times(json, input);
    }
    Some(Track { place: json.place().to_owned(), output, steps: input.count.saturating_mul(per_key) })
}

fn check_times(json: &Json<'_>, input: &Accessor<'_>) {
    let mut last = f32::NEG_INFINITY;
    for key in 0..input.count {
        let [time] = input.floats(key);
        if !(time.is_finite() && time > last) {
            json.warning_at("input", "gltf::animation-times", format_args!("key {key} is at {time}, not after {last}"));
            return;
        }
        last = time;
    }
}

fn check_channel(json: &Json<'_>, tracks: &[Option<Track<'_>>], nodes: &[NodeSource], meshes: &[MeshSource<'_>]) {
    let sampler = json.required_index("sampler", "samplers", tracks.len());
    let Some(target) = json.required("target").and_then(|_| json.object("target")) else { return };
    let node = target.index("node", "nodes", nodes.len());
    let path = target.required("path").and_then(|_| target.text("path"));
    let (Some(path), Some(sampler)) = (path, sampler) else { return };
    let Some(track) = tracks.get(sampler).and_then(|track| track.as_ref()) else { return };
    let targets = || {
        let mesh = meshes.get(nodes.get(node?)?.mesh?)?;
        mesh.primitives.iter().map(|primitive| primitive.targets.len()).max().filter(|targets| *targets > 0)
    };
    let (kind, values) = match path {
        "translation" | "scale" => (Kind::Vec3, Some(1)),
        "rotation" => (Kind::Vec4, Some(1)),
        "weights" => (Kind::Scalar, targets()),
        // Paths of extensions, for example KHR_animation_pointer.
        _ if target.has("extensions") => return,
        other => {
            target.error_at(
                "path",
                "gltf::animation",
                format_args!("expected translation, rotation, scale or weights, found `{}`", clip(other)),
            );
            return;
        }
    };
    let output = track.output;
    if output.kind != kind {
        json.report().error(
            "gltf::animation",
            &track.place,
            format_args!("for {path} expected {}, found {}", kind.name(), output.shown()),
            "",
        );
        return;
    }
    let expected = values.map(|values| track.steps.saturating_mul(values));
    if expected.is_some_and(|expected| output.count != expected) || output.count % track.steps.max(1) != 0 {
        let expected = expected.unwrap_or(track.steps);
        let problem = format!("its output has {} elements, but its keys need {expected}", output.count);
        json.report().error("gltf::animation", &track.place, problem, "export the animation again");
    }
}
