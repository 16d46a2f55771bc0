//! Vertex inputs, varyings and fragment outputs.

use crate::support::{check, check_interface, check_problems, describe_problems, run, shader};
use luminaire_graph::reflect::{check_fullscreen_inputs, check_varyings};

const DRAW: &str = "
    struct Input { position: vec3<f32>, @builtin(instance_index) instance: u32, normal: vec3<f32>, uv0: vec2<f32> }
    struct Varyings { @builtin(position) clip: vec4<f32>, @location(1) uv: vec2<f32>, @location(0) @interpolate(flat) id: u32 }
    struct Output { color: vec4<f32>, @builtin(frag_depth) depth: f32, ids: vec2<u32>, weight: f32 }
    @vertex fn vertex_main(in: Input, @builtin(vertex_index) index: u32, tangent: vec4<f32>) -> Varyings {
        return Varyings(vec4<f32>(in.position + in.normal, tangent.w), in.uv0, in.instance + index);
    }
    // The same struct of inputs at the same locations.
    @vertex fn vertex_shadow(in: Input) -> @builtin(position) vec4<f32> { return vec4<f32>(in.position, 1.0); }
    @vertex fn vertex_direct(@builtin(vertex_index) i: u32, uv0: vec2<f32>, color: f32) -> @builtin(position) vec4<f32> {
        return vec4<f32>(uv0, color, f32(i));
    }
    fn maybe(id: u32) { if (id == 3u) { discard; } }
    @fragment fn fragment_main(in: Varyings) -> Output { maybe(in.id); return Output(vec4<f32>(in.uv, 0.0, 1.0), 0.5, vec2<u32>(in.id), 1.0); }
    @fragment fn fragment_depth(@builtin(position) at: vec4<f32>) -> @builtin(frag_depth) f32 { return at.z; }
    @fragment fn fragment_nothing() {}
    @fragment fn fragment_screen(@location(0) uv: vec2<f32>) -> Output { return Output(vec4<f32>(uv, 0.0, 1.0), 0.5, vec2<u32>(0u), 1.0); }
";

#[test]
fn locations_follow_the_order_of_names() {
    check_interface(
        DRAW,
        "
        Vertex vertex_main
        vertex 0 position x3
        vertex 1 normal x3
        vertex 2 uv0 x2
        vertex 3 tangent x4
        varying 0 id: u32 flat, first
        varying 1 uv: vec2<f32> perspective, center
        Vertex vertex_shadow
        vertex 0 position x3
        vertex 1 normal x3
        vertex 2 uv0 x2
        Vertex vertex_direct
        vertex 0 uv0 x2
        vertex 1 color x1
        Fragment fragment_main writes-depth discards
        varying 0 id: u32 flat, first
        varying 1 uv: vec2<f32> perspective, center
        color 0 color Float x4
        color 1 ids Uint x2
        color 2 weight Float x1
        Fragment fragment_depth writes-depth
        Fragment fragment_nothing
        Fragment fragment_screen writes-depth
        varying 0 uv: vec2<f32> perspective, center
        color 0 color Float x4
        color 1 ids Uint x2
        color 2 weight Float x1
        ",
    );
}

