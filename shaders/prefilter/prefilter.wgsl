// One face of one step of a prefiltered cube: the mean of the environment over the GGX lobe that is seen along its axis (n = v = r).
//
// Karis 2013, "Real Shading in Unreal Engine 4": the first factor of the split sum, weights D(h) (n.l) / 4. It is summed over the whole
// sphere by cells of a quadtree, whose levels are those of the source: a cell is divided while the lobe changes within it (as in Barnes
// and Hut 1986, "A hierarchical O(N log N) force-calculation algorithm"), and while it holds so much light that its place counts. So
// nothing small and bright is missed, as samples would, and what is dark costs little.

#import "environment/cube_texel.wgsl"
#import "prefilter/steps.wgsl"
#import "shared/brdf.wgsl"
#import "shared/round_stored.wgsl"

struct Params {
    // 6 * step + face, of the first cube; the others follow.
    i: u32,
    // How large a cell may be at most, by the angle over which the lobe changes much.
    cell_size: f32,
    // Which part of the light of the mean environment may be in doubt because of where it lies within a cell.
    doubt: f32,
}

var<uniform> params: Params;
// Six faces for each cube, with levels down to one texel.
var source: texture_2d_array<f32>;

// Edge of level 0 of the cube that is made, and how many steps there are.
override edge: u32 = 1;
override steps: u32 = 2;

// The chord over which the cosine changes much, wherever the lobe is flat.
const LONGEST_CHORD: f32 = 0.6;
// Of the cosine from the middle of a cell to its end, by the cell's size; counts most at the horizon, where the cosine itself is small.
const COSINE_CHANGE: f32 = 0.5;

struct Targets {
    // In units of the source.
    radiance: vec4<f32>,
}

// Bits 0, 2, 4.. as bits 0, 1, 2..
fn every_second_bit(bits: u32) -> u32 {
    var x = bits & 0x55555555u;
    x = (x | (x >> 1u)) & 0x33333333u;
    x = (x | (x >> 2u)) & 0x0f0f0f0fu;
    x = (x | (x >> 4u)) & 0x00ff00ffu;
    return (x | (x >> 8u)) & 0x0000ffffu;
}

// The distribution of half vectors where n = v, from the cosine of the light's angle; times pi.
fn lobe(alpha: f32, n_dot_l: f32) -> f32 {
    // |n x h|^2 + (alpha n.h)^2, with (n.h)^2 = (1 + n.l) / 2.
    let along = 0.5 + 0.5 * n_dot_l;
    let spread = alpha * alpha * along + (0.5 - 0.5 * n_dot_l);
    return square(alpha / spread);
}

// All cells in the order of a quadtree: face after face, a cell is either taken or its four parts are.
fn lobe_mean(cube: u32, normal: vec3<f32>, alpha: f32) -> vec3<f32> {
    let coarsest = textureNumLevels(source) - 1u;
    var everything = 0.0;
    for (var face = 0u; face < 6u; face++) {
        everything += largest(textureLoad(source, vec2<u32>(0u), 6u * cube + face, coarsest).rgb);
    }
    // The weights add up to 4 pi for a narrow lobe and to pi for the widest, which is the cosine.
    let most_in_doubt = params.doubt * 4.0 * PI / (1.0 + 3.0 * square(alpha)) * everything / 6.0;
    // The chord over which the lobe keeps most of its height, squared.
    let core = square(2.0 * alpha);
    var level = coarsest;
    // The cell: its face, and below that two bits for each level.
    var cell = 0u;
    var sum = vec3<f32>(0.0);
    var weight = 0.0;
    loop {
        let depth = coarsest - level;
        let face = cell >> (2u * depth);
        if face >= 6u {
            break;
        }
        let edge = f32(1u << depth);
        let texel = vec2<u32>(every_second_bit(cell), every_second_bit(cell >> 1u)) & vec2<u32>((1u << depth) - 1u);
        let place = place_on_face(vec2<f32>(texel) + 0.5, edge);
        let along = inverseSqrt(1.0 + dot(place, place));
        let n_dot_l = dot(normal, cube_direction(face, place)) * along;
        // As an angle.
        let size = 2.0 / edge * along;
        // Half a diagonal below the horizon there is nothing of it above.
        if n_dot_l > -0.70710678 * size {
            // The chord over which the lobe changes much, from its axis to the middle of the cell.
            let chord = min(sqrt(core + 2.0 - 2.0 * n_dot_l), LONGEST_CHORD);
            let height = lobe(alpha, n_dot_l) * square(size) * along;
            let radiance = textureLoad(source, texel, 6u * cube + face, level).rgb;
            // By how much lobe and cosine change over the cell.
            let change = size * (max(n_dot_l, 0.0) / chord + COSINE_CHANGE);
            if level > 0u && (size > params.cell_size * chord || height * largest(radiance) * change > most_in_doubt) {
                level -= 1u;
                cell <<= 2u;
                continue;
            }
            let covered = height * max(n_dot_l, 0.0);
            sum += covered * radiance;
            weight += covered;
        }
        cell += 1u;
        while level < coarsest && (cell & 3u) == 0u {
            cell >>= 2u;
            level += 1u;
        }
    }
    return sum / weight;
}

@fragment
fn prefilter(@builtin(position) position: vec4<f32>) -> Targets {
    let step = (params.i / 6u) % steps;
    let cube = params.i / (6u * steps);
    let level_edge = f32(max(edge >> (step / STEPS_PER_LEVEL), 1u));
    let normal = normalize(cube_direction(params.i % 6u, place_on_face(position.xy, level_edge)));
    let alpha = ggx_alpha(step_roughness(step, steps));
    return Targets(vec4<f32>(round_stored(lobe_mean(cube, normal, alpha)), 1.0));
}
