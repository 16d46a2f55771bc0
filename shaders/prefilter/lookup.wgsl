// What a glossy surface sees along the mirrored direction: the slots `environment_cube` and `prefiltered`, of blocks/prefilter.ron and what
// it was made from.

#import "prefilter/steps.wgsl"

// Radiance, and its means over lobes.
var environment_cube: texture_cube_array<f32>;
var prefiltered: texture_cube_array<f32>;
var linear_clamp: sampler;

fn prefiltered_step(cube: u32, axis: vec3<f32>, step: u32) -> vec3<f32> {
    let layer = STEPS_PER_LEVEL * cube + step % STEPS_PER_LEVEL;
    return textureSampleLevel(prefiltered, linear_clamp, axis, layer, f32(step / STEPS_PER_LEVEL)).rgb;
}

// The mean of one of the cubes over a lobe around an axis, in units of the cube.
fn mean_over_lobe(cube: u32, axis: vec3<f32>, roughness: f32) -> vec3<f32> {
    let steps = STEPS_PER_LEVEL * textureNumLevels(prefiltered);
    let place = roughness_step(roughness, steps);
    if place < 0.0 {
        let sharp = textureSampleLevel(environment_cube, linear_clamp, axis, cube, 0.0).rgb;
        return mix(sharp, prefiltered_step(cube, axis, 0u), roughness / step_roughness(0u, steps));
    }
    let below = min(u32(place), steps - 1u);
    let above = min(below + 1u, steps - 1u);
    return mix(prefiltered_step(cube, axis, below), prefiltered_step(cube, axis, above), saturate(place - f32(below)));
}
