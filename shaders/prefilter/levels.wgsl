// Which roughness each level of a prefiltered cube holds.
//
// Level 0 holds `sharpest_roughness`, the last one 1; in between each level is rougher by the same factor, since the angle of the lobe grows
// with roughness^2 and texels grow by two. What is smoother than level 0 is between it and the environment itself.

override sharpest_roughness: f32 = 0.1;

fn level_roughness(level: u32, levels: u32) -> f32 {
    return pow(sharpest_roughness, 1.0 - f32(level) / f32(max(levels, 2u) - 1u));
}

// Negative where the environment itself has a part.
fn roughness_level(roughness: f32, levels: u32) -> f32 {
    return (1.0 - log(max(roughness, 1.0e-4)) / log(sharpest_roughness)) * f32(max(levels, 2u) - 1u);
}
