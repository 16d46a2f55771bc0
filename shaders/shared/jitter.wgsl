// Where in its pixel a frame is sampled: the texture in slot `jitter`, two texels. All zero is the pixel's centre, always.
//
// Texel 0: how far the image is shifted, in pixels right and down, and the same in clip space at w = 1. Texel 1: the sample's number,
// and two numbers in 0..1 that are as evenly spread as the places, for whatever else is sampled once a frame.

var jitter: texture_2d<f32>;

// A position in clip space, shifted.
fn jittered(clip_position: vec4<f32>) -> vec4<f32> {
    let shift = textureLoad(jitter, vec2<i32>(0, 0), 0).zw;
    return vec4<f32>(clip_position.xy + shift * clip_position.w, clip_position.zw);
}

// A place in the image to start random numbers from that are other ones for each sample: interleaved gradient noise takes another place in
// each frame so (Jimenez, "Next generation post processing in Call of Duty: Advanced Warfare", 2014).
fn pixel_of_sample(pixel: vec2<f32>) -> vec2<f32> {
    return pixel + 5.588238 * (textureLoad(jitter, vec2<i32>(1, 0), 0).x % 64.0);
}

// The place in the image, (0, 0) at its top left, of what a shifted image shows at `uv`.
fn unjittered_uv(uv: vec2<f32>) -> vec2<f32> {
    let shift = textureLoad(jitter, vec2<i32>(0, 0), 0).zw;
    return uv - vec2<f32>(shift.x, -shift.y) * 0.5;
}
