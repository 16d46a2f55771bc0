//! Faults that users of other render graphs have met, each as a test here.
//!
//! What needs a device is tested where there is one: a past that outlasts a resize (`tests/known_answers`), a thousand sizes, and no
//! creation in the steady state (`tests/growth.rs`, `tests/noop.rs`), poisoned memory under inputs that change (`tests/known_answers`).
//! Shipped pipelines without a single warning are `tests/plans.rs`, names seen from everywhere `expansions/blocks.ron`, passes that
//! nothing needs `schedule.rs`. No memory is placed by computed bytes: wgpu sizes its own.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

#[path = "support/fixture_files.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod support;

use luminaire_graph::compile::{CompileInput, compile};
use luminaire_graph::device::DeviceFacts;
use luminaire_graph::dump;
use luminaire_graph::harness::Harness;
use luminaire_graph::published::SceneCounts;
use luminaire_graph::source::{FileKind, MemoryFiles};

const PIPELINE: &str = r#"(
    doc: "A chain with one of everything.",
    params: {"edge": (default: 16), "strength": (default: 0.5)},
    resources: {
        "first": Texture(format: "rgba16float", size: Square("edge"), clear: Color(0.0, 0.0, 0.0, 1.0)),
        "depth": Texture(format: "depth32float", size: Square("edge"), clear: Depth(1.0)),
        "second": Texture(format: "rgba16float", size: Square("edge"), layers: 1),
        "apart": Texture(format: "rgba16float", size: Square(8)),
        "summed": Texture(format: "rgba16float", size: Square(8), clear: Zero),
    },
    passes: {
        "draw": Draw(
            shader: "draw.wgsl", objects: Opaque, view: Camera, cull: Back,
            depth: (test: LessEqual, write: true, bias: 0, slope_bias: 0.0),
            blend: {"color": Add}, write: {"color": "first", "depth": "depth"},
        ),
        "mix": Compute(shader: "mix.wgsl", entry: "mixed", constants: {"gain": 2}, cover: "second", read: {"source": "first"}, write: {"target_image": "second"}),
        "other": Clear(write: "apart", value: Color(1.0, 0.0, 0.0, 1.0)),
        "sum": Fullscreen(shader: "sum.wgsl", run: Accumulate(2), blend: {"color": Add}, read: {"source": "apart"}, modify: {"color": "summed"}),
    },
    outputs: {"color": "second", "apart": "apart", "sum": "summed"},
)"#;

const DRAW: &str = "
struct Camera { projection_from_world: mat4x4<f32> }
var<uniform> camera: Camera;
struct Vertex { position: vec3<f32> }
struct Output { color: vec4<f32> }
@vertex fn place(vertex: Vertex) -> @builtin(position) vec4<f32> { return camera.projection_from_world * vec4(vertex.position, 1.0); }
@fragment fn shade() -> Output { return Output(vec4(0.25)); }
";
const MIX: &str = "
var source: texture_2d<f32>;
var target_image: texture_storage_2d<rgba16float, write>;
struct Params { strength: f32 }
var<uniform> params: Params;
override gain: f32 = 1.0;
@compute @workgroup_size(8, 8) fn mixed(@builtin(global_invocation_id) id: vec3<u32>) {
    textureStore(target_image, id.xy, gain * params.strength * textureLoad(source, id.xy, 0));
}
@compute @workgroup_size(8, 8) fn plain(@builtin(global_invocation_id) id: vec3<u32>) {
    textureStore(target_image, id.xy, gain * params.strength * textureLoad(source, id.xy, 0) + vec4(1.0));
}
";
const SUM: &str = "
var source: texture_2d<f32>;
struct Output { color: vec4<f32> }
@fragment fn sum(@builtin(position) place: vec4<f32>) -> Output { return Output(textureLoad(source, vec2<i32>(place.xy), 0)); }
";

fn with<T>(pipeline: &str, shaders: [&str; 3], work: impl FnOnce(&CompileInput<'_>) -> T) -> T {
    let mut files = MemoryFiles::default().with(FileKind::Pipeline, "lessons.ron", pipeline);
    for (name, text) in ["draw.wgsl", "mix.wgsl", "sum.wgsl"].into_iter().zip(shaders) {
        files = files.with(FileKind::Shader, name, text);
    }
    work(&CompileInput {
        pipeline: "lessons.ron",
        files: &files,
        published: &support::schema(),
        counts: &SceneCounts::default(),
        device: &DeviceFacts::webgpu_defaults(),
        output: [64, 64],
        sets: &[],
        outputs: None,
    })
}

fn edited(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "`{from}` stands once");
    text.replace(from, to)
}

