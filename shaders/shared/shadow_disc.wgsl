// Samples of a disc that look random and clump nowhere, turned from pixel to pixel.

#import "shared/math.wgsl"

const DISC_SAMPLES: u32 = 32u;

// A Poisson disc (Cook, "Stochastic sampling in computer graphics", 1986) of radius 1 by Mitchell's best candidate ("Spectrally optimal
// sampling for distribution ray tracing", 1991): each point is the one of many candidates that lies farthest from those before it, so
// that the first half is as even as all of it.
const DISC: array<vec2<f32>, 32> = array<vec2<f32>, 32>(
    vec2<f32>(0.1200, -0.0800), vec2<f32>(-0.3652, 0.3693), vec2<f32>(-0.4886, -0.2568), vec2<f32>(0.3198, 0.4838),
    vec2<f32>(-0.0626, -0.6204), vec2<f32>(0.6485, 0.0577), vec2<f32>(0.4427, -0.4886), vec2<f32>(-0.0535, 0.7304),
    vec2<f32>(-0.7326, 0.1233), vec2<f32>(-0.4774, -0.6429), vec2<f32>(0.0018, 0.2824), vec2<f32>(-0.2517, 0.0182),
    vec2<f32>(0.7584, -0.3011), vec2<f32>(0.6833, 0.4244), vec2<f32>(-0.4072, 0.7193), vec2<f32>(0.2613, -0.7959),
    vec2<f32>(-0.6857, 0.4771), vec2<f32>(-0.8174, -0.2371), vec2<f32>(-0.1446, -0.2860), vec2<f32>(0.2663, 0.8145),
    vec2<f32>(0.3508, 0.1513), vec2<f32>(0.4196, -0.1483), vec2<f32>(0.5380, 0.6898), vec2<f32>(0.1562, -0.4193),
    vec2<f32>(-0.2267, -0.8591), vec2<f32>(-0.7233, -0.5136), vec2<f32>(0.8769, 0.2296), vec2<f32>(0.8952, -0.0537),
    vec2<f32>(0.7073, -0.5618), vec2<f32>(0.0333, -0.9157), vec2<f32>(0.5173, -0.7584), vec2<f32>(-0.4847, 0.1190),
);

// A number from 0 to 1 for a pixel, which is spread evenly among neighbours and is the same in every frame: interleaved gradient noise
// (Jimenez, "Next generation post processing in Call of Duty: Advanced Warfare", 2014).
fn interleaved_gradient_noise(pixel: vec2<f32>) -> f32 {
    return fract(52.9829189 * fract(dot(pixel, vec2<f32>(0.06711056, 0.00583715))));
}

// A turn by a random angle: cosine and sine.
fn random_turn(pixel: vec2<f32>) -> vec2<f32> {
    let angle = 2.0 * PI * interleaved_gradient_noise(pixel);
    return vec2<f32>(cos(angle), sin(angle));
}

// A sample of the disc, turned.
fn disc_sample(index: u32, turn: vec2<f32>) -> vec2<f32> {
    var disc = DISC;
    let place = disc[index];
    return vec2<f32>(place.x * turn.x - place.y * turn.y, place.x * turn.y + place.y * turn.x);
}
