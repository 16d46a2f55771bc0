// Depth of masked surfaces from a rectangle of light: what their alpha cuts out casts no shadow.

#import "shadow/rectangle_view.wgsl"
#import "shared/material_textures.wgsl"
#import "shared/textured_vertex.wgsl"

@vertex
fn transform(vertex: TexturedVertex, @builtin(instance_index) instance_index: u32) -> TexturedFragment {
    var fragment = transform_textured_vertex(vertex, instance_index);
    fragment.clip_position = seen_from_rectangle(fragment.clip_position);
    return fragment;
}

@fragment
fn cut(fragment: TexturedFragment) {
    let color = base_color_at(fragment.material, fragment.uv, fragment.color);
    if is_cut_out(fragment.material, color.a) {
        discard;
    }
}
