// A mip level from the one above: the mean of each two by two texels. Of an odd edge the last row counts for nothing.

var larger: texture_2d<f32>;

struct Targets {
    smaller: vec4<f32>,
}

@fragment
fn halve(@builtin(position) place: vec4<f32>) -> Targets {
    let first = 2 * vec2<i32>(place.xy);
    let above = textureLoad(larger, first, 0) + textureLoad(larger, first + vec2<i32>(1, 0), 0);
    let below = textureLoad(larger, first + vec2<i32>(0, 1), 0) + textureLoad(larger, first + 1, 0);
    return Targets(0.25 * (above + below));
}
