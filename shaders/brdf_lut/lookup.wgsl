// Where the table of what a lobe reflects has its texels: the first and the last stand at 0 and 1, so that what is fully rough or seen
// straight on is read without a step.

#import "shared/linear_clamp.wgsl"

// The cosine to the eye and the roughness of a texel.
fn lut_place(texel: vec2<f32>, edge: f32) -> vec2<f32> {
    return texel / (edge - 1.0);
}

// A and B: a lobe reflects F0 A + F90 B of light from everywhere.
fn lobe_factors(table: texture_2d<f32>, cosine: f32, roughness: f32) -> vec2<f32> {
    let edge = f32(textureDimensions(table).x);
    return textureSampleLevel(table, linear_clamp, (vec2<f32>(cosine, roughness) * (edge - 1.0) + 0.5) / edge, 0.0).rg;
}
