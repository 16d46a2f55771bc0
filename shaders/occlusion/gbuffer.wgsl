// As much of the G-buffer as occlusion reads: depth and normals (shared/gbuffer.wgsl).

#import "shared/forward_surface.wgsl"
#import "shared/gbuffer.wgsl"
#import "shared/jittered_vertex.wgsl"

struct Targets {
    normals: vec2<u32>,
}

@fragment
fn store(fragment: MeshFragment, @builtin(front_facing) front_facing: bool) -> Targets {
    let drawn = drawn_surface(fragment, front_facing);
    if is_cut_out(fragment.material, drawn.alpha) {
        discard;
    }
    return Targets(encode_gbuffer(drawn.point).normals);
}
