// Chooses where in their pixels the next sample of all pixels lies. Layout of the result: shared/jitter.wgsl.

#import "shared/sobol.wgsl"

// The mean so far; alpha counts its samples. That this pass reads what `gather` left makes them a cycle: what changes outside of it
// starts both again, the next sample does not.
var gathered: texture_2d<f32>;

struct Params {
    // Runs since something changed.
    accumulated: u32,
    // How many samples make the mean.
    samples: u32,
}

var<uniform> params: Params;

// The R2 sequence: powers of the inverse of the plastic number (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
// Sequences"). Evenly spread, and by another rule than the places, so that the two don't go together.
const R2_STEP: vec2<f32> = vec2<f32>(0.7548776662466927, 0.5698402909980532);

struct Targets {
    jitter: vec4<f32>,
}

@fragment
fn choose(@builtin(position) place: vec4<f32>) -> Targets {
    let count = u32(textureLoad(gathered, vec2<i32>(0, 0), 0).a);
    let index = select(count, 0u, params.accumulated == 0u);
    // The points of a box of area 1 / samples start at its corner; half a step brings their mean to the pixel's centre.
    let point = sobol_2d(index) + 0.5 / f32(params.samples);
    if u32(place.x) == 0u {
        let pixels = point - 0.5;
        let size = vec2<f32>(textureDimensions(gathered));
        return Targets(vec4<f32>(pixels, vec2<f32>(pixels.x, -pixels.y) * 2.0 / size));
    }
    return Targets(vec4<f32>(f32(index), fract(0.5 + f32(index) * R2_STEP), 0.0));
}
