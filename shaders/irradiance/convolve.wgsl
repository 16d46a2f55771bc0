// One face of a cube of irradiance / pi: a sum over all texels of a coarse level of the environment.

#import "environment/cube_texel.wgsl"
#import "shared/round_stored.wgsl"

struct Params {
    // The layer: six for each cube.
    f: u32,
}

var<uniform> params: Params;
// Six faces for each cube.
var source: texture_2d_array<f32>;

// Edge of the face that is made, in texels.
override edge: u32 = 1;

struct Targets {
    // Irradiance / pi, in units of the source.
    irradiance: vec4<f32>,
}

@fragment
fn convolve(@builtin(position) position: vec4<f32>) -> Targets {
    let first = params.f - params.f % 6u;
    let normal = normalize(cube_direction(params.f % 6u, place_on_face(position.xy, f32(edge))));
    let source_edge = textureDimensions(source).x;
    var sum = vec3<f32>(0.0);
    var weight = 0.0;
    for (var face = 0u; face < 6u; face++) {
        for (var index = 0u; index < source_edge * source_edge; index++) {
            let texel = vec2<u32>(index % source_edge, index / source_edge);
            let place = place_on_face(vec2<f32>(texel) + 0.5, f32(source_edge));
            let cosine = dot(normal, normalize(cube_direction(face, place)));
            if cosine > 0.0 {
                let covered = cosine * texel_solid_angle(texel, source_edge);
                sum += covered * textureLoad(source, texel, first + face, 0).rgb;
                weight += covered;
            }
        }
    }
    // The weights add up to pi, but for what the sum is off: a constant environment stays what it is.
    return Targets(vec4<f32>(round_stored(sum / weight), 1.0));
}
