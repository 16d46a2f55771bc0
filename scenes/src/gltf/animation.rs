//! Animations: which accessor moves what of which node.
//!
//! Guarantees: outputs have as many elements as their keys need, of the type that their path needs; a property of a node moves
//! once at most in an animation, and its node has a transform in parts. Key times that do not increase, and channels that can't
//! be played (those of morph weights, those of nodes with a matrix), are warnings: many files have them. No key has been read
//! yet, but for its time.

use std::collections::{BTreeMap, BTreeSet};

use super::accessor::Accessor;
use super::element::{Component, Kind};
use super::json::{Json, clip};
use super::mesh::MeshSource;
use super::node::NodeSource;
use crate::asset::{Interpolation, Property};

/// A checked animation.
pub(super) struct AnimationSource<'a> {
    pub(super) name: String,
    /// The last key of all channels, those that are left out included; seconds, not negative.
    pub(super) duration: f32,
    /// What can be played.
    pub(super) channels: Vec<ChannelSource<'a>>,
}

/// A checked channel.
pub(super) struct ChannelSource<'a> {
    /// The file's index.
    pub(super) node: usize,
    pub(super) property: Property,
    pub(super) track: Track<'a>,
}

/// A checked sampler.
#[derive(Clone)]
pub(super) struct Track<'a> {
    /// The JSON path, for messages.
    pub(super) place: String,
    pub(super) interpolation: Interpolation,
    pub(super) input: &'a Accessor<'a>,
    pub(super) output: &'a Accessor<'a>,
    /// The latest key; 0 if all lie before it.
    end: f32,
}

impl Track<'_> {
    /// Elements of the output for each key of a node's property.
    pub(super) fn per_key(&self) -> usize {
        if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 }
    }
}

/// What channels refer to.
#[derive(Clone, Copy)]
struct Targets<'a> {
    nodes: &'a [NodeSource],
    meshes: &'a [MeshSource<'a>],
}

/// Checks every animation.
pub(super) fn read_animations<'a>(
    root: &Json<'_>,
    accessors: &'a [Option<Accessor<'a>>],
    nodes: &[NodeSource],
    meshes: &[MeshSource<'_>],
) -> Vec<AnimationSource<'a>> {
    // Samplers share their key times; each accessor is read once.
    let mut ends = BTreeMap::new();
    let mut weights = None;
    let mut animations = Vec::new();
    for (index, json) in root.objects("animations").iter().enumerate() {
        json.required("channels");
        json.required("samplers");
        let samplers = json.objects("samplers");
        let tracks: Vec<Option<Track<'_>>> = samplers.iter().map(|sampler| read_sampler(sampler, accessors, &mut ends)).collect();
        let mut animation = AnimationSource { name: json.name_or("animation", index), duration: 0.0, channels: Vec::new() };
        let mut moved = BTreeSet::new();
        for channel in json.objects("channels") {
            let Some((path, node, track)) = read_channel(&channel, &tracks, Targets { nodes, meshes }) else { continue };
            animation.duration = animation.duration.max(track.end);
            match (path, node) {
                (Path::Weights, _) => weights = weights.or_else(|| Some(channel.place().to_owned())),
                (Path::Node(property), Some(node)) if is_playable(&channel, node, property, nodes, &mut moved) => {
                    animation.channels.push(ChannelSource { node, property, track: track.clone() });
                }
                _ => {}
            }
        }
        animations.push(animation);
    }
    if let Some(place) = weights {
        let problem = "moves weights of morph targets, which are not played; the mesh keeps those that it has at rest";
        root.report().warning("gltf::animated-weights", place, problem, "");
    }
    animations
}

