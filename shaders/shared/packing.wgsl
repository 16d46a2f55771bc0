// Numbers in few bits.

const EXPONENT_BIAS: i32 = 32768;
const EXPONENT_LEAST: i32 = -126;
const EXPONENT_MOST: i32 = 127;

// A colour of any brightness in 64 bits: three 16 bit fractions of a common power of two, whose exponent takes the fourth 16.
// Off by at most 2^-17 of twice the largest component; needs to know no unit, unlike a half float. Negative becomes 0.
fn pack_shared_exponent(color: vec3<f32>) -> vec2<u32> {
    let positive = max(color, vec3<f32>(0.0));
    let peak = max(positive.x, max(positive.y, positive.z));
    if !(peak > 0.0) {
        return vec2<u32>(0u);
    }
    // The smallest power of two that is greater than the peak.
    let exponent = clamp(frexp(peak).exp, EXPONENT_LEAST, EXPONENT_MOST);
    let fraction = positive * exp2(-f32(exponent));
    let red_green = pack2x16unorm(fraction.xy);
    let blue = pack2x16unorm(vec2<f32>(fraction.z, 0.0));
    return vec2<u32>(red_green, blue | (u32(exponent + EXPONENT_BIAS) << 16u));
}

fn unpack_shared_exponent(bits: vec2<u32>) -> vec3<f32> {
    if all(bits == vec2<u32>(0u)) {
        return vec3<f32>(0.0);
    }
    let exponent = i32(bits.y >> 16u) - EXPONENT_BIAS;
    let fraction = vec3<f32>(unpack2x16unorm(bits.x), unpack2x16unorm(bits.y).x);
    return fraction * exp2(f32(exponent));
}

// Two numbers in 0 to 1: the first in the low 16 bits, the second in the next 8; 8 bits of flags on top.
fn pack_16_8_8(first: f32, second: f32, flags: u32) -> u32 {
    let low = u32(saturate(first) * 65535.0 + 0.5);
    let middle = u32(saturate(second) * 255.0 + 0.5);
    return low | (middle << 16u) | (flags << 24u);
}

// The inverse: both numbers; the flags are `bits >> 24`.
fn unpack_16_8(bits: u32) -> vec2<f32> {
    return vec2<f32>(f32(bits & 0xffffu) / 65535.0, f32((bits >> 16u) & 0xffu) / 255.0);
}
