// Chooses where in their pixels this frame is sampled. Layout of the result: shared/jitter.wgsl.

#import "shared/sobol.wgsl"

// The texture's own past: where the frame before was sampled.
var before: texture_2d<f32>;
// What was shown before: as large as the image.
var history: texture_2d<f32>;
var light: texture_2d<f32>;

// Places that come again and again: a history that keeps a tenth of each frame holds about as many.
const PLACES: u32 = 16u;

struct Targets {
    jitter: vec4<f32>,
}

@fragment
fn choose(@builtin(position) place: vec4<f32>) -> Targets {
    let index = (u32(textureLoad(before, vec2<i32>(1, 0), 0).x) + 1u) % PLACES;
    let point = sobol_2d(index) + 0.5 / f32(PLACES);
    if u32(place.x) == 0u {
        let pixels = point - 0.5;
        return Targets(vec4<f32>(pixels, vec2<f32>(pixels.x, -pixels.y) * 2.0 / vec2<f32>(textureDimensions(history))));
    }
    return Targets(vec4<f32>(f32(index), point.yx, 0.0));
}
