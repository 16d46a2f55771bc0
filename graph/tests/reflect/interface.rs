//! Variables, layouts, uses, overrides and features.

use crate::support::{check, check_interface, describe, run, shader};

#[test]
fn unused_variables_are_dropped_and_bindings_follow_the_text() {
    check_interface(
        "
        // `b` is declared before `a`, and functions stand before what they use.
        @compute @workgroup_size(8, 4) fn second() { _ = helper(); }
        fn helper() -> f32 { return a.value + textureLoad(image, vec2<i32>(0), 0).x; }
        var<uniform> b: Values;
        struct Values { direction: vec3<f32>, value: f32, matrix: mat4x4<f32>, list: array<vec4<f32>, 14> }
        var<uniform> a: Values;
        var image: texture_2d<f32>;
        var<private> scratch: f32;
        var<workgroup> shared_values: array<f32, 4>;
        var base_color_texture: texture_2d<f32>;
        @compute @workgroup_size(1) fn first() { scratch = b.value; shared_values[0] = 1.0; }
        ",
        "
        Compute second [8, 4, 1]
        0.1 a: uniform 304 bytes [direction: vec3<f32> @0, value: f32 @12, matrix: mat4x4<f32> @16, list: array<vec4<f32>, 14> @80]
        0.2 image: texture D2 Float
        Compute first [1, 1, 1]
        0.0 b: uniform 304 bytes [direction: vec3<f32> @0, value: f32 @12, matrix: mat4x4<f32> @16, list: array<vec4<f32>, 14> @80]
        ",
    );
}

#[test]
fn material_bindings_stand_at_their_place_in_the_schema() {
    check_interface(
        "
        var other: texture_2d<f32>;
        var normal_sampler: sampler;
        var normal_texture: texture_2d<f32>;
        var<uniform> base_color_texture: vec4<f32>;
        @compute @workgroup_size(1) fn main() {
            _ = textureSampleLevel(normal_texture, normal_sampler, vec2<f32>(0.0), 0.0);
            _ = textureLoad(other, vec2<u32>(0u), 0) + base_color_texture;
        }
        ",
        "
        Compute main [1, 1, 1]
        0.0 other: texture D2 Float
        1.3 normal_sampler: sampler
        1.1 normal_texture: texture D2 Float filtered
        0.1 base_color_texture: uniform 16 bytes []
        ",
    );
}

#[test]
fn reads_and_writes_are_told_apart_through_callees() {
    check_interface(
        "
        struct Counter { total: atomic<u32>, items: array<vec3<u32>> }
        struct Item { position: vec3<f32>, index: u32 }
        var<storage, read> source: array<Item>;
        var<storage, read_write> written: array<u32>;
        var<storage, read_write> both: array<u32>;
        var<storage, read_write> only_read: array<u32>;
        var<storage, read_write> counter: Counter;
        var<storage, read> length_only: array<vec3<f32>>;
        fn deepest(index: u32) { both[index] += 1u; let target_cell = &written[index]; *target_cell = 4u; }
        fn middle(index: u32) { if (index > 3u) { loop { deepest(index); break; } } }
        @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            middle(only_read[id.x] + source[id.x].index);
            atomicAdd(&counter.total, arrayLength(&length_only));
        }
        @compute @workgroup_size(64) fn other() { _ = only_read[0]; }
        ",
        "
        Compute main [64, 1, 1]
        0.0 source: storage reads 16 bytes each [position: vec3<f32> @0, index: u32 @12]
        0.1 written: storage writable writes 4 bytes each []
        0.2 both: storage writable reads writes 4 bytes each []
        0.3 only_read: storage writable reads 4 bytes each []
        0.4 counter: storage writable reads writes 32 bytes each [total: atomic<u32> @0, items: array<vec3<u32>> @16]
        0.5 length_only: storage 16 bytes each []
        Compute other [64, 1, 1]
        0.3 only_read: storage writable reads 4 bytes each []
        ",
    );
}

#[test]
fn textures_are_filtered_where_their_sampler_filters() {
    check_interface(
        "
        var linear_clamp: sampler;
        var nearest_clamp: sampler;
        var compare_less: sampler_comparison;
        var smooth_image: texture_2d<f32>;
        var sharp: texture_2d<f32>;
        var both: texture_cube<f32>;
        var gathered: texture_2d_array<f32>;
        var shadow: texture_depth_2d_array;
        var samples: texture_multisampled_2d<f32>;
        var ids: texture_3d<u32>;
        fn look(image: texture_2d<f32>, how: sampler) -> vec4<f32> { return textureSampleLevel(image, how, vec2<f32>(0.5), 0.0); }
        @compute @workgroup_size(1) fn main() {
            _ = look(smooth_image, linear_clamp) + look(sharp, nearest_clamp);
            _ = textureSampleLevel(both, nearest_clamp, vec3<f32>(1.0), 0.0) + textureSampleLevel(both, linear_clamp, vec3<f32>(1.0), 0.0);
            _ = textureGather(0, gathered, linear_clamp, vec2<f32>(0.5), 0);
            _ = textureSampleCompareLevel(shadow, compare_less, vec2<f32>(0.5), 0, 0.5);
            _ = textureLoad(samples, vec2<u32>(0u), 0);
            _ = textureLoad(ids, vec3<u32>(0u), 0);
        }
        @compute @workgroup_size(1) fn sharp_only() { _ = look(smooth_image, nearest_clamp) + textureSampleLevel(both, nearest_clamp, vec3<f32>(1.0), 0.0); }
        ",
        "
        Compute main [1, 1, 1]
        0.0 linear_clamp: sampler
        0.1 nearest_clamp: sampler
        0.2 compare_less: sampler comparison
        0.3 smooth_image: texture D2 Float filtered
        0.4 sharp: texture D2 Float
        0.5 both: texture Cube Float filtered
        0.6 gathered: texture D2Array Float filtered
        0.7 shadow: depth D2Array
        0.8 samples: texture D2 Float multisampled
        0.9 ids: texture D3 Uint
        Compute sharp_only [1, 1, 1]
        0.1 nearest_clamp: sampler
        0.3 smooth_image: texture D2 Float
        0.5 both: texture Cube Float
        ",
    );
}

