// Numbers as a float of fewer digits holds them best.
//
// Stores into short floats may round towards zero (WebGPU leaves it open, Mesa's software driver does), which takes 0.02 % of all light from
// half floats and 0.8 % from those of 11 and 10 bits. A number that a format holds exactly is stored as it is by every rounding.

// Whether the target is rg11b10ufloat and not of half floats.
override stored_in_11_bits: bool = false;

// Digits behind the leading one.
const HALF_DIGITS: vec3<u32> = vec3<u32>(10u, 10u, 10u);
const RG11B10_DIGITS: vec3<u32> = vec3<u32>(6u, 6u, 5u);
const SINGLE_DIGITS: vec3<u32> = vec3<u32>(23u, 23u, 23u);
// The largest that rg11b10ufloat holds.
const RG11B10_MAX: vec3<f32> = vec3<f32>(65024.0, 65024.0, 64512.0);

// The nearest number with so many digits; for what lies between 2^-14, where both formats begin to lose digits, and their largest number.
fn round_digits(value: vec3<f32>, digits: vec3<u32>) -> vec3<f32> {
    let dropped = SINGLE_DIGITS - digits;
    // Half of the last digit that stays.
    let bits = bitcast<vec3<u32>>(value) + ((vec3<u32>(1u) << dropped) >> vec3<u32>(1u));
    return bitcast<vec3<f32>>((bits >> dropped) << dropped);
}

fn round_half(value: vec3<f32>) -> vec3<f32> {
    return round_digits(value, HALF_DIGITS);
}

// Light, for a target of half floats or of rg11b10ufloat.
fn round_stored(value: vec3<f32>) -> vec3<f32> {
    if stored_in_11_bits {
        return min(round_digits(value, RG11B10_DIGITS), RG11B10_MAX);
    }
    return round_half(value);
}
