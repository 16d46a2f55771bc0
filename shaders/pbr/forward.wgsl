// Surfaces that are shaded as they are drawn: emission and direct light. Those that blend come over what stands behind.

#import "shared/direct_light.wgsl"
#import "shared/forward_surface.wgsl"
#import "shared/jittered_vertex.wgsl"

struct Targets {
    // Radiance / light_unit, and how much of what is behind is covered.
    light: vec4<f32>,
}

@fragment
fn shade(fragment: MeshFragment, @builtin(front_facing) front_facing: bool) -> Targets {
    var drawn = drawn_surface(fragment, front_facing);
    if is_cut_out(fragment.material, drawn.alpha) {
        discard;
    }
    drawn.point.pixel = pixel_of_sample(drawn.point.pixel);
    return Targets(vec4<f32>(fit_half(emitted_and_direct_light(drawn.point, vec2<u32>(fragment.clip_position.xy))), saturate(drawn.alpha)));
}