/// A key that leaves a setting out serves what was made with another one.
#[test]
fn every_setting_counts() {
    let chain: &[&str] = &["draw", "mix"];
    let edits: &[(&str, &str, &[&str])] = &[
        ("objects: Opaque", "objects: Masked", chain),
        ("view: Camera", "view: DirectionalLight(0)", chain),
        ("cull: Back", "cull: Front", chain),
        ("test: LessEqual", "test: Always", chain),
        ("test: LessEqual, write: true", "test: LessEqual, write: false", chain),
        ("bias: 0,", "bias: 1,", chain),
        ("slope_bias: 0.0", "slope_bias: 1.0", chain),
        ("blend: {\"color\": Add}, write", "blend: {\"color\": Max}, write", chain),
        ("blend: {\"color\": Add}, write", "write", chain),
        ("clear: Color(0.0, 0.0, 0.0, 1.0)", "clear: Color(0.0, 0.0, 0.0, 0.0)", chain),
        ("clear: Depth(1.0)", "clear: Depth(0.5)", chain),
        ("\"edge\": (default: 16)", "\"edge\": (default: 17)", chain),
        ("\"strength\": (default: 0.5)", "\"strength\": (default: 0.25)", &["mix"]),
        ("\"gain\": 2", "\"gain\": 3", &["mix"]),
        ("constants: {\"gain\": 2}, ", "", &["mix"]),
        ("entry: \"mixed\"", "entry: \"plain\"", &["mix"]),
        ("cover: \"second\"", "groups: (3, 3, 1)", &["mix"]),
        ("\"first\": Texture(format: \"rgba16float\"", "\"first\": Texture(format: \"rgba8unorm\"", chain),
        ("value: Color(1.0, 0.0, 0.0, 1.0)", "value: Color(1.0, 0.0, 0.0, 0.0)", &["other", "sum"]),
        ("Accumulate(2), blend: {\"color\": Add}", "Accumulate(2), blend: {\"color\": Max}", &["sum"]),
        ("Accumulate(2)", "Accumulate(3)", &["sum"]),
        (
            "\"summed\": Texture(format: \"rgba16float\", size: Square(8), clear: Zero)",
            "\"summed\": Texture(format: \"rgba16float\", size: Square(8), clear: Color(1.0, 1.0, 1.0, 1.0))",
            &["sum"],
        ),
    ];
    let shaders = [DRAW, MIX, SUM];
    for (from, to, expected) in edits {
        let mut harness = with(PIPELINE, shaders, Harness::new).unwrap();
        harness.settle(8).unwrap();
        // Slots follow the depth test.
        let mut changed = edited(PIPELINE, from, to);
        if to.contains("write: false") {
            changed = edited(
                &changed,
                "write: {\"color\": \"first\", \"depth\": \"depth\"}",
                "write: {\"color\": \"first\"}, read: {\"depth\": \"depth\"}",
            );
        }
        with(&changed, shaders, |input| harness.replan(input)).unwrap();
        assert_eq!(harness.frame(), *expected, "{from} -> {to}");
        // And the plan is that of a first reading.
        let plans = [harness.plan().clone(), with(&changed, shaders, |input| compile(input).plan.unwrap())];
        let [kept, fresh] = plans.map(|plan| dump::json(&plan, &Default::default()));
        assert_eq!(kept, fresh, "{from} -> {to}");
    }
    for (from, to, expected) in [("vec4(0.25)", "vec4(0.5)", chain), ("position, 1.0", "position, 2.0", chain)] {
        let mut harness = with(PIPELINE, shaders, Harness::new).unwrap();
        harness.settle(8).unwrap();
        with(PIPELINE, [&edited(DRAW, from, to), MIX, SUM], |input| harness.replan(input)).unwrap();
        assert_eq!(harness.frame(), *expected, "{from} -> {to}");
    }
}

/// What stands in comments, names for people and orders that mean nothing reaches no pass.
#[test]
fn what_means_nothing_runs_nothing() {
    let shaders = [DRAW, MIX, SUM];
    let mut harness = with(PIPELINE, shaders, Harness::new).unwrap();
    harness.settle(8).unwrap();
    let first = dump::json(harness.plan(), &Default::default());
    for _ in 0..3 {
        with(PIPELINE, shaders, |input| harness.replan(input)).unwrap();
        assert!(harness.frame().is_empty(), "the same file, read again");
        assert_eq!(dump::json(harness.plan(), &Default::default()), first);
    }
    let other = edited(
        &edited(PIPELINE, "A chain with", "// more\n A chain of"),
        "\"strength\": (default: 0.5)",
        "\"strength\": (default: 0.5, doc: \"How much.\")",
    );
    with(&other, shaders, |input| harness.replan(input)).unwrap();
    assert!(harness.frame().is_empty(), "words for people");
}

