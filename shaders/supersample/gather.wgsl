// The running mean of the samples of each pixel.

// The next sample.
var light: texture_2d<f32>;
// The mean so far; alpha counts its samples.
var gathered: texture_2d<f32>;

struct Params {
    // Runs since something changed.
    accumulated: u32,
}

var<uniform> params: Params;

struct Targets {
    mean: vec4<f32>,
}

@fragment
fn gather(@builtin(position) place: vec4<f32>) -> Targets {
    let texel = vec2<i32>(place.xy);
    let sample = textureLoad(light, texel, 0).rgb;
    let before = textureLoad(gathered, texel, 0).rgb;
    let count = params.accumulated + 1u;
    // Not mix(): the first value may be anything, NaN included, and 0 times that is not 0.
    var mean = sample;
    if params.accumulated > 0u {
        mean = before + (sample - before) / f32(count);
    }
    return Targets(vec4<f32>(mean, f32(count)));
}
