// Unit vectors as two numbers in -1 to 1: the octahedral map.
//
// Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 3(2). At 16 bits a number the
// direction is off by 0.004 degrees at most.

// 1 where not negative, else -1: unlike `sign`, never 0.
fn side_of_zero(v: vec2<f32>) -> vec2<f32> {
    return select(vec2<f32>(-1.0), vec2<f32>(1.0), v >= vec2<f32>(0.0));
}

fn octahedral_encode(direction: vec3<f32>) -> vec2<f32> {
    let folded = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    if direction.z >= 0.0 {
        return folded;
    }
    return (1.0 - abs(folded.yx)) * side_of_zero(folded);
}

fn octahedral_decode(code: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - abs(code.x) - abs(code.y);
    if z >= 0.0 {
        return normalize(vec3<f32>(code, z));
    }
    return normalize(vec3<f32>((1.0 - abs(code.yx)) * side_of_zero(code), z));
}
