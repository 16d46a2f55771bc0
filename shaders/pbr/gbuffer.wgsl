// What the camera sees, with everything that shading needs to know. Layout: shared/gbuffer.wgsl.

#import "shared/forward_surface.wgsl"
#import "shared/gbuffer.wgsl"
#import "shared/jittered_vertex.wgsl"

@fragment
fn store(fragment: MeshFragment, @builtin(front_facing) front_facing: bool) -> GbufferTexel {
    let drawn = drawn_surface(fragment, front_facing);
    if is_cut_out(fragment.material, drawn.alpha) {
        discard;
    }
    return encode_gbuffer(drawn.point);
}
