// Depth of opaque surfaces from a light's view. No fragment shader: nothing but depth is wanted.

#import "shared/instances.wgsl"
#import "shared/map_shift.wgsl"
#import "shared/view.wgsl"

struct Vertex {
    position: vec3<f32>,
}

struct Params {
    // Along an edge of the map.
    texels: u32,
}

var<uniform> params: Params;

@vertex
fn transform(vertex: Vertex, @builtin(instance_index) instance_index: u32) -> @builtin(position) vec4<f32> {
    let world = drawn_instance(instance_index).world_from_object * vec4<f32>(vertex.position, 1.0);
    return shifted_on_map(view.projection_from_world * world, params.texels);
}
