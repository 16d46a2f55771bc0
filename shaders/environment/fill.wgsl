// One face of the environment cube: the mean of the sky's image over each texel, by solid angle.

#import "environment/cube_texel.wgsl"
#import "shared/round_stored.wgsl"
#import "skybox/sky_image.wgsl"

struct Params {
    // The face.
    f: u32,
    // Samples along the edge of a texel, at least.
    samples: u32,
}

var<uniform> params: Params;

// Edge of the face in texels.
override edge: u32 = 1;

// Samples along a texel of the image. Four see every texel's tent from all sides, so that one bright texel keeps its light.
const SAMPLES_PER_TEXEL: f32 = 4.0;
// Texels of the image beyond this number are sampled more thinly.
const MOST_SAMPLES: u32 = 32u;

struct Targets {
    // The image's nits / sky_unit.
    radiance: vec4<f32>,
}

@fragment
fn fill(@builtin(position) position: vec4<f32>) -> Targets {
    let image_edge = f32(textureDimensions(sky_image).x) / select(4.0, 2.0, environment.sky_has_faces == 1u);
    let wanted = u32(ceil(SAMPLES_PER_TEXEL * image_edge / f32(edge)));
    let samples = clamp(max(wanted, params.samples), 1u, MOST_SAMPLES);
    let corner = floor(position.xy);
    var sum = vec3<f32>(0.0);
    var weight = 0.0;
    for (var i = 0u; i < samples * samples; i++) {
        let part = (vec2<f32>(vec2<u32>(i % samples, i / samples)) + 0.5) / f32(samples);
        let place = place_on_face(corner + part, f32(edge));
        let covered = solid_angle_density(place);
        sum += covered * (sky_image_radiance(cube_direction(params.f, place)) / environment.sky_unit);
        weight += covered;
    }
    return Targets(vec4<f32>(round_stored(sum / weight), 1.0));
}