#[test]
fn stages_must_fit() {
    let shader = shader(DRAW);
    let entry = |name: &str| shader.entries.iter().find(|entry| entry.name == name).unwrap();
    assert_eq!(check_varyings(entry("vertex_main"), entry("fragment_main")), []);
    assert_eq!(check_fullscreen_inputs(entry("fragment_screen")), []);
    assert_eq!(check_fullscreen_inputs(entry("fragment_depth")), []);
    let (_, sources) = run(&[("main.wgsl", DRAW)]);
    let problems = [
        check_fullscreen_inputs(entry("fragment_main")),
        check_varyings(entry("vertex_shadow"), entry("fragment_screen")),
        check_varyings(entry("vertex_main"), entry("fragment_screen")),
    ]
    .concat();
    check(
        &describe_problems(&problems, &sources),
        "
        reflect::fullscreen-input: a fullscreen pass can't feed the input `id` of `fragment_main`
        at main.wgsl:3:119 `id`: @location(0), `u32`, interpolated flat, first
        hint fullscreen passes have builtins and `@location(0) uv: vec2<f32>`, (0, 0) at the top left
        reflect::fullscreen-input: a fullscreen pass can't feed the input `uv` of `fragment_main`
        at main.wgsl:3:72 `uv`: @location(1), `vec2<f32>`, interpolated perspective, center
        hint fullscreen passes have builtins and `@location(0) uv: vec2<f32>`, (0, 0) at the top left
        reflect::varying-mismatch: `fragment_screen` expects `uv` at @location(0), which `vertex_shadow` does not send
        at main.wgsl:17:47 `uv`: expected here
        at main.wgsl:9:16 `vertex_shadow`: the vertex entry point
        reflect::varying-mismatch: `id` of `vertex_main` and `uv` of `fragment_screen` share @location(0) and have different types
        at main.wgsl:17:47 `uv`: expects `vec2<f32>`
        at main.wgsl:3:119 `id`: sends `u32`
        reflect::varying-mismatch: `id` of `vertex_main` and `uv` of `fragment_screen` share @location(0) and have different interpolation
        at main.wgsl:17:47 `uv`: expects `perspective, center`
        at main.wgsl:3:119 `id`: sends `flat, first`
        ",
    );
}

#[test]
fn written_and_missing_locations() {
    check_problems(
        &[(
            "main.wgsl",
            "struct Input { @location(0) position: vec3<f32>, bones: vec4<u32> }
struct Varyings { @builtin(position) clip: vec4<f32>, uv: vec2<f32> }
@vertex fn vertex_main(in: Input, @location(3) color: vec4<f32>) -> Varyings { return Varyings(vec4<f32>(in.position, 1.0), color.xy); }
@fragment fn fragment_main(in: Varyings, more: f32) -> @location(0) vec4<f32> { return vec4<f32>(1.0); }
struct Output { @location(0) color: vec4<f32>, flag: vec2<f32>, deep: mat2x2<f32> }
@fragment fn fragment_struct() -> Output { var out: Output; return out; }
@vertex fn twice(a: Other, b: Input) -> @builtin(position) vec4<f32> { return vec4<f32>(a.other); }
struct Other { other: f32 }",
        )],
        "
        reflect::written-location: the vertex input `position` of `vertex_main` has @location
        at main.wgsl:1:29 `position`: here
        hint leave it out: vertex inputs and fragment outputs bind by name; only what goes from the vertex to the fragment stage has @location, in a struct of its own
        reflect::written-location: the vertex input `color` of `vertex_main` has @location
        at main.wgsl:3:48 `color`: here
        hint leave it out: vertex inputs and fragment outputs bind by name; only what goes from the vertex to the fragment stage has @location, in a struct of its own
        reflect::vertex-input-type: the vertex input `bones` of `vertex_main` has type `vec4<u32>`
        at main.wgsl:1:50 `bones`: this input
        hint vertex inputs are `f32`, `vec2<f32>`, `vec3<f32>` or `vec4<f32>`
        reflect::missing-location: the output `uv` of `vertex_main` has no @location
        at main.wgsl:2:55 `uv`: here
        hint values between the vertex and the fragment stage need @location(n), equal on both sides
        reflect::missing-location: the input `more` of `fragment_main` has no @location
        at main.wgsl:4:42 `more`: here
        hint values between the vertex and the fragment stage need @location(n), equal on both sides
        reflect::unnamed-output: the fragment entry point `fragment_main` returns a value that has no name
        at main.wgsl:4:53 `-> @location(0) vec4<f32>`: this result
        hint return a struct whose members are named after the slots that they write, without @location
        reflect::written-location: the fragment output `color` of `fragment_struct` has @location
        at main.wgsl:5:30 `color`: here
        hint leave it out: vertex inputs and fragment outputs bind by name; only what goes from the vertex to the fragment stage has @location, in a struct of its own
        reflect::output-type: the output `deep` of `fragment_struct` has type `mat2x2<f32>`
        at main.wgsl:5:65 `deep`: this output
        hint color outputs are 32-bit numbers or vectors of them
        reflect::two-input-structs: the vertex entry point `twice` takes its inputs from more than one struct
        at main.wgsl:7:12 `twice`: this entry point
        hint put all vertex inputs into one struct
        ",
    );
}
