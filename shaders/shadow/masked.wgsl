// Depth of masked surfaces from a light's view: what their alpha cuts out casts no shadow.

#import "shared/material_textures.wgsl"
#import "shared/map_shift.wgsl"
#import "shared/textured_vertex.wgsl"

struct Params {
    // Along an edge of the map.
    texels: u32,
}

var<uniform> params: Params;

@vertex
fn transform(vertex: TexturedVertex, @builtin(instance_index) instance_index: u32) -> TexturedFragment {
    var fragment = transform_textured_vertex(vertex, instance_index);
    fragment.clip_position = shifted_on_map(fragment.clip_position, params.texels);
    return fragment;
}

@fragment
fn cut(fragment: TexturedFragment) {
    let color = base_color_at(fragment.material, fragment.uv, fragment.color);
    if is_cut_out(fragment.material, color.a) {
        discard;
    }
}
