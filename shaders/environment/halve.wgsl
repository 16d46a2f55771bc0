// A level of one face of a cube from the one above: the mean of four texels by their solid angles, so that every level sends as much light.

#import "environment/cube_texel.wgsl"
#import "shared/round_stored.wgsl"

var finer: texture_2d<f32>;

struct Targets {
    // In units of the level above.
    coarser: vec4<f32>,
}

@fragment
fn halve(@builtin(position) position: vec4<f32>) -> Targets {
    let edge = textureDimensions(finer).x;
    let corner = 2u * vec2<u32>(position.xy);
    var sum = vec3<f32>(0.0);
    var weight = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let texel = corner + vec2<u32>(i & 1u, i >> 1u);
        let covered = texel_solid_angle(texel, edge);
        sum += covered * textureLoad(finer, texel, 0).rgb;
        weight += covered;
    }
    return Targets(vec4<f32>(round_stored(sum / weight), 1.0));
}
