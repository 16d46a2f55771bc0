// Base colour of what the camera sees: the smallest shader that draws a scene.
//
// `view`, `instances`, `materials` and the material's textures come from the scene, by name. The vertex shader asks for the vertex
// attributes that it wants, by name. Nothing has a binding or a location, except what goes from the vertex to the fragment shader.

#import "shared/instances.wgsl"
#import "shared/material_textures.wgsl"
#import "shared/view.wgsl"

struct Vertex {
    position: vec3<f32>,
    uv0: vec2<f32>,
    uv1: vec2<f32>,
    color: vec4<f32>,
}

struct Varyings {
    @builtin(position) clip_position: vec4<f32>,
    @location(0) uv: vec4<f32>,
    @location(1) color: vec4<f32>,
    @location(2) @interpolate(flat) material: u32,
}

// The members are the names of the pass's `write` slots.
struct Targets {
    color: vec4<f32>,
}

@vertex
fn transform(vertex: Vertex, @builtin(instance_index) instance_index: u32) -> Varyings {
    let instance = drawn_instance(instance_index);
    let world = instance.world_from_object * vec4<f32>(vertex.position, 1.0);
    return Varyings(
        view.projection_from_world * world,
        vec4<f32>(vertex.uv0, vertex.uv1),
        vertex.color,
        instance.material,
    );
}

@fragment
fn paint(varyings: Varyings) -> Targets {
    let color = base_color_at(varyings.material, varyings.uv, varyings.color);
    if is_cut_out(varyings.material, color.a) {
        discard;
    }
    return Targets(vec4<f32>(color.rgb, 1.0));
}
