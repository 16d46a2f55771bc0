// What a glossy surface sees along the mirrored direction, of what blocks/prefilter.ron makes and of what it was made from.

#import "prefilter/steps.wgsl"
#import "shared/linear_clamp.wgsl"

fn prefiltered_step(prefiltered: texture_cube_array<f32>, cube: u32, axis: vec3<f32>, step: u32) -> vec3<f32> {
    let layer = STEPS_PER_LEVEL * cube + step % STEPS_PER_LEVEL;
    return textureSampleLevel(prefiltered, linear_clamp, axis, layer, f32(step / STEPS_PER_LEVEL)).rgb;
}

// The mean of one of the cubes over a lobe around an axis, in units of the cubes. `sharp` are the cubes themselves.
fn mean_over_lobe(
    sharp: texture_cube_array<f32>,
    prefiltered: texture_cube_array<f32>,
    cube: u32,
    axis: vec3<f32>,
    roughness: f32,
) -> vec3<f32> {
    let steps = STEPS_PER_LEVEL * textureNumLevels(prefiltered);
    let place = roughness_step(roughness, steps);
    if place < 0.0 {
        let mirrored = textureSampleLevel(sharp, linear_clamp, axis, cube, 0.0).rgb;
        return mix(mirrored, prefiltered_step(prefiltered, cube, axis, 0u), roughness / step_roughness(0u, steps));
    }
    let below = min(u32(place), steps - 1u);
    let above = min(below + 1u, steps - 1u);
    let parts = saturate(place - f32(below));
    return mix(prefiltered_step(prefiltered, cube, axis, below), prefiltered_step(prefiltered, cube, axis, above), parts);
}
