// Places from which the scene is captured: the published table `reflection_probes`.

struct ReflectionProbe {
    // From where: the middle of the box.
    position: vec3<f32>,
    // Near plane of the faces of its cube, metres.
    near: f32,
    // World to the box in which it counts, whose corners are at -1 and 1 there.
    box_from_world: mat4x4<f32>,
    // Far plane of the faces, metres; 0 where there is no probe.
    far: f32,
}

var<storage, read> reflection_probes: array<ReflectionProbe>;