fn read_sampler<'a>(json: &Json<'_>, accessors: &'a [Option<Accessor<'a>>], ends: &mut BTreeMap<&'a str, f32>) -> Option<Track<'a>> {
    let accessor = |key: &str| accessors.get(json.required_index(key, "accessors", accessors.len())?)?.as_ref();
    let (input, output) = (accessor("input"), accessor("output"));
    let interpolation = match json.text("interpolation") {
        None | Some("LINEAR") => Interpolation::Linear,
        Some("STEP") => Interpolation::Step,
        Some("CUBICSPLINE") => Interpolation::CubicSpline,
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
    let end = *ends.entry(input.place.as_str()).or_insert_with(|| check_times(json, input));
    Some(Track { place: json.place().to_owned(), interpolation, input, output, end })
}

/// Warns of the first key that does not come after its predecessor, and returns the latest time.
fn check_times(json: &Json<'_>, input: &Accessor<'_>) -> f32 {
    let (mut last, mut end, mut is_told) = (f32::NEG_INFINITY, 0.0_f32, false);
    for key in 0..input.count {
        let [time] = input.floats(key);
        let increases = time.is_finite() && time > last;
        if !(increases || is_told) {
            let problem = format!("key {key} is at {time}, not after {last}");
            let hint = "keys that go back in time are left out, and two at one time are a jump";
            json.report().warning("gltf::animation-times", json.place_of("input"), problem, hint);
            is_told = true;
        }
        if time.is_finite() {
            (last, end) = (time, end.max(time));
        }
    }
    end
}

/// What a channel moves.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Path {
    Node(Property),
    Weights,
}

/// The path, the node if the channel names one, and the sampler. `None` for what is broken and for paths of extensions.
fn read_channel<'t, 'a>(
    json: &Json<'_>,
    tracks: &'t [Option<Track<'a>>],
    targets: Targets<'_>,
) -> Option<(Path, Option<usize>, &'t Track<'a>)> {
    let sampler = json.required_index("sampler", "samplers", tracks.len());
    let target = json.required("target").and_then(|_| json.object("target"))?;
    let node = target.index("node", "nodes", targets.nodes.len());
    let name = target.required("path").and_then(|_| target.text("path"))?;
    let track = tracks.get(sampler?)?.as_ref()?;
    let path = match name {
        "translation" => Path::Node(Property::Translation),
        "rotation" => Path::Node(Property::Rotation),
        "scale" => Path::Node(Property::Scale),
        "weights" => Path::Weights,
        // Paths of extensions, for example KHR_animation_pointer.
        _ if target.has("extensions") => return None,
        other => {
            let expected = "expected translation, rotation, scale or weights";
            target.error_at("path", "gltf::animation", format_args!("{expected}, found `{}`", clip(other)));
            return None;
        }
    };
    let morphs = || {
        let mesh = targets.meshes.get(targets.nodes.get(node?)?.mesh?)?;
        mesh.primitives.iter().map(|primitive| primitive.targets.len()).max().filter(|targets| *targets > 0)
    };
    let (kind, values) = match path {
        Path::Node(Property::Rotation) => (Kind::Vec4, Some(1)),
        Path::Node(_) => (Kind::Vec3, Some(1)),
        Path::Weights => (Kind::Scalar, morphs()),
    };
    let (output, steps) = (track.output, track.input.count.saturating_mul(track.per_key()));
    if output.kind != kind {
        let problem = format!("for {name} expected {}, found {}", kind.name(), output.shown());
        json.report().error("gltf::animation", &track.place, problem, "");
        return None;
    }
    let expected = values.map(|values| steps.saturating_mul(values));
    if expected.is_some_and(|expected| output.count != expected) || output.count % steps.max(1) != 0 {
        let expected = expected.unwrap_or(steps);
        let problem = format!("its output has {} elements, but its keys need {expected}", output.count);
        json.report().error("gltf::animation", &track.place, problem, "export the animation again");
        return None;
    }
    Some((path, node, track))
}

/// Whether the node has parts that can move, and no channel moves this one already.
fn is_playable(json: &Json<'_>, node: usize, property: Property, nodes: &[NodeSource], moved: &mut BTreeSet<(usize, Property)>) -> bool {
    if nodes.get(node).is_none_or(|node| node.pose.is_none()) {
        let problem = format!("nodes[{node}] has a matrix, whose parts can't move; the channel is left out");
        json.warning_at("target", "gltf::animated-matrix", problem);
        return false;
    }
    if !moved.insert((node, property)) {
        json.warning_at(
            "target",
            "gltf::animated-twice",
            format_args!("an earlier channel moves the same of nodes[{node}]; this one is left out"),
        );
        return false;
    }
    true
}
