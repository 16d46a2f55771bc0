// Base colour of what the camera sees: the smallest shader that draws a scene.
//
// `view`, `instances`, `materials` and the material's textures come from the scene, by name. The vertex shader asks for the vertex
// attributes that it wants, by name. Nothing has a binding or a location, except what goes from the vertex to the fragment shader.

#import "shared/material_textures.wgsl"
#import "shared/textured_vertex.wgsl"

// The members are the names of the pass's `write` slots.
struct Targets {
    color: vec4<f32>,
}

@vertex
fn transform(vertex: TexturedVertex, @builtin(instance_index) instance_index: u32) -> TexturedFragment {
    return transform_textured_vertex(vertex, instance_index);
}

@fragment
fn paint(fragment: TexturedFragment) -> Targets {
    let color = base_color_at(fragment.material, fragment.uv, fragment.color);
    if is_cut_out(fragment.material, color.a) {
        discard;
    }
    return Targets(vec4<f32>(color.rgb, 1.0));
}
