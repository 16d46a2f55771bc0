// A level of a cube from the one above: the mean of four texels by their solid angles, so that every level sends as much light.

#import "environment/cube_texel.wgsl"
#import "shared/round_half.wgsl"

// The six faces.
var finer: texture_2d_array<f32>;
var coarser: texture_storage_2d_array<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn halve(@builtin(global_invocation_id) id: vec3<u32>) {
    let edge = textureDimensions(coarser).x;
    if any(id.xy >= vec2<u32>(edge)) {
        return;
    }
    var sum = vec3<f32>(0.0);
    var weight = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let texel = 2u * id.xy + vec2<u32>(i & 1u, i >> 1u);
        let covered = texel_solid_angle(texel, 2u * edge);
        sum += covered * textureLoad(finer, texel, id.z, 0).rgb;
        weight += covered;
    }
    textureStore(coarser, id.xy, id.z, vec4<f32>(round_half(sum / weight), 1.0));
}
