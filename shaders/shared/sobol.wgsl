// The first two dimensions of Sobol's sequence: of each 2^k points in order, every elementary box of area 2^-k holds one (a
// (0, 2)-sequence). Sobol 1967; the second dimension by Kollig and Keller 2002, "Efficient Multidimensional Sampling", section 3.

// Numbers below 1 from the upper 24 bits, which is what a float holds.
fn unit_float(bits: u32) -> f32 {
    return f32(bits >> 8u) * exp2(-24.0);
}

fn sobol_2d(index: u32) -> vec2<f32> {
    var second = 0u;
    var direction = 1u << 31u;
    for (var rest = index; rest != 0u; rest >>= 1u) {
        if (rest & 1u) != 0u {
            second ^= direction;
        }
        direction ^= direction >> 1u;
    }
    return vec2<f32>(unit_float(reverseBits(index)), unit_float(second));
}
