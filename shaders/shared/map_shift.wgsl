// By how much shadow maps are shifted against their texels: another part of a texel for each sample of a picture whose shadows are sampled,
// too. The texture in slot `shadow_jitter`, laid out as shared/jitter.wgsl has it; all zero shifts nothing.

var shadow_jitter: texture_2d<f32>;

// Texels to the right and down.
fn map_shift() -> vec2<f32> {
    return textureLoad(shadow_jitter, vec2<i32>(0, 0), 0).xy;
}

// A position in a shadow view's clip space, shifted on a map with so many texels along an edge.
fn shifted_on_map(clip_position: vec4<f32>, texels: u32) -> vec4<f32> {
    let shift = map_shift() * vec2<f32>(2.0, -2.0) / f32(texels);
    return vec4<f32>(clip_position.xy + shift * clip_position.w, clip_position.zw);
}