#[test]
fn storage_textures_have_the_access_of_their_type() {
    check_interface(
        "
        var target_image: texture_storage_2d<rgba16float, write>;
        var volume: texture_storage_3d<r32uint, read_write>;
        var layers: texture_storage_2d_array<rgba8unorm, read>;
        fn store() { textureStore(target_image, vec2<i32>(0), vec4<f32>(1.0)); }
        @compute @workgroup_size(1) fn main() {
            store();
            textureStore(volume, vec3<i32>(0), textureLoad(volume, vec3<i32>(1)));
            _ = textureLoad(layers, vec2<i32>(0), 1);
        }
        ",
        "
        Compute main [1, 1, 1]
        0.0 target_image: storage-texture D2 rgba16float Write
        0.1 volume: storage-texture D3 r32uint ReadWrite
        0.2 layers: storage-texture D2Array rgba8unorm Read
        ",
    );
}

#[test]
fn overrides_belong_to_the_entries_that_use_them() {
    let text = "
        override tile: u32 = 4;
        override taps: i32 = 3;
        @id(7) override debug: bool = false;
        override scale: f32;
        override derived: f32 = scale * 2.0;
        override unused = 1.0;
        const half = 2u;
        var<workgroup> cache: array<f32, tile * tile>;
        var<private> start: f32 = derived;
        fn helper() -> f32 { if (debug) { return start; } return 0.0; }
        @compute @workgroup_size(tile * half, tile - 1, 2) fn sized() { cache[0] = 1.0; }
        @compute @workgroup_size(1) fn called() { _ = helper(); }
        @compute @workgroup_size(1) fn direct() { for (var i = 0; i < taps; i++) { _ = i; } }
    ";
    check_interface(
        text,
        "
        override tile: u32 with default
        override taps: i32 with default
        override debug: bool with default
        override scale: f32
        override derived: f32 with default
        override unused: f32 with default
        Compute sized [8, 3, 2] overrides tile
        Compute called [1, 1, 1] overrides debug scale derived
        Compute direct [1, 1, 1] overrides taps
        ",
    );
    let shader = shader(text);
    let with = |tile: f64| shader.workgroup_size("sized", &|name| (name == "tile").then_some(tile));
    assert_eq!(with(8.0), Some([16, 7, 2]));
    assert_eq!(with(1.0), None);
    assert_eq!(with(1.5), None);
    assert_eq!(shader.workgroup_size("nothing", &|_| None), None);
    assert_eq!(shader.variable_type("cache").as_deref(), Some("array<f32, ?>"));
    assert!(shader.module.overrides.iter().all(|(_, constant)| constant.id.is_none()));
}

#[test]
fn features_are_those_without_which_the_module_is_invalid() {
    check_interface("@compute @workgroup_size(1) fn main() { _ = pack2x16float(vec2<f32>(1.0)); }", "Compute main [1, 1, 1]");
    check_interface(
        "enable f16; @compute @workgroup_size(1) fn main() { var x = 1.0h; x += 1.0h; }",
        "needs shader-f16
         Compute main [1, 1, 1]",
    );
    check_interface(
        "@compute @workgroup_size(64) fn main() { _ = subgroupAdd(1u); }",
        "needs subgroups
         Compute main [64, 1, 1]",
    );
    check_interface(
        "enable primitive_index; @fragment fn main(@builtin(primitive_index) id: u32) { if (id == 1u) { discard; } }",
        "needs primitive-index
         Fragment main discards",
    );
}

#[test]
fn many_passes_of_one_file_give_the_same_interface() {
    let text = "
        struct A { a: f32 } struct B { b: f32 } struct C { c: f32 }
        var<uniform> z: A; var<uniform> y: B; var<uniform> x: C;
        @compute @workgroup_size(1) fn main() { _ = x.c + y.b + z.a; }
        @compute @workgroup_size(1) fn main_2() { _ = z.a; }
    ";
    let first = shader(text);
    for _ in 0..10 {
        let again = shader(text);
        assert_eq!(first.entries, again.entries);
        assert_eq!(format!("{:?}", first.module), format!("{:?}", again.module));
    }
}

#[test]
fn an_empty_shader_is_a_shader() {
    let (result, _) = run(&[("main.wgsl", "")]);
    check(&describe(&result.unwrap()), "");
}
