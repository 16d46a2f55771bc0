// Objects in the world: the published tables `instances` and `instance_slots`.
//
// Draws are instanced. An object keeps its slot in `instances` for life; `instance_slots` lists, per draw, which slots it draws.

struct Instance {
    world_from_object: mat4x4<f32>,
    // Columns of the inverse transpose of the above, for normals. The fourth component of the first is the sign of the
    // determinant: -1 if the transform mirrors.
    normal_from_object_0: vec4<f32>,
    normal_from_object_1: vec4<f32>,
    normal_from_object_2: vec4<f32>,
    // Index into `materials`.
    material: u32,
    // Stable number of the object.
    object: u32,
}

var<storage, read> instances: array<Instance>;
var<storage, read> instance_slots: array<u32>;

// The instance that a vertex shader draws, from its `@builtin(instance_index)`.
fn drawn_instance(instance_index: u32) -> Instance {
    return instances[instance_slots[instance_index]];
}

fn normal_to_world(instance: Instance, normal: vec3<f32>) -> vec3<f32> {
    return instance.normal_from_object_0.xyz * normal.x
        + instance.normal_from_object_1.xyz * normal.y
        + instance.normal_from_object_2.xyz * normal.z;
}
