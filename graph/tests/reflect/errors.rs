//! What is refused, and how it is told.

use crate::support::check_problems;

#[track_caller]
fn check(text: &str, expected: &str) {
    check_problems(&[("main.wgsl", text)], expected);
}

#[test]
fn written_bindings_are_all_reported() {
    check(
        "@group(0) @binding(0) var<uniform> a: f32;
/* ü */ @binding(1) @group(2)
  var image: texture_2d<f32>;
@compute @workgroup_size(1) fn main() {}",
        "
        reflect::written-binding: the variable `a` has @group and @binding
        at main.wgsl:1:1 `@group(0)`: here
        hint leave them out: variables bind by name, and the compiler assigns groups and bindings
        reflect::written-binding: the variable `image` has @binding and @group
        at main.wgsl:2:9 `@binding(1)`: here
        hint leave them out: variables bind by name, and the compiler assigns groups and bindings
        ",
    );
}

#[test]
fn own_problems_and_those_of_naga_come_together() {
    check(
        "@group(0) @binding(0) var<uniform> a: f32;
@vertex fn main(@location(0) position: vec3<f32>) -> @location(0) vec4<f32> { return vec4<f32>(position, a); }",
        "
        reflect::written-binding: the variable `a` has @group and @binding
        at main.wgsl:1:1 `@group(0)`: here
        hint leave them out: variables bind by name, and the compiler assigns groups and bindings
        reflect::written-location: the vertex input `position` of `main` has @location
        at main.wgsl:2:30 `position`: here
        hint leave it out: vertex inputs and fragment outputs bind by name; only what goes from the vertex to the fragment stage has @location, in a struct of its own
        reflect::wgsl-invalid: the entry point `main` is invalid: Vertex shaders must return a `@builtin(position)` output value
        at main.wgsl:2:12 `main`: here
        ",
    );
}

#[test]
fn variables_that_nothing_can_feed() {
    check(
        "enable wgpu_binding_array; var many: binding_array<texture_2d<f32>>;
struct Nested { inner: array<atomic<f32>, 4> }
var<storage, read_write> sums: array<Nested>;
var<workgroup> fast: atomic<f32>;
var narrow: texture_storage_2d<r16unorm, write>;
var small: texture_storage_2d<r8unorm, write>;
var both: texture_storage_2d<rgba16float, read_write>;
var<immediate> constants: vec4<f32>;
var outside: texture_external;
@compute @workgroup_size(1) fn main() {}",
        "
        reflect::unsupported-variable: the variable `many` is a binding array, which no pipeline can bind
        at main.wgsl:1:32 `many`: declared here
        hint shaders can have uniform and storage buffers, textures, storage textures and samplers
        reflect::float-atomic: the variable `sums` holds float atomics (`array<Nested>`)
        at main.wgsl:3:26 `sums`: declared here
        hint their sums depend on the order of invocations; accumulate fixed-point numbers in `atomic<u32>`, or gather instead
        reflect::float-atomic: the variable `fast` holds float atomics (`atomic<f32>`)
        at main.wgsl:4:16 `fast`: declared here
        hint their sums depend on the order of invocations; accumulate fixed-point numbers in `atomic<u32>`, or gather instead
        reflect::storage-format: the storage texture `narrow` has format `r16unorm`, which is not known to pipelines
        at main.wgsl:5:5 `narrow`: declared here
        reflect::storage-format: the storage texture `small` has format `r8unorm`, which can't be stored to
        at main.wgsl:6:5 `small`: declared here
        reflect::storage-format: the storage texture `both` has format `rgba16float`, which can be read or written, not both by one variable
        at main.wgsl:7:5 `both`: declared here
        reflect::unsupported-variable: the variable `constants` is immediate data (a push constant), which no pipeline can bind
        at main.wgsl:8:16 `constants`: declared here
        hint shaders can have uniform and storage buffers, textures, storage textures and samplers
        reflect::unsupported-variable: the variable `outside` is an external texture, which no pipeline can bind
        at main.wgsl:9:5 `outside`: declared here
        hint shaders can have uniform and storage buffers, textures, storage textures and samplers
        ",
    );
}

#[test]
fn acceleration_structures_and_other_stages() {
    check(
        "enable wgpu_ray_query; var scene: acceleration_structure; @compute @workgroup_size(1) fn main() {}",
        "
        reflect::unsupported-variable: the variable `scene` is an acceleration structure, which no pipeline can bind
        at main.wgsl:1:28 `scene`: declared here
        hint shaders can have uniform and storage buffers, textures, storage textures and samplers
        ",
    );
}

