// The vertex shader of what is drawn from the camera: moved to where the frame's sample lies in each pixel.

#import "shared/jitter.wgsl"
#import "shared/mesh.wgsl"

@vertex
fn transform(vertex: MeshVertex, @builtin(instance_index) instance_index: u32) -> MeshFragment {
    var fragment = transform_mesh_vertex(vertex, instance_index);
    fragment.clip_position = jittered(fragment.clip_position);
    return fragment;
}
