// From a vertex to what an alpha test and a base colour need: the vertex stage of Draw passes that do not shade.

#import "shared/instances.wgsl"
#import "shared/view.wgsl"

struct TexturedVertex {
    position: vec3<f32>,
    uv0: vec2<f32>,
    uv1: vec2<f32>,
    color: vec4<f32>,
}

struct TexturedFragment {
    @builtin(position) clip_position: vec4<f32>,
    // First set in xy, second in zw.
    @location(0) uv: vec4<f32>,
    @location(1) color: vec4<f32>,
    @location(2) @interpolate(flat) material: u32,
}

fn transform_textured_vertex(vertex: TexturedVertex, instance_index: u32) -> TexturedFragment {
    let instance = drawn_instance(instance_index);
    let world = instance.world_from_object * vec4<f32>(vertex.position, 1.0);
    return TexturedFragment(
        view.projection_from_world * world,
        vec4<f32>(vertex.uv0, vertex.uv1),
        vertex.color,
        instance.material,
    );
}
