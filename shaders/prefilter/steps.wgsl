// Which roughness each part of a prefiltered cube holds.
//
// There are two steps for each mip level, in two cubes. The last step holds roughness 1, each one before it sqrt(1/2) of that: where texels
// grow by two the angle of the lobe, which goes with roughness^2, grows by four, since wide lobes need the more texels, the wider the part
// of the sky that they mix. What is smoother than the first step lies between it and the environment itself.

const STEPS_PER_LEVEL: u32 = 2u;

fn step_roughness(step: u32, steps: u32) -> f32 {
    return exp2(-0.5 * f32(steps - 1u - step));
}

// Negative where the environment itself has a part.
fn roughness_step(roughness: f32, steps: u32) -> f32 {
    return f32(steps - 1u) + 2.0 * log2(max(roughness, 1.0e-4));
}