/// What can't be made again is still there when somebody wants it in a way that nobody did before.
#[test]
fn late_readers_leave_what_was_gathered() {
    let only = edited(
        PIPELINE,
        "\"summed\": Texture(",
        "\"shown\": Texture(format: \"rgba16float\", size: Square(8)), \"looked\": Texture(format: \"rgba16float\", size: Square(8)), \"summed\": Texture(",
    );
    let only = edited(&only, "\"sum\": \"summed\"", "\"sum\": \"shown\"");
    let copied = edited(&only, "\"other\": Clear(", "\"show\": Copy(read: \"summed\", write: \"shown\"), \"other\": Clear(");
    let sampled = edited(
        &copied,
        "\"other\": Clear(",
        "\"look\": Compute(shader: \"mix.wgsl\", entry: \"plain\", cover: \"looked\", read: {\"source\": \"summed\"}, write: {\"target_image\": \"looked\"}), \"other\": Clear(",
    );
    let sampled = edited(&sampled, "\"sum\": \"shown\"", "\"sum\": \"shown\", \"looked\": \"looked\"");
    let shaders = [DRAW, MIX, SUM];
    let mut harness = with(&copied, shaders, Harness::new).unwrap();
    assert!(harness.is_retained("summed"), "it can't be made again, though nobody reads it alone");
    harness.settle(8).unwrap();
    with(&sampled, shaders, |input| harness.replan(input)).unwrap();
    assert_eq!(harness.frame(), ["look"]);
}

/// Edits may come faster than frames.
#[test]
fn plans_without_a_frame_between_them_forget_nothing() {
    let shaders = [DRAW, MIX, SUM];
    let mut harness = with(PIPELINE, shaders, Harness::new).unwrap();
    harness.settle(8).unwrap();
    let other = edited(PIPELINE, "\"gain\": 2", "\"gain\": 3");
    for _ in 0..3 {
        with(&other, shaders, |input| harness.replan(input)).unwrap();
    }
    assert_eq!(harness.frame(), ["mix"]);
    let other = edited(&other, "value: Color(1.0, 0.0, 0.0, 1.0)", "value: Color(0.0, 0.0, 0.0, 1.0)");
    with(&other, shaders, |input| harness.replan(input)).unwrap();
    let again = edited(&other, "\"gain\": 3", "\"gain\": 4");
    with(&again, shaders, |input| harness.replan(input)).unwrap();
    assert_eq!(harness.frame(), ["mix", "other", "sum"]);
}

/// Bytes of one arena that another buffer had before.
#[test]
fn a_buffer_that_moves_within_its_arena_is_made_again() {
    const FILL: &str = "
var<storage, read_write> numbers: array<u32>;
@compute @workgroup_size(8) fn fill(@builtin(global_invocation_id) id: vec3<u32>) { numbers[id.x] = id.x; }
";
    const SHOW: &str = "
var<storage, read> one: array<u32>;
var<storage, read> two: array<u32>;
var texels: texture_storage_2d<r32float, write>;
@compute @workgroup_size(8, 8) fn show(@builtin(global_invocation_id) id: vec3<u32>) {
    textureStore(texels, id.xy, vec4(f32(one[id.x] + two[id.x])));
}
";
    let make = |name: &str| format!("\"make_{name}\": Compute(shader: \"draw.wgsl\", count: 8, write: {{\"numbers\": \"{name}\"}}), ");
    let show = |from: [&str; 2], to: &str| {
        let [one, two] = from;
        format!(
            "\"show_{to}\": Compute(shader: \"mix.wgsl\", cover: \"{to}\", read: {{\"one\": \"{one}\", \"two\": \"{two}\"}}, write: {{\"texels\": \"{to}\"}}), "
        )
    };
    let pipeline = |buffers: &str, passes: &str, outputs: &[&str]| {
        let textures: String = outputs.iter().map(|name| format!("\"{name}\": Texture(format: \"r32float\", size: Square(8)), ")).collect();
        let outputs: String = outputs.iter().map(|name| format!("\"{name}\": \"{name}\", ")).collect();
        format!("(doc: \"Buffers.\", resources: {{{buffers}{textures}}}, passes: {{{passes}}}, outputs: {{{outputs}}})")
    };
    // Three quarters of a KiB each time, of which `b` has the end, and then the start.
    let passes = make("a") + &make("b") + &show(["a", "b"], "x");
    let first = pipeline("\"a\": Buffer(size: 512), \"b\": Buffer(size: 256), ", &passes, &["x"]);
    let passes = make("b") + &make("c") + &make("d") + &show(["b", "c"], "x") + &show(["b", "d"], "y") + &show(["c", "d"], "z");
    let buffers = ["b", "c", "d"].map(|name| format!("\"{name}\": Buffer(size: 256), ")).concat();
    let second = pipeline(&buffers, &passes, &["x", "y", "z"]);
    let shaders = [FILL, SHOW, SUM];
    let mut harness = with(&first, shaders, Harness::new).unwrap();
    assert_eq!(harness.frame().len(), 3);
    let arena = |harness: &Harness| {
        let resource = harness.plan().resources.iter().find(|resource| resource.name == "b").unwrap();
        let placement = resource.placement.unwrap();
        (placement.offset, harness.plan().memories[placement.memory.index()].bytes)
    };
    let before = arena(&harness);
    with(&second, shaders, |input| harness.replan(input)).unwrap();
    let after = arena(&harness);
    assert!(before.0 != after.0 && before.1 == after.1, "{before:?} and {after:?}");
    assert!(harness.frame().contains(&"make_b".to_owned()));
}
