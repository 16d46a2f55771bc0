// One face of one level of a prefiltered cube: the mean of the environment over the GGX lobe that is seen along its axis (n = v = r).
//
// Karis 2013, "Real Shading in Unreal Engine 4": the first factor of the split sum, weights D(h) (n.l) / 4. Narrow lobes take samples of
// half vectors, each from the level of the source whose texels are as large as the sample's share of the lobe (Krivanek and Colbert 2008,
// "Real-time Shading with Filtered Importance Sampling"). Wide ones are summed over all texels of a coarse level: no sample can miss
// what is small and bright.

#import "environment/cube_texel.wgsl"
#import "prefilter/levels.wgsl"
#import "shared/brdf.wgsl"
#import "shared/frame.wgsl"
#import "shared/round_half.wgsl"
#import "shared/sobol.wgsl"

struct Params {
    // 6 * level + face, of the first cube; the others follow.
    i: u32,
    // Half vectors of level 0; each level takes twice as many as the one before.
    samples: u32,
}

var<uniform> params: Params;
// All levels of the cubes.
var source: texture_cube_array<f32>;
// Six faces for each cube, of the level that wide lobes are summed over.
var coarse: texture_2d_array<f32>;
var linear_clamp: sampler;

// Edge of level 0 of the cube that is made, and how many levels it has.
override edge: u32 = 1;
override levels: u32 = 1;

// From here a lobe is 6 texels of a coarse level of 32 texels wide at half its height.
const LEAST_SUMMED_ALPHA: f32 = 0.115;
// A sample takes the level whose texels are twice as large along each edge as its share: neighbours overlap, and leave no grain.
const LEVEL_BIAS: f32 = 1.0;

struct Targets {
    // In units of the source.
    radiance: vec4<f32>,
}

// The distribution of half vectors where n = v, from the cosine of the light's angle; times pi.
fn lobe(alpha: f32, n_dot_l: f32) -> f32 {
    // |n x h|^2 + (alpha n.h)^2, with (n.h)^2 = (1 + n.l) / 2.
    let along = 0.5 + 0.5 * n_dot_l;
    let spread = alpha * alpha * along + (0.5 - 0.5 * n_dot_l);
    return square(alpha / spread);
}

fn summed(cube: u32, normal: vec3<f32>, alpha: f32) -> vec3<f32> {
    let source_edge = textureDimensions(coarse).x;
    var sum = vec3<f32>(0.0);
    var weight = 0.0;
    for (var face = 0u; face < 6u; face++) {
        for (var index = 0u; index < source_edge * source_edge; index++) {
            let texel = vec2<u32>(index % source_edge, index / source_edge);
            let place = place_on_face(vec2<f32>(texel) + 0.5, f32(source_edge));
            let n_dot_l = dot(normal, normalize(cube_direction(face, place)));
            if n_dot_l > 0.0 {
                let covered = lobe(alpha, n_dot_l) * n_dot_l * texel_solid_angle(texel, source_edge);
                sum += covered * textureLoad(coarse, texel, 6u * cube + face, 0).rgb;
                weight += covered;
            }
        }
    }
    return sum / weight;
}

fn sampled(cube: u32, normal: vec3<f32>, alpha: f32, count: u32) -> vec3<f32> {
    let frame = frame_around(normal);
    let source_edge = f32(textureDimensions(source).x);
    // Texels of the source in all directions.
    let texels = 6.0 * square(source_edge);
    var sum = vec3<f32>(0.0);
    var weight = 0.0;
    for (var i = 0u; i < count; i++) {
        // The middle of each share.
        let number = sobol_2d(i) + 0.5 / f32(count);
        let along_squared = (1.0 - number.x) / (1.0 + (square(alpha) - 1.0) * number.x);
        let along = sqrt(along_squared);
        let across = sqrt(max(0.0, 1.0 - along_squared));
        let angle = 2.0 * PI * number.y;
        let n_dot_l = 2.0 * along_squared - 1.0;
        if n_dot_l > 0.0 {
            let to_light = frame * vec3<f32>(2.0 * along * across * vec2<f32>(cos(angle), sin(angle)), n_dot_l);
            let density = lobe(alpha, n_dot_l) / (4.0 * PI);
            let level = 0.5 * log2(texels / (4.0 * PI * density * f32(count))) + LEVEL_BIAS;
            sum += n_dot_l * textureSampleLevel(source, linear_clamp, to_light, cube, max(level, 0.0)).rgb;
            weight += n_dot_l;
        }
    }
    return sum / weight;
}

@fragment
fn prefilter(@builtin(position) position: vec4<f32>) -> Targets {
    let level = (params.i / 6u) % levels;
    let cube = params.i / (6u * levels);
    let level_edge = f32(max(edge >> level, 1u));
    let normal = normalize(cube_direction(params.i % 6u, place_on_face(position.xy, level_edge)));
    let alpha = ggx_alpha(level_roughness(level, levels));
    var radiance: vec3<f32>;
    if alpha >= LEAST_SUMMED_ALPHA {
        radiance = summed(cube, normal, alpha);
    } else {
        radiance = sampled(cube, normal, alpha, params.samples << level);
    }
    return Targets(vec4<f32>(round_half(radiance), 1.0));
}
