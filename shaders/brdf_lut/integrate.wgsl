// What a lobe reflects of light from everywhere: F0 * A + F90 * B, by cosine to the eye (columns) and roughness (rows).
//
// Karis 2013, "Real Shading in Unreal Engine 4", second factor of the split sum, with the height-correlated Smith term of shared/brdf.wgsl:
// a sum over visible half vectors (Heitz 2018, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4)), whose weight is
// G2 / G1 alone.

#import "brdf_lut/lookup.wgsl"
#import "shared/brdf.wgsl"
#import "shared/round_stored.wgsl"

struct Params {
    // Half vectors along each of two dimensions.
    samples: u32,
}

var<uniform> params: Params;

// Edge of the table.
override edge: u32 = 2;
// Whether it holds half floats.
override in_halves: bool = true;

// Stands for 0, where nothing is seen.
const LEAST_COSINE: f32 = 0.001;

struct Targets {
    // A and B.
    factors: vec4<f32>,
}

// Smith's Lambda: shadowed area per visible area.
fn smith_lambda(alpha: f32, cosine: f32) -> f32 {
    let cosine_squared = square(cosine);
    return 0.5 * (sqrt(1.0 + square(alpha) * (1.0 - cosine_squared) / cosine_squared) - 1.0);
}

// A half vector that the eye sees, in the frame of the normal; the eye stands over the x axis.
fn visible_half_vector(to_eye: vec3<f32>, alpha: f32, number: vec2<f32>) -> vec3<f32> {
    let stretched = normalize(vec3<f32>(alpha * to_eye.x, 0.0, to_eye.z));
    let radius = sqrt(number.x);
    // Both sides of the eye's plane reflect the same: one of them is enough.
    let angle = PI * (number.y - 0.5);
    let x = radius * cos(angle);
    let part = 0.5 * (1.0 + stretched.z);
    let y = mix(sqrt(max(0.0, 1.0 - x * x)), radius * sin(angle), part);
    // Across the eye's plane, up along it, and towards the eye.
    let up = vec3<f32>(-stretched.z, 0.0, stretched.x);
    let sampled = x * vec3<f32>(0.0, 1.0, 0.0) + y * up + sqrt(max(0.0, 1.0 - x * x - y * y)) * stretched;
    return normalize(vec3<f32>(alpha * sampled.xy, max(1.0e-6, sampled.z)));
}

@fragment
fn integrate(@builtin(position) position: vec4<f32>) -> Targets {
    let place = lut_place(floor(position.xy), f32(edge));
    let n_dot_v = max(place.x, LEAST_COSINE);
    let alpha = ggx_alpha(place.y);
    let to_eye = vec3<f32>(sqrt(1.0 - n_dot_v * n_dot_v), 0.0, n_dot_v);
    let from_eye = smith_lambda(alpha, n_dot_v);
    var sum = vec2<f32>(0.0);
    let count = params.samples * params.samples;
    for (var i = 0u; i < count; i++) {
        let cell = vec2<f32>(vec2<u32>(i % params.samples, i / params.samples));
        // Evenly by the height over the disc that half vectors are taken from, whose rim has the lobe's tail.
        let number = (cell + 0.5) / f32(params.samples);
        let height = 1.0 - number.x;
        let halfway = visible_half_vector(to_eye, alpha, vec2<f32>(1.0 - square(height), number.y));
        let v_dot_h = dot(to_eye, halfway);
        let n_dot_l = 2.0 * v_dot_h * halfway.z - n_dot_v;
        if n_dot_l > 0.0 {
            let seen = (1.0 + from_eye) / (1.0 + from_eye + smith_lambda(alpha, n_dot_l));
            let missing = saturate(1.0 - v_dot_h);
            let fresnel = square(square(missing)) * missing;
            sum += 2.0 * height * seen * vec2<f32>(1.0 - fresnel, fresnel);
        }
    }
    let mean = vec3<f32>(sum / f32(count), 0.0);
    return Targets(vec4<f32>(select(mean, round_half(mean), in_halves), 1.0));
}
