// Where each pixel starts to look: a pattern of 4 by 4 pixels, other ones for each sample of the image (Jimenez et al. 2016, "Practical
// Realtime Strategies for Accurate Indirect Occlusion", section 6).

// Of 4 by 4 pixels in a row, wherever they begin, each has another one of 16 turns. The starts of steps run across the turns.
const TURNS: u32 = 16u;
const STARTS: u32 = 4u;

// From one slice's start to the next one's: the golden ratio, so that slices of a pixel do not step in line.
const NEXT_START: f32 = 0.6180339887;

// How far a pixel's slices are turned, in parts of the angle between two of them. `shift` is one of the two numbers of a sample
// (shared/jitter.wgsl).
fn turn_of(texel: vec2<u32>, shift: f32) -> f32 {
    let turn = (((texel.x + texel.y) & 3u) << 2u) + (texel.x & 3u);
    return fract((f32(turn) + 0.5) / f32(TURNS) + shift);
}

// Where in its share of the way each step of a slice looks, 0 to 1.
fn start_of(texel: vec2<u32>, slice: u32, shift: f32) -> f32 {
    let start = (texel.y - texel.x) & (STARTS - 1u);
    return fract((f32(start) + 0.5) / f32(STARTS) + f32(slice) * NEXT_START + shift);
}