#[test]
fn workgroup_sizes_without_a_value() {
    check(
        "override tile: u32;
override zero: u32 = 0;
override half: f32 = 0.5;
@compute @workgroup_size(tile * 2) fn first() {}
@compute @workgroup_size(1, zero) fn second() {}
@compute @workgroup_size(1, 1, u32(half) + 1) fn third() {}",
        "
        reflect::workgroup-size-override: the workgroup size of `first` has no value: along x, the override `tile` has no default
        at main.wgsl:4:39 `first`: this entry point
        hint give each override that it uses a default, and use whole-number arithmetic only
        reflect::workgroup-size-override: the workgroup size of `second` has no value: along y it would be 0
        at main.wgsl:5:38 `second`: this entry point
        hint give each override that it uses a default, and use whole-number arithmetic only
        reflect::workgroup-size-override: the workgroup size of `third` has no value: along z, a number is not whole
        at main.wgsl:6:50 `third`: this entry point
        hint give each override that it uses a default, and use whole-number arithmetic only
        ",
    );
}

#[test]
fn vertex_stages_write_nothing() {
    check(
        "var<storage, read_write> cells: array<f32>;
fn value() -> f32 { return cells[0]; }
@vertex fn main() -> @builtin(position) vec4<f32> { return vec4<f32>(value()); }",
        "
        reflect::vertex-stage-writable: the vertex entry point `main` uses `cells`, which it could write
        at main.wgsl:3:12 `main`: this entry point
        hint declare it `read`, or write it in a compute or fragment entry point
        ",
    );
}

#[test]
fn syntax_errors_have_all_their_labels_and_notes() {
    check(
        "// β\nfn a() -> f32 { let b: i32 = 1.5; return 2.0; }",
        "
        reflect::wgsl-syntax: the type of `b` is expected to be `i32`, but got `{AbstractFloat}`
        at main.wgsl:2:21 `b`: definition of `b`
        ",
    );
    check(
        "fn a() { let x = 1; x = 2; }",
        "
        reflect::wgsl-syntax: invalid left-hand side of assignment
        at main.wgsl:1:21 `x`: cannot assign to this expression
        at main.wgsl:1:14 `x`: this is an immutable binding
        note consider declaring `x` with `var` instead of `let`
        ",
    );
    check(
        "fn a() -> f32 { return 1.0;",
        "
        reflect::unbalanced-bracket: `{` has no partner in its file
        at main.wgsl:1:15 `{`: here
        ",
    );
}

#[test]
fn validation_errors_have_their_causes() {
    check(
        "struct A { a: f32, b: array<f32, 4> }\nvar<uniform> x: A;\n@compute @workgroup_size(1) fn main() { _ = x.a; }",
        "
        reflect::wgsl-invalid: the variable `x` is invalid: The array stride 4 is not a multiple of the required alignment 16
        at main.wgsl:2:1 `var<uniform> x: A;`: this variable
        note Alignment requirements for address space Uniform are not met by [1]
        ",
    );
    check(
        "@compute @workgroup_size(100000) fn main() {}",
        "
        reflect::wgsl-invalid: the entry point `main` is invalid: Workgroup size is out of range
        at main.wgsl:1:37 `main`: here
        ",
    );
    check(
        "@fragment fn main(@location(0) id: u32) {}",
        "
        reflect::wgsl-invalid: the entry point `main` is invalid: `@interpolate(flat) must be explicitly specified for integer I/O
        at main.wgsl:1:14 `main`: here
        note Argument 0 varying error
        ",
    );
    check(
        "@compute @workgroup_size(1) fn main() { let x: f64 = 1.0lf; }",
        "
        reflect::wgsl-invalid: the entry point `main` is invalid: Using `f64` values requires the `naga::valid::Capabilities::FLOAT64` flag
        at main.wgsl:1:54 `1.0lf`: this expression
        note Expression [0] is invalid
        ",
    );
}

#[test]
fn a_missing_shader_is_an_error() {
    use luminaire_graph::source::{MemoryFiles, SourceMap, Span};
    let schema = crate::support::published();
    let mut sources = SourceMap::default();
    let asked = sources.add("pipeline.ron", "\n  shader: \"x.wgsl\"");
    let problems =
        luminaire_graph::reflect::reflect("x.wgsl", Span::new(asked, 11, 19), &MemoryFiles::default(), &schema, &mut sources).unwrap_err();
    crate::support::check(
        &crate::support::describe_problems(&problems, &sources),
        "
        reflect::missing-shader: can't read the shader file `x.wgsl`: no such file (searched: memory)
        at pipeline.ron:2:11 `\"x.wgsl\"`: asked for here
        ",
    );
}
