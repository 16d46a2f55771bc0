// Constants and small functions that several files need.

const PI: f32 = 3.14159265358979;

// Stands for "infinitely far away" where a real infinity would be risky: WGSL lets a compiler assume that there is none.
const VERY_FAR: f32 = 1.0e30;

// The largest finite value of a half float, which is what `rgba16float` holds.
const HALF_MAX: f32 = 65504.0;

// Light as it fits a half float: never negative, never infinite.
fn fit_half(light: vec3<f32>) -> vec3<f32> {
    return clamp(light, vec3<f32>(0.0), vec3<f32>(HALF_MAX));
}

fn square(x: f32) -> f32 {
    return x * x;
}

fn largest(v: vec3<f32>) -> f32 {
    return max(v.x, max(v.y, v.z));
}

fn smallest(v: vec3<f32>) -> f32 {
    return min(v.x, min(v.y, v.z));
}
