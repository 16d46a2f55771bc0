// Depth of opaque surfaces from a rectangle of light. No fragment shader: nothing but depth is wanted.

#import "shadow/rectangle_view.wgsl"
#import "shared/instances.wgsl"

struct Vertex {
    position: vec3<f32>,
}

@vertex
fn transform(vertex: Vertex, @builtin(instance_index) instance_index: u32) -> @builtin(position) vec4<f32> {
    let world = drawn_instance(instance_index).world_from_object * vec4<f32>(vertex.position, 1.0);
    return seen_from_rectangle(view.projection_from_world * world);
}
