// From a vertex of a mesh to what a fragment shader needs: the vertex stage of Draw passes that shade.

#import "shared/instances.wgsl"
#import "shared/view.wgsl"

// The vertex attributes, by name. A scene without the second set of coordinates has zeros there, one without colours white.
struct MeshVertex {
    position: vec3<f32>,
    normal: vec3<f32>,
    tangent: vec4<f32>,
    uv0: vec2<f32>,
    uv1: vec2<f32>,
    color: vec4<f32>,
}

struct MeshFragment {
    @builtin(position) clip_position: vec4<f32>,
    // World position minus the eye's. Differences between neighbours, which give the geometric normal, keep their precision far
    // from the origin.
    @location(0) from_eye: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // xyz in the world; w the sign of the bitangent, the transform's mirroring included.
    @location(2) tangent: vec4<f32>,
    // First set in xy, second in zw.
    @location(3) uv: vec4<f32>,
    @location(4) color: vec4<f32>,
    @location(5) @interpolate(flat) material: u32,
}

fn transform_mesh_vertex(vertex: MeshVertex, instance_index: u32) -> MeshFragment {
    let instance = drawn_instance(instance_index);
    let world = (instance.world_from_object * vec4<f32>(vertex.position, 1.0)).xyz;
    let mirroring = instance.normal_from_object_0.w;

    var fragment: MeshFragment;
    fragment.clip_position = view.projection_from_world * vec4<f32>(world, 1.0);
    fragment.from_eye = world - view.position;
    fragment.normal = normal_to_world(instance, vertex.normal);
    let tangent = (instance.world_from_object * vec4<f32>(vertex.tangent.xyz, 0.0)).xyz;
    fragment.tangent = vec4<f32>(tangent, vertex.tangent.w * mirroring);
    fragment.uv = vec4<f32>(vertex.uv0, vertex.uv1);
    fragment.color = vertex.color;
    fragment.material = instance.material;
    return fragment;
}
