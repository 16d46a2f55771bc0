// Numbers as a half float holds them best.
//
// Stores into half floats may round towards zero (WebGPU leaves it open, Mesa's software driver does), which takes 0.02 % of all light. A
// number that a half float holds exactly is stored as it is by every rounding.

// The nearest number with eleven digits; for what lies between 2^-14, where half floats begin to lose digits, and HALF_MAX.
fn round_half(value: vec3<f32>) -> vec3<f32> {
    // Half of the last digit that stays, of the thirteen that go.
    let bits = bitcast<vec3<u32>>(value) + vec3<u32>(0x1000u);
    return bitcast<vec3<f32>>(bits & vec3<u32>(0xffffe000u));
}
